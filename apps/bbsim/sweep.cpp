// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/sweep.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "api/assemble.hpp"
#include "base/number_text.hpp"
#include "base/short_number.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "file/outputs.hpp"
#include "progress.hpp"
#include "scenario/measures.hpp"
#include "scenario/variation.hpp"
#include "signals.hpp"
#include "solve/output_grid.hpp"
#include "sweep/case_file.hpp"
#include "sweep/sweep_measures.hpp"
#include "sweep_text.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct SweepArguments {
  ScenarioArguments scenario;
  std::vector<std::string> vary, measure;
  std::string combine, output, summary, shard, error;
  std::optional<double> samples, seed;
  std::size_t threads = 0;
  bool resume = false, keep_trajectories = false, force = false;
};

Shard read_shard(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  int end = 0;
  if (text.find_first_not_of("0123456789/") != std::string::npos || text.size() > 19 ||
      std::sscanf(text.c_str(), "%zu/%zu%n", &shard.number, &shard.of, &end) != 2 ||
      end != static_cast<int>(text.size()) || shard.number < 1 || shard.number > shard.of) {
    throw InputError("--shard: found " + text + "; allowed: K/N with K from 1 to N, such as 2/8");
  }
  return shard;
}

// What the scenario says of the sweep, and the command line instead of it.
Sweep sweep_of(const SweepArguments& arguments, const Sweep& in_scenario) {
  Sweep sweep = in_scenario;
  if (!arguments.vary.empty()) {
    sweep.vary.clear();
    for (const std::string& one : arguments.vary) {
      sweep.vary.push_back(scenario::split_variation(one));
    }
  }
  if (!arguments.combine.empty()) {
    sweep.combine = arguments.combine == "zip" ? Combine::zip : Combine::grid;
  }
  const auto random = [](const Variation& one) { return scenario::parse_variation(one).random(); };
  if (!arguments.vary.empty() && std::none_of(sweep.vary.begin(), sweep.vary.end(), random)) {
    sweep.samples.reset();  // of what the scenario would draw
  }
  if (arguments.samples) sweep.samples = *arguments.samples;
  if (arguments.seed) sweep.seed = *arguments.seed;
  if (!arguments.measure.empty()) {
    sweep.measure = scenario::split_measures(arguments.measure);
  }
  return sweep;
}

std::vector<scenario::Measure> measures_of(const Sweep& sweep, const ScenarioFamily& family,
                                           const sweep::SweepPlan& plan, const Scenario& first) {
  const bool loop = first.controller.has_value();
  return sweep::sweep_measures(
      sweep.measure.empty() ? scenario::default_measures(loop) : sweep.measure, family, plan);
}

// Columns of the output rows to be kept of each case.
void keep_trajectories(sweep::SweepTask& task, const Scenario& scenario) {
  for (const sweep::Axis& axis : task.plan.axes()) {
    if (axis.key.starts_with("time") || axis.key.starts_with("output")) {
      throw InputError(
          "--keep-trajectories: found " + axis.key +
          " among the keys that vary; allowed: keys that leave all cases with the same rows");
    }
  }
  for (const std::string& name : scenario.output.columns) {
    if (name != "t") task.series.push_back(scenario::find_column(name));
  }
  task.series_rows = solve::OutputGrid(scenario.time).size();
}

// "-sweep.csv", "-sweep-2of8.csv"
std::string suffix(const Shard& shard) {
  std::string text = "-sweep";
  if (shard.of > 1) text += '-' + std::to_string(shard.number) + "of" + std::to_string(shard.of);
  return text + ".csv";
}

std::size_t available_threads() {
  return std::max(1U, std::thread::hardware_concurrency());
}

// Comes before any of them is opened.
void declare_files(const SweepArguments& arguments, const ScenarioFamily& family,
                   const Scenario& first, const std::string& output) {
  file::Outputs outputs;
  reads_scenario(outputs, arguments.scenario.file, first);
  for (const auto& [name, hash] : family.table_hashes()) {
    outputs.reads(name, "a table of the scenario");
  }
  const std::string option = arguments.output.empty() ? "its name by default, without -o" : "-o";
  outputs.writes(output, option);
  for (const std::string& file : sweep::case_files_beside(output)) {
    outputs.writes(file, "kept beside " + output + " until the sweep is done");
  }
  if (!arguments.summary.empty()) outputs.writes(arguments.summary, "--summary");
}

// A controller of one's own that cannot be had is the scenario's fault, and not that of each case.
void try_controller(const ScenarioFamily& family, Scenario first, api::Watch& watch) {
  if (!first.controller || !first.controller->own) return;
  first.source = family.source();  // where its keys stand
  controller::Host host = api::make_host(watch);
  static_cast<void>(api::assemble(first, scenario::columns_named(first.output.columns), host));
}

ExitCode sweep(const SweepArguments& arguments, const Options& options) {
  std::vector<std::string> overrides = arguments.scenario.overrides;
  if (!arguments.error.empty()) overrides.push_back("solver.error=" + arguments.error);
  const Shard shard = read_shard(arguments.shard);
  say_if_waiting(arguments.scenario.file, "a scenario", options.quiet);
  const ScenarioFamily family(arguments.scenario.file, overrides);
  const Sweep sweep = sweep_of(arguments, family.read_sweep());
  const sweep::SweepPlan plan(family, sweep);
  const Scenario first = family.read(plan.settings(0));
  sweep::SweepTask task{family, plan, measures_of(sweep, family, plan, first)};
  Progress progress(family.source().file, options.quiet, true);
  task.tell = [&](std::string_view line) { progress.controller_says(line); };
  if (arguments.keep_trajectories) keep_trajectories(task, first);

  const sweep::Engine engine = sweep::choose_engine(task);
  const sweep::CaseRange range =
      sweep::shard_range(plan.cases(), engine.group, shard.number, shard.of);

  const std::atomic<bool>& stop = watch_signals();
  if (!options.quiet) {
    for (const std::string& remark : first.remarks) say(remark);
  }
  const bool checked = plan.check(family, range.first, range.last, [&](double part) {
    progress.update(part, "checking the cases");
    return !stop.load(std::memory_order_relaxed);
  });
  if (!checked) {
    progress.end();
    say("interrupted before the first case.");
    return ExitCode::interrupted;
  }

  const SweepFacts facts{family, sweep, task, first, shard};
  const std::string output = arguments.output.empty()
                                 ? default_output(arguments.scenario.file, suffix(shard))
                                 : arguments.output;
  declare_files(arguments, family, first, output);
  sweep::CaseFileLayout layout = layout_of(facts, engine, range);
  // Before a controller is started.
  sweep::check_case_target(output, layout, arguments.resume);
  if (arguments.output.empty() && !arguments.force) {
    file::require_like(output, file::table_with(sweep::header_of(layout.columns)));
  }
  try_controller(family, first, progress);
  const auto summary =
      arguments.summary.empty() ? nullptr : std::make_unique<file::AtomicFile>(arguments.summary);
  const auto file =
      sweep::open_case_file(output, std::move(layout), plan_text(facts), arguments.resume);
  if (!file->kept().trouble.empty()) say(file->kept().trouble);
  const std::size_t kept = file->kept().rows, all = range.last - range.first;
  SweepEnd end{true, kept, file->kept().statuses, engine.name, output};

  const std::size_t threads = arguments.threads > 0 ? arguments.threads : available_threads();
  const auto started = std::chrono::steady_clock::now();
  const auto seconds = [&started] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  };
  const auto rate = [&] { return static_cast<double>(end.rows - kept) / seconds(); };
  progress.start(static_cast<double>(kept) / static_cast<double>(all));
  end.finished = sweep::run_sweep(
      engine, {range.first + kept, range.last}, threads, stop,
      [&task](sweep::CaseResults& results) { write_text(task, results); },
      [&](const sweep::CaseResults& results) {
        file->append(results.text, results.count, results.series);
        end.rows += results.count;
        for (const sweep::CaseStatus& status : results.status) {
          end.statuses.add(status.word, status.reason);
        }
        progress.update(static_cast<double>(end.rows) / static_cast<double>(all),
                        rounded(rate(), 3) + " cases/s");
      },
      [&](std::size_t had) {
        if (options.quiet) return;
        say("the system gave no more than " + std::to_string(had) + " of " +
            std::to_string(threads) + " threads; the sweep continues with these");
      });
  progress.end();

  if (end.finished) {
    file->finish(attributes_of(facts, engine));
  } else {
    file->interrupt();
  }
  if (summary) {
    summary->write(summary_text(facts, end));
    summary->commit();
  }

  const std::string counts = std::to_string(end.rows) + " of " + std::to_string(all) + " cases";
  if (!end.finished) {
    std::string reason = "interrupted after " + counts + '.';
    if (!file->part().empty() && end.rows > 0) {
      reason += "\n  " + file->part() + " keeps them; the same command with --resume goes on.";
    }
    say(reason);
    return ExitCode::interrupted;
  }
  if (options.quiet) return ExitCode::done;
  std::string line = name_of_output(output) + ": " + counts;
  if (kept > 0) line += ", " + std::to_string(kept) + " of them from the earlier run";
  if (const std::size_t early = end.statuses.early(); early > 0) {
    line += ", " + std::to_string(early) + " ended early (see status)";
  }
  if (end.statuses.not_finite > 0) {
    line += ", " + std::to_string(end.statuses.not_finite) + " with no finite number (see reason)";
  }
  say(line + ", by " + engine.name + ", " + rounded(seconds(), 3) + " s");
  return ExitCode::done;
}

}  // namespace

void add_sweep(Command& command, const Options& options) {
  command.footer(
      "SPEC is linear:FROM:TO:COUNT, log:FROM:TO:COUNT, list:A,B,C, uniform:FROM:TO or "
      "normal:MEAN:SD. Values may have units. KEY may be a list of tied keys, each with a factor: "
      "KEY,-KEY,2*KEY.\n"
      "\n"
      "Examples:\n"
      "  bbsim sweep configs/fig2a.yaml --vary ball.position.0=linear:-0.1:0.1:41\n"
      "  bbsim sweep configs/fig2b.yaml --vary \"ball.position.0=normal:5 cm:2 mm\" \\\n"
      "      --samples 1000 --measure max_tilt,end_x -o spread.h5\n"
      "  bbsim sweep configs/fig2b.yaml --vary controller.pd.kv.0.0=log:0.1:10:1000 \\\n"
      "      --shard 2/8 --resume -o part-2of8.csv");
  const auto arguments = std::make_shared<SweepArguments>();
  add_scenario(command, arguments->scenario);
  command
      .option("--vary", arguments->vary,
              "values of a key, or of several tied keys (see below); repeatable; default: the "
              "scenario's sweep.vary")
      .takes("KEY=SPEC")
      .may_be_repeated();
  command
      .option(
          "--combine", arguments->combine,
          "grid: each value with each (default); zip: first values together, then second ones, ...")
      .takes("HOW")
      .takes_one_of({"grid", "zip"});
  command.option("--samples", arguments->samples, "number of cases to draw for uniform and normal")
      .takes("N")
      .takes_whole(1);
  command.option("--seed", arguments->seed, "seed of drawn values; default: 1")
      .takes("N")
      .takes_whole(0);
  command
      .option("--measure", arguments->measure,
              "measures to take instead of the default ones: min_, max_, rms_ or end_ before a "
              "column of `bbsim columns` (but not ball_q...); x.RiseTime, y.Overshoot, ...; \"when "
              "x=0.05\"; \"rms_x from 5 s\" (docs/reference/measures.md); repeatable")
      .takes("NAME,...")
      .may_be_repeated();
  command
      .option(
          "-o,--output", arguments->output,
          "write rows to FILE.csv or FILE.h5, or - for CSV on standard output; default: SCENARIO's "
          "name with -sweep.csv, in the current folder; if SCENARIO is -, standard output")
      .takes("FILE");
  add_force(command, arguments->force);
  command
      .option("--summary", arguments->summary,
              "write a summary of the sweep to FILE.json, or - for standard output: its settings, "
              "how cases ended, the engine")
      .takes("FILE");
  command
      .option("-j,--threads", arguments->threads,
              "number of threads; default: number of processors")
      .takes("N")
      .takes_whole(1, 1024);
  command
      .option("--shard", arguments->shard,
              "run only part K of N, K from 1; `bbsim merge` joins the parts")
      .takes("K/N");
  command.flag("--resume", arguments->resume, "continue a sweep that did not end");
  command.flag("--keep-trajectories", arguments->keep_trajectories,
               "also keep the output rows of each case (HDF5 only)");
  add_error(command, arguments->error);
  command.does([arguments, &options] {
    return with_error_option(arguments->error, [&] { return sweep(*arguments, options); });
  });
}

}  // namespace bbsim::app
