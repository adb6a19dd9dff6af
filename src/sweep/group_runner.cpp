#include "sweep/group_runner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sweep/single.hpp"
#include "sweep/verdict.hpp"

namespace bbsim::sweep {
namespace {

class GroupRunner : public CaseRunner {
 public:
  GroupRunner(const SweepTask& task, const Scenario& first, std::size_t group,
              std::unique_ptr<GroupCarrier> carrier)
      : task_(task),
        first_(first),
        group_(group),
        carrier_(std::move(carrier)),
        single_(single_runner(task)),
        has_all_(std::none_of(task.measures.begin(), task.measures.end(),
                              [&](const scenario::Measure& measure) {
                                return bool(scenario::missing(measure, first));
                              })) {}

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& stop) override {
    into.first = first;
    into.resize(count, task_);
    for (std::size_t i = 0; i < count; i += group_) {
      if (stop.load(std::memory_order_relaxed)) return i;
      if (!run_group(i, std::min(group_, count - i), into, stop)) return i;
    }
    return count;
  }

 private:
  // False if `stop` became true before all were run.
  bool run_group(std::size_t place, std::size_t count, CaseResults& into,
                 const std::atomic<bool>& stop) {
    const std::size_t axes = task_.plan.axes().size(), numbers = 1 + task_.measures.size();
    cases_.clear();
    for (std::size_t i = place; i < place + count; ++i) {
      double* const values = &into.values[i * axes];
      task_.plan.values(into.first + i, values);
      cases_.push_back({into.first + i, values, &into.numbers[i * numbers] + 1});
    }
    carrier_->carry(cases_);
    for (const GroupCase& one : cases_) {
      const std::size_t at = one.number - into.first;
      double* const results = &into.numbers[at * numbers];
      CaseStatus& status = into.status[at];
      if (one.carried) {
        results[0] = first_.time.end;
        if (status.word != "done" || !status.reason.empty()) status = {};
        if (!is_plain(one.measures)) judge(task_, first_, one.measures, status);
        continue;
      }
      if (single_->run(one.number, 1, alone_, stop) == 0) return false;
      std::copy(alone_.numbers.begin(), alone_.numbers.end(), results);
      status = alone_.status[0];
    }
    return true;
  }

  // Whether there is nothing to say about the measures.
  [[nodiscard]] bool is_plain(const double* measures) const {
    return has_all_ && std::all_of(measures, measures + task_.measures.size(),
                                   [](double value) { return std::isfinite(value); });
  }

  const SweepTask& task_;
  const Scenario first_;
  std::size_t group_;
  std::unique_ptr<GroupCarrier> carrier_;
  std::unique_ptr<CaseRunner> single_;
  bool has_all_;  // columns that the measures are of
  std::vector<GroupCase> cases_;
  CaseResults alone_;
};

}  // namespace

std::unique_ptr<CaseRunner> group_runner(const SweepTask& task, const Scenario& first,
                                         std::size_t group, std::unique_ptr<GroupCarrier> carrier) {
  return std::make_unique<GroupRunner>(task, first, group, std::move(carrier));
}

}  // namespace bbsim::sweep
