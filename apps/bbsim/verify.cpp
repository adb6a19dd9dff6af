// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/verify.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/short_number.hpp"
#include "commands.hpp"
#include "progress.hpp"
#include "scenario/reader.hpp"
#include "signals.hpp"
#include "study/full_model.hpp"
#include "study/verify_references.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct VerifyArguments {
  std::string scenario;
  std::vector<std::string> overrides;
};

struct NamedScenario {
  std::string name;
  Scenario scenario;
};

std::vector<NamedScenario> scenarios(const VerifyArguments& arguments) {
  if (!arguments.scenario.empty()) {
    const Scenario scenario = read_scenario(arguments.scenario, arguments.overrides);
    return {{scenario.source.file, scenario}};
  }
  std::vector<NamedScenario> list;
  for (const study::ReferenceScene& scene : study::reference_scenes) {
    const std::string name = scene.name;
    if (name != "fig2a" && name != "fig2b") continue;
    list.push_back({name, parse_scenario(scene.scenario, name, arguments.overrides)});
  }
  return list;
}

// Prints as printf does.
template <class... Values>
std::string formatted(const char* format, const Values&... values) {
  const int size = std::snprintf(nullptr, 0, format, values...);
  std::string text(static_cast<std::size_t>(size), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

std::string table_of(const study::Verification& verification) {
  std::size_t width = 5;
  for (const study::Check& check : verification.checks) {
    width = std::max(width, check.name.size());
  }
  const int columns = static_cast<int>(width);
  std::string text =
      formatted("%-*s  %9s  %9s        verdict\n", columns, "check", "error", "bound");
  std::size_t holding = 0;
  for (const study::Check& check : verification.checks) {
    text += formatted("%-*s  %9.1e  %9.1e %-5s  %s\n", columns, check.name.c_str(), check.error,
                      check.bound, check.unit.c_str(), check.holds() ? "holds" : "FAILS");
    if (check.holds()) ++holding;
  }
  return text + formatted("%zu of %zu checks hold\n", holding, verification.checks.size());
}

std::string table_of(const NamedScenario& named, const study::FullModelStudy& study) {
  std::string text =
      "\n"
      "What equation (27) adds in " +
      named.name + ": the error of simpler models\n";
  text += formatted("%-16s  %11s  %9s  %11s  %9s\n", "model", "max |dx| /m", "at t /s",
                    "max |dy| /m", "at t /s");
  for (const study::SimplerModel& model : study.simpler) {
    text +=
        formatted("%-16s  %11.3g  %9s  %11.3g  %9s\n", model.name.c_str(), model.dx,
                  short_number(model.at_dx).c_str(), model.dy, short_number(model.at_dy).c_str());
  }
  const double end = named.scenario.time.end;
  for (const study::SimplerModel& model : study.simpler) {
    if (model.reached >= end) continue;
    text += model.name + " is compared up to t = " + short_number(model.reached) + " s of " +
            short_number(end) + " s, which both models reach\n";
  }
  return text;
}

ExitCode verify(const VerifyArguments& arguments, const Options& options) {
  say_if_waiting(arguments.scenario, "a scenario", options.quiet);
  // Looked up before the checks, so that a mistake in it is told at once.
  const std::vector<NamedScenario> scenes = scenarios(arguments);
  for (const NamedScenario& named : scenes) study::require_comparable(named.scenario);
  file::Outputs outputs;
  if (!arguments.scenario.empty()) {
    reads_scenario(outputs, arguments.scenario, scenes.front().scenario);
  }
  prints(outputs);
  Progress progress("verify", options.quiet);
  const solve::Watch watch{&watch_signals(),
                           [&](double fraction) { progress.update(fraction, ""); }};
  const study::Verification verification = study::verify(watch);
  progress.end();
  print(table_of(verification));
  if (verification.interrupted) {
    say("interrupted.");
    return ExitCode::interrupted;
  }

  std::vector<study::SimplerModel> models;
  for (const NamedScenario& named : scenes) {
    const study::FullModelStudy study =
        study::compare_simpler(named.scenario, {&watch_signals(), {}});
    if (study.interrupted) return ExitCode::interrupted;
    print(table_of(named, study));
    models = study.simpler;
  }
  std::string equations = "\n";
  for (const study::SimplerModel& model : models) {
    equations += model.name + ": " + model.equation + '\n';
  }
  print(equations);
  return verification.holds() ? ExitCode::done : ExitCode::ended_early;
}

}  // namespace

void add_verify(Command& command, const Options& options) {
  const auto arguments = std::make_shared<VerifyArguments>();
  command.option("SCENARIO", arguments->scenario,
                 "a YAML file, or - for standard input: print the error of simpler models on it; "
                 "default: the paper's Fig. 2");
  add_overrides(command, arguments->overrides);
  command.does([arguments, &options] { return verify(*arguments, options); });
}

}  // namespace bbsim::app
