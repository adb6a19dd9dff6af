// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/replay.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "api/check.hpp"
#include "api/measure.hpp"
#include "api/version.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "record/log_distance.hpp"
#include "replay/sources.hpp"
#include "scenario/reader.hpp"

namespace bbsim::api {
namespace {

// Name of a file without its folder, as scenes show it.
std::string short_name(const std::string& file) {
  return file == "-" ? "standard input" : std::filesystem::path(file).filename().string();
}

// Adds facts about the scene: its plate, ball and signals, and, if `checked`, the report of
// `bbsim check`.
void describe_scene(replay::Run& run, const Scenario& scenario, bool checked = true) {
  replay::describe(run, scenario);
  if (checked) run.check = lines_of(to_text(describe(scenario)));
}

// Aligns the scene's last run, which is a log, with the first one if `align`. Returns sentences
// about the shift and the distance to that run.
std::vector<std::string> place_log(replay::Scene& scene, bool align) {
  replay::Run &log = scene.runs.back(), &run = scene.runs.front();
  log.file = log.name;  // for messages
  run.file = run.name;
  std::vector<std::string> notes;
  if (align) {
    const double offset = record::time_offset(log, run);
    for (double& time : log.find("t")->numbers) time += offset;
    notes.push_back(moved_text(log.name, offset));
  }
  const auto in_common = [&](const file::Column& column) {
    return column.name != "t" && run.find(column.name) != nullptr;
  };
  if (log.find("t") == nullptr || std::ranges::none_of(log.columns, in_common)) return notes;
  try {
    notes.push_back(record::to_text(record::log_distance(log, run), log.name, run.name));
    notes.back().pop_back();
  } catch (const InputError& error) {  // no time in common; the log can still be shown
    notes.push_back("warning: " + std::string(error.what()));
  }
  return notes;
}

// One of the files after reading; a scenario is run later.
struct SourceFile {
  std::string name;
  std::optional<Scenario> scenario{};
  std::optional<results::Result> result{};
  std::optional<replay::Run> log{};

  [[nodiscard]] bool is_sweep() const { return result && result->is_sweep(); }
};

// Distinguishes files of the same name by their folders, and repeated files by a number.
std::vector<std::string> names_of(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const auto alike = [&](const std::string& other) {
      return other != file && short_name(other) == short_name(file);
    };
    std::string name = std::ranges::any_of(files, alike) ? file : short_name(file);
    const std::string plain = name;
    for (int number = 2; std::ranges::find(names, name) != names.end(); ++number) {
      name = plain + " (" + std::to_string(number) + ")";
    }
    names.push_back(name);
  }
  return names;
}

// The command with the first file of columns as the log, and its options.
std::string as_data(const ReplayRequest& request) {
  std::string command = "bbsim replay --data ";
  const auto file =
      std::ranges::find_if_not(request.shown, is_scenario, &ReplayRequest::Shown::file);
  command += file == request.shown.end() ? "LOG.csv" : shell_word(file->file);
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) command += option + shell_word(value);
  };
  const results::LogChoice& log = request.log;
  for (const std::string& map : log.maps) add(" --map ", map);
  std::string header;
  for (const std::string& name : log.header) header += (header.empty() ? "" : ",") + name;
  add(" --header ", header);
  add(" --period ", log.period);
  add(" --time-offset ", log.time_offset);
  add(" --missing ", log.missing);
  return command;
}

void check_request(const ReplayRequest& request) {
  if (request.shown.empty() && request.logs.empty()) {
    throw InputError("FILES: missing; allowed: results, scenarios, or --data LOG.csv");
  }
  const auto scenarios =
      std::ranges::count_if(request.shown, is_scenario, &ReplayRequest::Shown::file);
  const auto results = static_cast<std::ptrdiff_t>(request.shown.size()) - scenarios;
  if (!request.beside.summary.empty() && results != 1) {
    throw InputError("--summary: found " + std::to_string(results) +
                     " results; allowed: one run, to which the summary belongs");
  }
  if (!request.beside.scenario.empty() && results == 0) {
    throw InputError("--scenario: allowed with a result, whose scenario it gives");
  }
  if (!request.beside.overrides.empty() && scenarios == 0 && request.beside.scenario.empty()) {
    throw InputError("--set: allowed with a scenario, in which it sets a key");
  }
  const std::size_t maps = request.log.maps.size(), logs = request.logs.size();
  if (maps > 1 && logs > 1 && maps != logs) {
    throw InputError("--map: found " + std::to_string(maps) + " for " + std::to_string(logs) +
                     " of --data; allowed: one for all, or one for each in their order");
  }
  if (request.log.given() && logs == 0) {
    throw InputError(
        "--map, --header, --period, --time-offset, --missing: allowed with --data, a log: " +
        as_data(request));
  }
  if (request.log.aligns() && request.shown.empty()) {
    throw InputError("--time-offset: found auto, without a run to align the log with");
  }
}

void note_all(const std::vector<std::string>& notes, Watch& watch) {
  for (const std::string& note : notes) watch.note(note);
}

SourceFile read_log(const ReplayRequest& request, std::size_t log, const std::string& name,
                    Watch& watch) {
  results::LogChoice choice = request.log;
  if (request.logs.size() > 1 && choice.maps.size() > 1) choice.maps = {choice.maps[log]};
  results::Result read = results::read_log(request.logs[log], choice, true);
  note_all(read.notes, watch);
  read.units_known = true;  // as --data or the map states
  SourceFile source{name};
  source.log = replay::run_of_result(std::move(read), name);
  if (!choice.maps.empty()) source.log->rolls = false;
  return source;
}

SourceFile read_shown(const ReplayRequest& request, const ReplayRequest::Shown& shown,
                      const std::string& name, file::Outputs& outputs, Watch& watch) {
  SourceFile source{name};
  if (shown.result) {
    source.result = shown.result;
  } else if (is_scenario(shown.file)) {
    source.scenario = read_scenario(shown.file, request.beside.overrides);
    reads_scenario(outputs, shown.file, *source.scenario);
  } else {
    outputs.reads(shown.file, "what is shown");
    source.result = results::read_result(shown.file, request.beside);
    note_all(source.result->notes, watch);
    reads_with_result(outputs, *source.result);
  }
  return source;
}

// Reads all files, and reports all their faults together.
std::vector<SourceFile> read_all(const ReplayRequest& request, file::Outputs& outputs,
                                 Watch& watch) {
  std::vector<std::string> files;
  for (const ReplayRequest::Shown& shown : request.shown) files.push_back(shown.file);
  files.insert(files.end(), request.logs.begin(), request.logs.end());
  const std::vector<std::string> names = names_of(files);
  std::vector<SourceFile> sources;
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::size_t count = request.shown.size();
    if (request.before_reading) request.before_reading(files[i]);
    try {
      if (i < count) {
        sources.push_back(read_shown(request, request.shown[i], names[i], outputs, watch));
      } else {
        outputs.reads(files[i], "--data");
        sources.push_back(read_log(request, i - count, names[i], watch));
      }
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return sources;
}

std::string title_of(const replay::Scene& scene) {
  for (const replay::Run& run : scene.runs) {
    if (!run.title.empty()) return run.title;
  }
  for (const replay::Sweep& sweep : scene.sweeps) {
    if (!sweep.title.empty()) return sweep.title;
  }
  return scene.runs.empty() ? scene.sweeps.front().name : scene.runs.front().name;
}

}  // namespace

replay::Run run_of(const Scenario& scenario, file::Table rows, record::RunSummary summary,
                   const std::vector<double>& end_row, bool checked) {
  for (std::size_t c = 0; c < end_row.size(); ++c) rows.columns[c].numbers.push_back(end_row[c]);
  replay::Run run = replay::run_of_table(std::move(rows), short_name(scenario.source.file));
  run.has_end_row = !end_row.empty();
  run.end_time = summary.end_time;
  describe_scene(run, scenario, checked);
  run.status = summary.status;
  run.reason = summary.reason;
  run.version = summary.version;
  for (const model::Occurrence& event : summary.events) {
    const model::BallMotion& ball = event.sample.ball;
    run.events.push_back({event.name, event.stopped, event.t, ball.x, ball.y});
  }
  summary.scenario_text.clear();  // the run's scenario has it
  run.summary = record::to_json(summary);
  return run;
}

bool is_scenario(const std::string& file) {
  const std::string ending = file::lower_ending(file);
  return ending == ".yaml" || ending == ".yml";
}

ReplayResult replay(const ReplayRequest& request, file::Outputs& outputs, Watch& watch) {
  check_request(request);
  std::vector<SourceFile> sources = read_all(request, outputs, watch);
  const auto sweeps =
      static_cast<std::size_t>(std::ranges::count_if(sources, &SourceFile::is_sweep));
  if (sweeps > 0 && sweeps < sources.size()) {
    throw InputError(std::ranges::find_if(sources, &SourceFile::is_sweep)->name +
                     ": is a sweep, among runs; allowed: a page of runs, or one of sweeps");
  }
  for (const SourceFile& source : sources) {
    if (source.result && !source.result->left_out.empty()) watch.note(source.result->left_out);
  }
  if (request.before_running) request.before_running();
  ReplayResult replayed;
  replayed.scene.version = version();
  for (SourceFile& source : sources) {
    if (source.scenario) {
      RunRequest run;
      run.scenario = std::move(*source.scenario);
      run.pictured = true;
      const auto live = request.live ? std::optional<LiveRun>(run) : std::nullopt;
      replayed.runs.push_back(api::run(run, watch));
      RunResult& result = replayed.runs.back();
      if (live) {
        replayed.scene.live = live->of(result, true);
        replayed.scene.live->loops = loops_of(run.scenario);
        // Open tasks are for the page's reader.
        result.unmet.clear();
        if (result.summary.status == "done") result.code = ExitCode::done;
      }
      if (replayed.code == ExitCode::done || result.code == ExitCode::interrupted) {
        replayed.code = result.code;
      }
      result.pictured->name = source.name;
      replayed.scene.runs.push_back(std::move(*result.pictured));
      if (replayed.code == ExitCode::interrupted) break;
    } else if (source.log) {
      replayed.scene.runs.push_back(std::move(*source.log));
      if (!request.shown.empty()) {
        note_all(place_log(replayed.scene, request.log.aligns()), watch);
      }
    } else if (source.is_sweep()) {
      replayed.scene.sweeps.push_back(
          replay::sweep_of_result(std::move(*source.result), source.name));
    } else {
      replayed.scene.runs.push_back(run_of(std::move(*source.result), source.name));
    }
  }
  replayed.scene.title = request.title.empty() ? title_of(replayed.scene) : request.title;
  return replayed;
}

replay::Run run_of(results::Result result, const std::string& name) {
  const std::optional<Scenario> scenario = result.scenario;
  const std::string title = result.title;
  replay::Run run = replay::run_of_result(std::move(result), name);
  if (!scenario) return run;
  const Source& source = scenario->source;
  try {
    describe_scene(run, parse_scenario(source.text, source.file, source.overrides));
  } catch (const InputError&) {  // its tables are gone, for example, or another version wrote it
    replay::describe_sight(run, *scenario);
  }
  if (!title.empty()) run.title = title;
  return run;
}

replay::Scene scene_of(replay::Run run) {
  replay::Scene scene;
  scene.version = version();
  scene.title = run.title.empty() ? run.name : run.title;
  scene.runs.push_back(std::move(run));
  return scene;
}

}  // namespace bbsim::api
