// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The controller's reference for the ball as a function of time.
#pragma once

#include "model/signals/signal_pair.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// x and y (m), or phi and theta (rad), of the reference as functions of time (s) for a run until
// `end`, with the jumps before the end. A square wave jumps at most most_jumps times in a run.
[[nodiscard]] SignalPair reference_path(const Reference& reference, double end);

}  // namespace bbsim::model
