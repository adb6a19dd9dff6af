// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The JSON of what a live page shows beside its run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "replay/live.hpp"
#include "replay/numbers.hpp"

namespace bbsim::replay {

[[nodiscard]] nlohmann::ordered_json live_json(const Live& live, const Numbers& numbers);

}  // namespace bbsim::replay
