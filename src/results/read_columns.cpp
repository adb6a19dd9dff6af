// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Converts tables of any origin to numbers and texts for pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/cell_table.hpp"
#include "results/read_result.hpp"
#include "scenario/columns.hpp"

namespace bbsim::results {
namespace {

bool has_digits_of_doubles(const Result& table) {
  constexpr std::size_t fewest = 15;  // characters of a number
  return std::ranges::any_of(table.columns, [](const Column& column) {
    return std::ranges::any_of(column.numbers, [](double number) {
      char text[longest_number];
      return static_cast<std::size_t>(write_number(text, number) - text) >= fewest;
    });
  });
}

// Whether bbsim seems to have written a table: all columns are in `bbsim columns`, some have names
// that only bbsim uses, and numbers have the digits of doubles, unlike a rig's log.
bool looks_like_a_run(const Result& table) {
  constexpr std::array<std::string_view, 12> anybodys = {
      "t", "x", "y", "vx", "vy", "phi", "theta", "spin", "tilt", "distance", "power", "energy"};
  if (table.find("t") == nullptr) return false;
  bool own_name = false;
  for (const Column& column : table.columns) {
    if (scenario::find_column(column.name) == nullptr) return false;
    own_name = own_name || std::ranges::find(anybodys, column.name) == anybodys.end();
  }
  return own_name && has_digits_of_doubles(table);
}

}  // namespace

Result result_of(file::CellTable cells, const std::string& file, std::vector<std::string>& notes) {
  notes.insert(notes.end(), cells.notes.begin(), cells.notes.end());
  const bool is_csv = !cells.file.empty();
  Result result;
  result.file = file;
  result.rows = cells.rows;
  if (result.rows == 0) {
    throw InputError(is_csv ? cells.file + ": has a header and no rows" : file + ": has no rows");
  }
  for (std::size_t c = 0; c < cells.columns.size(); ++c) {
    file::CellColumn& from = cells.columns[c];
    if (from.size() != result.rows) continue;  // trajectories of a sweep
    Column column{std::move(cells.names[c]), std::move(from.numbers)};
    if (!is_csv) column.unit = std::move(cells.units[c]);
    if (std::ranges::any_of(from.texts, [](const std::string& text) { return !text.empty(); })) {
      column.texts = std::move(from.texts);
      for (std::size_t row = 0; row < column.texts.size(); ++row) {
        const double number = column.numbers[row];
        if (!from.is_text[row] && !std::isnan(number)) column.texts[row] = number_text(number);
      }
    }
    result.columns.push_back(std::move(column));
  }
  result.units_known = !is_csv || result.is_sweep() || looks_like_a_run(result);
  return result;
}

Result read_csv_columns(const std::string& file, const std::vector<std::string>& header,
                        std::vector<std::string>& notes) {
  return result_of(file::read_cells(file, {{}, header}), file, notes);
}

}  // namespace bbsim::results
