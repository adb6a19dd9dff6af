// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim replay`: a page that plays runs, sweeps and logs; and replay files.
#include "api/replay.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "commands.hpp"
#include "file/default_name.hpp"
#include "file/table_writer.hpp"
#include "replay.hpp"
#include "replay/page.hpp"
#include "replay/template.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

std::string size_text(std::size_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f MB", static_cast<double>(bytes) / 1e6);
  return text;
}

std::string content_text(const replay::Scene& scene) {
  std::size_t rows = 0, cases = 0;
  for (const replay::Run& run : scene.runs) rows += replay::rows_of_file(run);
  for (const replay::Sweep& sweep : scene.sweeps) cases += sweep.status.size();
  if (scene.runs.empty()) return counted(cases, "case");
  const std::string text = counted(rows, "row");
  return scene.runs.size() == 1 ? text : std::to_string(scene.runs.size()) + " runs, " + text;
}

struct ReplayArguments {
  std::vector<std::string> files;
  std::string output;
  bool force = false;
  api::ReplayRequest request{};
};

std::string output_of(const ReplayArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  const std::vector<std::string>& files =
      arguments.files.empty() ? arguments.request.logs : arguments.files;
  if (files.empty()) return "";
  if (files.front() == "-")
    throw InputError("--output: missing; standard input (-) gives the page no name");
  if (api::is_scenario(files.front())) return default_output(files.front(), ".html");
  return std::filesystem::path(files.front()).replace_extension(".html").string();
}

ExitCode replay_files(const ReplayArguments& arguments, const Options& options) {
  if (!arguments.output.empty()) require_replay_ending(arguments.output, "--output");
  const std::string output = output_of(arguments);
  const results::Beside& beside = arguments.request.beside;
  if (arguments.request.live && (arguments.files.size() != 1 || !arguments.request.logs.empty() ||
                                 !api::is_scenario(arguments.files.front()))) {
    throw InputError("--live: allowed with one scenario, FILE.yaml, and no logs");
  }
  file::Outputs outputs;
  if (!beside.summary.empty()) outputs.reads(beside.summary, "--summary");
  if (!beside.scenario.empty()) outputs.reads(beside.scenario, "--scenario");
  api::ReplayRequest request = arguments.request;
  for (const std::string& file : arguments.files) request.shown.push_back({file});
  request.before_reading = [&](const std::string& file) {
    say_if_waiting(file, api::is_scenario(file) ? "a scenario" : "a CSV", options.quiet);
  };
  std::optional<ReplayFile> file;
  request.before_running = [&] {
    declare_replay(outputs, output,
                   arguments.output.empty() ? "the first file's name, without -o" : "-o");
    if (arguments.output.empty() && !arguments.force) {
      file::require_like(output, {.what = "a replay of bbsim's", .mark = replay::page_mark});
    }
    file.emplace(output, request.live);
  };
  Progress progress(output, options.quiet);
  const api::ReplayResult replayed = api::replay(request, outputs, progress);
  progress.end();
  for (const api::RunResult& run : replayed.runs) say_outcome(run, options.quiet);
  file->write(replayed.scene, options.quiet);
  return replayed.code;
}

}  // namespace

void require_replay_ending(const std::string& file, const std::string& option) {
  if (file == "-" || file::lower_ending(file) == ".html") return;
  const std::string instead = instead_of(file::lower_ending(file));
  throw InputError(option + ": found " + file +
                   (instead.empty() ? "; allowed: a name that ends in .html" : ": " + instead));
}

void declare_replay(file::Outputs& outputs, const std::string& file, const std::string& what) {
  outputs.reads(replay::file_of_template(replay::replay_name), "the template of pages");
  outputs.reads(replay::file_of_template(replay::engine_name), "the engine of live pages");
  outputs.writes(file, what);
}

ReplayFile::ReplayFile(const std::string& target, bool live)
    : target_(target),
      template_(replay::read_template(replay::replay_name)),
      engine_(live ? replay::read_template(replay::engine_name) : ""),
      file_(target) {}

void ReplayFile::write(const replay::Scene& scene, bool quiet) {
  const std::string content = replay::page(scene, template_, engine_);
  file_.write(content);
  file_.commit();
  if (quiet || target_ == "-") return;
  say(target_ + ": " + content_text(scene) + ", " + size_text(content.size()));
}

void add_replay(Command& command, const Options& options) {
  command.footer(
      "The page opens in any browser, offline. It shows the rig in three dimensions, plots, and "
      "the settings of the run. With several runs, the first one leads and the others are ghosts. "
      "bbsim runs a scenario first. Title, plate, ball and events of a .csv come from its summary "
      "(NAME.json beside NAME.csv, or --summary) or from --scenario.\n"
      "\n"
      "Examples:\n"
      "  bbsim replay configs/rig.yaml -o rig.html\n"
      "  bbsim replay configs/fig2b.yaml --live -o fig2b.html\n"
      "  bbsim run configs/fig2b.yaml --summary fig2b.json && bbsim replay fig2b.csv\n"
      "  bbsim replay slow.h5 fast.h5 -o both.html\n"
      "  bbsim replay configs/rig.yaml --data log.csv \\\n"
      "      --map t=Time:ms,x=Ballx:mm,y=Bally:mm\n"
      "  bbsim replay fig2b-sweep.csv --scenario configs/fig2b.yaml");
  ReplayArguments& arguments = command.does(replay_files, options);
  command.option(
      "FILES", arguments.files,
      "results (CSV, HDF5) of runs or of sweeps, or scenarios; - is CSV on standard input");
  command.option(
      "-o,--output FILE", arguments.output,
      "write FILE.html, or - for standard output; default: the first file's name with .html");
  add_force(command, arguments.force);
  command.flag("--live", arguments.request.live,
               "a page that changes the scenario and runs it again, in the browser");
  command.option("--data LOG", arguments.request.logs,
                 "LOG.csv of a real rig, shown with the runs; repeatable");
  add_log_options(command, arguments.request.log);
  command.option("--title TEXT", arguments.request.title,
                 "title of the page; default: the scenario's");
  command.option("--summary FILE", arguments.request.beside.summary,
                 "FILE.json: the summary of a result, from `bbsim run --summary`");
  command.option("--scenario FILE", arguments.request.beside.scenario,
                 "FILE.yaml: the scenario of a result");
  add_overrides(command, arguments.request.beside.overrides);
}

}  // namespace bbsim::app
