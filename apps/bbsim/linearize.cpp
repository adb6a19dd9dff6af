// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <memory>
#include <string>

#include "assemble.hpp"
#include "base/number_text.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "file/atomic_file.hpp"
#include "linear_report.hpp"
#include "record/linear_text.hpp"
#include "scenario/reader.hpp"
#include "signals.hpp"
#include "study/operating_point.hpp"
#include "terminal.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::app {
namespace {

struct LinearizeArguments {
  ScenarioArguments scenario;
  std::string at = "home", output;
  bool plant = false, loop = false, sampled = false;
};

using ToText = std::string (*)(const record::LinearReport&);

// What a file of that name holds.
ToText format_of(const std::string& output) {
  if (output == "-" || output.ends_with(".json")) return record::to_json;
  if (output.ends_with(".m")) return record::to_matlab;
  if (output.ends_with(".py")) return record::to_python;
  if (output.ends_with(".csv")) return record::to_csv;
  throw InputError("-o: found " + output +
                   "; allowed: a name that ends in .m, .py, .json or .csv, or - for JSON on "
                   "standard output");
}

model::LinearKind kind_of(const LinearizeArguments& arguments, const Scenario& scenario) {
  if (arguments.plant) return model::LinearKind::plant;
  if (arguments.loop) return model::LinearKind::loop;
  if (arguments.sampled) return model::LinearKind::sampled;
  return model::usual_kind(scenario);
}

const char* name_of(model::LinearKind kind) {
  switch (kind) {
    case model::LinearKind::plant:
      return "plant";
    case model::LinearKind::loop:
      return "loop";
    case model::LinearKind::sampled:
      return "sampled";
  }
  return "";
}

double read_time(const std::string& text, const Scenario& scenario) {
  const yaml::Quantity time = yaml::read_quantity(text, false, yaml::Dimension::time);
  if (!time.value || !(*time.value >= 0 && *time.value <= scenario.time.end)) {
    throw InputError("--at: found " + text +
                     "; allowed: home, equilibrium, or a time from 0 to time.end, which is " +
                     short_number(scenario.time.end) + " s");
  }
  return *time.value;
}

ExitCode linearize(const LinearizeArguments& arguments, const Options& options) {
  const ToText format = arguments.output.empty() ? nullptr : format_of(arguments.output);
  say_if_waiting(arguments.scenario.file, "a scenario", options.quiet);
  const Scenario scenario = read_scenario(arguments.scenario.file, arguments.scenario.overrides);
  file::Outputs outputs;
  reads_scenario(outputs, arguments.scenario.file, scenario);
  if (format != nullptr) {
    outputs.writes(arguments.output, "-o");
  } else {
    prints(outputs);
  }
  const model::Model model = assemble(scenario, {});
  model::LinearPoint point = model::home_point();
  std::string at = arguments.at;
  if (at == "equilibrium") {
    point = model::equilibrium(scenario);
  } else if (at != "home") {
    const double time = read_time(at, scenario);
    at = "t = " + number_text(time) + " s";
    const study::PointInTime found =
        study::point_in_time(scenario, model, time, {&watch_signals(), {}});
    if (!found.point) {
      if (found.outcome.ending == solve::Ending::interrupted) {
        say("interrupted at t = " + short_number(found.outcome.reached) + " s.");
        return ExitCode::interrupted;
      }
      say("the run does not reach t = " + short_number(time) + " s: it ends at t = " +
          short_number(found.outcome.reached) + " s; `bbsim run` says why.");
      return ExitCode::ended_early;
    }
    point = *found.point;
  }
  const model::LinearKind kind = kind_of(arguments, scenario);
  const model::Linearization made = model::linearize(scenario, model, kind, point);
  if (made.poles.empty()) {
    say("the " + std::string(name_of(kind)) + " about " + at +
        " has poles beyond the range of doubles.");
    return ExitCode::ended_early;
  }
  if (made.system.period) {
    const std::string frames = without_frames(scenario, true);
    if (!frames.empty()) say("linearize: " + frames + ".");
  }
  const record::LinearReport report{scenario.source.file, name_of(kind), at, made};
  if (format == nullptr) {
    print(linear_report("the " + report.kind +
                            (kind == model::LinearKind::sampled ? " plant" : "") + " about " + at,
                        made));
    return ExitCode::done;
  }
  file::write_file(arguments.output, format(report));
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
  const auto arguments = std::make_shared<LinearizeArguments>();
  add_scenario(command, arguments->scenario);
  command
      .option("--at", arguments->at,
              "home: all states zero (default); equilibrium: at rest under the reference of t = 0; "
              "or a TIME of the run, such as \"2 s\"")
      .takes("POINT");
  Option plant = command.flag(
      "--plant", arguments->plant,
      "the plant, from the gimbal's commands to the ball's position; default without a controller");
  Option loop = command.flag("--loop", arguments->loop,
                             "the closed loop, from the reference to the position; from sample to "
                             "sample if the controller samples; default with a built-in law");
  Option sampled = command.flag("--sampled", arguments->sampled,
                                "the plant under a zero-order hold, with the delays of sensor and "
                                "controller; default with your own controller");
  loop.excludes(plant);
  sampled.excludes(plant).excludes(loop);
  command
      .option("-o,--output", arguments->output,
              "write FILE.m, FILE.py, FILE.json or FILE.csv; - is JSON on standard output")
      .takes("FILE");
  command.does([arguments, &options] { return linearize(*arguments, options); });
}

}  // namespace bbsim::app
