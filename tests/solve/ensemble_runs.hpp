// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs lists of cases in an ensemble and records each outcome.
#pragma once

#include <algorithm>
#include <atomic>
#include <optional>
#include <vector>

#include "catch.hpp"
#include "solve/ensemble/ensemble.hpp"

namespace bbsim_test {

namespace ensemble = bbsim::solve::ensemble;

struct Course {
  ensemble::Ending ending = ensemble::Ending::given_up;
  double reached = 0;
  std::vector<double> x, y, state, greatest;

  bool operator==(const Course&) const = default;
};

class Cases : public ensemble::Study {
 public:
  explicit Cases(const std::vector<ensemble::Case>& cases) : runs(cases.size()), cases_(cases) {}

  std::optional<std::size_t> begin(ensemble::Case& one) override {
    if (begun_ == cases_.size()) return {};
    one = cases_[begun_];
    return begun_++;
  }
  void end(std::size_t number, const ensemble::Result& run) override {
    runs[number] = {run.ending,
                    run.reached,
                    {run.x, run.x + run.rows},
                    {run.y, run.y + run.rows},
                    {run.state, run.state + ensemble::states},
                    {run.greatest, run.greatest + bbsim::solve::ensemble::size_count}};
    ++ended;
  }

  std::vector<Course> runs;
  std::size_t ended = 0;

 private:
  const std::vector<ensemble::Case>& cases_;
  std::size_t begun_ = 0;
};

inline std::vector<Course> carry(ensemble::Ensemble& lanes,
                                 const std::vector<ensemble::Case>& cases) {
  const std::atomic<bool> stop{false};
  Cases study(cases);
  lanes.carry(study, stop);
  CHECK(study.ended == cases.size());
  return study.runs;
}

inline bool are_done(const std::vector<Course>& runs) {
  return std::all_of(runs.begin(), runs.end(),
                     [](const Course& run) { return run.ending == ensemble::Ending::done; });
}

// Runs cases together; checks that companions, their order and earlier runs do not matter.
inline std::vector<Course> carry_in_any_company(ensemble::Ensemble& lanes,
                                                const std::vector<ensemble::Case>& cases) {
  std::vector<Course> together = carry(lanes, cases);
  CHECK(carry(lanes, cases) == together);
  std::vector<Course> backwards = carry(lanes, {cases.rbegin(), cases.rend()});
  std::reverse(backwards.begin(), backwards.end());
  CHECK(backwards == together);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CAPTURE(i);
    CHECK(carry(lanes, {cases[i]}).front() == together[i]);
  }
  return together;
}

}  // namespace bbsim_test
