// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables for tests.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "file/table_writer.hpp"

inline std::vector<std::vector<double>> numbers_of(const bbsim::file::Table& table) {
  std::vector<std::vector<double>> numbers;
  for (const bbsim::file::Column& column : table.columns) numbers.push_back(column.numbers);
  return numbers;
}

// Bitwise equality, except that all NaNs are equal.
inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) && std::isnan(b[i])) continue;
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  }
  return true;
}

// Doubles of every kind: any bit pattern, subnormals, zeros of both signs, the extremes.
inline bbsim::file::Table random_table(std::size_t columns, std::size_t rows) {
  using Limits = std::numeric_limits<double>;
  std::mt19937_64 random(20240229);
  const std::vector<double> special = {0.0,
                                       -0.0,
                                       Limits::min(),
                                       -Limits::denorm_min(),
                                       Limits::max(),
                                       Limits::lowest(),
                                       Limits::epsilon(),
                                       Limits::infinity(),
                                       Limits::quiet_NaN(),
                                       0.1};
  bbsim::file::Table table;
  for (std::size_t c = 0; c < columns; ++c) {
    std::vector<double> values(special);
    while (values.size() < rows) {
      constexpr std::uint64_t without_exponent = 0x800fffffffffffffULL;
      const std::uint64_t bits = values.size() % 4 == 0 ? random() & without_exponent : random();
      values.push_back(std::bit_cast<double>(bits));
    }
    values.resize(rows);
    table.columns.push_back({"c" + std::to_string(c), values});
  }
  table.rows = rows;
  return table;
}

// Writes in two blocks, as a run does.
inline void write_table(const std::string& file, const bbsim::file::Table& table,
                        const bbsim::file::Attributes& attributes = {}) {
  std::vector<bbsim::file::ColumnHeader> headers;
  for (const auto& column : table.columns) headers.push_back({column.name, "m", "one value a row"});
  const auto writer = bbsim::file::open_table(file, headers);
  const std::size_t rows = table.columns.empty() ? 0 : table.columns[0].numbers.size();
  const std::size_t half = rows / 2;
  std::vector<const double*> first, second;
  for (const auto& column : table.columns) {
    first.push_back(column.numbers.data());
    second.push_back(column.numbers.data() + half);
  }
  writer->append(first, half);
  writer->append(second, rows - half);
  writer->finish(attributes);
}
