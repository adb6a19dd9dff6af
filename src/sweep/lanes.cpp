#include "sweep/lanes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <variant>

#include "model/model.hpp"
#include "record/track/track_measures.hpp"
#include "solve/choose.hpp"
#include "solve/rosenbrock/loop_lanes.hpp"
#include "sweep/case_scenario.hpp"
#include "sweep/lane_extremes.hpp"
#include "sweep/sample_cases.hpp"
#include "sweep/single.hpp"
#include "sweep/verdict.hpp"

namespace bbsim::sweep {
namespace {

using solve::rosenbrock::LoopCase;
constexpr std::size_t group = solve::rosenbrock::group;

// From here up the Rosenbrock method in lanes takes less time at the same error than radau case by
// case (docs/sweeps.md): its order is 5, but what is stiff costs it less.
constexpr double least_rtol = 1e-7, least_rtol_of_stiff = 1e-9;
constexpr double stiff = 1000;  // decays over the scene

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

// Whether most of the cases are, as far as some from all over the sweep tell.
bool are_stiff(const SweepTask& task) {
  constexpr int looked_at = 16;
  int found = 0;
  for (int i = 0; i < looked_at; ++i) {
    const Scenario scenario =
        task.family.read(task.plan.settings(sample_case(i, task.plan.cases())));
    const model::Model model = model::assemble(scenario, false, model::Symmetry::ignored);
    if (solve::decays_over_scene(model, scenario.time.end) > stiff) ++found;
  }
  return 2 * found > looked_at;
}

class LaneRunner : public CaseRunner {
 public:
  explicit LaneRunner(const SweepTask& task)
      : task_(task),
        first_(task.family.read(task.plan.settings(0))),
        scenario_(task),
        track_(task.measures),
        single_(single_runner(task)),
        same_signals_(task.plan.shares_signals()) {
    grid_.emplace(first_.time);
    lanes_.emplace(first_.controller->drives,
                   solve::Tolerances{first_.solver.rtol, first_.solver.atol}, *grid_);
  }

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

  bool run_group(std::size_t first, std::size_t place, std::size_t count, CaseResults& into,
                 const std::atomic<bool>& stop) {
    const std::size_t axes = task_.plan.axes().size(), numbers = 1 + task_.measures.size();
    std::array<LoopCase, group> loops;
    std::vector<LaneCase>& cases = cases_;
    cases.clear();
    alone_.clear();
    for (std::size_t i = place; i < place + count; ++i) {
      double* const values = &into.values[i * axes];
      task_.plan.values(first + i, values);
      const Scenario& scenario = scenario_.at(first + i, values);
      model::Model model = model::assemble(scenario, false, model::Symmetry::ignored);
      loops[cases.size()] = loop_case(scenario, model, record::signals_of(model).view());
      cases.push_back({i, std::move(model), model::constants_of(scenario)});
    }
    std::vector<const model::SignalPair*> references;
    for (const LaneCase& one : cases) references.push_back(&record::signals_of(one.model));
    extremes_.begin(references);
    const auto carried =
        lanes_->integrate(loops.data(), static_cast<int>(cases.size()), &extremes_);
    for (std::size_t lane = 0; lane < cases.size(); ++lane) {
      const LaneCase& one = cases[lane];
      const auto greatest = extremes_.of(lane);
      if (!carried[lane] || !greatest) {
        alone_.push_back(one.place);
        continue;
      }
      track_.begin(one.model, one.constants, *grid_, same_signals_);
      track_.take(grid_->size(), lanes_->rows() + lane, solve::rosenbrock::states * group, group,
                  *greatest);
      double* const results = &into.numbers[one.place * numbers];
      results[0] = grid_->end();
      track_.finish(results + 1);
      into.status[one.place] = {};
      judge(task_, first_, results + 1, into.status[one.place]);
    }
    for (const std::size_t i : alone_) {
      if (single_->run(first + i, 1, one_, stop) == 0) return false;
      std::copy(one_.numbers.begin(), one_.numbers.end(), &into.numbers[i * numbers]);
      into.status[i] = one_.status[0];
    }
    return true;
  }

  const SweepTask& task_;
  const Scenario first_;  // like which all are, but for their numbers
  CaseScenario scenario_;
  record::TrackMeasures track_;
  LaneExtremes extremes_;
  std::unique_ptr<CaseRunner> single_;
  bool same_signals_;
  std::optional<solve::OutputGrid> grid_;
  std::optional<solve::rosenbrock::LoopLanes> lanes_;
  std::vector<LaneCase> cases_;
  std::vector<std::size_t> alone_;
  CaseResults one_;
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
         record::has_track(model::assemble(scenario, false)) &&
         scenario.solver.rtol >= least_rtol_of_stiff &&
         (scenario.solver.rtol >= least_rtol || are_stiff(task));
}

std::size_t lane_group() {
  return group;
}

std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task) {
  return std::make_unique<LaneRunner>(task);
}

}  // namespace bbsim::sweep
