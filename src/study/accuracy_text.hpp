// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a study of accuracy as a table for people, as CSV for programs, or as a gnuplot script.
#pragma once

#include <string>

#include "study/accuracy.hpp"

namespace bbsim::study {

// Every point, then the best choice for each decade of error.
[[nodiscard]] std::string accuracy_table(const AccuracyStudy& study);

// method,rtol,atol,error_m,time_us,steps,rhs_evaluations,jacobian_evaluations,status
[[nodiscard]] std::string accuracy_csv(const AccuracyStudy& study);

enum class Picture { svg, png, pdf };

// A gnuplot script that writes a work-precision diagram to its standard output: time over error,
// both logarithmic, with one curve for each method. Runs that ended early are left out.
[[nodiscard]] std::string accuracy_plot(const AccuracyStudy& study, const std::string& title,
                                        Picture picture);

}  // namespace bbsim::study
