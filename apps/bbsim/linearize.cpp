// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim linearize`: A, B, C, D, poles, zeros and margins.
#include <string>

#include "api/check.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct LinearizeArguments {
  ScenarioArguments scenario;
  std::string at = "home", output;
  bool plant = false, loop = false, sampled = false;
};

void require_ending(const std::string& output) {
  if (output.empty() || output == "-") return;
  for (const char* ending : {".json", ".m", ".py", ".csv"}) {
    if (output.ends_with(ending)) return;
  }
  throw InputError("-o: found " + output +
                   "; allowed: a name that ends in .m, .py, .json or .csv, or - for JSON on "
                   "standard output");
}

ExitCode linearize(const LinearizeArguments& arguments, const Options& options) {
  require_ending(arguments.output);
  file::Outputs outputs;
  api::LinearizeRequest request{read(arguments.scenario, options, outputs)};
  if (!arguments.output.empty()) {
    outputs.writes(arguments.output, "-o");
  } else {
    prints(outputs);
  }
  if (arguments.plant) request.kind = api::LinearKind::plant;
  if (arguments.loop) request.kind = api::LinearKind::loop;
  if (arguments.sampled) request.kind = api::LinearKind::sampled;
  request.at = arguments.at;
  Progress progress(request.scenario.source.file, options.quiet);
  const api::Linearized linearized = api::linearize(request, progress);
  if (linearized.code != ExitCode::done) {
    say(linearized.reason);
    return linearized.code;
  }
  if (!linearized.note.empty()) say("linearize: " + linearized.note + ".");
  if (arguments.output.empty()) {
    print_report(report_of(linearized));
  } else {
    file::write_file(arguments.output, file_text(linearized, arguments.output));
  }
  return ExitCode::done;
}

}  // namespace

void add_linearize(Command& command, const Options& options) {
  command.footer(
      "Without -o, bbsim prints poles, zeros and margins. Files contain A, B, C, D and the names "
      "of states, inputs and outputs: .m for MATLAB and Octave, .py for numpy and python-control, "
      ".json and .csv for other programs.\n"
      "\n"
      "Examples:\n"
      "  bbsim linearize configs/step.yaml\n"
      "  bbsim linearize configs/rig.yaml --sampled -o plant.m\n"
      "  bbsim linearize configs/fig2b.yaml --plant --at \"2 s\" -o plant.json");
  LinearizeArguments& arguments = command.does(linearize, options);
  add_scenario(command, arguments.scenario);
  command.option("--at POINT", arguments.at,
                 "home: all states zero (default); equilibrium: at rest under the reference of t = "
                 "0; or a TIME of the run, such as \"2 s\"");
  Option plant = command.flag(
      "--plant", arguments.plant,
      "the plant, from the gimbal's commands to the ball's position; default without a controller");
  Option loop = command.flag("--loop", arguments.loop,
                             "the closed loop, from the reference to the position; from sample to "
                             "sample if the controller samples; default with a built-in law");
  Option sampled = command.flag("--sampled", arguments.sampled,
                                "the plant under a zero-order hold, with the delays of sensor and "
                                "controller; default with your own controller");
  loop.excludes(plant);
  sampled.excludes(plant).excludes(loop);
  command.option("-o,--output FILE", arguments.output,
                 "write FILE.m, FILE.py, FILE.json or FILE.csv; - is JSON on standard output");
}

}  // namespace bbsim::app
