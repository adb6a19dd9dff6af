// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim replay`: a page that plays runs, sweeps and logs.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/inputs.hpp"
#include "api/measure.hpp"
#include "api/picture.hpp"
#include "api/place_log.hpp"
#include "api/run.hpp"
#include "api/version.hpp"
#include "commands.hpp"
#include "file/default_name.hpp"
#include "progress.hpp"
#include "replay/log.hpp"
#include "replay/page.hpp"
#include "replay/sources.hpp"
#include "replay_file.hpp"
#include "results/read_result.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct ReplayArguments {
  std::vector<std::string> files;
  std::string output, title;
  bool force = false;
  std::vector<std::string> logs;
  results::LogChoice log;
  results::Beside beside;
};

// One of the files after reading; a scenario is run later.
struct Replayed {
  std::string name;
  std::optional<Scenario> scenario{};
  std::optional<results::Result> result{};
  std::optional<replay::Run> log{};
};

// Distinguishes files of the same name by their folders, and repeated files by a number.
std::vector<std::string> names_of(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const auto alike = [&](const std::string& other) {
      return other != file && api::short_name(other) == api::short_name(file);
    };
    std::string name = std::ranges::any_of(files, alike) ? file : api::short_name(file);
    const std::string plain = name;
    for (int number = 2; std::ranges::find(names, name) != names.end(); ++number) {
      name = plain + " (" + std::to_string(number) + ")";
    }
    names.push_back(name);
  }
  return names;
}

std::string output_of(const ReplayArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  const std::string& first =
      arguments.files.empty() ? arguments.logs.front() : arguments.files.front();
  if (first == "-")
    throw InputError("--output: missing; standard input (-) gives the page no name");
  if (is_scenario(first)) return default_output(first, ".html");
  return std::filesystem::path(first).replace_extension(".html").string();
}

void check_arguments(const ReplayArguments& arguments) {
  if (arguments.files.empty() && arguments.logs.empty()) {
    throw InputError("FILES: missing; allowed: results, scenarios, or --data LOG.csv");
  }
  if (!arguments.output.empty()) require_replay_ending(arguments.output, "--output");
  const auto scenarios = std::ranges::count_if(arguments.files, is_scenario);
  const auto results = static_cast<std::ptrdiff_t>(arguments.files.size()) - scenarios;
  if (!arguments.beside.summary.empty() && results != 1) {
    throw InputError("--summary: found " + std::to_string(results) +
                     " results; allowed: one run, to which the summary belongs");
  }
  if (!arguments.beside.scenario.empty() && results == 0) {
    throw InputError("--scenario: allowed with a result, whose scenario it gives");
  }
  if (!arguments.beside.overrides.empty() && scenarios == 0 && arguments.beside.scenario.empty()) {
    throw InputError("--set: allowed with a scenario, in which it sets a key");
  }
  const std::size_t maps = arguments.log.maps.size(), logs = arguments.logs.size();
  if (maps > 1 && logs > 1 && maps != logs) {
    throw InputError("--map: found " + std::to_string(maps) + " for " + std::to_string(logs) +
                     " of --data; allowed: one for all, or one for each in their order");
  }
  if (maps > 0 && logs == 0) throw InputError("--map: allowed with --data, whose columns it names");
  if (arguments.log.given() && logs == 0) {
    throw InputError("--header, --period, --time-offset: allowed with --data, a log");
  }
  if (arguments.log.aligns() && arguments.files.empty()) {
    throw InputError("--time-offset: found auto, without a run to align the log with");
  }
}

void say_all(const std::vector<std::string>& notes, const Options& options) {
  for (const std::string& note : notes) {
    if (!options.quiet) say(note);
  }
}

// Reads all files, and reports all their faults together.
std::vector<Replayed> read_all(const ReplayArguments& arguments, const Options& options,
                               file::Outputs& outputs) {
  std::vector<std::string> files = arguments.files;
  files.insert(files.end(), arguments.logs.begin(), arguments.logs.end());
  const std::vector<std::string> names = names_of(files);
  std::vector<Replayed> sources;
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < files.size(); ++i) {
    Replayed source{names[i]};
    say_if_waiting(files[i], "a CSV", options.quiet);
    try {
      if (i >= arguments.files.size()) {
        outputs.reads(files[i], "--data");
        const std::size_t log = i - arguments.files.size();
        results::LogChoice choice = arguments.log;
        if (arguments.logs.size() > 1 && choice.maps.size() > 1) choice.maps = {choice.maps[log]};
        std::vector<std::string> notes;
        results::Result read = results::read_csv_columns(files[i], choice.header, notes);
        source.log = replay::run_of_log(std::move(read), choice, names[i], notes);
        say_all(notes, options);
      } else if (is_scenario(files[i])) {
        source.scenario = read({files[i], arguments.beside.overrides}, options, outputs);
      } else {
        outputs.reads(files[i], "what is shown");
        std::vector<std::string> notes;
        source.result = results::read_result(files[i], arguments.beside, {}, &notes);
        say_all(notes, options);
        api::reads_with_result(outputs, *source.result);
      }
      sources.push_back(std::move(source));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return sources;
}

replay::Run run_scenario(Replayed& source, const Options& options, ExitCode& code) {
  Progress progress(source.scenario->source.file, options.quiet);
  api::RunRequest request;
  request.scenario = std::move(*source.scenario);
  request.pictured = true;
  api::RunResult made = api::run(request, progress);
  tell(made, options.quiet);
  if (code == ExitCode::done || made.code == ExitCode::interrupted) code = made.code;
  made.pictured->name = source.name;
  return std::move(*made.pictured);
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

ExitCode replay_files(const ReplayArguments& arguments, const Options& options) {
  check_arguments(arguments);
  const std::string output = output_of(arguments);
  file::Outputs outputs;
  if (!arguments.beside.summary.empty()) outputs.reads(arguments.beside.summary, "--summary");
  if (!arguments.beside.scenario.empty()) outputs.reads(arguments.beside.scenario, "--scenario");
  std::vector<Replayed> sources = read_all(arguments, options, outputs);
  declare_replay(outputs, output,
                 arguments.output.empty() ? "the first file's name, without -o" : "-o");
  if (arguments.output.empty() && !arguments.force) {
    file::require_like(output, {.what = "a replay of bbsim's", .mark = replay::page_mark});
  }

  const auto is_sweep = [](const Replayed& source) {
    return source.result && source.result->is_sweep();
  };
  const auto sweeps = static_cast<std::size_t>(std::ranges::count_if(sources, is_sweep));
  if (sweeps > 0 && sweeps < sources.size()) {
    throw InputError(std::ranges::find_if(sources, is_sweep)->name +
                     ": is a sweep, among runs; allowed: a page of runs, or one of sweeps");
  }

  for (const Replayed& source : sources) {
    const bool lacks = source.result && !source.result->left_out.empty();
    if (lacks && !options.quiet) say(source.result->left_out);
  }
  ReplayFile file(output);
  replay::Scene scene;
  scene.version = api::version();
  ExitCode code = ExitCode::done;
  for (Replayed& source : sources) {
    if (source.scenario) {
      scene.runs.push_back(run_scenario(source, options, code));
      if (code == ExitCode::interrupted) break;
    } else if (source.log) {
      scene.runs.push_back(std::move(*source.log));
      if (!arguments.files.empty()) say_all(api::place_log(scene, arguments.log.aligns()), options);
    } else if (is_sweep(source)) {
      scene.sweeps.push_back(replay::sweep_of_result(std::move(*source.result), source.name));
    } else {
      scene.runs.push_back(run_of(std::move(*source.result), source.name));
    }
  }
  scene.title = arguments.title.empty() ? title_of(scene) : arguments.title;
  file.write(scene, options.quiet);
  return code;
}

}  // namespace

void add_replay(Command& command, const Options& options) {
  command.footer(
      "The page opens in any browser, offline. It shows the rig in three dimensions, plots, and "
      "the settings of the run. With several runs, the first one leads and the others are ghosts. "
      "bbsim runs a scenario first. Title, plate, ball and events of a .csv come from its summary "
      "(NAME.json beside NAME.csv, or --summary) or from --scenario.\n"
      "\n"
      "Examples:\n"
      "  bbsim replay configs/rig.yaml -o rig.html\n"
      "  bbsim run configs/fig2b.yaml --summary fig2b.json && bbsim replay fig2b.csv\n"
      "  bbsim replay slow.h5 fast.h5 -o both.html\n"
      "  bbsim replay configs/rig.yaml --data log.csv --map t=Time:ms,x=Ballx:mm,y=Bally:mm\n"
      "  bbsim replay fig2b-sweep.csv --scenario configs/fig2b.yaml");
  const auto arguments = std::make_shared<ReplayArguments>();
  command.option(
      "FILES", arguments->files,
      "results (CSV, HDF5) of runs or of sweeps, or scenarios; - is CSV on standard input");
  command
      .option(
          "-o,--output", arguments->output,
          "write FILE.html, or - for standard output; default: the first file's name with .html")
      .takes("FILE");
  add_force(command, arguments->force);
  command
      .option("--data", arguments->logs, "LOG.csv of a real rig, shown with the runs; repeatable")
      .takes("LOG")
      .may_be_repeated();
  add_log_options(command, arguments->log);
  command.option("--title", arguments->title, "title of the page; default: the scenario's")
      .takes("TEXT");
  command
      .option("--summary", arguments->beside.summary,
              "FILE.json: the summary of a result, from `bbsim run --summary`")
      .takes("FILE");
  command.option("--scenario", arguments->beside.scenario, "FILE.yaml: the scenario of a result")
      .takes("FILE");
  add_overrides(command, arguments->beside.overrides);
  command.does([arguments, &options] { return replay_files(*arguments, options); });
}

}  // namespace bbsim::app
