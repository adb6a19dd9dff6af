// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// From which acceleration on does a stepper lose steps, and how many? Compares bbsim's rule with a
// rotor whose field pulls it by T sin(N (field - rotor)), integrated in small steps.
#include <bbsim/bbsim.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace {

constexpr double torque = 0.4, inertia = 2e-4;  // N m, kg m^2
constexpr double pole_pairs = 50;               // 200 steps
constexpr double period = 2 * std::numbers::pi / pole_pairs;
constexpr double move = 1.2, fastest = 20;  // rad, rad/s

// The field's angle and rate on a trapezoidal ramp from rest.
struct Field {
  double angle, rate;
};
Field field(double acceleration, double t) {
  const double peak = std::fmin(fastest, std::sqrt(acceleration * move));
  const double rise = peak / acceleration;
  const double even = (move - peak * rise) / peak, left = 2 * rise + even - t;
  if (left <= 0) return {move, 0};
  if (t < rise) return {acceleration * t * t / 2, acceleration * t};
  if (left < rise) return {move - acceleration * left * left / 2, acceleration * left};
  return {peak * (t - rise / 2), peak};
}

// The periods that a rotor is behind a second after its field has come to rest. `friction`: dry, as
// a fraction of the torque.
double rotor_loses(double acceleration, double friction) {
  const auto pull = [&](double t, double angle, double rate) {
    const Field now = field(acceleration, t);
    return torque / inertia *
           (std::sin(pole_pairs * (now.angle - angle)) - friction * std::tanh(rate / 0.05));
  };
  const double end = 2 * std::sqrt(move / acceleration) + move / fastest + 1;
  constexpr double h = 2e-6;
  double angle = 0, rate = 0;
  for (long i = 0; static_cast<double>(i) * h < end; ++i) {  // classical Runge-Kutta
    const double t = static_cast<double>(i) * h;
    const double k1 = pull(t, angle, rate);
    const double r2 = rate + h / 2 * k1, k2 = pull(t + h / 2, angle + h / 2 * rate, r2);
    const double r3 = rate + h / 2 * k2, k3 = pull(t + h / 2, angle + h / 2 * r2, r3);
    const double r4 = rate + h * k3, k4 = pull(t + h, angle + h * r3, r4);
    angle += h / 6 * (rate + 2 * r2 + 2 * r3 + r4);
    rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return std::round((move - angle) / period);
}

double bbsim_loses(double acceleration) {
  const auto number = [](double value) { return std::to_string(value); };
  const bbsim::Scenario scenario = bbsim::Scenario::from_text(
      "ball: {radius: 0.01}\n"
      "gimbal: {servo: {stepper: {torque: " +
      number(torque) + ", inertia: 2e-4}, rate_limit: " + number(fastest) +
      ", acceleration_limit: " + number(acceleration) +
      "}}\n"
      // One sample, which sees the ball at 0.
      "controller: {pd: {kp: [[1, 0], [0, 0]], kv: 0}, drives: angle, reference: {point: [" +
      number(move) +
      ", 0]},\n"
      "  sampling: {period: 10}}\n"
      "time: {end: 2, step: 1}\n"
      "output: {columns: [t, phi, phi_believed]}\n");
  const bbsim::Result result = bbsim::run(scenario);
  return (result.column("phi_believed").back() - result.column("phi").back()) / period;
}

}  // namespace

int main() {
  std::printf("inertia x acceleration / torque from which steps are lost\n");
  for (const double friction : {0.0, 0.02, 0.05, 0.1, 0.2}) {
    double none = 0.3, some = 1.5;
    while (some - none > 1e-3) {
      const double middle = (none + some) / 2;
      (rotor_loses(middle * torque / inertia, friction) == 0 ? none : some) = middle;
    }
    std::printf("  rotor, friction %.2f: %.3f\n", friction, some);
  }
  double none = 0.3, some = 1.5;
  while (some - none > 1e-3) {
    const double middle = (none + some) / 2;
    (bbsim_loses(middle * torque / inertia) == 0 ? none : some) = middle;
  }
  std::printf("  bbsim: %.3f\n\nfour-step periods lost in a move of %.3g of them\n", some,
              move / period);
  for (const double load : {0.5, 0.9, 1.02, 1.1, 1.3, 2.0}) {
    const double a = load * torque / inertia;
    std::printf("  load %.2f: rotor %3.0f (friction 0.05), %3.0f (0.2), bbsim %3.0f\n", load,
                rotor_loses(a, 0.05), rotor_loses(a, 0.2), bbsim_loses(a));
  }
  return 0;
}
