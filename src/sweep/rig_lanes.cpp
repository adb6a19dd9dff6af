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
#include "record/recorder.hpp"
#include "sweep/runners.hpp"

namespace bbsim::sweep {
namespace {

bool fits_lanes(const Scenario& scenario, const model::Model& model) {
  return !scenario.solver.error && choose_method(scenario.solver.method) == Method::radau &&
         solve::sampled::fits_sweep_lanes(model);
}

// The model of a case without gamma, which lanes lack.
model::Model model_of(const Scenario& scenario, const SweepTask& task) {
  scenario::Integrals integrals = false;
  integrals.work = scenario::any_needs(task.measures, scenario::Needs::work);
  return model::assemble(scenario, integrals);
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
  return column == nullptr || std::ranges::find(lacks, column->needs) == lacks.end();
}

// Whether lanes can take the measure. Their pieces do not end at samples, where the columns of
// samples jump.
bool is_in_lanes(const scenario::Measure& measure) {
  const auto has = [&](const scenario::Column* column) {
    return is_in_rows(column) && (column == nullptr || column->needs != scenario::Needs::samples ||
                                  measure.kind == scenario::Measure::Kind::end);
  };
  return has(measure.column) && has(measure.instant.column) && has(measure.reference);
}

class RigLaneRunner : public LaneRunner {
 public:
  RigLaneRunner(const SweepTask& task, const Scenario& first)
      : task_(task),
        scenario_(task),
        timed_(timed_rows(task, first)),
        grid_(timed_ ? timed_->grid : solve::OutputGrid(first.time)),
        tolerances_{first.solver.rtol, first.solver.atol},
        lanes_(tolerances_, grid_) {
    for (std::size_t lane = 0; lane < solve::sampled::group; ++lane) {
      recorders_[lane] =
          std::make_unique<record::Recorder>(record::RecordRequest{task.series, task.measures});
      recorders_[lane]->share_reference(lanes_.shared_reference());
    }
  }

  void run(std::span<GroupCase> cases, const std::atomic<bool>& stop) override {
    rigs_.clear();
    for (GroupCase& group_case : cases) take(group_case);
    if (rigs_.empty()) return;
    std::array<solve::sampled::RigLanes::Rig, solve::sampled::group> in_lanes{};
    std::array<std::optional<SeriesWriter>, solve::sampled::group> series;
    for (std::size_t lane = 0; lane < rigs_.size(); ++lane) {
      const Rig& rig = rigs_[lane];
      series[lane].emplace(*rig.of->series, rig.of->place, timed_ ? &*timed_ : nullptr);
      recorders_[lane]->begin(rig.model, rig.constants, grid_, &*series[lane]);
      in_lanes[lane] = {&rig.model, recorders_[lane].get()};
    }
    const auto done = lanes_.integrate(std::span(in_lanes).first(rigs_.size()), stop);
    solve::Outcome whole;
    whole.reached = grid_.end();
    whole.rows = grid_.size();
    for (std::size_t lane = 0; lane < rigs_.size(); ++lane) {
      GroupCase& of = *rigs_[lane].of;
      of.is_done = done[lane];
      if (!of.is_done) continue;
      recorders_[lane]->finish(whole, of.measures);
      of.whys = recorders_[lane]->whys();
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
  std::array<std::unique_ptr<record::Recorder>, solve::sampled::group> recorders_;
  solve::sampled::RigLanes lanes_;
  std::vector<Rig> rigs_;
};

}  // namespace

bool can_use_rig_lanes(const SweepTask& task) {
  // Fewer cases would leave lanes empty, and single runs match `bbsim run` bit for bit.
  if (task.plan.cases() < solve::sampled::group || !can_share_rows(task) ||
      !share_reference(task.plan) || !std::ranges::all_of(task.measures, is_in_lanes) ||
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
