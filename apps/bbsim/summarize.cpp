// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim summarize`: statistics of a sweep.
#include <memory>
#include <string>

#include "api/measure.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/outputs.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

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
  const auto arguments = std::make_shared<SummarizeArguments>();
  command
      .option("SWEEP", arguments->file,
              "the result of a sweep: CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  command
      .option("--by", arguments->keys,
              "group cases with equal values of these keys; default: one group of all cases")
      .takes("KEY,...")
      .parted_by_commas();
  command.option("--measure", arguments->measures, "only these measures; repeatable")
      .takes("NAME,...")
      .may_be_repeated();
  command
      .option("--quantiles", arguments->quantiles,
              "numbers from 0 to 1; default: 0.05,0.25,0.5,0.75,0.95")
      .takes("Q,...")
      .parted_by_commas();
  command
      .option("-o,--output", arguments->output,
              "write FILE.csv, or - for CSV on standard output (default)")
      .takes("FILE");
  command.does([arguments, &options] { return summarize(*arguments, options); });
}

}  // namespace bbsim::app
