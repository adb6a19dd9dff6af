#include "sweep/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bbsim::sweep {

void judge(const SweepTask& task, const Scenario& scenario, double* measures, CaseStatus& status) {
  const std::size_t count = task.measures.size();
  for (std::size_t m = 0; m < count; ++m) {
    if (scenario::missing(task.measures[m], scenario)) {
      measures[m] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  const auto finite = [](double value) { return std::isfinite(value); };
  if (status.word != "done" || std::all_of(measures, measures + count, finite)) return;
  status.reason = scenario::why_not_finite(task.measures, measures, scenario);
}

DoneVerdict::DoneVerdict(const SweepTask& task, const Scenario& first)
    : task_(task),
      has_all_(std::none_of(task.measures.begin(), task.measures.end(),
                            [&](const scenario::Measure& measure) {
                              return bool(scenario::missing(measure, first));
                            })) {}

void DoneVerdict::judge(const Scenario& scenario, double* measures, CaseStatus& status) const {
  if (status.word != "done" || !status.reason.empty()) status = {};
  const bool is_plain = has_all_ && std::all_of(measures, measures + task_.measures.size(),
                                                [](double value) { return std::isfinite(value); });
  if (!is_plain) sweep::judge(task_, scenario, measures, status);
}

}  // namespace bbsim::sweep
