// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a study of accuracy as a table for people, or as CSV for programs.
#pragma once

#include <string>

#include "study/accuracy.hpp"

namespace bbsim::study {

// Every point, then the best choice for each decade of error.
[[nodiscard]] std::string accuracy_table(const AccuracyStudy& study);

// method,rtol,atol,error_m,time_us,steps,rhs_evaluations,jacobian_evaluations,status
[[nodiscard]] std::string accuracy_csv(const AccuracyStudy& study);

}  // namespace bbsim::study
