#include "sweep/lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "model/model.hpp"
#include "record/track/track_measures.hpp"
#include "solve/choose.hpp"
#include "solve/loop/loop_lanes.hpp"
#include "sweep/case_scenario.hpp"
#include "sweep/group_runner.hpp"

namespace bbsim::sweep {
namespace {

using solve::loop::LoopCase;
constexpr std::size_t group = solve::loop::group;

bool has_single_harmonic(const Reference& reference) {
  return std::holds_alternative<PointReference>(reference) ||
         std::holds_alternative<CircleReference>(reference);
}

// A loop of the paper's, in the numbers that a lane has.
LoopCase loop_case(const Scenario& scenario, const model::Model& model,
                   const model::SignalView& reference) {
  LoopCase loop{};
  loop.radius = scenario.ball.radius;
  loop.gravity = scenario.gravity;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      loop.kv[i][j] = scenario.controller->kv[i][j];
      loop.kp[i][j] = scenario.controller->kp[i][j];
    }
    loop.start[i] = reference.start[i];
    loop.rate[i] = reference.rate[i];
    if (reference.harmonic_count == 0) continue;
    loop.sine[i] = reference.harmonics[0].sine[i];
    loop.cosine[i] = reference.harmonics[0].cosine[i];
  }
  if (reference.harmonic_count > 0) loop.frequency = reference.harmonics[0].frequency;
  if (scenario.gimbal.servo) {
    loop.omega_n = scenario.gimbal.servo->natural_frequency;
    loop.zeta = scenario.gimbal.servo->damping;
  }
  std::copy(model.initial.begin(), model.initial.end(), loop.initial);
  return loop;
}

class LoopCarrier : public GroupCarrier {
 public:
  LoopCarrier(const SweepTask& task, const Scenario& first)
      : scenario_(task),
        track_(task.measures),
        grid_(first.time),
        lanes_(first.controller->drives, solve::loop::choose_nodes(first.solver.rtol),
               {first.solver.rtol, first.solver.atol}, grid_),
        same_signals_(task.plan.shares_signals()) {
    lanes_.leave_out_all_but_places();
  }

  void carry(std::span<GroupCase> cases) override {
    std::array<LoopCase, group> loops;
    loops_.clear();
    for (const GroupCase& one : cases) {
      const Scenario& scenario = scenario_.at(one.number, one.values);
      model::Model model = model::assemble(scenario, false, model::Symmetry::ignored);
      loops[loops_.size()] = loop_case(scenario, model, record::signals_of(model).view());
      loops_.push_back({std::move(model), model::constants_of(scenario)});
    }
    const auto carried = lanes_.integrate(loops.data(), static_cast<int>(cases.size()));
    for (std::size_t lane = 0; lane < cases.size(); ++lane) {
      const auto greatest = extremes(lane);
      if (!carried[lane] || !greatest) continue;
      track_.begin(loops_[lane].model, loops_[lane].constants, grid_, same_signals_);
      track_.take(grid_.size(), lanes_.rows() + lane, lanes_.row_size(), group, *greatest);
      track_.finish(cases[lane].measures);
      cases[lane].carried = true;
    }
  }

 private:
  // None where squares were too large or too small for a double.
  [[nodiscard]] std::optional<record::TrackExtremes> extremes(std::size_t lane) const {
    const auto& of = lanes_.greatest().of;
    const double distance = of[solve::loop::distance_squared][lane];
    const double error = of[solve::loop::error_squared][lane];
    if (!record::is_square(distance) || !record::is_square(error)) return {};
    return record::TrackExtremes{of[solve::loop::versine][lane],
                                 of[solve::loop::rate_squared][lane], std::sqrt(distance),
                                 std::sqrt(error)};
  }

  struct Loop {
    model::Model model;
    model::BallConstants constants;
  };

  CaseScenario scenario_;
  record::TrackMeasures track_;
  solve::OutputGrid grid_;
  solve::loop::LoopLanes lanes_;
  bool same_signals_;
  std::vector<Loop> loops_;  // of the group, a lane each
};

}  // namespace

bool can_use_lanes(const SweepTask& task) {
  if (!task.series.empty() || !record::are_track_measures(task.measures) ||
      !task.plan.independent()) {
    return false;
  }
  // Planar cases among others are carried as these are; a sweep of planar ones alone has less to
  // integrate one by one. Whatever else is asked here is the same in all cases.
  const Scenario scenario = task.family.read(task.plan.general_settings());
  return scenario.controller && !scenario.solver.error &&
         solve::choose_method(scenario.solver.method) == Method::radau &&
         has_single_harmonic(scenario.controller->reference) &&
         record::has_track(model::assemble(scenario, false));
}

std::size_t lane_group() {
  return group;
}

std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task) {
  const Scenario first = task.family.read(task.plan.settings(0));
  return group_runner(task, first, group, std::make_unique<LoopCarrier>(task, first));
}

}  // namespace bbsim::sweep
