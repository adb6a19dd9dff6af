// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/cell_table.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "file/formats.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file {

void CellColumn::add_number(double number) {
  numbers.push_back(number);
  if (is_text.empty()) return;
  is_text.push_back(false);
  texts.emplace_back();
}

void CellColumn::add_text(std::string text) {
  is_text.resize(numbers.size());
  texts.resize(numbers.size());
  numbers.push_back(std::numeric_limits<double>::quiet_NaN());
  is_text.push_back(true);
  texts.push_back(std::move(text));
}

void CellColumn::shorten(std::size_t count) {
  if (numbers.size() <= count) return;
  numbers.resize(count);
  if (is_text.empty()) return;
  is_text.resize(count);
  texts.resize(count);
  if (std::ranges::find(is_text, true) != is_text.end()) return;
  is_text.clear();
  texts.clear();
}

CellTable read_hdf5_cells(const std::string& file) {
  constexpr std::size_t rows_at_a_time = 65536;
  Hdf5TableReader reader(file, rows_at_a_time);
  CellTable table;
  for (const Hdf5Column& column : reader.columns()) {
    table.names.push_back(column.name);
    table.units.push_back(column.unit);
    table.columns.emplace_back();
    if (column.kind == Hdf5Kind::series) table.columns.back().width = column.width;
  }
  Hdf5Block block;
  while (reader.read(block)) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      CellColumn& column = table.columns[c];
      for (std::string& text : block.texts[c]) column.add_text(std::move(text));
      column.numbers.insert(column.numbers.end(), block.values[c].begin(), block.values[c].end());
    }
  }
  for (const auto& [column, values] : reader.head().axes) {
    table.names.push_back(column.name);
    table.units.push_back(column.unit);
    table.columns.emplace_back(values, values.size());  // one row with all values of the axis
  }
  table.rows = reader.rows();
  table.attributes = reader.head().attributes;
  return table;
}

const CellColumn* CellTable::find(std::string_view name) const {
  const auto at = std::ranges::find(names, name);
  return at == names.end() ? nullptr : &columns[static_cast<std::size_t>(at - names.begin())];
}

}  // namespace bbsim::file
