// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A linear system as files that other programs read.
#pragma once

#include <string>

#include "model/control/linearize.hpp"

namespace bbsim::record {

// A linearization, and what it is of.
struct LinearReport {
  std::string scenario, kind, at;  // "loop", "home"
  const model::Linearization& linearization;
};

// states, inputs, outputs, A, B, C, D, poles and period, which is null in continuous time; and
// beside them units, zeros, margins and bandwidths, null where there is none. Doubles read back to
// the bit.
[[nodiscard]] std::string to_json(const LinearReport& report);

// A script for MATLAB and Octave that sets A, B, C, D, the names and, where ss() is known, `sys`.
[[nodiscard]] std::string to_matlab(const LinearReport& report);

// A module for Python that sets the same as numpy arrays and, where python-control is there, `sys`.
[[nodiscard]] std::string to_python(const LinearReport& report);

// The matrix [A, B; C, D] with the names of its columns and, first, of its rows.
[[nodiscard]] std::string to_csv(const LinearReport& report);

}  // namespace bbsim::record
