// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes the scenario of a case. Replaces numbers in place if no rule relates their keys to other
// keys; otherwise reads the scenario again.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenario/scenario.hpp"
#include "sweep/task.hpp"

namespace bbsim::sweep {

class CaseScenario {
 public:
  explicit CaseScenario(const SweepTask& task);
  CaseScenario(const CaseScenario&) = delete;  // places_ point into scenario_
  CaseScenario& operator=(const CaseScenario&) = delete;

  // Returns the scenario of case `number`, valid until the next call: its window, if the task has
  // windows. `values` are the plan's values for that case, already checked.
  [[nodiscard]] const Scenario& at(std::size_t number, const double* values);

 private:
  // Sets the values of the keys; returns whether that may have changed the scenario.
  bool put(std::size_t number, const double* values);

  const SweepTask& task_;
  Scenario scenario_;
  bool in_place_ = true;
  std::vector<std::vector<double*>> places_;  // for each axis
  std::vector<double> values_;                // of scenario_, if they are not in place
  std::optional<Scenario> window_;            // of scenario_
  double begin_ = 0, end_ = 0;                // of window_, s
};

}  // namespace bbsim::sweep
