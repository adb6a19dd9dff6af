// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes the scenario of a case. Replaces numbers in place if no rule relates their keys to other
// keys; otherwise reads the scenario again.
#pragma once

#include <cstddef>
#include <vector>

#include "scenario/scenario.hpp"
#include "sweep/task.hpp"

namespace bbsim::sweep {

class CaseScenario {
 public:
  explicit CaseScenario(const SweepTask& task);
  CaseScenario(const CaseScenario&) = delete;  // places_ point into scenario_
  CaseScenario& operator=(const CaseScenario&) = delete;

  // Returns the scenario of case `number`, valid until the next call. `values` are the plan's
  // values for that case, already checked.
  [[nodiscard]] const Scenario& at(std::size_t number, const double* values);

 private:
  const SweepTask& task_;
  Scenario scenario_;
  bool in_place_ = true;
  std::vector<std::vector<double*>> places_;  // for each axis
};

}  // namespace bbsim::sweep
