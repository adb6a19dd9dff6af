// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/shown.hpp"
#include "replay/sources.hpp"
#include "scenario/columns.hpp"
#include "yaml/nearest.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::replay {
namespace {

struct Mapped {
  const scenario::Column* column;
  std::string from;
  double unit = 1;  // in SI units
};

[[noreturn]] void refuse(const std::string& part, const std::string& what) {
  throw InputError("--map: found " + bbsim::quoted(part, uncut) + what);
}

double unit_of(const std::string& part, const scenario::Column& column, const std::string& unit) {
  if (unit == column.unit) return 1;
  const yaml::Quantity one =
      yaml::read_quantity("1 " + unit, false, yaml::dimension_of(column.unit));
  if (one.value && !unit.empty()) return *one.value;
  refuse(part, ": " + std::string(column.name) + " is in " + std::string(column.unit) +
                   "; allowed: no unit, or a unit of the same quantity" + one.fault);
}

std::string near(const std::string& name, const std::vector<std::string_view>& names) {
  const std::string_view nearest = yaml::nearest_name(name, names);
  return nearest.empty() ? "" : "; did you mean " + std::string(nearest) + "?";
}

Mapped mapped(const std::string& part) {
  const std::size_t equals = part.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == part.size()) {
    refuse(part, "; allowed: COLUMN=NAME or COLUMN=NAME:UNIT, such as x=Ballx:mm");
  }
  const std::string name = part.substr(0, equals);
  const scenario::Column* const column = scenario::find_column(name);
  if (column == nullptr) {
    std::vector<std::string_view> names;
    for (const scenario::Column& one : scenario::catalogue) names.push_back(one.name);
    refuse(part, ": there is no column " + bbsim::quoted(name) + near(name, names) +
                     "; allowed: those of `bbsim columns`");
  }
  std::string from = part.substr(equals + 1);
  double unit = 1;
  if (const std::size_t colon = from.rfind(':'); colon != std::string::npos) {
    unit = unit_of(part, *column, from.substr(colon + 1));
    from.erase(colon);
  }
  return {column, from, unit};
}

std::vector<Mapped> read_map(const std::string& map) {
  std::vector<Mapped> all;
  for (std::size_t start = 0; start <= map.size();) {
    const std::size_t end = std::min(map.find(',', start), map.size());
    all.push_back(mapped(map.substr(start, end - start)));
    const auto same = [&](const Mapped& one) { return one.column == all.back().column; };
    if (std::ranges::count_if(all, same) > 1) {
      refuse(map.substr(start, end - start),
             ": " + std::string(all.back().column->name) + " is there twice");
    }
    start = end + 1;
  }
  return all;
}

void require_numbers(const plot::Result& log, const plot::Column& column) {
  for (std::size_t row = 0; row < column.texts.size(); ++row) {
    if (column.texts[row].empty() || !std::isnan(column.numbers[row])) continue;
    throw InputError(log.file + ": column " + shown(column.name) + ", row " +
                     std::to_string(row + 1) + ": found " + bbsim::quoted(column.texts[row]) +
                     "; allowed: numbers, or an empty field");
  }
}

}  // namespace

Run run_of_log(plot::Result log, const std::string& map, const std::string& name) {
  if (map.empty()) {
    log.units_known = true;  // as --data states
    return run_of_result(std::move(log), name);
  }
  std::vector<Mapped> all = read_map(map);
  const scenario::Column* const time = scenario::find_column("t");
  if (std::ranges::find(all, time, &Mapped::column) == all.end() && log.find("t") != nullptr) {
    all.push_back({time, "t", 1});
  }
  file::TableData table;
  for (const Mapped& one : all) {
    const plot::Column* const column = log.find(one.from);
    if (column == nullptr) {
      std::vector<std::string_view> names;
      std::string known;
      for (const plot::Column& there : log.columns) {
        names.push_back(there.name);
        known += (known.empty() ? "" : ", ") + shown(there.name);
      }
      throw InputError("--map: " + log.file + " has no column " + bbsim::quoted(one.from) +
                       near(one.from, names) + "; it has " + known);
    }
    require_numbers(log, *column);
    table.names.emplace_back(one.column->name);
    table.columns.push_back(column->numbers);
    for (double& number : table.columns.back()) number *= one.unit;
  }
  Run run = run_of_table(std::move(table), name);
  run.rolls = false;
  return run;
}

}  // namespace bbsim::replay
