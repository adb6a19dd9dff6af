// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/inputs.hpp"

#include "controller/host.hpp"
#include "scenario/reader.hpp"

namespace bbsim::api {
namespace {

// Declares the files that a scenario names.
void reads_parts(file::Outputs& outputs, const Scenario& scenario) {
  for (const TableFile& table : table_files(scenario)) {
    outputs.reads(table.path, "a table of the scenario");
  }
  for (const std::string& file : controller::files_of(scenario)) {
    outputs.reads(file, "the scenario's controller");
  }
}

}  // namespace

void reads_scenario(file::Outputs& outputs, const std::string& file, const Scenario& scenario) {
  outputs.reads(file, "the scenario");
  reads_parts(outputs, scenario);
}

void reads_with_result(file::Outputs& outputs, const results::Result& result) {
  if (!result.beside.empty()) outputs.reads(result.beside, "the summary of " + result.file);
  if (result.scenario) reads_parts(outputs, *result.scenario);
}

}  // namespace bbsim::api
