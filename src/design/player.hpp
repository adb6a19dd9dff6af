// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An Arduino sketch that plays a table of tilts and prints a log.
#pragma once

#include <string>
#include <vector>

#include "base/pair.hpp"

namespace bbsim::design {

struct Player {
  double rate = 0;                 // rows in a second, Hz
  std::vector<double> phi, theta;  // rad
  Pair ball{0, 0};                 // where it begins, m
};

// The table is in flash, as whole numbers of 16 bits. Throws InputError for one that is too long.
[[nodiscard]] std::string player_sketch(const Player& player);

}  // namespace bbsim::design
