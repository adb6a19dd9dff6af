#include "record/columns.hpp"

#include <cstdio>

#include "commands.hpp"

namespace bbsim::app {
namespace {

ExitCode print_columns() {
  std::printf("%-20s %-8s %s\n", "column", "unit", "meaning");
  for (const record::Column& column : record::all_columns()) {
    std::printf("%-20.*s %-8.*s %.*s\n", static_cast<int>(column.name.size()), column.name.data(),
                static_cast<int>(column.unit.size()), column.unit.data(),
                static_cast<int>(column.meaning.size()), column.meaning.data());
  }
  return ExitCode::done;
}

}  // namespace

void add_columns(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("columns", "List the output columns, their units and meaning");
  command->callback([&chosen] { chosen = print_columns; });
}

}  // namespace bbsim::app
