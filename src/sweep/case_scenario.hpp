// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenario of a case: numbers put in place where no rule minds, read anew otherwise.
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

  // The scenario is valid until the next call. `values` are those of the plan for that case, which
  // has been checked.
  [[nodiscard]] const Scenario& at(std::size_t number, const double* values);

 private:
  const SweepTask& task_;
  Scenario scenario_;
  bool in_place_ = true;
  std::vector<std::vector<double*>> places_;  // of each axis
};

}  // namespace bbsim::sweep
