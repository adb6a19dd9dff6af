// Which integrator suits a scene.
#pragma once

#include <string>
#include <string_view>

#include "model/model.hpp"
#include "solve/outcome.hpp"

namespace bbsim::solve {

// As the scenario names it: "bdf".
[[nodiscard]] std::string_view method_name(Method method);

struct Choice {
  Method method;
  std::string reason;
};

// Chooses from the spectrum of the Jacobian over the scene: BDF where a mode decays so fast that
// stability, not accuracy, would hold an explicit-like method's steps down; Adams elsewhere.
// A method that is not automatic is returned as it is. `end` in s.
[[nodiscard]] Choice choose_method(const model::Model& model, Method asked, Tolerances tolerances,
                                   double end);

}  // namespace bbsim::solve
