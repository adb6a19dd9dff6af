// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A linear law whose equations are not known, from what it answers to pulses.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "model/control/linear_system.hpp"

namespace bbsim::model {

// What it answers from the sample of a pulse on, divided by the pulse: of each command (rows) to
// each coordinate (columns). At least four samples.
using PulseResponse = std::vector<Eigen::MatrixXd>;

// How many samples take in what a law of so many states does; the usual ones have at most a dozen.
inline constexpr int pulse_samples = 62;

// The law of fewest states with that response: A, B, C, D from sample to sample, without names and
// period. `noise` bounds the error of each number. Nothing if no such law comes near: within 2 % of
// the largest number. Method: Ho and Kalman, Regelungstechnik 14 (1966), with singular values as by
// Kung (1978).
[[nodiscard]] std::optional<LinearSystem> law_of(const PulseResponse& response, double noise);

}  // namespace bbsim::model
