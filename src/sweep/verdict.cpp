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

}  // namespace bbsim::sweep
