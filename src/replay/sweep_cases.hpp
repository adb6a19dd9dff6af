// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Selects the cases of a large sweep that a page shows.
#pragma once

#include <cstddef>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::replay {

// Returns all cases if there are at most `most`. A grid has every combination of its keys' values
// once. It keeps every 2nd, 4th, 8th, ... value of the keys with the most values, so that the rest
// is a grid with the same first values. Other sweeps keep every n-th case.
[[nodiscard]] std::vector<std::size_t> cases_kept(const Sweep& sweep, std::size_t most);

}  // namespace bbsim::replay
