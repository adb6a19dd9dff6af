// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/assemble.hpp"
#include "base/short_number.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/format.hpp"
#include "file/outputs.hpp"
#include "gnuplot.hpp"
#include "model/model.hpp"
#include "progress.hpp"
#include "scenario/reader.hpp"
#include "signals.hpp"
#include "solve/choose.hpp"
#include "solve/output_grid.hpp"
#include "study/accuracy_text.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct AccuracyArguments {
  ScenarioArguments scenario;
  std::string csv, plot;
  std::string rtols = "1e-3:1e-13";
  std::vector<std::string> methods;
};

// Every method but `auto`, which is one of the others, if none is named.
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
      std::string message = "--methods: found " + name + ", allowed are, separated by commas:";
      for (const NamedMethod& method : named_methods) (message += ' ') += method.name;
      throw InputError(message);
    }
    methods.push_back(known->method);
  }
  return methods;
}

std::optional<double> tolerance(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !(value >= 1e-14 && value <= 0.1)) return {};
  return value;
}

// "1e-3:1e-13": a value a decade from the first to the last; or a single value.
std::vector<double> tolerance_ladder(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto first = tolerance(text.substr(0, colon));
  const auto last = colon == std::string::npos ? first : tolerance(text.substr(colon + 1));
  if (!first || !last || *last > *first) {
    throw InputError("--rtol: found " + text +
                     ", allowed is LOOSEST:TIGHTEST such as 1e-3:1e-13, or one value, each from "
                     "0.1 down to 1e-14");
  }
  std::vector<double> ladder;
  for (int decade = 0;; ++decade) {
    const double rung = decade == 0 ? *first : study::ten_digits(*first / std::pow(10.0, decade));
    if (rung < *last) return ladder;
    ladder.push_back(rung);
  }
}

study::Picture picture_of(const std::string& file) {
  const std::string ending = file::lower_ending(file);
  if (ending == ".svg") return study::Picture::svg;
  if (ending == ".png") return study::Picture::png;
  if (ending == ".pdf") return study::Picture::pdf;
  throw InputError("--plot: found " + file + ", allowed is a name that ends in .svg, .png or .pdf");
}

void explain_reference(const study::AccuracyStudy& study, double end) {
  say("the reference's own error: about " + rounded(study.reference_error, 2) + " m");
  if (!study.reference_complete && !study.interrupted) {
    say("the reference solution ended at t = " + short_number(study.reference_reached) + " s of " +
        short_number(end) + " s, and the errors are those up to then: " + study.reference_reason);
  }
}

// Of a model that is hybrid().
std::string what_switches(const Scenario& scenario, const model::Model& model) {
  std::string list;
  const auto add = [&list](bool there, const char* what) {
    if (there) list += (list.empty() ? "" : ", ") + std::string(what);
  };
  add(model.events.has_value(), "events");
  if (model.rig) {
    const bool by_angles =
        scenario.controller && scenario.controller->law == Law::gravity_compensation;
    add(model.rig->sampled.has_value(), "controller.sampling");
    add(model.rig->limits_commands(),
        by_angles ? "the command limit, which gravity_compensation always has"
                  : "controller.limit");
    add(std::ranges::any_of(model.rig->servo, &model::RigServo::switches),
        "a limit or the backlash of gimbal.servo");
    add(model.rig->between.has_pieces(), "a measured curve of gimbal.linkage");
  }
  add(model.dry.has_value(), "dry friction, sliding, or a motor's limit");
  return list;
}

ExitCode accuracy(const AccuracyArguments& arguments, const Options& options) {
  file::Outputs outputs;
  const Scenario scenario = read(arguments.scenario, options, outputs);
  const std::vector<Method> methods = methods_named(arguments.methods);
  const std::vector<double> rtols = tolerance_ladder(arguments.rtols);
  if (arguments.csv != "-") prints(outputs);
  if (!arguments.csv.empty()) outputs.writes(arguments.csv, "--csv");
  if (!arguments.plot.empty()) outputs.writes(arguments.plot, "--plot");
  // What is written is opened, and gnuplot looked for, before the work is done.
  std::unique_ptr<file::AtomicFile> csv, plot;
  if (!arguments.csv.empty()) csv = std::make_unique<file::AtomicFile>(arguments.csv);
  const study::Picture picture =
      arguments.plot.empty() ? study::Picture::svg : picture_of(arguments.plot);
  if (!arguments.plot.empty()) {
    require_gnuplot();
    plot = std::make_unique<file::AtomicFile>(arguments.plot);
  }

  const auto columns = scenario::columns_named(scenario.output.columns);
  const model::Model model = api::assemble(scenario, columns);
  if (model.hybrid()) {
    throw InputError(
        scenario.source.file + ": accuracy compares smooth runs; found a switch or an event: " +
        what_switches(scenario, model) +
        "; allowed: a scene without one (`bbsim run --error` estimates the error of this one)");
  }
  const solve::OutputGrid grid(scenario.time);
  Progress progress("accuracy", options.quiet);
  const study::AccuracyStudy study =
      study::measure_accuracy(model, grid, methods, rtols,
                              {&watch_signals(), [&](double part) { progress.update(part, ""); }});
  progress.end();

  if (!options.quiet) explain_reference(study, grid.end());
  if (csv) {
    csv->write(study::accuracy_csv(study));
    csv->commit();
  }
  const std::string title = scenario.title.empty()
                                ? std::filesystem::path(scenario.source.file).stem().string()
                                : scenario.title;
  if (arguments.csv != "-") print(study::accuracy_table(study));
  const bool any = !study::best_by_decade(study).empty();
  if (plot && any) {
    plot->write(run_gnuplot(study::accuracy_plot(study, title, picture)));
    plot->commit();
  }
  if (study.interrupted) {
    say("interrupted.");
    return ExitCode::interrupted;
  }
  if (any) return ExitCode::done;
  say("no method reached the end of the scene; `bbsim run` says why");
  return ExitCode::ended_early;
}

}  // namespace

void add_accuracy(Command& command, const Options& options) {
  command.footer(
      "The error is the largest |dx| or |dy| over the output times, against a solution in quad "
      "precision. The time is the median processor time of repeated runs, without files. atol is "
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
  command.option("--plot", arguments->plot, "draw time over error to FILE, with gnuplot")
      .takes("FILE.svg|.png|.pdf");
  command.does([arguments, &options] { return accuracy(*arguments, options); });
}

}  // namespace bbsim::app
