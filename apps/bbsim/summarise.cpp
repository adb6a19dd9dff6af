// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/summarise.hpp"

#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/cell_table.hpp"
#include "file/outputs.hpp"
#include "scenario/measures.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct SummariseArguments {
  std::string file, output = "-";
  std::vector<std::string> keys, measures;
  std::vector<double> quantiles{0.05, 0.25, 0.5, 0.75, 0.95};
};

ExitCode summarise(const SummariseArguments& arguments, const Options& options) {
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
  const file::CellTable table = file::read_cells(arguments.file);
  const auto groups =
      record::summarise(table, arguments.file, arguments.keys,
                        scenario::split_measures(arguments.measures), arguments.quantiles);
  file::write_file(arguments.output, record::to_csv(groups, arguments.keys, arguments.quantiles));
  return ExitCode::done;
}

}  // namespace

void add_summarise(Command& command, const Options& options) {
  command.footer(
      "Of each group the cases that are done count, with the measures that are finite numbers; "
      "`cases` is how many there are. The deviation is that of a sample.\n"
      "\n"
      "Example, twenty seeds of a sensor's noise at three gains:\n"
      "  bbsim sweep configs/rig.yaml --vary controller.sensor.seed=linear:1:20:20 \\\n"
      "      --vary controller.gravity_compensation.kp=list:8,12,16 -o seeds.csv\n"
      "  bbsim summarise seeds.csv --by controller.gravity_compensation.kp");
  const auto arguments = std::make_shared<SummariseArguments>();
  command
      .option("SWEEP", arguments->file,
              "a result of a sweep: CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  command
      .option("--by", arguments->keys,
              "cases with one value of these keys are a group; without, all are one")
      .takes("KEY,...")
      .parted_by_commas();
  command.option("--measure", arguments->measures, "these measures only; may be given again")
      .takes("NAME,...")
      .may_be_repeated();
  command
      .option("--quantiles", arguments->quantiles,
              "parts of the cases; default: 0.05,0.25,0.5,0.75,0.95")
      .takes("Q,...")
      .parted_by_commas();
  command
      .option("-o,--output", arguments->output,
              "FILE.csv, or - for CSV on standard output (default)")
      .takes("FILE");
  command.does([arguments, &options] { return summarise(*arguments, options); });
}

}  // namespace bbsim::app
