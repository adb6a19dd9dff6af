#include "record/compare.hpp"

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "record/atomic_file.hpp"
#include "record/table_writer.hpp"

namespace bbsim::app {
namespace {

struct CompareOptions {
  std::string a, b;
  record::Tolerances tolerances;
  std::vector<std::string> columns;
};

ExitCode run_compare(const CompareOptions& options) {
  record::Outputs outputs;
  outputs.reads(options.a, "A");
  outputs.reads(options.b, "B");
  prints(outputs);
  const record::TableData a = record::read_table(options.a);
  const record::TableData b = record::read_table(options.b);
  const record::Comparison comparison = record::compare(a, b, options.tolerances, options.columns);
  record::write_file("-", to_text(comparison, options.a, options.b, options.tolerances));
  return comparison.alike() ? ExitCode::done : ExitCode::ended_early;
}

}  // namespace

void add_compare(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("compare", "Compare two CSV or HDF5 files");
  command->footer(
      "Columns are compared by name, whatever their order, rows by position. Values a and b are\n"
      "alike if |a - b| <= atol + rtol max(|a|, |b|); NaN is like NaN, an infinity like the same\n"
      "infinity. The exit code is 0 if the files are alike, 1 if they differ, 2 if one cannot be\n"
      "read or lacks a named column.");
  auto options = std::make_shared<CompareOptions>();
  command
      ->add_option("A", options->a,
                   "a CSV file, an HDF5 file (.h5, .hdf5), or - for CSV on standard input")
      ->required();
  command->add_option("B", options->b, "what to compare it with")->required();
  command->add_option("--rtol", options->tolerances.rtol, "relative tolerance, of the larger value")
      ->type_name("R")
      ->capture_default_str();
  command
      ->add_option("--atol", options->tolerances.atol, "absolute tolerance, in the column's unit")
      ->type_name("A")
      ->capture_default_str();
  command
      ->add_option("--columns", options->columns,
                   "compare these only (default: all; one that a file lacks is a difference)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);  // a file may follow
  command->callback([options, &chosen] { chosen = [options] { return run_compare(*options); }; });
}

}  // namespace bbsim::app
