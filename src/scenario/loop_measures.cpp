// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/loop_measures.hpp"

#include <algorithm>

#include "scenario/coupled.hpp"

namespace bbsim::scenario {

const LoopMeasure* find_loop_measure(std::string_view name) {
  const auto* const found = std::ranges::find(loop_measures, name, &LoopMeasure::name);
  return found == loop_measures.end() ? nullptr : found;
}

Missing missing(const LoopMeasure& measure, const Scenario& scenario) {
  const char* const instead = "measures of the motion, such as max_tilt";
  if (!scenario.controller) return {"there is no controller", instead};
  if (scenario.controller->law == Law::commands) return {"commands close no loop", instead};
  if (scenario.controller->own) {
    return {"only the controller knows its law; `bbsim check` tries to identify it", instead};
  }
  if (measure.kind == LoopMeasure::Kind::spectral_radius && !scenario.controller->sampling) {
    return {"the controller takes no samples", "spectral_abscissa; or give controller.sampling"};
  }
  if (measure.of_response() && dry_part(scenario) != nullptr) {
    return {"dry friction has no linear equations", "viscous losses alone"};
  }
  return {};
}

}  // namespace bbsim::scenario
