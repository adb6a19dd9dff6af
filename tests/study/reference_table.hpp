// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The reference trajectories of tests/data/reference, with all their 21 digits.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/quad.hpp"

// Converts a decimal number to quad precision.
inline bbsim::Quad parse_quad(const std::string& text) {
  const std::size_t e = text.find_first_of("eE");
  int exponent = e == std::string::npos ? 0 : std::atoi(text.c_str() + e + 1);
  bbsim::Quad value = 0.0;
  bool fraction = false;
  for (const char c : text.substr(0, e)) {
    if (c == '.') fraction = true;
    if (c < '0' || c > '9') continue;
    value = value * 10 + (c - '0');
    if (fraction) --exponent;
  }
  bbsim::Quad power = 1.0;
  for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
  value = exponent < 0 ? value / power : value * power;
  return text[0] == '-' ? -value : value;
}

// Rows of t, x, y, vx, vy, spin, gamma, phi, theta, phi_rate, theta_rate.
inline std::vector<std::vector<bbsim::Quad>> read_reference_table(const std::string& scene) {
  const std::string path = BBSIM_SOURCE_DIR "/tests/data/reference/" + scene + ".csv";
  std::ifstream file(path);
  if (!file) throw std::runtime_error("no file " + path);
  std::vector<std::vector<bbsim::Quad>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<bbsim::Quad> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(parse_quad(cell));
    rows.push_back(row);
  }
  return rows;
}
