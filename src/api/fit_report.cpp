// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/fit_report.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "api/fit_text.hpp"
#include "api/version.hpp"
#include "base/json.hpp"
#include "replay/base64.hpp"
#include "replay/template.hpp"
#include "scenario/columns.hpp"

namespace bbsim::api {
namespace {

using PageJson = nlohmann::ordered_json;

constexpr std::size_t most_page_rows = 40000;

using WindowList = std::vector<const fit::WindowSeries*>;

// Windows of a log, in order of time.
WindowList windows_of(const fit::Fitted& fitted, std::size_t log) {
  WindowList windows;
  for (const fit::WindowSeries& one : fitted.series) {
    if (one.log == log) windows.push_back(&one);
  }
  std::ranges::sort(windows, {}, &fit::WindowSeries::begin);
  return windows;
}

// Three series per column: log, model and difference.
struct PageRows {
  std::vector<double> times;
  std::vector<std::array<std::vector<double>, 3>> columns;

  void add(double time) {
    times.push_back(time);
    for (auto& column : columns) {
      for (auto& values : column) values.push_back(std::numeric_limits<double>::quiet_NaN());
    }
  }
  void add(const fit::WindowSeries& window, std::size_t row) {
    add(window.times[row]);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      columns[c][0].back() = window.measured[c][row];
      columns[c][1].back() = window.modelled[c][row];
      columns[c][2].back() = window.modelled[c][row] - window.measured[c][row];
    }
  }
};

PageJson log_json(const std::string& name, const fit::Fitted& fitted, const WindowList& windows,
                  std::size_t step) {
  PageRows rows;
  rows.columns.resize(fitted.columns.size());
  PageJson parts = PageJson::array();
  std::size_t all = 0;
  for (const fit::WindowSeries* const window : windows) {
    // A row without numbers separates the lines of two windows.
    if (!rows.times.empty()) rows.add((rows.times.back() + window->times.front()) / 2);
    const std::size_t first = rows.times.size(), count = window->times.size();
    for (std::size_t row = 0; row < count; ++row) {
      if (row % step == 0 || row + 1 == count) rows.add(*window, row);
    }
    parts.push_back({{"first", first}, {"last", rows.times.size() - 1}, {"held", window->held}});
    all += count;
  }
  PageJson columns = PageJson::array();
  for (std::size_t c = 0; c < fitted.columns.size(); ++c) {
    constexpr const char* endings[] = {"", "_modelled", "_residual"};
    constexpr const char* meanings[] = {"as logged", "of the model", "model minus log"};
    for (std::size_t k = 0; k < 3; ++k) {
      columns.push_back({{"name", fitted.columns[c].column + endings[k]},
                         {"unit", fitted.columns[c].unit},
                         {"meaning", meanings[k]},
                         {"data", replay::base64_of_floats(rows.columns[c][k])}});
    }
  }
  // Runs of replays have the other members too.
  return {{"name", name},
          {"rows", all},
          {"every", step},
          {"windows", std::move(parts)},
          {"time", replay::base64_of_doubles(rows.times)},
          {"columns", std::move(columns)},
          {"orientation", ""},
          {"reference", ""},
          {"reached", nullptr},
          {"unitsKnown", true},
          {"events", PageJson::array()}};
}

PageJson table_json(const std::vector<std::vector<std::string>>& lines) {
  return {{"head", lines.front()},
          {"rows", std::vector<std::vector<std::string>>(lines.begin() + 1, lines.end())}};
}

// Pair of compared columns that hold the ball's position.
PageJson place_json(const fit::Fitted& fitted) {
  for (const auto& [x, y] : {std::array{"x", "y"}, std::array{"x_measured", "y_measured"}}) {
    const auto has = [&](const char* name) {
      return std::ranges::find(fitted.columns, name, &fit::ColumnResidual::column) !=
             fitted.columns.end();
    };
    if (has(x) && has(y)) return {x, y};
  }
  return nullptr;
}

double radius_of(const Scenario& scenario, const fit::Fitted& fitted) {
  if (scenario.ball.groove) return scenario.ball.groove->ball_radius;
  const auto found = std::ranges::find(fitted.parameters, "ball.radius", &fit::Parameter::key);
  return found == fitted.parameters.end() ? scenario.ball.radius : found->estimate;
}

PageJson lines_json(const std::string& text) {
  PageJson lines = PageJson::array();
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    lines.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return lines;
}

}  // namespace

std::string fit_page(const FitRequest& request, const fit::Fitted& fitted,
                     std::string_view page_template) {
  const Scenario scenario = request.family.read({});
  const std::string& file = request.family.source().file;
  const std::string title = "Fit of " + (scenario.title.empty() ? file : scenario.title);
  PageJson json = {{"format", 1},
                   {"version", version()},
                   {"title", title},
                   {"scenario", file},
                   {"logs", request.logs},
                   {"parameters", table_json(parameter_table(fitted))},
                   {"residuals", table_json(residual_table(fitted))},
                   {"remarks", lines_json(remarks_of(request, fitted))},
                   {"place", place_json(fitted)},
                   {"radius", radius_of(scenario, fitted)}};
  PageJson columns = PageJson::array();
  for (const fit::ColumnResidual& one : fitted.columns) {
    const scenario::Column* const column = scenario::find_column(one.column);
    columns.push_back({{"name", one.column},
                       {"symbol", column == nullptr ? one.column : std::string(column->symbol)},
                       {"meaning", column == nullptr ? "" : std::string(column->meaning)},
                       {"unit", one.unit}});
  }
  json["columns"] = std::move(columns);
  std::size_t rows = 0;
  for (const fit::WindowSeries& one : fitted.series) rows += one.times.size();
  const std::size_t step = std::max<std::size_t>(1, (rows + most_page_rows - 1) / most_page_rows);
  PageJson logs = PageJson::array();
  for (std::size_t log = 0; log < request.logs.size(); ++log) {
    const WindowList windows = windows_of(fitted, log);
    if (!windows.empty()) logs.push_back(log_json(request.logs[log], fitted, windows, step));
  }
  json["runs"] = std::move(logs);
  return replay::filled(page_template, title, json_text(json));
}

}  // namespace bbsim::api
