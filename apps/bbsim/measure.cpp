// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim measure`: measures of a result or a log; `bbsim compare`: two results, or a log and a run;
// `bbsim summarize`: statistics of a sweep.
#include "api/measure.hpp"

#include <string>
#include <utility>
#include <vector>

#include "api/replay.hpp"
#include "api/run.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/outputs.hpp"
#include "results/result.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct MeasureArguments {
  std::string file;
  std::vector<std::string> measures;
  results::LogChoice log;
};

ExitCode measure(const MeasureArguments& arguments, const Options& options) {
  say_if_waiting(arguments.file, "a CSV", options.quiet);
  results::refuse_auto(arguments.log);
  if (api::is_scenario(arguments.file)) {
    std::string command = "bbsim run " + shell_word(arguments.file);
    for (const std::string& list : arguments.measures) command += " --measure " + shell_word(list);
    throw InputError(arguments.file +
                     ": is a scenario; allowed: a result; measure its run: " + command);
  }
  results::Result result = results::read_result(arguments.file, {}, arguments.log);
  const std::vector<std::string> notes = result.notes;
  file::Outputs outputs;
  outputs.reads(arguments.file, "FILE");
  api::reads_with_result(outputs, result);
  prints(outputs);
  const api::Measured measured =
      api::measure(std::move(result), arguments.file, arguments.measures);
  print(measure_text(measured.values));
  if (options.quiet) return ExitCode::done;
  for (const std::string& note : notes) say(note);
  for (const std::string& note : measured.notes) say(note);
  return ExitCode::done;
}

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

struct SummarizeArguments : api::SummarizeRequest {
  std::string output = "-";
};

ExitCode summarize(const SummarizeArguments& arguments, const Options& options) {
  if (!arguments.output.ends_with(".csv") && arguments.output != "-") {
    throw InputError("-o: found " + arguments.output +
                     "; allowed: FILE.csv, or - for standard output");
  }
  for (const double part : arguments.quantiles) {
    if (!(part >= 0 && part <= 1)) {
      throw InputError("--quantiles: allowed: numbers from 0 to 1, such as 0.05,0.5,0.95");
    }
  }
  file::Outputs outputs;
  outputs.reads(arguments.file, "SWEEP");
  outputs.writes(arguments.output, "-o");
  say_if_waiting(arguments.file, "a CSV", options.quiet);
  file::write_file(arguments.output, api::summarize(arguments));
  return ExitCode::done;
}

}  // namespace

std::string measure_text(const std::vector<std::pair<std::string, double>>& measures) {
  std::string text = "measure,value\n";
  for (const auto& [name, value] : measures) text += name + ',' + number_text(value) + '\n';
  return text;
}

Option add_measures(Command& command, std::vector<std::string>& lists, const std::string& what) {
  return command.option("--measure NAME,...", lists, what);
}

std::string measures_footer() {
  return "Measures of any column x:\n"
         "  extremes      min_x, max_x, rms_x, end_x\n"
         "  step metrics  x.RiseTime, SettlingTime, SettlingMin, SettlingMax, Overshoot,\n"
         "                Undershoot, Peak, PeakTime, SteadyStateValue\n"
         "  instants      \"when x=0.05\", with rise=N, fall=N or cross=N (N may be last);\n"
         "                \"when x stays below 0.05\", or above\n"
         "  values        \"find y when x=0.05\", \"find y at 2\"\n"
         "  of the loop   stable, spectral_radius, spectral_abscissa; phi_ or theta_ and\n"
         "                gain_margin, gain_reduction, phase_margin or delay_margin; x_\n"
         "                or y_ and bandwidth or feedback_bandwidth; not of a stored run\n"
         "A step goes from x at the start to x_reference at the end, or to x at the end if x has "
         "no reference. Append \"from 5 s\", \"to 20 s\" or both to measure a part of the run.";
}

void add_measure(Command& command, const Options& options) {
  command.footer(
      "Values between two rows are interpolated linearly. `bbsim run --measure` measures the "
      "motion itself.\n" +
      measures_footer() +
      "\n\nExamples:\n"
      "  bbsim measure step.csv --measure x.RiseTime,x.Overshoot\n"
      "  bbsim measure rig.csv --measure \"rms_tracking_error from 5 s\"\n"
      "  bbsim measure log.csv --map t=millis:ms,x=Ballx:mm --measure x.RiseTime\n"
      "  bbsim measure rig.h5 --measure \"when tracking_error stays below 2 mm\"");
  MeasureArguments& arguments = command.does(measure, options);
  command
      .option("FILE", arguments.file,
              "the result of a run: CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  add_measures(command, arguments.measures, "measures to take; repeatable").required();
  add_log_options(command, arguments.log);
}

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
  CompareArguments& arguments = command.does(compare, all);
  api::CompareRequest& request = arguments.request;
  command.option("A", request.a, "CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  command.option("B", request.b, "the file to compare it with, or a scenario (.yaml) to run")
      .required();
  command
      .option("--rtol R", request.rtol,
              "tolerance relative to the larger value; default: see below")
      .takes_number();
  command
      .option("--atol A", request.atol,
              "absolute tolerance, in the column's unit; default: see below")
      .takes_number();
  command
      .option("--columns NAME,...", request.columns,
              "compare only these columns; default: all; a column that only one file has is a "
              "difference")
      .parted_by_commas();  // a file may follow
  add_log_options(command, request.log);
  add_overrides(command, arguments.overrides);
}

void add_summarize(Command& command, const Options& options) {
  command.footer(
      "Statistics are over the cases of a group that are done and have a finite measure; `cases` "
      "is the number of all cases in the group. The deviation is the sample standard deviation. "
      "`bbsim summarise` is the same command.\n"
      "\n"
      "Example (twenty seeds of the sensor noise at three gains):\n"
      "  bbsim sweep configs/rig.yaml --vary controller.sensor.seed=linear:1:20:20 \\\n"
      "      --vary controller.gravity_compensation.kp=list:8,12,16 -o seeds.csv\n"
      "  bbsim summarize seeds.csv --by controller.gravity_compensation.kp");
  SummarizeArguments& arguments = command.does(summarize, options);
  command
      .option("SWEEP", arguments.file,
              "the result of a sweep: CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  command
      .option("--by KEY,...", arguments.keys,
              "group cases with equal values of these keys; default: one group of all cases")
      .parted_by_commas();
  command.option("--measure NAME,...", arguments.measures, "only these measures; repeatable");
  command
      .option("--quantiles Q,...", arguments.quantiles,
              "numbers from 0 to 1; default: 0.05,0.25,0.5,0.75,0.95")
      .takes_number()
      .parted_by_commas();
  command.option("-o,--output FILE", arguments.output,
                 "write FILE.csv, or - for CSV on standard output (default)");
}

}  // namespace bbsim::app
