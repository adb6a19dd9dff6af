// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `time`, `solver` and `output`.
#include <algorithm>
#include <set>

#include "scenario/columns.hpp"
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

constexpr double most_rows = 1e9;

std::vector<std::string_view> column_names() {
  std::vector<std::string_view> names;
  for (const Column& column : catalogue) names.push_back(column.name);
  return names;
}

struct Columns {
  [[nodiscard]] static std::string allowed() { return "a list of columns, such as [t, x, y]"; }
  // Any other name is a number of your own controller, if there is one.
  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared column(yaml::Declared::Kind::name);
    for (const std::string_view name : column_names()) column.names.emplace_back(name);
    yaml::Declared columns = yaml::Declared::list(
        1, yaml::Declared::unbounded, yaml::Declared::any({column, yaml::Declared::Kind::text}));
    columns.distinct = true;
    return columns;
  }
  [[nodiscard]] static std::string text_of(const std::vector<std::string>& columns) {
    return '[' + yaml::comma_separated({columns.begin(), columns.end()}) + ']';
  }
  static bool read(const yaml::Value& value, std::vector<std::string>& into) {
    if (value.node->kind != yaml::Node::Kind::sequence || value.node->items.empty()) {
      return value.refuse("", allowed());
    }
    into.clear();
    std::set<std::string_view> seen;
    std::size_t own = 0;
    for (std::size_t i = 0; i < value.node->items.size(); ++i) {
      const yaml::Value item = value.item(i);
      const std::string& name = item.node->text;
      if (std::ranges::find(catalogue, name, &Column::name) == catalogue.end()) {
        if (!value.context->own_controller || !is_own_name(name)) {
          yaml::refuse_name(item, column_names());
          continue;
        }
        own_column(name);
        if (++own > most_own_columns) {
          item.refuse(", beside 64 other numbers of the controller's own", "64 of them");
          continue;
        }
      }
      if (!seen.insert(name).second) {
        item.refuse(" again", "each column once");
      } else {
        into.push_back(name);
      }
    }
    return into.size() == value.node->items.size();
  }
};

yaml::NameOf<Method> methods() {
  yaml::NameOf<Method> rule;
  for (const NamedMethod& method : named_methods) {
    rule.choices.push_back({method.method, method.name});
  }
  return rule;
}

// Reports an error bound beside tolerances. If exactly one of them comes from the command line, it
// overrides the other.
void check_bound(yaml::Keys& keys, Solver& solver) {
  const auto on_command_line = [](const yaml::Value& value) { return value.position.source > 0; };
  const yaml::Value error = *keys.find("error");
  for (const char* name : {"rtol", "atol"}) {
    const std::optional<yaml::Value> tolerance = keys.find(name);
    if (!tolerance) continue;
    if (on_command_line(*tolerance) == on_command_line(error)) {
      tolerance->report(
          "given together with error, which chooses the tolerances; allowed: one of them");
    } else if (on_command_line(error)) {
      tolerance->mention("not used: the command line's bound on the error chooses the tolerances");
      solver.rtol = Solver{}.rtol;
      solver.atol = Solver{}.atol;
    } else {
      error.mention("not used: the command line gives tolerances instead");
      solver.error.reset();
    }
  }
}

}  // namespace

void read_time(yaml::Keys& keys, OutputTimes& time) {
  const bool end = keys.required("end", yaml::Number{yaml::Dimension::time, {.above = 0}}, time.end,
                                 {"end of the run"});
  const bool step =
      keys.required("step", yaml::Number{yaml::Dimension::time, {.above = 0}}, time.step,
                    {.meaning = "a row at i × step, exactly, and at the end",
                     .range = "> 0, `end` / 10⁹ or more"});
  if (end) keys.context().end = time.end;
  if (end && step && time.step > time.end) {
    keys.find("step")->warn("is longer than the run, so the result has a row at its start only");
  }
  if (end && step && time.end / time.step > most_rows) {
    keys.find("step")->refuse(", more than 1e9 rows of output",
                              "a time of at least " + number_text(time.end / most_rows));
  }
}

void read_solver(yaml::Keys& keys, Solver& solver) {
  const yaml::Number rtol{yaml::Dimension::number, {.at_least = 1e-14, .at_most = 0.1}, "1e-8"};
  const yaml::Number atol{yaml::Dimension::number, {.above = 0, .at_most = 1}, "1e-10"};
  keys.exclusive({{"error"}, {"rtol", "atol"}});
  keys.optional("method", methods(), solver.method,
                {"`radau`: bbsim's own collocation; `bdf`, `adams`: CVODES; `auto` takes the "
                 "cheapest, which is `radau`"});
  keys.optional("rtol", rtol, solver.rtol, {"local relative tolerance"});
  keys.optional("atol", atol, solver.atol, {"local absolute tolerance", "state's unit"});
  const yaml::Number error{yaml::Dimension::length, {.above = 0, .at_most = 1}, "1e-9"};
  if (keys.optional(
          "error", error, solver.error,
          {"instead of tolerances: a bound on the error of x and y at all output times"}) &&
      solver.error)
    check_bound(keys, solver);
}

void read_output(yaml::Keys& keys, Output& output) {
  keys.optional("columns", Columns{}, output.columns,
                {"[columns](columns.md) of the result, each once"});
}

}  // namespace bbsim::scenario
