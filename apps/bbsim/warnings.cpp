// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "warnings.hpp"

#include "describe.hpp"

namespace bbsim::app {
namespace {

std::string plate_text(const Plate& plate) {
  if (plate.diameter) return "plate.diameter is " + short_number(*plate.diameter) + " m";
  return "plate.size is [" + short_number((*plate.size)[0]) + ", " +
         short_number((*plate.size)[1]) + "] m";
}

std::string edge_warning(const Scenario& scenario, const record::OffPlate& left) {
  return "warning: the ball is off the plate in the row at t = " + short_number(left.t) +
         " s, at x = " + short_number(left.x) + " m, y = " + short_number(left.y) +
         " m, and the run continues as if the plate were larger: " + plate_text(scenario.plate) +
         "; events.edge: stop ends it there";
}

}  // namespace

std::vector<std::string> warnings_of(const Scenario& scenario, const model::Model& model,
                                     bool failed, const std::optional<record::OffPlate>& left) {
  std::vector<std::string> warnings = scenario.remarks;
  if (model.closed_loop() && !failed) {
    const std::string instability = instability_warning(scenario, model);
    if (!instability.empty()) warnings.push_back("warning: " + instability);
  }
  if (left) warnings.push_back(edge_warning(scenario, *left));
  return warnings;
}

}  // namespace bbsim::app
