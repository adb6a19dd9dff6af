// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Places a log beside a run in time.
#pragma once

#include <string>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::api {

// Aligns the scene's last run, which is a log, with the first one if `align`. Returns sentences
// about the shift and the distance to that run.
[[nodiscard]] std::vector<std::string> place_log(replay::Scene& scene, bool align);

}  // namespace bbsim::api
