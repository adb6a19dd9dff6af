// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/operating_point.hpp"

#include <type_traits>
#include <variant>
#include <vector>

#include "model/hybrid/hybrid_system.hpp"
#include "solve/integrate.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {
namespace {

// The row at the start, after all switches at that instant.
std::vector<double> first_row(const model::Model& model) {
  std::vector<double> row = model.initial;
  if (!model.hybrid()) {
    row.resize(model.row_size());
    return row;
  }
  // The resolution is 0: scenes with dry friction are refused.
  model::HybridSystem run(model, 0);
  run.handle_time_event(0, row.data());
  row.resize(model.row_size());
  run.write_extras(0, row.data(), row.data() + model.size() + (model.gamma ? 1 : 0));
  return row;
}

model::LinearPoint point_of(const model::Model& model, double time, const double* row) {
  const model::Sample sample = model.sample(time, row);
  model::LinearPoint point;
  const model::GimbalState& gimbal = sample.gimbal;
  point.state = {sample.ball.x,
                 sample.ball.y,
                 sample.ball.x_dot,
                 sample.ball.y_dot,
                 model.radius * sample.ball.gamma_dot,
                 gimbal.phi,
                 gimbal.theta,
                 gimbal.phi_dot,
                 gimbal.theta_dot};
  point.command = sample.command;
  point.time = time;
  std::visit(
      [&](const auto& system) {
        using Any = std::decay_t<decltype(system)>;
        if constexpr (Any::open_loop) {
          point.command = {gimbal.phi_ddot, gimbal.theta_ddot};
        } else {
          point.reference = system.reference().at(time);
        }
        // The states contain the angles of the servos, not of the plate.
        if constexpr (model::is_rig<Any> || model::is_coupled_loop<Any>) {
          point.state.assign(row, row + Any::size);
        }
        if constexpr (model::is_coupled_loop<Any>) {
          if (system.by == model::GimbalBy::given_torques) {
            for (std::size_t i = 0; i < 2; ++i) point.command[i] = point.reference[i].value;
          }
        } else if constexpr (model::is_coupled<Any>) {
          point.command = {gimbal.phi_ddot, gimbal.theta_ddot};
        }
      },
      model.system);
  return point;
}

}  // namespace

PointInTime point_in_time(const Scenario& scenario, const model::Model& model, double time,
                          const solve::Watch& watch) {
  PointInTime found;
  if (time == 0) {
    found.point = point_of(model, 0, first_row(model).data());
    return found;
  }
  const solve::OutputGrid grid(OutputTimes{time, time});
  solve::Trajectory trajectory(model.row_size());
  const Solver& solver = scenario.solver;
  found.outcome =
      solve::integrate(model, solver.method, {solver.rtol, solver.atol}, grid, trajectory, watch);
  if (found.outcome.ending == solve::Ending::done) {
    found.point = point_of(model, time, trajectory.row(trajectory.rows() - 1));
  }
  return found;
}

}  // namespace bbsim::study
