#include "model/control/linear_law.hpp"

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
  std::array<Jet<Number>, 2> path;
  for (std::size_t i = 0; i < 2; ++i) {
    const int first = next + static_cast<int>(i);
    path[i] = {Number::variable(reference[i].value, first),
               Number::variable(reference[i].rate, first + 2),
               Number::variable(reference[i].acceleration, first + 4)};
  }
  const auto unlimited_command = [](int, const Number& raw) { return raw; };
  const Command<Number> u = command(law, state, path, unlimited_command);
  for (int i = 0; i < 2; ++i) {
    linear.of_feedback.row(i) = u.value[i].gradient.head<10>().transpose();
    linear.of_reference.row(i) = u.value[i].gradient.tail<6>().transpose();
  }
  return linear;
}

}  // namespace bbsim::model
