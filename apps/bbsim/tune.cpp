// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim tune`: gains for the worst of many rigs.
#include "api/tune.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct TuneArguments {
  ScenarioArguments scenario;
  std::vector<std::string> free, require, vary;
  std::string minimize;
  FoundFiles files;
  std::optional<double> samples, hold_out, quantile;
  std::size_t threads = 0;
};

ExitCode tune(const TuneArguments& arguments, const Options& options) {
  const auto& [file, overrides] = arguments.scenario;
  say_if_waiting(file, "a scenario", options.quiet);
  const ScenarioFamily family(file, overrides);
  file::Outputs outputs;
  outputs.reads(file, "the scenario");
  arguments.files.declare(outputs);

  api::TuneRequest request{family, arguments.free, arguments.minimize, arguments.require,
                           arguments.vary};
  request.samples = arguments.samples;
  request.hold_out = arguments.hold_out;
  request.quantile = arguments.quantile.value_or(1);
  request.threads = arguments.threads;
  Progress progress(family.source().file, options.quiet, true);
  const api::TuneResult made = api::tune(request, !arguments.files.scenario.empty(), progress);
  if (made.tuned) {
    arguments.files.write(family, made.scenario, made.json, made.text, options.quiet);
  }
  if (!made.reason.empty()) say(made.reason);
  return made.code;
}

}  // namespace

void add_tune(Command& command, const Options& options) {
  command.footer(
      "bbsim finds the values of the free keys that make the measure smallest on the worst of the "
      "rigs that --vary draws, while the requirements hold on all of them. It prints the values "
      "and what they achieve. A run that does not reach its end, or a measure that is not finite, "
      "counts as infinite. The exit code is 1 if it finds no values at which all requirements "
      "hold; the best ones are then printed and written.\n"
      "\n"
      "Examples:\n"
      "  bbsim tune configs/rig.yaml --free controller.gravity_compensation.kp=2:30 \\\n"
      "      --free controller.gravity_compensation.kv=2:20 --minimize rms_tracking_error\n"
      "  bbsim tune rig.yaml --free \"controller.pid.kp.0.0,controller.pid.kp.1.1=1:30\" \\\n"
      "      --minimize \"rms_tracking_error from 5 s\" --require \"max_tilt < 10 deg\" \\\n"
      "      --vary \"gimbal.servo.natural_frequency=normal:5 Hz:0.3 Hz\" --samples 200 \\\n"
      "      --hold-out 1000 -o tuned.yaml");
  const auto arguments = std::make_shared<TuneArguments>();
  add_scenario(command, arguments->scenario);
  command
      .option("--free", arguments->free,
              "a key to choose, and its bounds; or tied keys, as in KEY,-KEY,2*KEY; repeatable")
      .takes("KEY=FROM:TO")
      .may_be_repeated()
      .required();
  command
      .option("--minimize", arguments->minimize,
              "the measure to minimize, as in `bbsim sweep --measure`")
      .takes("MEASURE")
      .required();
  command
      .option("--require", arguments->require,
              "\"MEASURE < VALUE\", or with <=, > or >=, which must hold on all rigs; repeatable")
      .takes("CONDITION")
      .may_be_repeated();
  command
      .option("--vary", arguments->vary,
              "what differs from rig to rig, as in `bbsim sweep`; repeatable; default: one rig, "
              "the scenario's")
      .takes("KEY=SPEC")
      .may_be_repeated();
  command.option("--samples", arguments->samples, "number of rigs to draw for uniform and normal")
      .takes("N")
      .takes_whole(1);
  command
      .option(
          "--hold-out", arguments->hold_out,
          "draw N more rigs, try the result on them, and print on how many all requirements hold")
      .takes("N")
      .takes_whole(1);
  command
      .option("--quantile", arguments->quantile,
              "judge by this share of the rigs instead of all; default: 1")
      .takes("Q");
  add_found_files(command, arguments->files, "the values");
  add_threads(command, arguments->threads);
  command.does([arguments, &options] { return tune(*arguments, options); });
}

}  // namespace bbsim::app
