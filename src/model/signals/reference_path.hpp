// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The controller's reference for the ball as a function of time.
#pragma once

#include "model/signals/signal_pair.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// x and y (m) of the reference at time t (s), with their derivatives, for a run to t = `end`,
// with the jumps before the end; of a square wave no more than most_jumps.
[[nodiscard]] SignalPair reference_path(const Reference& reference, double end);

}  // namespace bbsim::model
