#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "file/outputs.hpp"
#include "file/table_writer.hpp"
#include "measure_text.hpp"
#include "record/measure_rows.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct MeasureArguments {
  std::string file;
  std::vector<std::string> measures;
};

ExitCode measure(const MeasureArguments& arguments) {
  file::Outputs outputs;
  outputs.reads(arguments.file, "FILE");
  prints(outputs);
  const record::StoredRun run(file::read_table(arguments.file), arguments.file);
  const auto measures = run.measures_named(scenario::split_measures(arguments.measures));
  std::vector<double> values;
  for (const scenario::Measure& one : measures) values.push_back(run.value_of(one));
  print(measure_text(measures, values));
  return ExitCode::done;
}

}  // namespace

void add_measure(Command& command, const Options& /*it has nothing to be quiet about*/) {
  command.footer(
      "What lies between two rows is on the straight line from one to the other: `bbsim run "
      "--measure` has the motion itself.\n" +
      measures_footer() +
      "\n\nExamples:\n"
      "  bbsim measure step.csv --measure x.RiseTime,x.Overshoot\n"
      "  bbsim measure rig.h5 --measure \"when tracking_error stays below 2 mm\"");
  const auto arguments = std::make_shared<MeasureArguments>();
  command
      .option("FILE", arguments->file,
              "a result of a run: CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  add_measures(command, arguments->measures, "what to measure; may be given again").required();
  command.does([arguments] { return measure(*arguments); });
}

}  // namespace bbsim::app
