// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/full_model.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "model/ball/simpler_equations.hpp"
#include "model/model.hpp"
#include "scenario/coupled.hpp"
#include "solve/cvode/derivative.hpp"
#include "solve/integrate.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {
namespace {

using solve::Trajectory;

constexpr solve::Tolerances tolerances{1e-9, 1e-11};

template <class Equation>
solve::Derivative simpler_derivative(const model::Model& model) {
  return std::visit(
      [](const auto& system) -> solve::Derivative {
        if constexpr (requires { system.template with_equation<Equation>(); }) {
          return [simpler = system.template with_equation<Equation>()](
                     double t, const double* z, double* dz) { simpler.derivative(t, z, dz); };
        } else {
          throw InputError("verify: simpler models are compared over scenarios without switches");
        }
      },
      model.system);
}

struct Position {
  double x, y;
};

Position position(const model::Model& model, double t, const double* row) {
  const model::BallMotion ball = model.sample(t, row).ball;
  return {ball.x, ball.y};
}

SimplerModel compare(std::string name, std::string equation, const Trajectory& full,
                     const Trajectory& simpler, const model::Model& model,
                     const solve::OutputGrid& grid) {
  SimplerModel result{std::move(name), std::move(equation)};
  const std::size_t rows = std::min(full.rows(), simpler.rows());
  for (std::size_t i = 0; i < rows; ++i) {
    const Position a = position(model, grid[i], full.row(i));
    const Position b = position(model, grid[i], simpler.row(i));
    const double dx = std::abs(a.x - b.x), dy = std::abs(a.y - b.y);
    if (dx > result.dx) std::tie(result.dx, result.at_dx) = std::pair(dx, grid[i]);
    if (dy > result.dy) std::tie(result.dy, result.at_dy) = std::pair(dy, grid[i]);
    result.reached = grid[i];
  }
  return result;
}

}  // namespace

void require_comparable(const Scenario& scenario) {
  const model::Model model = model::assemble(scenario, false);
  if (model.hybrid() || model.rig || scenario::is_coupled(scenario) ||
      !model::is_the_papers(scenario)) {
    throw InputError(
        scenario.source.file +
        ": simpler models are compared over scenarios with the paper's gimbal and ball, "
        "with prescribed motion or under pd, without events and limits; try --set "
        "events=null, or run `bbsim verify` without a scenario");
  }
}

FullModelStudy compare_simpler(const Scenario& scenario, const solve::Watch& watch) {
  require_comparable(scenario);
  const model::Model model = model::assemble(scenario, false);
  const solve::OutputGrid grid(scenario.time);
  Trajectory full(model.size());
  const solve::Outcome outcome =
      solve::integrate(model, Method::automatic, tolerances, grid, full, watch);
  FullModelStudy study;
  study.reached = outcome.reached;
  const auto add = [&](std::string name, std::string equation, solve::Derivative derivative) {
    const Trajectory rows =
        solve::integrate_by_bdf(std::move(derivative), model, tolerances, grid, watch);
    study.simpler.push_back(compare(std::move(name), std::move(equation), full, rows, model, grid));
  };
  add("slope only", "x'' = (5/7) g sin phi, y'' = -(5/7) g cos phi sin theta",
      simpler_derivative<model::SlopeOnly>(model));
  add("ball and plate",
      "x'' = (5/7)(g sin phi + x phi'^2 + y phi' theta'), "
      "y'' = (5/7)(-g sin theta + y theta'^2 + x phi' theta')",
      simpler_derivative<model::BallAndPlate>(model));
  study.interrupted = watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed);
  return study;
}

}  // namespace bbsim::study
