// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.hpp"
#include "base/real.hpp"
#include "base/text.hpp"
#include "file/line_reader.hpp"

namespace bbsim::file {

bool Column::is_text() const {
  return std::ranges::any_of(texts, [](const std::string& text) { return !text.empty(); });
}

bool Column::has_text(std::size_t i) const {
  return !texts.empty() && std::isnan(numbers[i]);
}

std::string Column::text(std::size_t i) const {
  if (has_text(i)) return texts[i];
  return std::isnan(numbers[i]) ? "" : number_text(numbers[i]);
}

void Column::add_text(std::string text) {
  texts.resize(numbers.size());
  texts.push_back(std::move(text));
  numbers.push_back(no_number);
}

void Column::keep(const std::vector<std::size_t>& rows) {
  std::vector<double> kept;
  std::vector<std::string> kept_texts;
  for (const std::size_t row : rows) {
    kept.push_back(numbers[row]);
    if (!texts.empty()) kept_texts.push_back(std::move(texts[row]));
  }
  numbers = std::move(kept);
  texts = std::move(kept_texts);
}

Table::Table(const std::vector<std::string>& names, std::vector<std::vector<double>> numbers)
    : rows(numbers.empty() ? 0 : numbers.front().size()) {
  for (std::size_t c = 0; c < names.size(); ++c) {
    columns.push_back({names[c], std::move(numbers[c])});
  }
}

Table::Table(std::vector<Column> its_columns)
    : columns(std::move(its_columns)),
      rows(columns.empty() ? 0 : columns.front().numbers.size() / columns.front().width) {}

const Column* Table::find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

Column* Table::find(std::string_view name) {
  return const_cast<Column*>(std::as_const(*this).find(name));
}

std::vector<std::string> Table::names() const {
  std::vector<std::string> names;
  std::ranges::transform(columns, std::back_inserter(names), &Column::name);
  return names;
}

std::vector<Column> Table::take_texts() {
  const auto texts = std::stable_partition(columns.begin(), columns.end(),
                                           [](const Column& column) { return !column.is_text(); });
  std::vector<Column> taken(std::make_move_iterator(texts), std::make_move_iterator(columns.end()));
  columns.erase(texts, columns.end());
  return taken;
}

void refuse_text(const std::string& file, const Column& column) {
  const auto text = std::ranges::find_if_not(column.texts, &std::string::empty);
  const Place& place = column.first_text;
  const std::string row =
      place.line == 0 ? ", row " + std::to_string(text - column.texts.begin() + 1) : "";
  const std::string what = "column " + shown(column.name) + row + ": found " +
                           quoted(*text, longest_name) + "; allowed: a number";
  throw InputError(
      {Problem{name_in_messages(file) + (place.line == 0 ? ""
                                                         : ':' + std::to_string(place.line) + ':' +
                                                               std::to_string(place.column)),
               what}});
}

}  // namespace bbsim::file
