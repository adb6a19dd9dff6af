// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim verify`: checks the program against closed forms and references.
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/accuracy.hpp"
#include "base/short_number.hpp"
#include "commands.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

// Formats as printf does.
template <class... Values>
std::string formatted(const char* format, const Values&... values) {
  const int size = std::snprintf(nullptr, 0, format, values...);
  std::string text(static_cast<std::size_t>(size), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

std::string table_of(const api::Verification& verification) {
  std::size_t width = 5;
  for (const auto& check : verification.checks) {
    width = std::max(width, check.name.size());
  }
  const int columns = static_cast<int>(width);
  std::string text = formatted("%-*s  %7s  %7s    verdict\n", columns, "check", "error", "bound");
  std::size_t holding = 0;
  for (const auto& check : verification.checks) {
    text += formatted("%-*s  %7.1e  %7.1e m  %s\n", columns, check.name.c_str(), check.error,
                      check.bound, check.holds() ? "holds" : "FAILS");
    if (check.holds()) ++holding;
  }
  return text + formatted("%zu of %zu checks hold\n", holding, verification.checks.size());
}

std::string table_of(const Scenario& scenario, const api::FullModelStudy& study) {
  std::string text =
      "\n"
      "What equation (27) adds in " +
      scenario.source.file + ": the error of simpler models\n";
  text += formatted("%-16s  %11s  %9s  %11s  %9s\n", "model", "max |dx| /m", "at t /s",
                    "max |dy| /m", "at t /s");
  for (const api::SimplerModel& model : study.simpler) {
    text +=
        formatted("%-16s  %11.3g  %9s  %11.3g  %9s\n", model.name.c_str(), model.dx,
                  short_number(model.at_dx).c_str(), model.dy, short_number(model.at_dy).c_str());
  }
  const double end = scenario.time.end;
  for (const api::SimplerModel& model : study.simpler) {
    if (model.reached >= end) continue;
    text += model.name + " is compared up to t = " + short_number(model.reached) + " s of " +
            short_number(end) + " s, which both models reach\n";
  }
  return text;
}

ExitCode verify(const ScenarioArguments& arguments, const Options& options) {
  // Read the scenes before the checks, so that a mistake is reported at once.
  file::Outputs outputs;
  const std::vector<Scenario> scenes = arguments.file.empty()
                                           ? api::paper_scenes(arguments.overrides)
                                           : std::vector{read(arguments, options, outputs)};
  for (const Scenario& scene : scenes) api::require_comparable(scene);
  prints(outputs);
  Progress progress("verify", options.quiet);
  const api::Verification verification = api::verify(progress);
  print(table_of(verification));
  if (verification.interrupted) {
    say("interrupted.");
    return ExitCode::interrupted;
  }

  std::vector<api::SimplerModel> models;
  for (const Scenario& scene : scenes) {
    const api::FullModelStudy study = api::compare_simpler(scene, progress);
    if (study.interrupted) return ExitCode::interrupted;
    print(table_of(scene, study));
    models = study.simpler;
  }
  std::string equations = "\n";
  for (const api::SimplerModel& model : models) {
    const std::size_t of_y = model.equation.find("y''");  // on a line of its own
    const std::string_view equation = model.equation;
    equations += model.name + ":\n  " + std::string(equation.substr(0, of_y - 1)) + "\n  " +
                 std::string(equation.substr(of_y)) + '\n';
  }
  print(equations);
  return verification.holds() ? ExitCode::done : ExitCode::ended_early;
}

}  // namespace

void add_verify(Command& command, const Options& options) {
  const auto arguments = std::make_shared<ScenarioArguments>();
  command.option("SCENARIO", arguments->file,
                 "a YAML file, or - for standard input: print the error of simpler models on it; "
                 "default: the paper's Fig. 2");
  add_overrides(command, arguments->overrides);
  command.does([arguments, &options] { return verify(*arguments, options); });
}

}  // namespace bbsim::app
