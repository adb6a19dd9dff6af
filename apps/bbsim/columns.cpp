// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim columns`: the columns that a run can record.
#include "scenario/columns.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "commands.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

ExitCode print_columns() {
  std::string report;
  const auto add = [&report](std::string_view name, std::string_view unit,
                             std::string_view meaning) {
    const auto padded = [](std::string_view text, std::size_t width) {
      std::string field(text);
      field.resize(std::max(width, field.size()), ' ');
      return field + ' ';
    };
    report += padded(name, 20) + padded(unit, 8);
    (report += meaning) += '\n';
  };
  add("column", "unit", "meaning");
  for (const scenario::Column& column : scenario::catalogue) {
    add(column.name, column.unit, column.meaning);
  }
  print(report);
  return ExitCode::done;
}

}  // namespace

void add_columns(Command& command, const Options& /*it has nothing to be quiet about*/) {
  command.does(print_columns);
}

}  // namespace bbsim::app
