// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which cases of a large sweep a page shows.
#pragma once

#include <cstddef>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::replay {

// All, if there are at most `most`. Of a grid, where every combination of the keys' values is there
// once, every 2nd, 4th, 8th, ... value of the keys with the most values, so that what is left is a
// grid with the same first values; of others every n-th case.
[[nodiscard]] std::vector<std::size_t> cases_kept(const Sweep& sweep, std::size_t most);

}  // namespace bbsim::replay
