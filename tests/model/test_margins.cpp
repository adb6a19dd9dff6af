// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Stability margins against the loop's own poles; poles that rounding must not move; zeros.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "catch.hpp"
#include "model/control/identified_law.hpp"
#include "model/control/linear_system.hpp"
#include "model/control/linearize.hpp"
#include "model/control/sampled_cycle.hpp"
#include "model/eigenvalues.hpp"
#include "model/matched.hpp"
#include "support/reading.hpp"
#include "support/sanitizers.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_margins {

using namespace bbsim;
using Eigen::MatrixXd;
using model::Eigenvalues;
using model::Linearization;
using model::LinearKind;
using model::Margins;
using Complex = std::complex<double>;

namespace {

Linearization loop_of(const Scenario& scene) {
  return model::linearize(scene, model::assemble(scene, false), LinearKind::loop,
                          model::home_point());
}

bool is_stable(const Scenario& scene) {
  const model::Model model = model::assemble(scene, false);
  return model.rig && model.rig->sampled ? model::stable(model::sampled_poles(model), true)
                                         : model::stable(model::closed_loop_poles(model));
}

// All the law's gains of one axis times a factor.
Scenario with_row(Scenario scene, std::size_t row, double factor) {
  Controller& law = *scene.controller;
  for (Matrix2* gain : {&law.kp, &law.kv, &law.ki}) {
    for (double& one : (*gain)[row]) one *= factor;
  }
  for (double& one : law.gain[row]) one *= factor;
  return scene;
}

// Loops of all kinds, mostly stable.
class Loops {
 public:
  Scenario draw() {
    Scenario scene = fig2b();
    scene.ball.radius = by_factors(0.005, 0.05);
    scene.ball.mass = by_factors(0.01, 0.5);
    Controller& controller = *scene.controller;
    controller.reference = PointReference{};
    const bool sampled = chance(0.6), by_torque = chance(0.25);
    const double slowest = sampled ? 10 : 3;
    scene.gimbal.servo = Servo{by_factors(slowest, 150), between(0.3, 1.5)};
    if (chance(0.2)) {
      scene.gimbal.mounting = {between(-0.03, 0.03), between(-0.02, 0.02), between(-0.02, 0.02),
                               between(-0.1, 0.1),   between(-0.5, 0.5),   between(-0.03, 0.03)};
    }
    if (by_torque) {
      scene.gimbal.servo.reset();
      scene.plate.inertia = {{0.004, by_factors(0.002, 0.008), 0.008}};
      scene.gimbal.motor = Motor{};
      scene.gimbal.motor->viscous = by_factors(1e-3, 0.1);
      controller.drives = Drives::torque;
    }
    const double whole = by_torque ? by_factors(3, 8) : by_factors(0.2, 1),
                 of_rate = whole * by_factors(0.2, 1.2),
                 of_angle = by_torque ? by_factors(1, 4) : between(-0.1, 0.5),
                 of_angle_rate = by_torque ? by_factors(0.1, 0.5) : between(-0.01, 0.03);
    const int law = by_torque ? 2 : static_cast<int>(between(0, 3));
    controller.law = law == 0 ? Law::pd : law == 1 ? Law::pid : Law::state_feedback;
    controller.kp = {{{whole, 0}, {0, -whole}}};
    controller.kv = {{{of_rate, 0}, {0, -of_rate}}};
    if (law == 1) {
      const double of_sum = whole * by_factors(0.02, 1);
      controller.ki = {{{of_sum, 0}, {0, -of_sum}}};
    }
    if (law == 2) {
      controller.kp = controller.kv = {};
      controller.gain = {{{whole, 0, of_rate, 0, of_angle, 0, of_angle_rate, 0},
                          {0, -whole, 0, -of_rate, 0, of_angle, 0, of_angle_rate}}};
    }
    if (sampled) {
      controller.sampling = Sampling{by_torque ? by_factors(0.002, 0.02) : by_factors(0.005, 0.05)};
      if (chance(0.4)) controller.sampling->delay = controller.sampling->period * between(0, 2);
      if (chance(0.6)) controller.sampling->derivative_filter = by_factors(0.005, 0.05);
      if (chance(0.4)) {
        controller.sensor = Sensor{};
        controller.sensor->delay = controller.sampling->period * between(0, 2);
      }
      if (!by_torque && law != 2 && chance(0.2)) {
        scene.gimbal.servo = Servo{};
        scene.gimbal.servo->time_constant = by_factors(0.02, 0.1);
      }
    }
    return scene;
  }

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  double by_factors(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  bool chance(double p) { return between(0, 1) < p; }

  std::mt19937 random_{11};
};

}  // namespace

TEST_CASE("gain margins are where the poles of 500 random loops cross the stability limit") {
  // Ten times slower under sanitizers, where a part is enough.
  const int count = bbsim_test::under_sanitizers ? 50 : 500;
  Loops loops;
  int tried = 0, sampled = 0, at_zero = 0, at_half_rate = 0, between = 0, down = 0, none = 0;
  while (tried < count) {
    const Scenario scene = loops.draw();
    if (!is_stable(scene)) continue;
    const auto row = static_cast<std::size_t>(tried % 2);
    const Margins margins = loop_of(scene).margins[row].margins;
    const auto stable_with = [&](double factor) { return is_stable(with_row(scene, row, factor)); };
    ++tried;
    const bool samples = scene.controller->sampling.has_value();
    CAPTURE(tried, samples, static_cast<int>(scene.controller->law), margins.gain, margins.gain_at,
            margins.reduction, margins.reduction_at);
    if (samples) ++sampled;
    if (std::isfinite(margins.gain)) {
      CHECK(stable_with(0.99 * margins.gain));
      CHECK_FALSE(stable_with(1.01 * margins.gain));
      const bool last =
          samples && margins.gain_at == std::numbers::pi / scene.controller->sampling->period;
      ++(last ? at_half_rate : between);
    } else {
      ++none;
      CHECK(stable_with(1e3));
    }
    if (margins.reduction > 0) {
      CHECK(stable_with(1.01 * margins.reduction));
      CHECK_FALSE(stable_with(0.99 * margins.reduction));
      ++(margins.reduction_at == 0 ? at_zero : down);
    } else {
      CHECK(stable_with(1e-3));
    }
    // No crossing in between.
    const double low = std::log(std::max(margins.reduction, 1e-3)),
                 high = std::log(std::min(margins.gain, 1e3));
    for (int i = 0; i < 3; ++i) CHECK(stable_with(std::exp(loops.between(low, high))));
  }
  CAPTURE(sampled, at_zero, at_half_rate, between, down, none);
  // Every kind occurs.
  CHECK(std::min({sampled, count - sampled, at_zero, at_half_rate, between, down, none}) >
        count / 25);
}

TEST_CASE("a negative phase margin is a lead: that much brings the loop to the stability limit") {
  Scenario scene = fig2b();
  scene.ball.radius = 0.032;
  scene.gimbal.servo = Servo{130, 0.717};
  scene.controller->kp = {{{0.693, 0}, {0, -0.693}}};
  scene.controller->kv = {{{0.728, 0}, {0, -0.728}}};
  scene.controller->reference = PointReference{};
  scene.controller->sampling = Sampling{0.03};
  REQUIRE(is_stable(scene));
  const Margins margins = loop_of(scene).margins[0].margins;
  REQUIRE(margins.phase < 0);
  // L = K(z) G(z), with the plant under a held command.
  const Linearization plant = model::linearize(scene, model::assemble(scene, false),
                                               LinearKind::sampled, model::home_point());
  const auto& system = plant.system;
  const model::FrequencyResponse response(system.a, system.b, system.c, system.d, 0.03);
  const Complex z = std::polar(1.0, margins.phase_at * 0.03);
  const Complex l = (0.693 + 0.728 * (1.0 - 1.0 / z) / 0.03) * response.at(margins.phase_at, 0, 0);
  CHECK(std::abs(1.0 + l * std::polar(1.0, -margins.phase)) < 1e-9);
}

TEST_CASE("the spin of a ball on a turning plane does not count as a margin") {
  const Scenario scene = read_scenario(BBSIM_SOURCE_DIR "/configs/hold.yaml");
  const Margins home = loop_of(scene).margins[0].margins;
  model::LinearPoint at;
  at.state = {0.05, -0.04, -0.1, 0.05, 0.1, 0.02, -0.01, 0.03, 0.02};
  for (const bool sampled : {false, true}) {
    Scenario moving = scene;
    if (sampled) moving.controller->sampling = Sampling{0.01};
    const Linearization made =
        model::linearize(moving, model::assemble(moving, false), LinearKind::loop, at);
    REQUIRE(made.system.states[4].name == (sampled ? "phi" : "r*spin"));
    for (const model::LoopMargins& one : made.margins) {
      CAPTURE(sampled, one.command);
      CHECK(one.margins.reduction == 0);
    }
    // So slow a turn changes little else for a ball that spins at 10 rad/s.
    if (!sampled) CHECK(made.margins[0].margins.gain == Approx(home.gain).epsilon(0.03));
  }
}

TEST_CASE("rounding of a loss that stops the ball makes no pole unstable") {
  for (const double viscous : {1e3, 1e6, 1e9}) {
    Scenario scene = read_scenario(BBSIM_SOURCE_DIR "/configs/hold.yaml");
    scene.ball.losses.viscous = viscous;
    CAPTURE(viscous);
    const Eigenvalues poles = model::closed_loop_poles(model::assemble(scene, false));
    CHECK(model::stable(poles));
    // x' = g m r^2 / viscous phi, but for 1e-8 with the least loss; quads leave 1e-20 1/s of 2e14.
    const double slow = -0.7 * scene.gravity * scene.ball.mass * 1e-4 / viscous;
    for (const std::size_t i : {0U, 1U}) CHECK(poles[i].real() == Approx(slow).epsilon(1e-5));
    const auto margins = loop_of(scene).margins;
    // An integrator: 90 degrees at its own rate.
    CHECK(margins[1].margins.phase == Approx(std::numbers::pi / 2).epsilon(1e-6));
    CHECK(margins[1].margins.phase_at == Approx(-slow).epsilon(1e-6));
    CHECK(margins[1].margins.reduction == 0);

    Scenario sampled = read_scenario(BBSIM_SOURCE_DIR "/configs/step.yaml");
    sampled.ball.losses.viscous = viscous;
    CHECK(model::growing(model::sampled_poles(model::assemble(sampled, false)), true) == 0);
  }
}

TEST_CASE("a narrow resonance between two frequencies is seen") {
  // 0.1 / (s^2 + 0.02 s + 1), above 1 from 0.95 to 1.05 rad/s only.
  const model::FrequencyResponse open_loop(MatrixXd{{0, 1}, {-1, -0.02}}, MatrixXd{{0}, {1}},
                                           MatrixXd{{0.1, 0}}, MatrixXd{{0}}, 0);
  const auto phase = [&](const std::vector<double>& frequencies) {
    return model::margins_of(open_loop, frequencies, 1e-3, {false, true}).phase;
  };
  const double expected = phase({0.1, 0.5, 0.9, 1, 1.1, 2});
  CHECK(expected == Approx(std::asin(0.02 * std::sqrt(1.0998) / 0.1)).epsilon(1e-3));
  for (const double near : {0.8, 0.9, 0.94, 1.06, 1.1}) {
    CHECK(phase({0.1, 0.5, near, 1.5, 3}) == Approx(expected));
  }
}

TEST_CASE("eigenvalues in quads are accurate beside others 1e25 times as large") {
  MatrixXd a(4, 4);
  // Two blocks with (-1e12, -1e-13) and (2 +- 3i); the first acts on the second.
  a << -1e12, 1e-3, 0, 0, 0, -1e-13, 0, 0, 1e6, 1, 2, 9, -1e5, 3, -1, 2;
  auto values = model::exact_eigenvalues(a);
  std::ranges::sort(values, {}, [](const Complex& one) { return std::abs(one); });
  REQUIRE(values.size() == 4);
  CHECK(values[0].real() == Approx(-1e-13).epsilon(1e-14));
  CHECK(values[1].real() == Approx(2).epsilon(1e-14));
  CHECK(std::abs(values[1].imag()) == Approx(3).epsilon(1e-14));
  CHECK(values[1] == std::conj(values[2]));
  CHECK(values[3].real() == Approx(-1e12).epsilon(1e-14));
  CHECK(model::exact_eigenvalues(MatrixXd(0, 0)).empty());
  CHECK(model::exact_eigenvalues(MatrixXd::Zero(2, 2)) == Eigenvalues(2));
  a(0, 0) = std::nan("");
  CHECK(model::exact_eigenvalues(a).empty());
}

TEST_CASE("eigenvalues near the end of the range of doubles are right, and beyond it refused") {
  const MatrixXd a = MatrixXd{{0, 1}, {-0.5, -1.5}}, wide = MatrixXd{{1, 1}, {1, 1}};
  for (const double size : {1e-300, 1.0, 1e200, 1.15e308}) {
    CAPTURE(size);
    const Eigenvalues found = model::sorted_eigenvalues(size * a);
    REQUIRE(found.size() == 2);
    CHECK(found[0].real() / size == Approx(-0.5));
    CHECK(found[1].real() / size == Approx(-1));
    CHECK(model::exact_eigenvalues(size * a).size() == 2);
  }
  CHECK(model::sorted_eigenvalues(1.7e308 * wide).empty());
  CHECK(model::exact_eigenvalues(1.7e308 * wide).empty());
}

TEST_CASE("zeros are those of the plant with servos of any speed, and of the law") {
  for (const char* name : {"fig2b", "hold", "lissajous", "waypoints"}) {
    Scenario scene = read_scenario(std::string(BBSIM_SOURCE_DIR "/configs/") + name + ".yaml");
    const Controller& controller = *scene.controller;
    const double r = scene.ball.radius, beyond = std::sqrt(5 * scene.gravity / 7 / r);
    for (const double speed : {10.0, 1e3, 1e4, 1e5, 1e6, 1e7}) {
      scene.gimbal.servo = Servo{speed, 0.9};
      CAPTURE(name, speed);
      // An entry of A sums 5/7 g and r speed^2, which costs these digits.
      const double conditioning = 1e-15 * (1 + r * speed * speed / (5 * scene.gravity / 7));
      const auto plant = model::linearize(scene, model::assemble(scene, false), LinearKind::plant,
                                          model::home_point());
      const Eigenvalues of_plant{beyond, beyond, -beyond, -beyond};
      CHECK(distance(plant.zeros, of_plant, 0) < 1e-13 + 10 * conditioning);
      Eigenvalues of_loop = of_plant;
      for (const std::size_t i : {0U, 1U}) {
        of_loop.emplace_back(-controller.kp[i][i] / controller.kv[i][i]);
      }
      CHECK(distance(loop_of(scene).zeros, of_loop, 0) < 1e-12 + 1e3 * conditioning);
    }
  }
  // 5/7 g vanishes beside this: any answer, as long as there is one.
  for (const double speed : {1e9, 1e15, 1e60}) {
    Scenario scene = read_scenario(BBSIM_SOURCE_DIR "/configs/hold.yaml");
    scene.gimbal.servo = Servo{speed, 0.9};
    CHECK_NOTHROW(loop_of(scene));
  }
  Scenario steep = read_scenario(BBSIM_SOURCE_DIR "/configs/hold.yaml");
  steep.controller->kv = {{{1e6, 0}, {0, -100}}};
  CHECK(loop_of(steep).zeros.size() == 6);
}

TEST_CASE("zeros do not depend on the units of states, inputs, outputs and time") {
  // Two outputs with the zeros 2, -3e-4 and -5e3, and -7, of s^3 + ... and s^2 + ...; the second
  // input also acts on the first output.
  const double zeros[3] = {2, -3e-4, -5e3};
  const double sum = zeros[0] + zeros[1] + zeros[2],
               pairs = zeros[0] * zeros[1] + zeros[1] * zeros[2] + zeros[2] * zeros[0],
               product = zeros[0] * zeros[1] * zeros[2];
  MatrixXd a = MatrixXd::Zero(6, 6), b = MatrixXd::Zero(6, 2), c = MatrixXd::Zero(2, 6);
  for (const int i : {0, 1, 2, 4}) a(i, i + 1) = 1;
  a.row(3).head(4) << -24, -50, -35, -10;
  a.row(5).tail(2) << -2, -3;
  b(3, 0) = b(5, 1) = 1;
  b(3, 1) = 0.7;
  c.row(0).head(4) << -product, pairs, -sum, 1;
  c.row(1).tail(2) << 7, 1;
  const MatrixXd d = MatrixXd::Zero(2, 2);
  const Eigenvalues expected{2, -3e-4, -5e3, -7};
  CHECK(distance(model::transmission_zeros(a, b, c, d), expected, 0) < 1e-11);
  std::mt19937 random(5);
  const auto unit = [&random](double decades) {
    return std::pow(10.0, std::uniform_real_distribution<double>(-decades, decades)(random));
  };
  for (int i = 0; i < 50; ++i) {
    MatrixXd scaled_a = a, scaled_b = b, scaled_c = c;
    const double time = unit(9);
    for (int k = 0; k < 6; ++k) {
      const double scale = unit(12);
      scaled_a.row(k) *= scale;
      scaled_a.col(k) /= scale;
      scaled_b.row(k) *= scale;
      scaled_c.col(k) /= scale;
    }
    scaled_a *= time;
    scaled_b *= unit(20);
    scaled_b.col(0) *= unit(20);
    scaled_c.row(1) *= unit(20);
    Eigenvalues all = model::transmission_zeros(scaled_a, scaled_b, scaled_c, d);
    for (Complex& one : all) one /= time;
    // Sums of entries, the largest 1e4 times the smallest.
    CHECK(distance(all, expected, 0) < 1e-11);
  }
  // No states, no inputs, no outputs.
  CHECK(model::transmission_zeros(MatrixXd(0, 0), MatrixXd(0, 1), MatrixXd(1, 0),
                                  MatrixXd::Ones(1, 1))
            .empty());
  CHECK(model::transmission_zeros(a, MatrixXd(6, 0), MatrixXd(0, 6), MatrixXd(0, 0)).size() == 6);
  CHECK_NOTHROW(model::transmission_zeros(a, b, MatrixXd::Zero(2, 6), d));
  CHECK_NOTHROW(model::transmission_zeros(a, MatrixXd::Zero(6, 2), c, d));
}

TEST_CASE("a plant under a held command keeps slow modes beside modes 1e13 times as fast") {
  model::LinearPlant plant{MatrixXd::Zero(3, 3), MatrixXd::Zero(3, 2)};
  plant.a(0, 0) = -1e13;
  plant.a(0, 1) = 1e13;
  plant.a(1, 1) = -3;
  plant.a(1, 2) = 1;
  plant.b(2, 0) = 1;
  const model::LinearPlant later = model::zero_order_hold(plant, 0.02);
  CHECK(later.a(1, 1) == Approx(std::exp(-0.06)).epsilon(1e-14));
  CHECK(later.a(1, 2) == Approx(-std::expm1(-0.06) / 3).epsilon(1e-13));
  CHECK(later.a(0, 2) == Approx(later.a(1, 2)).epsilon(1e-11));
  CHECK(later.b(2, 0) == Approx(0.02).epsilon(1e-14));
  CHECK(later.a(2, 2) == 1);
}

namespace {

// A typical handwritten PID for one axis.
struct OwnPid {
  double kp, ki, kd, filter, period;
  double last = 0, velocity = 0, sum = 0;

  double command(double position) {
    const double keep = filter / (filter + period);
    velocity = keep * velocity + (1 - keep) * (position - last) / period;
    last = position;
    sum += position * period;
    return -(kp * position + ki * sum + kd * velocity);
  }
};

model::PulseResponse answers(const std::array<OwnPid, 2>& controllers, double pulse) {
  model::PulseResponse response(model::pulse_samples, MatrixXd::Zero(2, 2));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    OwnPid one = controllers[axis];
    const auto at = static_cast<Eigen::Index>(axis);
    for (std::size_t i = 0; i < response.size(); ++i) {
      response[i](at, at) = one.command(i == 0 ? pulse : 0) / pulse;
    }
  }
  return response;
}

}  // namespace

TEST_CASE("an external controller's margins from its pulses equal those of the built-in law") {
  for (const double ki : {0.0, 0.05}) {
    for (const double filter : {0.0, 0.03}) {
      Scenario scene = fig2b();
      scene.gimbal.servo = Servo{30, 0.8};
      Controller& controller = *scene.controller;
      controller.reference = PointReference{};
      controller.drives = Drives::angle;
      controller.law = ki > 0 ? Law::pid : Law::pd;
      controller.kp = {{{0.7, 0}, {0, -0.7}}};
      controller.kv = {{{0.6, 0}, {0, -0.6}}};
      controller.ki = {{{ki, 0}, {0, -ki}}};
      controller.sampling = Sampling{0.02};
      controller.sampling->delay = 0.005;
      controller.sampling->derivative_filter = filter;
      const Linearization exact = loop_of(scene);
      const Linearization plant = model::linearize(scene, model::assemble(scene, false),
                                                   LinearKind::sampled, model::home_point());
      const OwnPid phi{0.7, ki, 0.6, filter, 0.02}, theta{-0.7, -ki, -0.6, filter, 0.02};
      const auto law = model::law_of(answers({phi, theta}, 1e-3), 0);
      REQUIRE(law);
      CAPTURE(ki, filter, law->a.rows());
      const Linearization own = model::loop_with(plant, *law, {0, 1});
      CHECK(own.stable == exact.stable);
      REQUIRE(own.margins.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        const Margins &of = own.margins[i].margins, &is = exact.margins[i].margins;
        CHECK(own.margins[i].command == exact.margins[i].command);
        CHECK(of.gain == Approx(is.gain).epsilon(1e-3));
        CHECK(of.reduction == Approx(is.reduction).epsilon(1e-3).margin(1e-6));
        CHECK(of.phase == Approx(is.phase).epsilon(1e-3));
        CHECK(of.delay == Approx(is.delay).epsilon(1e-3));
      }
      // With the rounding noise of single precision.
      model::PulseResponse noisy = answers({phi, theta}, 1e-3);
      for (MatrixXd& one : noisy) {
        one =
            one.unaryExpr([](double value) { return value * (1 + 1e-7 * std::sin(1e3 * value)); });
      }
      const auto near = model::law_of(noisy, 1e-5);
      REQUIRE(near);
      const Margins of = model::loop_with(plant, *near, {0, 1}).margins[0].margins;
      CHECK(of.phase == Approx(exact.margins[0].margins.phase).epsilon(0.02));
      CHECK(of.gain == Approx(exact.margins[0].margins.gain).epsilon(0.02));
    }
  }
}

}  // namespace bbsim_test::test_margins
