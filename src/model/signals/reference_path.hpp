// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Where a controller wants the ball, as functions of time with their derivatives.
#pragma once

#include "model/signals/signal_pair.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// x and y (m) of the reference at time t (s).
[[nodiscard]] SignalPair reference_path(const Reference& reference);

}  // namespace bbsim::model
