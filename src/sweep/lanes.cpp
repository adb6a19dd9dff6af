// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

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

bool has_single_harmonic(const Reference& reference) {
  return std::holds_alternative<PointReference>(reference) ||
         std::holds_alternative<CircleReference>(reference);
}

// Converts a loop of the paper to the numbers of a lane.
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

// Cases that share one call of the lanes. Some lanes are empty while the last cases finish; among
// this many cases that costs little.
constexpr std::size_t in_turn = 1024;

class LoopCarrier : public GroupCarrier, private solve::loop::LoopStudy {
 public:
  LoopCarrier(const SweepTask& task, const Scenario& first)
      : scenario_(task),
        track_(task.measures),
        grid_(first.time),
        lanes_(first.controller->drives, solve::loop::choose_nodes(first.solver.rtol),
               {first.solver.rtol, first.solver.atol}, grid_),
        same_signals_(task.plan.shares_signals()),
        ends_at_places_(std::all_of(
            task.measures.begin(), task.measures.end(), [](const scenario::Measure& measure) {
              return measure.kind != scenario::Measure::Kind::end || measure.column->name == "x" ||
                     measure.column->name == "y";
            })) {}

  void carry(std::span<GroupCase> cases, const std::atomic<bool>& stop) override {
    cases_ = cases;
    begun_ = 0;
    loops_.clear();
    loops_.resize(cases.size());
    lanes_.carry(*this, stop);
  }

 private:
  struct Loop {
    model::Model model;
    model::BallConstants constants;
  };

  std::optional<std::size_t> begin(LoopCase& loop) override {
    if (begun_ == cases_.size()) return {};
    const GroupCase& one = cases_[begun_];
    const Scenario& scenario = scenario_.at(one.number, one.values);
    model::Model model = model::assemble(scenario, false, model::Form::full);
    loop = loop_case(scenario, model, record::signals_of(model).view());
    loops_[begun_].emplace(Loop{std::move(model), model::constants_of(scenario)});
    return begun_++;
  }

  void end(std::size_t number, const solve::loop::LoopRun& run) override {
    using solve::loop::LoopEnding;
    GroupCase& one = cases_[number];
    std::optional<Loop>& loop = loops_[number];
    const auto greatest = extremes(run);
    const bool unbounded = run.ending == LoopEnding::unbounded;
    // In the last row before infinity only x and y are known.
    if (run.ending != LoopEnding::given_up && greatest && (!unbounded || ends_at_places_)) {
      track_.begin(loop->model, loop->constants, grid_, same_signals_);
      std::array<double, solve::loop::states> last;
      std::copy_n(run.state, last.size(), last.begin());
      if (unbounded) {
        last[0] = run.x[run.rows - 1];
        last[1] = run.y[run.rows - 1];
      }
      track_.take(run.rows, run.x, run.y, last.data(), *greatest);
      track_.finish(one.measures);
      one.carried = true;
      if (unbounded) one.unbounded_at = run.reached;
    }
    loop.reset();
  }

  // Empty if a square overflows or vanishes.
  [[nodiscard]] static std::optional<record::TrackExtremes> extremes(
      const solve::loop::LoopRun& run) {
    const double distance = run.greatest[solve::loop::distance_squared];
    const double error = run.greatest[solve::loop::error_squared];
    if (!record::is_square(distance) || !record::is_square(error)) return {};
    return record::TrackExtremes{run.greatest[solve::loop::versine],
                                 run.greatest[solve::loop::rate_squared], std::sqrt(distance),
                                 std::sqrt(error)};
  }

  CaseScenario scenario_;
  record::TrackMeasures track_;
  solve::OutputGrid grid_;
  solve::loop::LoopLanes lanes_;
  bool same_signals_;
  bool ends_at_places_;  // measures at the end are of x and y only
  std::span<GroupCase> cases_;
  std::size_t begun_ = 0;
  std::vector<std::optional<Loop>> loops_;  // of cases that are in a lane
};

}  // namespace

bool can_use_lanes(const SweepTask& task) {
  if (!task.series.empty() || !record::are_track_measures(task.measures) ||
      !task.plan.independent()) {
    return false;
  }
  // Among others, planar cases are carried with all states. A sweep of only planar cases has fewer
  // states, and runs singly. Everything else tested here is the same in all cases.
  const Scenario scenario = task.family.read(task.plan.general_settings());
  return scenario.controller && !scenario.solver.error &&
         solve::choose_method(scenario.solver.method) == Method::radau &&
         has_single_harmonic(scenario.controller->reference) &&
         record::has_track(model::assemble(scenario, false));
}

std::size_t lane_group() {
  return solve::loop::group;
}

std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task) {
  const Scenario first = task.family.read(task.plan.settings(0));
  return group_runner(task, first, in_turn, std::make_unique<LoopCarrier>(task, first));
}

}  // namespace bbsim::sweep
