// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim accuracy`: error against processor time.
#include "api/accuracy.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/short_number.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/outputs.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct AccuracyArguments {
  ScenarioArguments scenario;
  std::string csv;
  std::string rtols = "1e-3:1e-13";
  std::vector<std::string> methods;
};

// The methods named; by default all except `auto`, which is one of the others.
std::vector<Method> methods_named(const std::vector<std::string>& names) {
  std::vector<Method> methods;
  if (names.empty()) {
    for (const NamedMethod& known : named_methods) {
      if (known.method != Method::automatic) methods.push_back(known.method);
    }
    return methods;
  }
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

void explain_reference(const api::AccuracyStudy& study, double end) {
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
  const api::AccuracyStudy study = api::accuracy(scenario, methods, rtols, progress);

  if (!options.quiet) explain_reference(study, scenario.time.end);
  if (csv) {
    csv->write(api::accuracy_csv(study));
    csv->commit();
  }
  if (arguments.csv != "-") print(api::accuracy_table(study));
  if (study.interrupted) {
    say("interrupted.");
    return ExitCode::interrupted;
  }
  if (api::any_complete(study)) return ExitCode::done;
  say("no method reached the end of the scenario; `bbsim run` says why");
  return ExitCode::ended_early;
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
  const auto arguments = std::make_shared<AccuracyArguments>();
  add_scenario(command, arguments->scenario);
  command
      .option("--methods", arguments->methods,
              "methods to compare: radau, bdf, adams; default: all")
      .takes("NAME,...")
      .parted_by_commas();
  command.option("--rtol", arguments->rtols, "tolerances, a decade apart")
      .takes("LOOSEST:TIGHTEST")
      .shows_default();
  command.option("--csv", arguments->csv, "write all points to FILE as CSV; - is standard output")
      .takes("FILE");
  command.does([arguments, &options] { return accuracy(*arguments, options); });
}

}  // namespace bbsim::app
