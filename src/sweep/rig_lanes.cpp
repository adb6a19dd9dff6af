#include "sweep/rig_lanes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "model/model.hpp"
#include "record/track/track_measures.hpp"
#include "solve/choose.hpp"
#include "solve/held/rig_lanes.hpp"
#include "sweep/case_scenario.hpp"
#include "sweep/rig_lane_measures.hpp"
#include "sweep/sample_cases.hpp"
#include "sweep/single.hpp"
#include "sweep/verdict.hpp"

namespace bbsim::sweep {
namespace {

constexpr std::size_t group = solve::held::group;

bool is_carried(const Scenario& scenario, const model::Model& model) {
  return !scenario.solver.error && solve::choose_method(scenario.solver.method) == Method::radau &&
         solve::held::carries(model);
}

const model::SignalPair& reference_of(const model::Model& model) {
  return std::get<model::RigLoop<false>>(model.system).reference();
}

bool share_reference(const SweepPlan& plan) {
  return std::none_of(plan.axes().begin(), plan.axes().end(), [](const Axis& axis) {
    return axis.key == "controller" || axis.key.starts_with("controller.reference");
  });
}

class RigLaneRunner : public CaseRunner {
 public:
  explicit RigLaneRunner(const SweepTask& task)
      : task_(task),
        first_(task.family.read(task.plan.settings(0))),
        scenario_(task),
        grid_(first_.time),
        tolerances_{first_.solver.rtol, first_.solver.atol},
        measures_(task.measures, grid_),
        lanes_(tolerances_, grid_, measures_.asks_for()),
        single_(single_runner(task)) {}

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& stop) override {
    into.first = first;
    into.resize(count, task_);
    for (std::size_t i = 0; i < count; i += group) {
      if (stop.load(std::memory_order_relaxed)) return i;
      if (!run_group(first, i, std::min(group, count - i), into, stop)) return i;
    }
    return count;
  }

 private:
  // A case on its way through a lane.
  struct LaneCase {
    std::size_t place;  // among the results
    model::Model model;
    model::BallConstants constants;
  };

  // Whether the case can be carried among those of its group.
  bool take(std::size_t number, std::size_t place, const double* values) {
    try {
      const Scenario& scenario = scenario_.at(number, values);
      model::Model model = model::assemble(scenario, false);
      if (!is_carried(scenario, model) || solve::OutputGrid(scenario.time) != grid_ ||
          scenario.solver.rtol != tolerances_.rtol || scenario.solver.atol != tolerances_.atol ||
          (!cases_.empty() && !solve::held::go_together(cases_.front().model, model))) {
        return false;
      }
      cases_.push_back({place, std::move(model), model::constants_of(scenario)});
    } catch (const InputError&) {  // which whoever runs it alone tells of
      return false;
    }
    return true;
  }

  bool run_group(std::size_t first, std::size_t place, std::size_t count, CaseResults& into,
                 const std::atomic<bool>& stop) {
    const std::size_t axes = task_.plan.axes().size(), numbers = 1 + task_.measures.size();
    cases_.clear();
    alone_.clear();
    for (std::size_t i = place; i < place + count; ++i) {
      double* const values = &into.values[i * axes];
      task_.plan.values(first + i, values);
      if (!take(first + i, i, values)) alone_.push_back(i);
    }
    if (!cases_.empty()) {
      std::array<const model::Model*, group> models{};
      for (std::size_t lane = 0; lane < cases_.size(); ++lane) models[lane] = &cases_[lane].model;
      measures_.begin(reference_of(cases_.front().model));
      const auto carried = lanes_.integrate(models.data(), cases_.size(), measures_);
      for (std::size_t lane = 0; lane < cases_.size(); ++lane) {
        const LaneCase& one = cases_[lane];
        double* const results = &into.numbers[one.place * numbers];
        if (!carried[lane] || !measures_.finish(lane, one.model, one.constants, results + 1)) {
          alone_.push_back(one.place);
          continue;
        }
        results[0] = grid_.end();
        into.status[one.place] = {};
        judge(task_, first_, results + 1, into.status[one.place]);
      }
    }
    for (const std::size_t i : alone_) {
      if (single_->run(first + i, 1, one_, stop) == 0) return false;
      std::copy(one_.numbers.begin(), one_.numbers.end(), &into.numbers[i * numbers]);
      into.status[i] = one_.status[0];
    }
    return true;
  }

  const SweepTask& task_;
  const Scenario first_;  // like which all are, but for what varies
  CaseScenario scenario_;
  solve::OutputGrid grid_;
  solve::Tolerances tolerances_;
  RigLaneMeasures measures_;
  solve::held::RigLanes lanes_;
  std::unique_ptr<CaseRunner> single_;
  std::vector<LaneCase> cases_;
  std::vector<std::size_t> alone_;
  CaseResults one_;
};

}  // namespace

bool can_use_rig_lanes(const SweepTask& task) {
  // Fewer would leave lanes empty, and are those of `bbsim run` to the bit.
  if (task.plan.cases() < group || !task.series.empty() ||
      !record::are_track_measures(task.measures) || !share_reference(task.plan)) {
    return false;
  }
  constexpr int looked_at = 16;
  int found = 0;
  for (int i = 0; i < looked_at; ++i) {
    try {
      const Scenario scenario =
          task.family.read(task.plan.settings(sample_case(i, task.plan.cases())));
      if (!scenario.controller) return false;
      if (is_carried(scenario, model::assemble(scenario, false))) ++found;
    } catch (const InputError&) {  // refused when its turn comes
      continue;
    }
  }
  return 2 * found > looked_at;
}

std::size_t rig_group() {
  return group;
}

std::unique_ptr<CaseRunner> rig_lane_runner(const SweepTask& task) {
  return std::make_unique<RigLaneRunner>(task);
}

}  // namespace bbsim::sweep
