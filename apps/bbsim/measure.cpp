// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim measure`: measures of a result or a log.
#include "api/measure.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/inputs.hpp"
#include "base/number_text.hpp"
#include "commands.hpp"
#include "results/read_result.hpp"
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
  std::vector<std::string> notes;
  results::Result result = results::read_result(arguments.file, {}, arguments.log, &notes);
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

}  // namespace

std::string measure_text(const std::vector<std::pair<std::string, double>>& measures) {
  std::string text = "measure,value\n";
  for (const auto& [name, value] : measures) text += name + ',' + number_text(value) + '\n';
  return text;
}

Option add_measures(Command& command, std::vector<std::string>& lists, const std::string& what) {
  return command.option("--measure", lists, what).takes("NAME,...").may_be_repeated();
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
  const auto arguments = std::make_shared<MeasureArguments>();
  command
      .option("FILE", arguments->file,
              "the result of a run: CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  add_measures(command, arguments->measures, "measures to take; repeatable").required();
  add_log_options(command, arguments->log);
  command.does([arguments, &options] { return measure(*arguments, options); });
}

}  // namespace bbsim::app
