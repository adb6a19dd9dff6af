// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps of sampled rigs that advance in step, with a case in each SIMD lane.
#include "solve/sampled/rig_lanes.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "model/model.hpp"
#include "solve/choose.hpp"
#include "sweep/case_scenario.hpp"
#include "sweep/group_runner.hpp"
#include "sweep/lane_measures.hpp"
#include "sweep/rig_lane_measures.hpp"
#include "sweep/runners.hpp"

namespace bbsim::sweep {
namespace {

bool fits_lanes(const Scenario& scenario, const model::Model& model) {
  return !scenario.solver.error && solve::choose_method(scenario.solver.method) == Method::radau &&
         solve::sampled::fits_sweep_lanes(model);
}

// The model of a case without gamma, which lanes lack.
model::Model model_of(const Scenario& scenario, const SweepTask& task) {
  scenario::Integrals integrals = false;
  integrals.work = scenario::any_needs(task.measures, scenario::Needs::work);
  return model::assemble(scenario, integrals);
}

const model::SignalPair& reference_of(const model::Model& model) {
  const model::SignalPair* reference = nullptr;
  solve::sampled::with_given_plate(model.system,
                                   [&](const auto& loop) { reference = &loop.reference(); });
  return *reference;
}

bool share_reference(const SweepPlan& plan) {
  return std::none_of(plan.axes().begin(), plan.axes().end(), [](const PlanAxis& axis) {
    return axis.key == "controller" || axis.key.starts_with("controller.reference") ||
           axis.key.starts_with("controller.commands");
  });
}

// Whether the rows of a rig in a lane have all that the column needs.
bool is_in_rows(const scenario::Column* column) {
  using scenario::Needs;
  const auto lacks = {Needs::gamma, Needs::orientation, Needs::work, Needs::own};
  return std::ranges::find(lacks, column->needs) == lacks.end();
}

class RigLaneRunner : public LaneRunner {
 public:
  RigLaneRunner(const SweepTask& task, const Scenario& first)
      : task_(task),
        scenario_(task),
        timed_(timed_rows(task, first)),
        grid_(timed_ ? timed_->grid : solve::OutputGrid(first.time)),
        tolerances_{first.solver.rtol, first.solver.atol},
        measures_(task.measures, task.series, grid_),
        lanes_(tolerances_, grid_, measures_.asks_for()) {}

  void run(std::span<GroupCase> cases, const std::atomic<bool>& stop) override {
    rigs_.clear();
    for (GroupCase& group_case : cases) take(group_case);
    if (rigs_.empty()) return;
    std::array<const model::Model*, solve::sampled::group> models{};
    for (std::size_t lane = 0; lane < rigs_.size(); ++lane) models[lane] = &rigs_[lane].model;
    measures_.begin(reference_of(rigs_.front().model));
    const auto done = lanes_.integrate(models.data(), rigs_.size(), measures_, stop);
    for (std::size_t lane = 0; lane < rigs_.size(); ++lane) {
      const Rig& rig = rigs_[lane];
      rig.of->is_done =
          done[lane] && measures_.finish(lane, rig.model, rig.constants, rig.of->measures);
      if (rig.of->is_done && !task_.series.empty()) {
        SeriesWriter writer(*rig.of->series, rig.of->place, timed_ ? &*timed_ : nullptr);
        measures_.write_series(lane, rig.model, rig.constants, writer);
      }
    }
  }

 private:
  // A case in a lane.
  struct Rig {
    GroupCase* of;
    model::Model model;
    model::BallConstants constants;
  };

  [[nodiscard]] bool has_rows(const OutputTimes& time) const {
    return timed_ ? time.end == grid_.end() : solve::OutputGrid(time) == grid_;
  }

  // Gives the case a lane if it fits into its group.
  void take(GroupCase& group_case) {
    try {
      const Scenario& scenario = scenario_.at(group_case.number, group_case.values);
      model::Model model = model_of(scenario, task_);
      if (!fits_lanes(scenario, model) || !has_rows(scenario.time) ||
          scenario.solver.rtol != tolerances_.rtol || scenario.solver.atol != tolerances_.atol ||
          (!rigs_.empty() && !solve::sampled::go_together(rigs_.front().model, model)) ||
          std::ranges::any_of(task_.measures,
                              [&](const scenario::Measure& measure) {
                                return bool(scenario::missing(measure, scenario));
                              }) ||
          std::ranges::any_of(task_.series, [&](const scenario::Column* column) {
            return bool(scenario::missing(*column, scenario));
          })) {
        return;
      }
      rigs_.push_back({&group_case, std::move(model), model::constants_of(scenario)});
    } catch (const InputError&) {  // the single run reports it
    }
  }

  const SweepTask& task_;
  CaseScenario scenario_;
  std::optional<TimedRows> timed_;
  solve::OutputGrid grid_;
  solve::Tolerances tolerances_;
  RigLaneMeasures measures_;
  solve::sampled::RigLanes lanes_;
  std::vector<Rig> rigs_;
};

}  // namespace

bool can_use_rig_lanes(const SweepTask& task) {
  // Fewer cases would leave lanes empty, and single runs match `bbsim run` bit for bit.
  if (task.plan.cases() < solve::sampled::group || !can_share_rows(task) ||
      !are_usual_measures(task.measures) || !share_reference(task.plan) ||
      !std::ranges::all_of(task.series, is_in_rows)) {
    return false;
  }
  constexpr std::size_t samples = 16;
  std::size_t found = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    try {
      const Scenario scenario = task.family.read(task.plan.settings(task.plan.sampled(i)));
      if (!scenario.controller) return false;
      if (fits_lanes(scenario, model_of(scenario, task))) ++found;
    } catch (const InputError&) {  // reported when the case is run
      continue;
    }
  }
  return 2 * found > samples;
}

std::size_t rig_group() {
  return solve::sampled::group;
}

std::unique_ptr<CaseRunner> rig_lane_runner(const SweepTask& task) {
  const Scenario first = task.family.read(task.plan.first_settings());
  return group_runner(task, first, solve::sampled::group,
                      std::make_unique<RigLaneRunner>(task, first));
}

}  // namespace bbsim::sweep
