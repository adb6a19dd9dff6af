#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/shown.hpp"
#include "commands.hpp"
#include "file/outputs.hpp"
#include "file/table_writer.hpp"
#include "measure_text.hpp"
#include "plot/read_result.hpp"
#include "record/measure_rows.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct MeasureArguments {
  std::string file;
  std::vector<std::string> measures;
};

// Whether a measure is of that column: x of "max_x", "x.Peak" and "when x=1".
bool names(const std::string& measure, const std::string& column) {
  const auto is_letter = [&](std::size_t at) {
    return at < measure.size() && std::isalnum(static_cast<unsigned char>(measure[at])) != 0;
  };
  std::size_t at = measure.find(column);
  for (; at != std::string::npos; at = measure.find(column, at + 1)) {
    const std::size_t after = at + column.size();
    const bool ends = !is_letter(after) && (after >= measure.size() || measure[after] != '_');
    if ((at == 0 || !is_letter(at - 1)) && ends) return true;
  }
  return false;
}

// The columns of numbers; those of words are for others, as a log may have them.
file::TableData numbers_of(plot::Result result, const std::vector<std::string>& measures) {
  if (result.is_sweep()) {
    throw InputError(result.file +
                     ": is a sweep; allowed: the result of a run. Measures of a sweep "
                     "are its columns: bbsim summarise " +
                     result.file);
  }
  file::TableData table;
  for (plot::Column& column : result.columns) {
    if (column.is_text()) {
      const bool asked = std::ranges::any_of(
          measures, [&](const std::string& one) { return names(one, column.name); });
      if (!asked && column.name != "t") continue;
      std::size_t row = 0;
      while (!std::isnan(column.numbers[row]) || column.texts[row].empty()) ++row;
      throw InputError(result.file + ": column " + shown(column.name) + ", row " +
                       std::to_string(row + 1) + ": found " + bbsim::quoted(column.texts[row]) +
                       ", a number is expected");
    }
    table.names.push_back(column.name);
    table.columns.push_back(std::move(column.numbers));
  }
  return table;
}

ExitCode measure(const MeasureArguments& arguments) {
  file::Outputs outputs;
  outputs.reads(arguments.file, "FILE");
  prints(outputs);
  const std::vector<std::string> asked = scenario::split_measures(arguments.measures);
  const record::StoredRun run(numbers_of(plot::read_result(arguments.file, {}), asked),
                              arguments.file);
  const auto measures = run.measures_named(asked);
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
