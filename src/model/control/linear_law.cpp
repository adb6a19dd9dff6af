// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/linear_law.hpp"

#include "model/control/linear_parts.hpp"
#include "simd/gradient.hpp"

namespace bbsim::model {

LinearLaw linear_law(const ControlLaw& law, const Feedback<double>& at,
                     const std::array<Jet<double>, 2>& reference) {
  using Number = simd::WithGradient<16>;
  LinearLaw linear;
  linear.of_feedback.setZero();
  linear.of_reference.setZero();
  if (law.kind == LawKind::held) return linear;
  int next = 0;
  const auto variables = [&next](const double(&values)[2], Number(&into)[2]) {
    for (int i = 0; i < 2; ++i) into[i] = Number::variable(values[i], next++);
  };
  Feedback<Number> state;
  variables(at.position, state.position);
  variables(at.velocity, state.velocity);
  variables(at.angle, state.angle);
  variables(at.rate, state.rate);
  variables(at.integral, state.integral);
  const auto path = varied<Number>(reference, next);
  const auto unlimited_command = [](int, const Number& raw) { return raw; };
  const Command<Number> u = command(law, state, path, unlimited_command);
  linear.of_feedback = simd::gradients(u.value, 0, 10);
  linear.of_reference = simd::gradients(u.value, 10, 6);
  return linear;
}

}  // namespace bbsim::model
