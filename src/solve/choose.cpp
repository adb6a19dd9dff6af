// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/choose.hpp"

#include <algorithm>

#include "model/spectrum.hpp"

namespace bbsim::solve {

std::string_view method_name(Method method) {
  const auto* named = std::find_if(named_methods.begin(), named_methods.end(),
                                   [method](const auto& entry) { return entry.method == method; });
  return named == named_methods.end() ? "" : named->name;
}

Method choose_method(Method asked) {
  return asked == Method::automatic ? Method::radau : asked;
}

double decays_over_scene(const model::Model& model, double end) {
  double fastest = 0;
  const auto look = [&](const model::Eigenvalues& values) {
    for (const auto& value : values) fastest = std::max(fastest, -value.real());
  };
  if (model.closed_loop()) {
    look(model::eigenvalues(model, 0, model.initial.data()));
    look(model::closed_loop_poles(model));
  } else {
    // The Jacobian depends only on time. Sample it across the scene.
    constexpr int samples = 8;
    for (int i = 0; i <= samples; ++i) {
      look(model::eigenvalues(model, end * i / samples, model.initial.data()));
    }
  }
  return fastest * end;
}

}  // namespace bbsim::solve
