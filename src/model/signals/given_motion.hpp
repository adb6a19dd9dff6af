// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The gimbal's prescribed motion.
#pragma once

#include "model/signals/signal_pair.hpp"

namespace bbsim::model {

// phi and theta of a scene with gimbal.motion, including the mounting's offsets.
[[nodiscard]] SignalPair given_motion(const Scenario& scenario);

}  // namespace bbsim::model
