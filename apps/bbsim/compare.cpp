// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim compare`: two results, or a log and a run.
#include <memory>
#include <string>
#include <vector>

#include "api/measure.hpp"
#include "api/replay.hpp"
#include "commands.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct CompareArguments {
  api::CompareRequest request;
  std::vector<std::string> overrides;
};

ExitCode compare(const CompareArguments& arguments, const Options& all) {
  api::CompareRequest request = arguments.request;
  file::Outputs outputs;
  outputs.reads(request.a, "A");
  say_if_waiting(request.a, "a CSV", all.quiet);
  if (api::is_scenario(request.b)) {
    request.run = read({request.b, arguments.overrides}, all, outputs);
  } else if (!arguments.overrides.empty()) {
    throw InputError("--set: allowed with a scenario as B, in which it sets a key");
  } else {
    outputs.reads(request.b, "B");
    say_if_waiting(request.b, "a CSV", all.quiet);
  }
  prints(outputs);
  Progress progress(request.b, all.quiet || !request.run);
  const api::Compared compared = api::compare(request, progress);
  if (!compared.reason.empty()) say(compared.reason);
  if (compared.code == ExitCode::interrupted) return compared.code;
  print(compared.text);
  if (!all.quiet) {
    for (const std::string& warning : compared.warnings) say(warning);
  }
  return compared.alike ? compared.code : ExitCode::ended_early;
}

}  // namespace

void add_compare(Command& command, const Options& all) {
  command.footer(
      "bbsim matches columns by name and rows by position. Values a and b are alike if |a - b| <= "
      "atol + rtol max(|a|, |b|). NaN equals NaN, and an infinity equals the same infinity. Texts, "
      "such as a sweep's status, must be equal. Without --rtol and --atol, the tolerances follow "
      "from the solver settings that HDF5 files carry; for other files they are 1e-9 and 1e-12.\n"
      "With one of --map, --header, --period, --time-offset and --missing, or a scenario as B, A "
      "is the log "
      "of a rig and B a run. bbsim then prints, for each common column, how far the log's rows are "
      "from the run at their times; --rtol and --atol say what is alike.\n"
      "The exit code is 0 if the files are alike, 1 if they differ, 2 if one cannot be read or "
      "lacks a named column.\n"
      "\n"
      "Examples:\n"
      "  bbsim compare old.h5 new.h5\n"
      "  bbsim compare log.csv rig.csv --map t=millis:ms,x=Ballx:mm --time-offset auto\n"
      "  bbsim compare log.csv rig.yaml --set ball.radius=0.02");
  const auto arguments = std::make_shared<CompareArguments>();
  api::CompareRequest* const request = &arguments->request;
  command.option("A", request->a, "CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  command.option("B", request->b, "the file to compare it with, or a scenario (.yaml) to run")
      .required();
  command
      .option("--rtol", request->rtol, "tolerance relative to the larger value; default: see below")
      .takes("R");
  command
      .option("--atol", request->atol,
              "absolute tolerance, in the column's unit; default: see below")
      .takes("A");
  command
      .option("--columns", request->columns,
              "compare only these columns; default: all; a column that only one file has is a "
              "difference")
      .takes("NAME,...")
      .parted_by_commas();  // a file may follow
  add_log_options(command, request->log);
  add_overrides(command, arguments->overrides);
  command.does([arguments, &all] { return compare(*arguments, all); });
}

}  // namespace bbsim::app
