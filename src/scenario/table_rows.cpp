// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/table_rows.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "file/clock.hpp"
#include "file/table.hpp"
#include "file/table_writer.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

constexpr std::size_t fewest_rows = 4;  // a C2 interpolant needs four without extra end conditions

using Names = std::vector<std::string>;

constexpr yaml::About about_file{"a file and its columns: [tables from files](#tables-from-files)"};
constexpr yaml::About about_header{"names of the columns of a CSV without a header"};

// The names of a table's columns, for a CSV without a header.
constexpr yaml::ListOf<yaml::Text, std::string> header_names{
    {"the name of a column"},
    1,
    1000,
    "names, one for each column, such as [t, x, y]",
    "each name once"};

void report(const yaml::Value& file, const InputError& error) {
  for (const Problem& problem : error.problems()) {
    const std::string where = problem.where.empty() ? "" : problem.where + ": ";
    file.report(where + problem.message);
  }
}

// The file's content; null after reporting a fault. All tables of a file have the same header.
const file::Table* load(yaml::Keys& keys, const std::string& name, const Names& header) {
  const yaml::Value file = *keys.find("file");
  yaml::Context& context = *file.context;
  const std::filesystem::path path = context.folder / name;
  context.table_files.emplace_back(file.path, path.string());
  const std::lock_guard lock(context.tables->mutex);
  auto& tables = context.tables->by_file;
  if (!header.empty() && file::format_of(path.string()) == file::Format::hdf5) {
    keys.find("header")->report(
        "found for an HDF5 file, which names its columns; allowed: for CSV");
    return nullptr;
  }
  const auto known = tables.find(path.string());
  if (known != tables.end()) {
    const file::Table& data = *known->second.data;
    if (header.empty() || data.names() == header) return &data;
    keys.find("header")->report("found other names than where " + yaml::shown(name) +
                                " is read first; allowed: the same names");
    return nullptr;
  }

  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    file.refuse(", which is not a regular file", "a table file");
    return nullptr;
  }
  try {
    file::Table data = file::read_table(path.string(), {{}, header});
    for (const std::string& note : data.notes) {
      const std::string text = note.substr(note.find(' ') + 1);
      note.starts_with("warning: ") ? file.warn(text) : file.mention(text);
    }
    // Trajectories of a sweep are not columns.
    std::erase_if(data.columns, [&](const auto& of) { return of.numbers.size() != data.rows; });
    return tables
        .emplace(path.string(),
                 file::InputTable{name, std::make_shared<const file::Table>(std::move(data))})
        .first->second.data.get();
  } catch (const InputError& error) {
    report(file, error);
    return nullptr;
  }
}

// A column that a key names.
struct Wanted {
  std::string_view key;
  yaml::Dimension dimension;
  std::string name{};
  std::optional<yaml::UnitScale> unit{};  // the given one, or that in the column's name

  void put_in_si(std::vector<double>& numbers) const {
    if (!unit) return;
    for (double& number : numbers) number = unit->in_si(number);
  }
};

// Reads the keys of a file and its columns.
bool read_names(yaml::Keys& keys, std::string& file, std::vector<Wanted>& columns, Names& header) {
  constexpr yaml::Text name{"the name of a column of the file"};
  bool named = keys.required("file", yaml::Text{"the name of a CSV file"}, file, about_file);
  for (Wanted& column : columns) {
    named = keys.required(column.key, name, column.name, yaml::same) && named;
  }
  return keys.optional("header", header_names, header, about_header) && named;
}

// Copies the columns from the file, with the units in their names and dates as seconds. Returns
// false after reporting a column that the file lacks, or a text.
bool take_columns(yaml::Keys& keys, const std::string& file, const Names& header,
                  std::vector<Wanted>& columns, std::vector<file::Column>& into) {
  const file::Table* const table = load(keys, file, header);
  if (table == nullptr) return false;
  const Names names = table->names();
  for (Wanted& column : columns) {
    const auto found = find_log_column(names, column.name, column.dimension);
    if (found) {
      into.push_back(table->columns[*found]);
      if (!column.unit) column.unit = unit_in_name(into.back().name, column.dimension);
      if (column.key != "time") continue;
      if (const auto done = file::read_stamps(into.back())) {
        keys.mapping().warn(yaml::shown(file) + ": " + *done);
        column.unit = yaml::UnitScale{};
      } else if (!column.unit) {
        const std::string_view unit = file::unit_since_epoch(into.back().numbers);
        if (unit.empty()) continue;
        column.unit = yaml::unit_scale(unit, yaml::Dimension::time);
        keys.mapping().warn(yaml::shown(file) + ": its times count from an epoch, in " +
                            std::string(unit));
      }
    } else {
      Names known;  // safe for a terminal
      for (const std::string& name : names) known.push_back(yaml::shown(name));
      yaml::refuse_name(*keys.find(column.key), {known.begin(), known.end()});
    }
  }
  if (into.size() < columns.size()) return false;
  const auto text = std::ranges::find_if(into, &file::Column::is_text);
  if (text == into.end()) return true;
  try {
    file::refuse_text(table->file, *text);
  } catch (const InputError& error) {
    report(*keys.find("file"), error);
  }
  return false;
}

std::string not_finite(std::string_view what, double value, std::size_t row,
                       std::string_view noun) {
  return "found the " + std::string(what) + ' ' + number_text(value) + " in row " +
         std::to_string(row + 1) + " below the header; allowed: a finite " + std::string(noun);
}

// The first fault of the rows as "found ...; allowed: ...", or nothing.
std::string fault(const TableRows& table, const std::vector<std::string_view>& value_keys,
                  std::string_view noun) {
  const std::size_t rows = table.times.size();
  if (rows < fewest_rows) {
    return "found " + counted(rows, "row") + "; allowed: at least " + std::to_string(fewest_rows);
  }
  for (std::size_t i = 0; i < rows; ++i) {
    if (!std::isfinite(table.times[i])) return not_finite("time", table.times[i], i, "time");
    for (std::size_t k = 0; k < value_keys.size(); ++k) {
      const double value = table.values[k][i];
      if (!std::isfinite(value)) return not_finite(value_keys[k], value, i, noun);
    }
    if (i > 0 && !(table.times[i] > table.times[i - 1])) {
      const bool same = table.times[i] == table.times[i - 1];
      return "found the time " + number_text(table.times[i]) + " in row " + std::to_string(i + 1) +
             " below the header, after " + number_text(table.times[i - 1]) +
             "; allowed: strictly increasing times; " +
             (same ? "remove one of the two rows"
                   : "sort the rows by time, or split the file where its clock starts again");
    }
  }
  return "";
}

std::string cover_fault(const TableRows& table, double end) {
  const double first = table.times.front();
  const double last = table.times.back();
  if (first <= 0 && last >= end) return "";
  return "found times from " + number_text(first) + " to " + number_text(last) +
         " s; allowed: a table that covers the run, 0 to " + number_text(end) + " s" +
         (first > end || (first > 0 && last - first >= end)
              ? "; time_offset: start makes its first row t = 0"
              : "");
}

// Whether the table has a regular clock, and ends at most one of its periods before the run does.
bool ends_a_period_early(const TableRows& table, double end) {
  if (table.times.size() < fewest_rows || !(table.times.back() < end)) return false;
  std::vector<double> periods;
  for (std::size_t i = 1; i < table.times.size(); ++i) {
    periods.push_back(table.times[i] - table.times[i - 1]);
  }
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::ranges::nth_element(periods, middle);
  const double longest = std::ranges::max(periods);
  constexpr double most = 2;         // times the median: a regular clock may jitter
  constexpr double rounding = 1e-6;  // of a clock with six digits
  return longest <= most * *middle && end - table.times.back() <= longest * (1 + rounding);
}

// Adds rows at times of -infinity and infinity, so that Spline holds the end values outside.
void hold_ends(TableRows& rows) {
  rows.times.insert(rows.times.begin(), -INFINITY);
  rows.times.push_back(INFINITY);
  for (std::vector<double>& values : rows.values) {
    values.insert(values.begin(), values.front());
    values.push_back(values.back());
  }
}

// The dimension's noun without its article: "angle".
std::string_view bare_noun(yaml::Dimension dimension) {
  const std::string_view noun = yaml::noun(dimension);
  return noun.substr(noun.find(' ') + 1);
}

// The name of a unit of the dimension.
struct UnitOf {
  yaml::Dimension dimension;

  [[nodiscard]] std::string allowed() const { return "one of " + yaml::unit_names(dimension); }
  [[nodiscard]] yaml::Declared declared() const {
    yaml::Declared unit(yaml::Declared::Kind::unit);
    unit.dimension = dimension;
    return unit;
  }
  bool read(const yaml::Value& value, yaml::UnitScale& into) const {
    if (value.node->kind != yaml::Node::Kind::scalar) return value.refuse("", allowed());
    const auto scale = yaml::unit_scale(value.node->text, dimension);
    if (scale) into = *scale;
    return scale ? true : value.refuse("", allowed());
  }
};

// Changes to a table: value(t) = offset + scale * table(t - delay).
struct Changes {
  std::vector<double> scales, offsets;  // one for each column of values; offsets in SI
  double delay = 0, time_offset = 0;    // s
  bool from_start = false;              // the first row is t = 0
};

// A number in the table's own unit, or a quantity.
struct OffsetOf {
  yaml::Dimension dimension;
  const std::optional<yaml::UnitScale>& unit;

  [[nodiscard]] std::string allowed() const { return yaml::Number{dimension}.allowed(); }
  [[nodiscard]] yaml::Declared declared() const { return yaml::Declared::number(dimension); }
  bool read(const yaml::Value& value, double& into) const {
    const yaml::Quantity bare =
        value.node->kind == yaml::Node::Kind::scalar
            ? yaml::read_quantity(value.node->text, value.node->quoted, yaml::Dimension::number)
            : yaml::Quantity{};
    if (!bare.value || !unit) return yaml::Number{dimension}.read(value, into);
    into = unit->in_si(*bare.value);
    value.note(into, dimension);
    return true;
  }
};

// A value for all columns, or a list with one for each.
template <class Rule>
struct ForEach {
  Rule rule;
  std::size_t columns;

  [[nodiscard]] std::string allowed() const { return rule.allowed(); }
  [[nodiscard]] yaml::Declared declared() const {
    if (columns == 1) return rule.declared();
    return yaml::Declared::any(
        {rule.declared(), yaml::Declared::list(columns, columns, rule.declared())});
  }
  [[nodiscard]] static std::string text_of(const std::vector<double>& values) {
    return number_text(values.front());
  }
  bool read(const yaml::Value& value, std::vector<double>& into) const {
    if (value.node->kind == yaml::Node::Kind::sequence && columns > 1) {
      return yaml::ListOf<Rule, double>{rule, columns, columns, "numbers, one for each column"}
          .read(value, into);
    }
    double number = 0;
    if (!rule.read(value, number)) return false;
    into.assign(columns, number);
    return true;
  }
};
template <class Rule>
ForEach(Rule, std::size_t) -> ForEach<Rule>;  // clang 14 deduces none for aggregates

struct TimeOffsetRule {
  static constexpr yaml::Number time{yaml::Dimension::time, {}, "0.02 or \"20 ms\", or start"};

  [[nodiscard]] static std::string allowed() { return time.allowed(); }
  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared start(yaml::Declared::Kind::name);
    start.names = {"start"};
    return yaml::Declared::any({time.declared(), start});
  }
  static bool read(const yaml::Value& value, Changes& into) {
    into.from_start = value.node->kind == yaml::Node::Kind::scalar && value.node->text == "start";
    return into.from_start || time.read(value, into.time_offset);
  }
};

// Reads all changes but the offset, which needs the table's unit.
bool read_changes(yaml::Keys& keys, std::size_t columns, yaml::Dimension dimension, Changes& into) {
  into.scales.assign(columns, 1);
  into.offsets.assign(columns, 0);
  bool fine = keys.optional(
      "scale", ForEach{yaml::Number{}, columns}, into.scales,
      {"value = offset + scale × table; the offset in the table's own unit", "-", "1, 0"});
  static_cast<void>(
      keys.find("offset", ForEach{yaml::Number{dimension}, columns}, yaml::same, "0"));
  fine = keys.optional("delay", yaml::Number{yaml::Dimension::time}, into.delay,
                       {"value(t) = table(t − delay)"}) &&
         fine;
  return keys.optional("time_offset", TimeOffsetRule{}, into,
                       {.meaning = "added to the table's times; `start`: its first row is t = 0",
                        .standard = "0",
                        .range = "a time, `start`"}) &&
         fine;
}

void move_times(const Changes& changes, std::vector<double>& times) {
  if (times.empty()) return;
  const double offset = changes.from_start ? -times.front() : changes.time_offset;
  if (offset == 0) return;
  for (double& time : times) time += offset;
}

// A delayed table holds its end values outside its rows.
void change_values(const Changes& changes, TableRows& rows) {
  for (std::size_t k = 0; k < rows.values.size(); ++k) {
    const double scale = changes.scales[k], offset = changes.offsets[k];
    if (scale == 1 && offset == 0) continue;
    for (double& value : rows.values[k]) value = offset + scale * value;
  }
  if (changes.delay == 0 || rows.times.empty()) return;
  for (double& time : rows.times) time += changes.delay;
  hold_ends(rows);
}

// Drops rows in which a column is empty, with a warning.
void leave_out_gaps(const yaml::Keys& keys, const std::string& file,
                    std::vector<file::Column>& columns) {
  std::vector<std::size_t> kept;
  std::optional<std::size_t> first;
  const std::size_t rows = columns.front().numbers.size();
  for (std::size_t i = 0; i < rows; ++i) {
    if (std::ranges::none_of(columns, [i](const auto& column) { return column.has_text(i); })) {
      kept.push_back(i);
    } else if (!first) {
      first = i;
    }
  }
  if (!first) return;
  const std::size_t count = rows - kept.size();
  keys.mapping().warn(yaml::shown(file) + ": " + std::to_string(count) +
                      (count == 1 ? " row lacks" : " rows lack") + " a number, first row " +
                      std::to_string(*first + 1) + " below the header; left out");
  for (file::Column& column : columns) column.keep(kept);
}

void warn_of_units(const yaml::Value& table, const TableRows& rows,
                   const std::vector<std::string_view>& value_keys, yaml::Dimension dimension,
                   bool has_unit, bool has_time_unit) {
  for (std::size_t k = 0; k < rows.values.size() && !has_unit; ++k) {
    const double largest = largest_size(rows.values[k]);
    const std::optional<Doubt> doubt = doubt_of(largest, dimension);
    if (!doubt) continue;
    warn_of_unit(table, rows.file,
                 std::string(value_keys[k]) + " goes up to " + number_text(largest), dimension,
                 *doubt, "unit");
    break;  // one warning suffices, because all values have one unit
  }
  const std::optional<double> run = table.context->end;
  if (has_time_unit || !run || rows.times.empty()) return;
  const double span = rows.times.back() - rows.times.front();
  const std::optional<Doubt> doubt = doubt_of_span(span, *run);
  if (!doubt) return;
  warn_of_unit(table, rows.file,
               "time spans " + number_text(span) + ", for a run of " + number_text(*run) + " s",
               yaml::Dimension::time, *doubt, "time_unit");
}

}  // namespace

void warn_of_unit(const yaml::Value& table, const std::string& file, const std::string& what,
                  yaml::Dimension dimension, const Doubt& doubt, std::string_view key) {
  const std::string its = std::string(key) + ": ", si(yaml::si_unit(dimension));
  table.warn(yaml::shown(file) + ": " + what + ", read in " + si + ": it looks like " +
             std::string(doubt.looks_like) + "; say " + its + std::string(doubt.units) + ", or " +
             its + si + " if that is right");
}

bool read_columns(yaml::Keys& keys, const std::vector<std::string_view>& column_keys,
                  yaml::Dimension dimension, FileColumns& into) {
  std::vector<Wanted> wanted;
  for (const std::string_view key : column_keys) wanted.push_back({key, dimension});
  Names header;
  bool named = read_names(keys, into.file, wanted, header);
  std::optional<yaml::UnitScale> unit;
  named = keys.optional("unit", UnitOf{dimension}, unit) && named;
  if (dimension == yaml::Dimension::time) {
    keys.exclusive({{"unit"}, {"time_unit"}});
    named = keys.optional("time_unit", UnitOf{dimension}, unit, yaml::same) && named;
    if (const auto given = keys.find("time_unit"); given && keys.find("unit")) {
      named = given->report("found beside unit; allowed: one of them");
    }
  }
  for (Wanted& column : wanted) column.unit = unit;
  std::vector<file::Column> columns;
  if (!named || !take_columns(keys, into.file, header, wanted, columns)) return false;
  into.columns.clear();
  into.has_unit = std::ranges::any_of(wanted, [](const Wanted& of) { return of.unit.has_value(); });
  for (std::size_t k = 0; k < columns.size(); ++k) {
    into.columns.push_back(std::move(columns[k].numbers));
    std::vector<double>& column = into.columns.back();
    wanted[k].put_in_si(column);
    const auto bad = std::ranges::find_if_not(column, [](double of) { return std::isfinite(of); });
    if (bad == column.end()) continue;
    return keys.mapping().report(yaml::shown(into.file) + ": " +
                                 not_finite(wanted[k].key, *bad,
                                            static_cast<std::size_t>(bad - column.begin()),
                                            bare_noun(dimension)));
  }
  return true;
}

void read_table_rows(yaml::Keys& keys, const std::vector<std::string_view>& value_keys,
                     yaml::Dimension dimension, TableRows& into) {
  std::vector<Wanted> wanted{{"time", yaml::Dimension::time}};
  for (const std::string_view key : value_keys) wanted.push_back({key, dimension});
  Names header;
  bool named = read_names(keys, into.file, wanted, header);
  std::optional<yaml::UnitScale> unit;
  Changes changes;
  named = keys.optional("unit", UnitOf{dimension}, unit) && named;
  named = keys.optional("time_unit", UnitOf{yaml::Dimension::time}, wanted[0].unit) && named;
  named = read_changes(keys, value_keys.size(), dimension, changes) && named;
  for (std::size_t k = 1; k < wanted.size(); ++k) wanted[k].unit = unit;
  std::vector<file::Column> columns;
  if (!named || !take_columns(keys, into.file, header, wanted, columns)) return;
  for (std::size_t k = 1; k < wanted.size() && !unit; ++k) unit = wanted[k].unit;
  if (const auto given = keys.find("offset");
      given && !ForEach{OffsetOf{dimension, unit}, value_keys.size()}.read(*given, changes.offsets))
    return;
  leave_out_gaps(keys, into.file, columns);
  into.times = std::move(columns[0].numbers);
  if (const auto done = file::unwrap(into.times)) {
    keys.mapping().warn(yaml::shown(into.file) + ": " + *done);
  }
  wanted[0].put_in_si(into.times);
  move_times(changes, into.times);
  for (std::size_t k = 1; k < wanted.size(); ++k) {
    wanted[k].put_in_si(columns[k].numbers);
    into.values.push_back(std::move(columns[k].numbers));
  }

  std::string wrong = fault(into, value_keys, bare_noun(dimension));
  bool holds_end = false;
  if (wrong.empty() && keys.context().end && changes.delay == 0) {
    const double end = *keys.context().end;
    holds_end = into.times.front() <= 0 && ends_a_period_early(into, end);
    if (holds_end) {
      keys.mapping().mention(yaml::shown(into.file) + ": its last row, at " +
                             number_text(into.times.back()) + " s, holds until time.end, " +
                             number_text(end) + " s");
    } else {
      wrong = cover_fault(into, end);
    }
  }
  if (!wrong.empty()) keys.mapping().report(yaml::shown(into.file) + ": " + wrong);
  warn_of_units(keys.mapping(), into, value_keys, dimension, unit.has_value(),
                wanted[0].unit.has_value());
  change_values(changes, into);
  if (holds_end) hold_ends(into);
}

}  // namespace bbsim::scenario
