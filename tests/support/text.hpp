// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Searches texts, and reads the numbers of CSVs.
#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace bbsim_test {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++times;
  }
  return times;
}

inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

inline std::vector<std::string> lines(const std::string& text) {
  return split(text, '\n');
}

// The cells of a CSV, with its header.
inline std::vector<std::vector<std::string>> rows(const std::string& csv) {
  std::vector<std::vector<std::string>> table;
  for (const std::string& line : lines(csv)) table.push_back(split(line, ','));
  return table;
}

// The numbers of a CSV by column.
inline std::map<std::string, std::vector<double>> columns_of(const std::string& csv) {
  std::map<std::string, std::vector<double>> columns;
  const auto table = rows(csv);
  for (std::size_t row = 1; row < table.size(); ++row) {
    for (std::size_t i = 0; i < table[row].size(); ++i) {
      columns[table[0][i]].push_back(std::stod(table[row][i]));
    }
  }
  return columns;
}

}  // namespace bbsim_test
