// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A linear system as files that other programs read.
#pragma once

#include <string>

#include "model/control/linearize.hpp"

namespace bbsim::record {

// A linearization with its origin.
struct LinearReport {
  std::string scenario, kind, at;  // such as kind "loop", at "home"
  model::Linearization linearization{};
};

// An object with states, inputs, outputs, A, B, C, D, poles and period (null in continuous time),
// and with units, zeros, margins and bandwidths (null if there is none). Doubles read back bit for
// bit.
[[nodiscard]] std::string to_json(const LinearReport& report);

// The object `margins` of that.
[[nodiscard]] std::string margins_json(const model::Linearization& made);

// A script for MATLAB and Octave that sets A, B, C, D, the names and, if ss() is known, `sys`.
[[nodiscard]] std::string to_matlab(const LinearReport& report);

// A Python module that sets the same as numpy arrays and, if python-control is installed, `sys`.
[[nodiscard]] std::string to_python(const LinearReport& report);

// The matrix [A, B; C, D] with column names, and with row names in the first column.
[[nodiscard]] std::string to_csv(const LinearReport& report);

}  // namespace bbsim::record
