// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Identifies a linear law with unknown equations from its response to pulses.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "model/control/linear_system.hpp"

namespace bbsim::model {

// Response from the sample of a pulse on, divided by the pulse: rows are commands, columns are
// coordinates. At least four samples.
using PulseResponse = std::vector<Eigen::MatrixXd>;

// Number of samples that identifies a law; the usual ones have at most a dozen states.
inline constexpr int pulse_samples = 62;

// Returns the law of fewest states with that response: A, B, C, D from sample to sample, without
// names and period. `noise` bounds the error of each number. Empty if no such law fits within 2 %
// of the largest number. Method: Ho and Kalman, Regelungstechnik 14 (1966), with singular values as
// in Kung (1978).
[[nodiscard]] std::optional<LinearSystem> law_of(const PulseResponse& response, double noise);

}  // namespace bbsim::model
