// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::api {

// The last run of the scene is a log: aligns it with the first one if `align`. Returns sentences
// that say how far it was moved, and how far it is from that run.
[[nodiscard]] std::vector<std::string> place_log(replay::Scene& scene, bool align);

}  // namespace bbsim::api
