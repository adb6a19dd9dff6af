// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables of numbers and texts: runs, sweeps, and logs of rigs. The one reader of files.
#pragma once

#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/number_text.hpp"

namespace bbsim::file {

// Text or a number.
class AttributeValue {
 public:
  using Variant = std::variant<std::string, double, std::int64_t>;

  AttributeValue(std::string text) : value_(std::move(text)) {}
  AttributeValue(const char* text) : value_(std::string(text)) {}
  AttributeValue(double number) : value_(number) {}
  template <std::integral Integer>
  AttributeValue(Integer number) : value_(static_cast<std::int64_t>(number)) {}

  [[nodiscard]] const Variant& value() const { return value_; }

  // The value as text, with numbers in their shortest form.
  [[nodiscard]] std::string text() const {
    if (const auto* real = std::get_if<double>(&value_)) return number_text(*real);
    if (const auto* whole = std::get_if<std::int64_t>(&value_)) return std::to_string(*whole);
    return std::get<std::string>(value_);
  }

  friend bool operator==(const AttributeValue&, const AttributeValue&) = default;

 private:
  Variant value_;
};

// Root attributes of an HDF5 file, in order. CSV cannot hold them.
using Attributes = std::vector<std::pair<std::string, AttributeValue>>;

// A place in a file, counted from 1; line 0 means none.
struct Place {
  std::size_t line = 0, column = 0;
  friend auto operator<=>(const Place&, const Place&) = default;
};

// A number or a text per row. In the trajectories of a sweep, each row has `width` numbers,
// stored row after row.
struct Column {
  std::string name;
  std::vector<double> numbers;       // NaN where there is a text or nothing
  std::vector<std::string> texts{};  // empty if all fields are numbers; not of a number
  std::string unit{};                // from its file; empty if unknown
  std::size_t width = 1;
  Place first_text{};  // in a CSV, of the first field that is neither a number nor missing

  // Whether some field is neither a number nor missing.
  [[nodiscard]] bool is_text() const;
  // Whether a field is a text, or missing in a column that is not all numbers.
  [[nodiscard]] bool has_text(std::size_t i) const;
  // The field as text; empty for NaN.
  [[nodiscard]] std::string text(std::size_t i) const;
  void add_text(std::string text);
  // Keeps the rows with these indices, in this order.
  void keep(const std::vector<std::size_t>& rows);
};

// Columns in the file's order. Columns that were not requested have a name but no values.
struct Table {
  Table() = default;
  Table(const std::vector<std::string>& names, std::vector<std::vector<double>> numbers);
  explicit Table(std::vector<Column> its_columns);

  std::string file{};  // as the user wrote it; empty for a table in memory
  std::vector<Column> columns{};
  std::size_t rows = 0;
  Attributes attributes{};           // root attributes of an HDF5 file
  std::vector<std::string> notes{};  // what was left out or changed: "warning: ..." or "note: ..."

  // The column with this name, or null.
  [[nodiscard]] const Column* find(std::string_view name) const;
  [[nodiscard]] Column* find(std::string_view name);
  [[nodiscard]] std::vector<std::string> names() const;
  // Removes the columns of texts, and returns them.
  std::vector<Column> take_texts();
};

// A table that a scenario read, under the file name in the scenario.
struct InputTable {
  std::string file;
  std::shared_ptr<const Table> data;
};

// Options for reading a CSV.
struct CsvChoice {
  std::vector<std::string> wanted{};  // reads only these columns and t; empty: all
  std::vector<std::string> header{};  // the columns' names, if the file lacks them
};

// Reads an HDF5 file (by its ending) or a CSV; "-" is CSV on standard input. Commas, semicolons or
// tabs separate the fields of a CSV. Fields may be quoted; numbers may have decimal commas. Rows
// may name each field, as in "x:0.01 y:0.02", in place of a header. Skips lines before the header,
// blank lines and lines that start with #. A field that is not a number is text; a missing value is
// empty text. Throws InputError: where, found, allowed.
[[nodiscard]] Table read_table(const std::string& file, const CsvChoice& choice = {});

// Throws InputError for the first text of a column of the file: where, found, allowed.
[[noreturn]] void refuse_text(const std::string& file, const Column& column);

// The most bytes of a field or a name in messages.
inline constexpr std::size_t longest_name = 40;

}  // namespace bbsim::file
