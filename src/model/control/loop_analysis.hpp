// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of the loop about home (scenario/measures.hpp), for `bbsim check` and `bbsim
// linearize`.
#pragma once

#include <optional>
#include <vector>

#include "model/control/linearize.hpp"
#include "model/model.hpp"
#include "model/spectrum.hpp"
#include "scenario/measures.hpp"

namespace bbsim::model {

// The parts that a list's measures of the loop need; other measures are ignored.
[[nodiscard]] LoopParts parts_of(const std::vector<scenario::Measure>& measures);

// Computes margins on first use, because poles are much cheaper.
class LoopAnalysis {
 public:
  // `model` is that of `scene`; `parts` is parts_of() the measures that will be asked for. The
  // scene and the model must outlive this object.
  LoopAnalysis(const Scenario& scene, const Model& model, const LoopParts& parts)
      : scene_(scene), model_(model), parts_(parts) {}

  // In the measure's unit. A margin is infinite if no change uses it up, a bandwidth if the
  // response does not fall. NaN, with the reason, if there is no value.
  struct Value {
    double value;
    const char* why = nullptr;
  };
  // The scene must not lack the measure (scenario::missing).
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
