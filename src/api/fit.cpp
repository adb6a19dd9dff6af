// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "api/fit_candidates.hpp"
#include "api/fit_text.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "base/text.hpp"
#include "results/read_result.hpp"
#include "scenario/edit_text.hpp"
#include "scenario/unit_doubts.hpp"
#include "scenario/value_in.hpp"

namespace bbsim::api {
namespace {

using scenario::Column;

// Columns to compare if a log has them. The gimbal's count only if it moves by itself.
constexpr std::array ball_columns = {"x", "y", "vx", "vy"};
constexpr std::array gimbal_columns = {"phi", "theta", "phi_rate", "theta_rate"};

bool is_of_gimbal(std::string_view name) {
  return std::ranges::find(gimbal_columns, name) != gimbal_columns.end();
}

// Names that the user maps, except the time.
std::vector<std::string> mapped_names(const results::LogChoice& choice) {
  std::vector<std::string> names;
  for (const std::string& map : choice.maps) {
    for (std::size_t start = 0; start <= map.size();) {
      const std::size_t end = std::min(map.find(',', start), map.size());
      std::string name = map.substr(start, std::min(map.find('=', start), end) - start);
      std::erase(name, ' ');
      if (name != "t") names.push_back(std::move(name));
      start = end + 1;
    }
  }
  return names;
}

std::vector<const Column*> columns_of(const FitRequest& request, const Scenario& scenario,
                                      const results::Result& log,
                                      std::vector<std::string>& warnings) {
  std::vector<std::string> names = mapped_names(request.choice);
  if (names.empty()) {
    names.assign(ball_columns.begin(), ball_columns.end());
    names.insert(names.end(), gimbal_columns.begin(), gimbal_columns.end());
    std::erase_if(names, [&](const std::string& name) {
      return log.find(name) == nullptr || (is_of_gimbal(name) && scenario.gimbal.motion);
    });
  }
  std::vector<const Column*> columns;
  for (const std::string& name : names) {
    const Column* const column = scenario::find_column(name);
    if (column == nullptr) continue;  // make_log() has refused it
    if (is_of_gimbal(name) && scenario.gimbal.motion) {
      warnings.push_back("note: " + name +
                         " is given by gimbal.motion, and not compared with the log");
      continue;
    }
    if (const scenario::Missing missing = scenario::missing(*column, scenario)) {
      throw InputError("--map: found " + name + ", " + missing.why +
                       "; allowed: columns that the scenario has");
    }
    columns.push_back(column);
  }
  if (columns.empty()) {
    throw InputError(request.logs.front() +
                     ": has no column to compare; allowed: x, y, vx or vy by name, or --map "
                     "x=NAME:UNIT");
  }
  return columns;
}

fit::Log log_of(const results::Result& read, const std::string& file,
                const std::vector<const Column*>& columns, std::vector<std::string>& warnings) {
  const auto require = [&](std::string_view name, const char* hint) -> const results::Column& {
    const results::Column* const column = read.find(name);
    if (column != nullptr && !column->is_text()) return *column;
    if (column != nullptr) {
      for (std::size_t row = 0; row < column->texts.size(); ++row) {
        if (column->texts[row].empty() || !std::isnan(column->numbers[row])) continue;
        throw InputError(file + ": column " + shown(column->name) + ", row " +
                         std::to_string(row + 1) + ": found " + bbsim::quoted(column->texts[row]) +
                         "; allowed: numbers, or an empty field");
      }
      return *column;
    }
    std::string names;
    for (const results::Column& one : read.columns)
      names += (names.empty() ? "" : ", ") + shown(one.name);
    throw InputError(file + ": has no column " + std::string(name) + "; it has " + names + hint);
  };
  fit::Log log;
  log.name = file;
  log.times = require("t", ". --map t=NAME:UNIT names the time").numbers;
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    if (std::isfinite(log.times[i]) && (i == 0 || log.times[i] > log.times[i - 1])) continue;
    throw InputError(file + ": column t, row " + std::to_string(i + 1) + ": found " +
                     number_text(log.times[i]) + "; allowed: finite times that increase");
  }
  if (log.times.empty()) throw InputError(file + ": has no rows");
  for (const Column* const column : columns) {
    log.values.push_back(require(column->name, "").numbers);
    const double largest = scenario::largest_size(log.values.back());
    if (const auto doubt = scenario::doubt_of(largest, column->name)) {
      warnings.push_back("warning: " + file + ": " + std::string(column->name) + " goes up to " +
                         number_text(largest) + ", read in SI: it looks like " +
                         std::string(doubt->looks_like));
    }
  }
  return log;
}

// Keys of the tables that read `file`.
std::vector<std::string> tables_of(const Scenario& scenario, const std::filesystem::path& folder,
                                   const std::string& file) {
  const auto is_it = [&](const std::string& name) {
    std::error_code none;
    return std::filesystem::equivalent(folder / name, file, none);
  };
  std::vector<std::string> keys;
  const auto add_profile = [&](const std::string& key, const Profile& profile) {
    for (std::size_t i = 0; i < profile.size(); ++i) {
      const auto* const table = std::get_if<Table>(&profile[i]);
      if (table == nullptr || !is_it(table->file)) continue;
      keys.push_back(key + (profile.size() == 1 ? "" : "." + std::to_string(i)) + ".table.file");
    }
  };
  if (scenario.gimbal.motion) {
    add_profile("gimbal.motion.phi", scenario.gimbal.motion->phi);
    add_profile("gimbal.motion.theta", scenario.gimbal.motion->theta);
  }
  if (scenario.gimbal.torque) {
    add_profile("gimbal.torque.phi", scenario.gimbal.torque->phi);
    add_profile("gimbal.torque.theta", scenario.gimbal.torque->theta);
  }
  if (const auto* const commands = commands_of(scenario)) {
    add_profile("controller.commands.phi", commands->phi);
    add_profile("controller.commands.theta", commands->theta);
  } else if (scenario.controller) {
    const auto* const table = std::get_if<TableReference>(&scenario.controller->reference);
    if (table != nullptr && is_it(table->file)) keys.push_back("controller.reference.table.file");
  }
  return keys;
}

double window_of(const std::string& text) {
  const auto value = scenario::value_in(text, "s");
  if (value && *value > 0) return *value;
  throw InputError("--window: found " + bbsim::quoted(text) +
                   "; allowed: a time greater than 0, such as 2 or \"500 ms\"");
}

}  // namespace

FitResult fit(const FitRequest& request, bool with_scenario, Watch& watch) {
  if (!(request.hold_out >= 0) || !(request.hold_out < 1)) {
    throw InputError("--hold-out: found " + number_text(request.hold_out) +
                     "; allowed: a share from 0 to below 1, such as 0.3");
  }
  if (request.loss != "squares" && request.loss != "huber") {
    throw InputError("--loss: found " + bbsim::quoted(request.loss) +
                     "; allowed: squares or huber");
  }
  if (request.starts < 1) throw InputError("--starts: found 0; allowed: 1 or more");
  results::refuse_auto(request.choice);
  const Scenario scenario = request.family.read({});
  if (scenario.controller && scenario.controller->own) {
    throw InputError(
        "controller: found a program or library of your own; allowed in a fit: a law of bbsim, or "
        "gimbal.motion from the log's table");
  }
  FitResult made;
  fit::Task task{request.family, {}, {}, {}};
  task.keys = fit::read_free_keys(request.free, request.family);
  if (with_scenario) {  // fails before the work if the text cannot be written
    std::vector<ScenarioFamily::Setting> settings;
    for (const fit::FreeKey& key : task.keys) settings.push_back(key.setting(key.start));
    static_cast<void>(edited_scenario(request.family.source(), "", settings));
  }
  // If a table of the scenario is one of the logs, each log replaces it in turn.
  std::vector<std::string> of_log;
  const auto folder = std::filesystem::path(request.family.source().file).parent_path();
  for (const std::string& file : request.logs) {
    if (of_log.empty()) of_log = tables_of(scenario, folder, file);
  }
  for (const std::string& file : request.logs) {
    const results::Result read = results::read_log(file, request.choice, made.warnings);
    if (task.columns.empty()) task.columns = columns_of(request, scenario, read, made.warnings);
    task.logs.push_back(log_of(read, file, task.columns, made.warnings));
    if (request.logs.size() == 1) continue;
    for (const std::string& key : of_log) {
      task.logs.back().settings.push_back(
          {key, "'" + std::filesystem::absolute(file).string() + "'"});
    }
  }
  for (const std::string& text : request.free) {
    if (fit::is_of_log(text)) fit::add_free_key(task.keys, fit::read_log_key(text, task.columns));
  }
  task.candidates = fit_candidates(task);
  if (!request.window.empty()) task.window = window_of(request.window);
  task.with_series = request.with_series;
  task.hold_out = request.hold_out;
  task.threads = request.threads;
  task.starts = request.starts;
  task.robust = request.loss == "huber";
  task.continuity = request.continuity;
  task.stop = watch.stop();
  task.progress = [&watch](double fraction, const std::string& detail) {
    watch.update(fraction, detail);
  };
  watch.start(0);
  made.fitted = fit::fit(task);
  watch.end();
  if (made.fitted.interrupted) made.code = ExitCode::interrupted;
  if (made.fitted.parameters.empty()) return made;
  made.text = report_of(request, made.fitted);
  made.json = json_of(made.fitted);
  if (with_scenario) made.scenario = fitted_scenario(request, made.fitted);
  return made;
}

}  // namespace bbsim::api
