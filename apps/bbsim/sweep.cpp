// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim sweep`: a scenario at many values of its keys; `bbsim merge`: joins the parts of a sweep.
#include "api/sweep.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "scenario/measures.hpp"
#include "scenario/variation.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

// "gains.h5" and the number of a part become "gains-3of8.h5". merge() finds missing parts by such
// names.
struct PartName {
  std::string stem, ending;

  explicit PartName(const std::string& file) {
    const std::size_t dot = file.rfind('.');
    const std::size_t slash = file.rfind('/');
    const bool has_ending =
        dot != std::string::npos && (slash == std::string::npos || dot > slash + 1);
    stem = file.substr(0, has_ending ? dot : file.size());
    ending = has_ending ? file.substr(dot) : "";
  }

  // `number` is for a shell: $SLURM_ARRAY_TASK_ID in quotes, or a star.
  [[nodiscard]] std::string word(std::string_view number, std::size_t tasks) const {
    return shell_word(stem + '-') + std::string(number) +
           shell_word("of" + std::to_string(tasks) + ending);
  }
};

constexpr std::string_view task = "\"$SLURM_ARRAY_TASK_ID\"";

struct SweepArguments {
  ScenarioArguments scenario;
  std::vector<std::string> vary;
  std::string shard, error, slurm;
  api::SweepChoice choice;    // without `vary`
  api::SweepRequest request;  // filled in from the options
  std::size_t threads = 0, slurm_tasks = 1000;
};

// The options of a sweep that each of its shards needs, as words for a shell.
std::vector<std::string> options_of(const SweepArguments& arguments) {
  const api::SweepChoice& choice = arguments.choice;
  std::vector<std::string> options;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) options.push_back(name + ' ' + shell_word(value));
  };
  const auto add_all = [&](const std::string& name, const std::vector<std::string>& values) {
    for (const std::string& value : values) add(name, value);
  };
  add_all("--set", arguments.scenario.overrides);
  add("--error", arguments.error);
  add_all("--vary", arguments.vary);
  add("--combine", choice.combine);
  if (choice.samples) add("--samples", number_text(*choice.samples));
  if (choice.seed) add("--seed", number_text(*choice.seed));
  add_all("--measure", choice.measures);
  add_all("--expect", arguments.request.expect);
  if (arguments.request.keeps_rows) options.emplace_back("--keep-trajectories");
  return options;
}

// The script that runs a sweep as a Slurm job array, one shard for each task.
std::string slurm_script(const SweepArguments& arguments, const api::SweepRequest& request,
                         std::size_t cases, std::size_t shards) {
  const std::string tasks = std::to_string(shards);
  const PartName part(request.output);
  const std::string merge =
      "bbsim merge " + part.word("*", shards) + " -o " + shell_word(request.output);
  std::string text =
      "#!/bin/sh\n"
      "# A sweep of " +
      std::to_string(cases) + " cases as a Slurm job array of " + tasks +
      " tasks. Submit it from the folder\n"
      "# in which bbsim wrote it, because names of files are relative to that folder:\n"
      "#\n"
      "#   sbatch " +
      shell_word(request.script) +
      "\n"
      "#\n"
      "# A task that is queued again continues where it stopped. When all tasks are done, join "
      "their parts:\n"
      "#\n"
      "#   " +
      merge +
      "\n"
      "#\n"
      "# or let Slurm do it, with the number of the array's job in place of JOB:\n"
      "#\n"
      "#   sbatch --dependency=afterany:JOB --wrap=" +
      shell_word(merge) +
      "\n"
      "#\n"
      "#SBATCH --job-name=bbsim\n"
      "#SBATCH --array=1-" +
      tasks + "\n";
  if (arguments.threads > 0)
    text += "#SBATCH --cpus-per-task=" + std::to_string(arguments.threads) + '\n';
  text +=
      "#SBATCH --requeue\n"
      "#SBATCH --output=bbsim-%A_%a.log\n"
      "exec \"${BBSIM:-bbsim}\" sweep " +
      shell_word(request.file);
  for (const std::string& option : options_of(arguments)) text += " \\\n  " + option;
  if (!request.summary.empty()) {
    text += " \\\n  --summary " + PartName(request.summary).word(task, shards);
  }
  text += " \\\n  -j \"${SLURM_CPUS_PER_TASK:-1}\" --resume --shard " + std::string(task) + '/' +
          tasks + " \\\n  -o " + part.word(task, shards) + '\n';
  return text;
}

api::Shard read_shard(const std::string& text) {
  api::Shard shard;
  if (text.empty()) return shard;
  int end = 0;
  if (text.find_first_not_of("0123456789/") != std::string::npos || text.size() > 19 ||
      std::sscanf(text.c_str(), "%zu/%zu%n", &shard.number, &shard.of, &end) != 2 ||
      end != static_cast<int>(text.size()) || shard.number < 1 || shard.number > shard.of) {
    throw InputError("--shard: found " + text + "; allowed: K/N with K from 1 to N, such as 2/8");
  }
  return shard;
}

// The scenario's sweep block, with the command line taking precedence.
Sweep sweep_of(const SweepArguments& arguments, const Sweep& in_scenario) {
  api::SweepChoice choice = arguments.choice;
  for (const std::string& variation : arguments.vary) {
    choice.vary.push_back(scenario::split_variation(variation));
  }
  return api::with_choice(in_scenario, choice);
}

// "-sweep.csv", "-sweep-2of8.csv"
std::string suffix(const api::Shard& shard) {
  std::string text = "-sweep";
  if (shard.of > 1) text += '-' + std::to_string(shard.number) + "of" + std::to_string(shard.of);
  return text + ".csv";
}

std::string_view how(std::string_view engine) {
  if (engine.ends_with("lanes")) return "eight at a time";
  return engine == "single runs" ? "one at a time" : "by linear analysis";
}

// "sweep.csv: 41 of 41 cases, eight at a time, 0.0123 s"
std::string written_text(const api::SweepResult& result) {
  std::string line = name_of_output(result.output) + ": " + std::to_string(result.rows) + " of " +
                     std::to_string(result.cases) + " cases";
  if (result.kept > 0) line += ", " + std::to_string(result.kept) + " of them from the earlier run";
  if (const std::size_t early = result.statuses.early(); early > 0) {
    line += ", " + std::to_string(early) + " ended early (see status)";
  }
  if (result.statuses.not_finite > 0) {
    line +=
        ", " + std::to_string(result.statuses.not_finite) + " with no finite number (see reason)";
  }
  return line + ", " + std::string(how(result.engine)) + ", " + rounded(result.seconds, 3) + " s";
}

// Writes the script that runs the sweep on a cluster, in place of a run.
ExitCode write_slurm(const SweepArguments& arguments, api::SweepRequest request,
                     const Options& options) {
  if (request.file == "-" || request.output == "-" || request.summary == "-") {
    throw InputError(
        "--slurm: found - among the files of the sweep; allowed: files, which the tasks read and "
        "write");
  }
  request.script = arguments.slurm;
  Progress progress(request.family->source().file, options.quiet, true);
  const api::SweepSize size = api::check_sweep(request, progress);
  const std::size_t tasks = std::min(size.shards, arguments.slurm_tasks);
  file::write_file(arguments.slurm, slurm_script(arguments, request, size.cases, tasks));
  if (!options.quiet) {
    say(name_of_output(arguments.slurm) + ": " + std::to_string(size.cases) + " cases in " +
        counted(tasks, "task") + "; submit it with sbatch");
  }
  return ExitCode::done;
}

ExitCode sweep(const SweepArguments& arguments, const Options& options) {
  const api::Shard shard = read_shard(arguments.shard);
  const auto& [file, overrides] = with_error(arguments.scenario, arguments.error);
  say_if_waiting(file, "a scenario", options.quiet);
  const ScenarioFamily family(file, overrides);
  api::SweepRequest request = arguments.request;
  request.file = file;
  request.family = &family;
  request.sweep = sweep_of(arguments, family.read_sweep());
  request.shard = shard;
  request.by_default = request.output.empty();
  if (request.by_default) request.output = default_output(file, suffix(shard));
  request.threads = static_cast<double>(arguments.threads);
  if (!arguments.slurm.empty()) return write_slurm(arguments, std::move(request), options);
  Progress progress(family.source().file, options.quiet, true);
  const api::SweepResult result = api::sweep(request, progress);
  if (!result.reason.empty()) {
    say(result.reason);
  } else if (!options.quiet) {
    say(written_text(result));
  }
  for (const std::string& expectation : result.unmet) say(expectation);
  if (!options.quiet && !result.repeat.empty()) say(result.repeat);
  return result.code;
}

struct MergeArguments {
  std::vector<std::string> parts;
  std::string output;
};

ExitCode merge(const MergeArguments& arguments, const Options& options) {
  Progress progress("merge", options.quiet);
  const auto merged = api::merge(arguments.parts, arguments.output, progress);
  if (!merged.note.empty() && !options.quiet) say(merged.note);
  if (merged.interrupted) {
    say("interrupted; nothing was written.");
    return ExitCode::interrupted;
  }
  if (!options.quiet) {
    say(name_of_output(arguments.output) + ": " + counted(merged.cases, "case") + " from " +
        counted(arguments.parts.size(), "part"));
  }
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
      "      --shard 2/8 --resume -o part-2of8.csv\n"
      "  bbsim sweep configs/rig.yaml --vary \"gimbal.servo.damping=normal:0.8:0.05\" \\\n"
      "      --samples 100 --expect \"max_distance < 9 cm\"");
  SweepArguments& arguments = command.does(sweep, options);
  add_scenario(command, arguments.scenario);
  command.option("--vary KEY=SPEC", arguments.vary,
                 "values of a key, or of several tied keys (see below); repeatable; default: the "
                 "scenario's sweep.vary");
  command
      .option("--combine HOW", arguments.choice.combine,
              "grid: every combination (default); zip: the first values together, then the second "
              "ones, ...")
      .takes_one_of({"grid", "zip"});
  command
      .option("--samples N", arguments.choice.samples,
              "number of cases to draw for uniform and normal")
      .takes_whole(1);
  command.option("--seed N", arguments.choice.seed, "seed of drawn values; default: 1")
      .takes_whole(0);
  command.option("--measure NAME,...", arguments.choice.measures,
                 "measures to take instead of the default ones: min_, max_, rms_ or end_ before a "
                 "column of `bbsim columns` (but not ball_q...); x.RiseTime, y.Overshoot, ...; "
                 "\"when x=0.05\"; \"rms_x from 5 s\" (docs/reference/measures.md); repeatable");
  command.option("--expect \"MEASURE < VALUE\"", arguments.request.expect,
                 "add a column of 1 where it holds and 0 where not, and exit with 1 if it does not "
                 "hold in every case; also <=, > and >=; repeatable");
  command.option(
      "-o,--output FILE", arguments.request.output,
      "write rows to FILE.csv or FILE.h5, or - for CSV on standard output; default: SCENARIO's "
      "name with -sweep.csv, in the current folder; if SCENARIO is -, standard output");
  add_force(command, arguments.request.replaces_anything);
  command.option("--summary FILE", arguments.request.summary,
                 "write a summary of the sweep to FILE.json, or - for standard output: its "
                 "settings, how cases ended, the engine");
  command
      .option("-j,--threads N", arguments.threads,
              "number of threads; default: number of processors; the result is the same")
      .takes_whole(1, api::most_threads);
  Option shard = command.option("--shard K/N", arguments.shard,
                                "run only part K of N, K from 1; `bbsim merge` joins the parts");
  command
      .option("--slurm FILE", arguments.slurm,
              "run nothing: write FILE, a script for Slurm's sbatch that runs the sweep as an "
              "array of tasks, one shard each, and says how to merge them")
      .excludes(shard);
  command
      .option("--slurm-tasks N", arguments.slurm_tasks,
              "the most tasks of that array; your site's limit; default: 1000")
      .takes_whole(1);
  command.flag("--resume", arguments.request.resumes, "continue a sweep that did not end");
  command.flag("--keep-trajectories", arguments.request.keeps_rows,
               "also keep the output rows of each case (HDF5 only)");
  add_error(command, arguments.error);
}

void add_merge(Command& command, const Options& options) {
  MergeArguments& arguments = command.does(merge, options);
  command.option("PARTS", arguments.parts, "the files of all shards, in any order").required();
  command
      .option("-o,--output FILE", arguments.output,
              "write FILE.csv or FILE.h5, like the parts; - is CSV on standard output")
      .required();
}

}  // namespace bbsim::app
