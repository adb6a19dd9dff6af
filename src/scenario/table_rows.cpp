// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/table_rows.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

constexpr std::size_t fewest_rows = 4;  // a C2 interpolant needs four without extra end conditions

// The file's content; nullptr after reporting a fault.
const file::TableData* load(const yaml::Value& file, const std::string& name) {
  yaml::Context& context = *file.context;
  const std::filesystem::path path = context.folder / name;
  const std::lock_guard lock(context.tables->mutex);
  auto& tables = context.tables->by_file;
  const auto known = tables.find(path.string());
  if (known != tables.end()) return known->second.data.get();

  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    file.refuse(", which is no regular file", "a table file");
    return nullptr;
  }
  try {
    auto data = std::make_shared<const file::TableData>(file::read_table(path.string()));
    return tables.emplace(path.string(), file::InputTable{name, std::move(data)})
        .first->second.data.get();
  } catch (const InputError& e) {
    for (const Problem& problem : e.problems()) {
      const std::string where = problem.where.empty() ? "" : problem.where + ": ";
      file.report(where + problem.message);
    }
    return nullptr;
  }
}

const std::vector<double>* find_column(const yaml::Value& key, const std::string& name,
                                       const file::TableData& data) {
  const auto found = std::ranges::find(data.names, name);
  if (found == data.names.end()) {
    std::vector<std::string> names;  // the names in the file, safe for a terminal
    for (const std::string& one : data.names) names.push_back(yaml::shown(one));
    yaml::refuse_name(key, {names.begin(), names.end()});
    return nullptr;
  }
  return &data.columns[static_cast<std::size_t>(found - data.names.begin())];
}

// The first fault of the rows as "found ...; allowed: ...", or nothing.
std::string fault(const TableRows& table, const std::vector<std::string_view>& value_keys,
                  std::string_view noun) {
  const std::size_t rows = table.times.size();
  if (rows < fewest_rows) {
    return "found " + std::to_string(rows) + (rows == 1 ? " row" : " rows") +
           "; allowed: at least " + std::to_string(fewest_rows);
  }
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string row = " in row " + std::to_string(i + 1) + " below the header";
    if (!std::isfinite(table.times[i])) {
      return "found the time " + number_text(table.times[i]) + row + "; allowed: a finite time";
    }
    for (std::size_t k = 0; k < value_keys.size(); ++k) {
      const double value = table.values[k][i];
      if (std::isfinite(value)) continue;
      return "found the " + std::string(value_keys[k]) + ' ' + number_text(value) + row +
             "; allowed: a finite " + std::string(noun);
    }
    if (i > 0 && !(table.times[i] > table.times[i - 1])) {
      return "found the time " + number_text(table.times[i]) + row + ", after " +
             number_text(table.times[i - 1]) + "; allowed: strictly increasing times";
    }
  }
  return "";
}

std::string cover_fault(const TableRows& table, double end) {
  const double first = table.times.front();
  const double last = table.times.back();
  if (first <= 0 && last >= end) return "";
  return "found times from " + number_text(first) + " to " + number_text(last) +
         " s; allowed: a table that covers the run, 0 to " + number_text(end) + " s";
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
  bool read(const yaml::Value& value, std::optional<yaml::UnitScale>& into) const {
    if (value.node->kind != yaml::Node::Kind::scalar) return value.refuse("", allowed());
    into = yaml::unit_scale(value.node->text, dimension);
    return into ? true : value.refuse("", allowed());
  }
};

void put_in_si(const std::optional<yaml::UnitScale>& unit, std::vector<double>& numbers) {
  if (!unit) return;
  for (double& number : numbers) number = unit->in_si(number);
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
  std::vector<std::string> names(column_keys.size());
  bool named = keys.required("file", yaml::Text{"the name of a CSV file"}, into.file);
  for (std::size_t k = 0; k < names.size(); ++k) {
    named =
        keys.required(column_keys[k], yaml::Text{"the name of a column of the file"}, names[k]) &&
        named;
  }
  std::optional<yaml::UnitScale> unit;
  if (const auto given = keys.find("unit")) named = UnitOf{dimension}.read(*given, unit) && named;
  if (dimension == yaml::Dimension::time) {
    if (const auto given = keys.find("time_unit")) {
      named = UnitOf{dimension}.read(*given, unit) && named;
      if (keys.find("unit")) named = given->report("found beside unit; allowed: one of them");
    }
  }
  if (!named) return false;
  const file::TableData* data = load(*keys.find("file"), into.file);
  if (data == nullptr) return false;
  into.columns.clear();
  into.has_unit = unit.has_value();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::vector<double>* found = find_column(*keys.find(column_keys[k]), names[k], *data);
    if (found == nullptr) continue;
    into.columns.push_back(*found);
    put_in_si(unit, into.columns.back());
  }
  if (into.columns.size() < names.size()) return false;
  for (std::size_t k = 0; k < into.columns.size(); ++k) {
    const std::vector<double>& column = into.columns[k];
    for (std::size_t i = 0; i < column.size(); ++i) {
      if (std::isfinite(column[i])) continue;
      return keys.mapping().report(
          yaml::shown(into.file) + ": found the " + std::string(column_keys[k]) + ' ' +
          number_text(column[i]) + " in row " + std::to_string(i + 1) +
          " below the header; allowed: a finite " + std::string(bare_noun(dimension)));
    }
  }
  return true;
}

void read_table_rows(yaml::Keys& keys, const std::vector<std::string_view>& value_keys,
                     yaml::Dimension dimension, TableRows& into) {
  constexpr yaml::Text column{"the name of a column of the file"};
  std::string time_name;
  std::vector<std::string> names(value_keys.size());
  bool named = keys.required("file", yaml::Text{"the name of a CSV file"}, into.file);
  named = keys.required("time", column, time_name) && named;
  for (std::size_t k = 0; k < names.size(); ++k) {
    named = keys.required(value_keys[k], column, names[k]) && named;
  }
  std::optional<yaml::UnitScale> unit, time_unit;
  if (const auto given = keys.find("unit")) named = UnitOf{dimension}.read(*given, unit) && named;
  if (const auto given = keys.find("time_unit")) {
    named = UnitOf{yaml::Dimension::time}.read(*given, time_unit) && named;
  }
  if (!named) return;

  const file::TableData* data = load(*keys.find("file"), into.file);
  if (data == nullptr) return;
  const std::vector<double>* times = find_column(*keys.find("time"), time_name, *data);
  std::vector<std::vector<double>> values;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::vector<double>* found = find_column(*keys.find(value_keys[k]), names[k], *data);
    if (found != nullptr) values.push_back(*found);
  }
  if (times == nullptr || values.size() < names.size()) return;
  into.times = *times;
  into.values = std::move(values);
  put_in_si(time_unit, into.times);
  for (std::vector<double>& one : into.values) put_in_si(unit, one);

  std::string wrong = fault(into, value_keys, bare_noun(dimension));
  if (wrong.empty() && keys.context().end) wrong = cover_fault(into, *keys.context().end);
  if (!wrong.empty()) keys.mapping().report(yaml::shown(into.file) + ": " + wrong);
  warn_of_units(keys.mapping(), into, value_keys, dimension, unit.has_value(),
                time_unit.has_value());
}

}  // namespace bbsim::scenario
