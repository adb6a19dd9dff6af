// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An Arduino sketch that plays a table of tilts and prints a log.
#pragma once

#include <string>
#include <vector>

#include "base/pair.hpp"

namespace bbsim::design {

struct Player {
  double rate = 0;                 // rows per second, Hz
  std::vector<double> phi, theta;  // rad
  Pair ball{0, 0};                 // start of the ball, m
};

// The sketch keeps the table in flash, as 16-bit integers. Throws InputError if it is too long.
[[nodiscard]] std::string player_sketch(const Player& player);

}  // namespace bbsim::design
