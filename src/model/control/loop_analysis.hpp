// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures of the loop (scenario/loop_measures.hpp): the numbers of `bbsim check` and `bbsim
// linearize`, about home.
#pragma once

#include <optional>
#include <vector>

#include "model/control/linearize.hpp"
#include "model/model.hpp"
#include "model/spectrum.hpp"
#include "scenario/measures.hpp"

namespace bbsim::model {

// What measures of the loop need; others in the list do not matter.
[[nodiscard]] LoopParts parts_of(const std::vector<scenario::Measure>& measures);

// Computes margins when one is first asked for: poles are much cheaper.
class LoopAnalysis {
 public:
  // `model` is the one of `scene`; `parts` are the parts_of() what will be asked. The first two
  // must outlive this.
  LoopAnalysis(const Scenario& scene, const Model& model, const LoopParts& parts)
      : scene_(scene), model_(model), parts_(parts) {}

  // In the measure's unit. An infinite margin is one that any change leaves; a bandwidth is
  // infinite where the response does not fall. NaN, and why, where there is none.
  struct Value {
    double value;
    const char* why = nullptr;
  };
  // Requires that the scene does not lack the measure (scenario::missing).
  [[nodiscard]] Value value_of(const scenario::LoopMeasure& measure);

 private:
  [[nodiscard]] bool sampled() const { return model_.rig && model_.rig->sampled; }
  [[nodiscard]] const Eigenvalues& poles();
  [[nodiscard]] bool is_stable();
  [[nodiscard]] Value pole_value(scenario::LoopMeasure::Kind kind);
  [[nodiscard]] Value margin(const scenario::LoopMeasure& measure);
  [[nodiscard]] Value bandwidth(const scenario::LoopMeasure& measure);

  const Scenario& scene_;
  const Model& model_;
  const LoopParts parts_;
  std::optional<Eigenvalues> poles_;
  std::optional<Linearization> loop_;
};

}  // namespace bbsim::model
