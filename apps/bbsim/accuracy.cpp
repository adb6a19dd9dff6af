// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim accuracy`: error against processor time; `bbsim verify`: checks the program against closed
// forms and references.
#include "api/accuracy.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_text.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/outputs.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct AccuracyArguments {
  ScenarioArguments scenario;
  std::string csv;
  std::string rtols = "1e-3:1e-13";
  std::vector<std::string> methods;
};

std::vector<Method> methods_named(const std::vector<std::string>& names) {
  std::vector<Method> methods;
  for (const std::string& name : names) {
    const auto known = std::ranges::find(named_methods, name, &NamedMethod::name);
    if (known == named_methods.end()) {
      std::string message = "--methods: found " + name + "; allowed, separated by commas:";
      for (const NamedMethod& method : named_methods) (message += ' ') += method.name;
      throw InputError(message);
    }
    methods.push_back(known->method);
  }
  return methods;
}

void explain_reference(const study::AccuracyStudy& study, double end) {
  say("the reference's own error: about " + rounded(study.reference_error, 2) + " m" +
      (study.reference_by_cvode ? " (CVODE's Adams method at rtol 1e-13)" : ""));
  if (!study.reference_complete && !study.interrupted) {
    say("the reference solution ended at t = " + short_number(study.reference_reached) + " s of " +
        short_number(end) + " s; the errors are those up to then: " + study.reference_reason);
  }
}

ExitCode accuracy(const AccuracyArguments& arguments, const Options& options) {
  file::Outputs outputs;
  const Scenario scenario = read(arguments.scenario, options, outputs);
  const std::vector<Method> methods = methods_named(arguments.methods);
  const std::vector<double> rtols = api::tolerance_ladder(arguments.rtols);
  if (arguments.csv != "-") prints(outputs);
  if (!arguments.csv.empty()) outputs.writes(arguments.csv, "--csv");
  std::unique_ptr<file::AtomicFile> csv;  // opened before the work
  if (!arguments.csv.empty()) csv = std::make_unique<file::AtomicFile>(arguments.csv);

  Progress progress("accuracy", options.quiet);
  const study::AccuracyStudy study = api::accuracy(scenario, methods, rtols, progress);

  if (!options.quiet) explain_reference(study, scenario.time.end);
  if (csv) {
    csv->write(study::accuracy_csv(study));
    csv->commit();
  }
  if (arguments.csv != "-") print(study::accuracy_table(study));
  if (study.interrupted) {
    say("interrupted.");
    return ExitCode::interrupted;
  }
  if (!study::best_by_decade(study).empty()) return ExitCode::done;
  say("no method reached the end of the scenario; `bbsim run` says why");
  return ExitCode::ended_early;
}

// Formats as printf does.
template <class... Values>
std::string formatted(const char* format, const Values&... values) {
  const int size = std::snprintf(nullptr, 0, format, values...);
  std::string text(static_cast<std::size_t>(size), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

std::string table_of(const study::Verification& verification) {
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

std::string table_of(const Scenario& scenario, const study::FullModelStudy& study) {
  std::string text =
      "\n"
      "What equation (27) adds in " +
      scenario.source.file + ": the error of simpler models\n";
  text += formatted("%-16s  %11s  %9s  %11s  %9s\n", "model", "max |dx| /m", "at t /s",
                    "max |dy| /m", "at t /s");
  for (const study::SimplerModel& model : study.simpler) {
    text +=
        formatted("%-16s  %11.3g  %9s  %11.3g  %9s\n", model.name.c_str(), model.dx,
                  short_number(model.at_dx).c_str(), model.dy, short_number(model.at_dy).c_str());
  }
  const double end = scenario.time.end;
  for (const study::SimplerModel& model : study.simpler) {
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
                                           ? study::paper_scenes(arguments.overrides)
                                           : std::vector{read(arguments, options, outputs)};
  for (const Scenario& scene : scenes) study::require_comparable(scene);
  prints(outputs);
  Progress progress("verify", options.quiet);
  const study::Verification verification = api::verify(progress);
  print(table_of(verification));
  if (verification.interrupted) {
    say("interrupted.");
    return ExitCode::interrupted;
  }

  std::vector<study::SimplerModel> models;
  for (const Scenario& scene : scenes) {
    const study::FullModelStudy study = api::compare_simpler(scene, progress);
    if (study.interrupted) return ExitCode::interrupted;
    print(table_of(scene, study));
    models = study.simpler;
  }
  std::string equations = "\n";
  for (const study::SimplerModel& model : models) {
    const std::size_t of_y = model.equation.find("y''");  // on a line of its own
    const std::string_view equation = model.equation;
    equations += model.name + ":\n  " + std::string(equation.substr(0, of_y - 1)) + "\n  " +
                 std::string(equation.substr(of_y)) + '\n';
  }
  print(equations);
  return verification.holds() ? ExitCode::done : ExitCode::ended_early;
}

}  // namespace

void add_accuracy(Command& command, const Options& options) {
  command.footer(
      "The error is the largest |dx| or |dy| over the output times, against a solution in quad "
      "precision, or by CVODE at rtol 1e-13 for scenarios that switch, then without resolutions of "
      "commands and sensors. The time is the median processor time of repeated runs, without "
      "files. atol is "
      "rtol / 100. A second table names the fastest choice for each decade of error.\n"
      "CSV columns: method, rtol, atol, error_m, time_us, steps, rhs_evaluations, "
      "jacobian_evaluations, status.");
  AccuracyArguments& arguments = command.does(accuracy, options);
  add_scenario(command, arguments.scenario);
  command
      .option("--methods NAME,...", arguments.methods,
              "methods to compare: radau, bdf, adams; default: all")
      .parted_by_commas();
  command.option("--rtol LOOSEST:TIGHTEST", arguments.rtols, "tolerances, a decade apart")
      .shows_default();
  command.option("--csv FILE", arguments.csv,
                 "write all points to FILE as CSV; - is standard output");
}

void add_verify(Command& command, const Options& options) {
  ScenarioArguments& arguments = command.does(verify, options);
  command.option("SCENARIO", arguments.file,
                 "a YAML file, or - for standard input: print the error of simpler models on it; "
                 "default: the paper's Fig. 2");
  add_overrides(command, arguments.overrides);
}

}  // namespace bbsim::app
