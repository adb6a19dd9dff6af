// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sweep of a scenario of this project, for tests of engines.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "scenario/family.hpp"
#include "scenario/measures.hpp"
#include "support/largest.hpp"
#include "sweep/plan.hpp"
#include "sweep/task.hpp"

namespace bbsim_test {

inline const std::atomic<bool> goes_on{false};

// A sweep with everything it refers to. `scene` is a path in the project.
struct Setup {
  Setup(const std::string& scene, std::vector<bbsim::Variation> vary,
        const std::vector<std::string>& set, const std::vector<std::string>& names,
        double samples = 0)
      : family(BBSIM_SOURCE_DIR "/" + scene, set),
        plan(family, sweep(std::move(vary), samples)),
        task{family, plan, measures(names)} {}

  bbsim::ScenarioFamily family;
  bbsim::sweep::SweepPlan plan;
  bbsim::sweep::SweepTask task;

 private:
  static bbsim::Sweep sweep(std::vector<bbsim::Variation> vary, double samples) {
    bbsim::Sweep made;
    made.vary = std::move(vary);
    if (samples > 0) made.samples = samples;
    return made;
  }
  static std::vector<bbsim::scenario::Measure> measures(const std::vector<std::string>& names) {
    std::vector<bbsim::scenario::Measure> found;
    for (const std::string& name : names) {
      const auto measure = bbsim::scenario::find_measure(name);
      CAPTURE(name);
      REQUIRE(measure);
      found.push_back(*measure);
    }
    return found;
  }
};

// Runs all cases on this thread.
inline bbsim::sweep::CaseResults run_all(bbsim::sweep::CaseRunner& runner,
                                         const bbsim::sweep::SweepTask& task) {
  bbsim::sweep::CaseResults results;
  REQUIRE(runner.run(0, task.plan.cases(), results, goes_on) == task.plan.cases());
  return results;
}

// Largest difference between two sweeps' numbers, relative for numbers above 1.
inline double largest_difference(const bbsim::sweep::CaseResults& a,
                                 const bbsim::sweep::CaseResults& b) {
  REQUIRE(a.numbers.size() == b.numbers.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.numbers.size(); ++i) {
    const double size = std::max(1.0, std::abs(a.numbers[i]));
    largest = largest_finite(largest, {std::abs(a.numbers[i] - b.numbers[i]) / size});
  }
  return largest;
}

// All cases end in the same way, and for the same reason.
inline void check_endings(const bbsim::sweep::CaseResults& a, const bbsim::sweep::CaseResults& b) {
  REQUIRE(a.status.size() == b.status.size());
  for (std::size_t i = 0; i < a.status.size(); ++i) {
    CAPTURE(i);
    CHECK(a.status[i].word == b.status[i].word);
    CHECK(a.status[i].reason == b.status[i].reason);
  }
}

}  // namespace bbsim_test
