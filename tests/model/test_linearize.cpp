// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenes as linear systems: against differences in quad precision, closed forms and independently
// computed poles of the loop.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "base/error.hpp"
#include "base/quad.hpp"
#include "catch.hpp"
#include "model/assemble.hpp"
#include "model/control/linearize.hpp"
#include "model/control/transmission_zeros.hpp"
#include "model/systems/jacobian.hpp"
#include "support/reading.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_linearize {

using namespace bbsim;
using Eigen::MatrixXd;
using model::Linearization;
using model::LinearKind;
using Complex = std::complex<double>;

namespace {

// A position servo and a PD law about the origin, on the paper's gimbal.
Scenario pd_scene() {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.gimbal.servo = Servo{30, 0.8};
  scene.controller->kp = {{{0.4, 0}, {0, -0.4}}};
  scene.controller->kv = {{{0.35, 0}, {0, -0.35}}};
  scene.controller->reference = PointReference{};
  return scene;
}

Scenario sampled_scene() {
  Scenario scene = pd_scene();
  scene.controller->sampling = Sampling{0.02, 0.013, 0, 0.03};
  scene.controller->sensor = Sensor{};
  scene.controller->sensor->delay = 0.055;
  return scene;
}

// A scene without any symmetry.
Scenario crooked_scene() {
  Scenario scene = pd_scene();
  scene.ball.inertia_factor = 0.6;
  scene.gimbal.mounting = {0.03, 0.01, -0.02, 0.04, 0.1, 0.02};
  scene.controller->kp[0][1] = 0.05;
  return scene;
}

Linearization linear(const Scenario& scene, LinearKind kind,
                     const model::LinearPoint& at = model::home_point()) {
  return model::linearize(scene, model::assemble(scene, false), kind, at);
}

// Largest distance from a value to the nearest of the others, relative to 1 + its magnitude.
double distance(const model::Eigenvalues& values, model::Eigenvalues others) {
  REQUIRE(values.size() == others.size());
  double worst = 0;
  for (const Complex& value : values) {
    const auto nearest = std::min_element(
        others.begin(), others.end(),
        [&](const auto& p, const auto& q) { return std::abs(p - value) < std::abs(q - value); });
    worst = std::max(worst, std::abs(*nearest - value) / (1 + std::abs(value)));
    others.erase(nearest);
  }
  return worst;
}

model::LinearPoint somewhere() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-0.5, 0.5);
  model::LinearPoint at;
  for (double& one : at.state) one = number(random);
  for (double& one : at.command) one = number(random);
  for (auto& one : at.reference) one = {number(random), number(random), number(random)};
  return at;
}

}  // namespace

TEST_CASE("poles of a linear loop equal those that check prints") {
  Scenario scene = pd_scene();
  SECTION("PD") {}
  SECTION("PD of accelerations, unstable") {
    scene = fig2b_literal();
  }
  SECTION("planar") {
    scene.ball.position = {0.05, 0};
    scene.controller->kp[1] = scene.controller->kv[1] = {0, 0};
  }
  SECTION("PID") {
    scene.controller->law = Law::pid;
    scene.controller->ki = {{{0.1, 0}, {0, 0}}};
  }
  SECTION("LQR") {
    scene.controller->law = Law::lqr;
    scene.controller->weights = {100, 1, 0, 0, 1};
  }
  SECTION("crooked") {
    scene = crooked_scene();
  }
  SECTION("gravity compensation, whose reference is not home") {
    scene.controller->law = Law::gravity_compensation;
    scene.controller->kp = {{{4, 0}, {0, 4}}};
    scene.controller->kv = {{{3, 0}, {0, 3}}};
    scene.controller->reference = CircleReference{0.1, 2, 0, {0, 0}};
  }
  const model::Model model = model::assemble(scene, false);
  const Linearization made = linear(scene, LinearKind::loop);
  // Rounding in eigenvalues of a nonsymmetric matrix that was computed in two ways.
  CHECK(distance(made.poles, model::closed_loop_poles(model)) < 1e-10);
  CHECK_FALSE(made.system.period);
}

TEST_CASE("poles of a sampled loop equal those that check prints") {
  Scenario scene = sampled_scene();
  SECTION("PD") {}
  SECTION("PID with a servo of first order, no delay") {
    scene.controller->law = Law::pid;
    scene.controller->ki = {{{0.1, 0}, {0, -0.1}}};
    scene.controller->sampling->delay = 0;
    scene.controller->sensor->delay = 0;
    scene.gimbal.servo = Servo{};
    scene.gimbal.servo->time_constant = 0.05;
  }
  const model::Model model = model::assemble(scene, false);
  const Linearization made = linear(scene, LinearKind::loop);
  CHECK(made.system.period == 0.02);
  // The delays' poles at zero are defective: rounding moves n of them by its n-th root.
  const auto large = [](model::Eigenvalues poles) {
    std::erase_if(poles, [](const Complex& pole) { return std::abs(pole) < 0.05; });
    return poles;
  };
  const auto poles = model::sampled_poles(model);
  CHECK(made.poles.size() == poles.size());
  CHECK(distance(large(made.poles), large(poles)) < 1e-9);
}

namespace {

model::Eigenvalues large_ones(model::Eigenvalues poles) {
  std::erase_if(poles, [](const Complex& pole) { return std::abs(pole) < 0.05; });
  return poles;
}

}  // namespace

TEST_CASE("at home a linkage that the controller knows, or its ratio, has no effect") {
  const bool sampled = GENERATE(false, true), feeds_back = GENERATE(false, true);
  const Assumes assumes = GENERATE(Assumes::exact, Assumes::ratio);
  Scenario ideal = sampled ? sampled_scene() : pd_scene();
  if (sampled) ideal.controller->sensor->delay = 0.005;
  if (feeds_back) {
    ideal.controller->law = Law::lqr;
    ideal.controller->weights = {100, 1, 1, 0.1, 1};
  }
  Scenario linked = ideal, three = ideal;
  linked.controller->assumes = three.controller->assumes = assumes;
  linked.gimbal.linkage = {RodLinkage{0.025, 0.08, {}, {0.06, 0.09}},
                           RodLinkage{0.03, 0.06, 0.08, {0.02, 0.06}}};
  three.gimbal.three_servos = ThreeServoPlate{0.06, 0.09, 0.04, 0.1, 0.11};
  const auto poles_of = [&](const Scenario& scene) {
    const model::Model model = model::assemble(scene, false);
    return large_ones(sampled ? model::sampled_poles(model) : model::closed_loop_poles(model));
  };
  const auto expected = poles_of(ideal);
  // theta's home is not its curve's zero; the ratio is that at home, good to 1e-9.
  CHECK(distance(poles_of(linked), expected) < 1e-7);
  CHECK(distance(large_ones(linear(linked, LinearKind::loop).poles), expected) < 1e-7);
  CHECK(distance(large_ones(linear(three, LinearKind::loop).poles), expected) < 1e-7);
  // Three servos have heave as an extra motion, with the servo's poles once more.
  auto of_three = poles_of(three);
  if (!sampled) CHECK(of_three.size() == expected.size() + 2);
}

TEST_CASE("with a linkage A is the derivative of the system, also at rest away from home") {
  Scenario scene = pd_scene();
  scene.gimbal.linkage = {RodLinkage{0.025, 0.08, {}, {0.06, 0.09}},
                          RodLinkage{0.03, 0.06, 0.08, {0.02, 0.06}}};
  scene.gimbal.mounting.phi_offset = 0.04;
  scene.controller->assumes = GENERATE(Assumes::exact, Assumes::ratio);
  const model::LinearPoint at = model::equilibrium(scene);
  const model::Model model = model::assemble(scene, false);
  const auto& system =
      std::get<model::CoupledLoop<model::SignalPair, model::Linkages>>(model.system);
  double z[model::CoupledLoopLayout::states] = {};
  std::copy(at.state.begin(), at.state.end(), z);
  double rates[model::CoupledLoopLayout::states];
  system.derivative(0.0, z, rates);
  for (int i = 0; i < 9; ++i) CHECK(std::abs(rates[i]) < 1e-10);  // it is at rest
  constexpr int size = model::CoupledLoopLayout::states;
  Eigen::Matrix<double, size, size> full;
  model::jacobian(model.system, 0.0, z, full.data());
  const std::vector<int> states{0, 1, 2, 3, 5, 6, 7, 8};
  const Linearization made = linear(scene, LinearKind::loop, at);
  REQUIRE(made.system.a.rows() == 8);
  CHECK((made.system.a - full(states, states)).cwiseAbs().maxCoeff() <
        1e-9 * full.cwiseAbs().maxCoeff());
}

TEST_CASE("a rotated sensor affects the poles and the ball's resting place") {
  Scenario scene = sampled_scene();
  scene.controller->sensor->delay = 0.005;
  const auto straight = model::sampled_poles(model::assemble(scene, false));
  scene.controller->sensor->rotation = 0.4;
  scene.controller->sensor->offset = {0.003, 0};
  const model::Model model = model::assemble(scene, false);
  const auto turned = model::sampled_poles(model);
  CHECK(std::abs(turned.front()) > std::abs(straight.front()) + 1e-3);
  CHECK(distance(large_ones(linear(scene, LinearKind::loop).poles), large_ones(turned)) < 1e-9);
  const model::LinearPoint at = model::equilibrium(scene);
  // R(0.4) p + offset = reference, which is the origin.
  CHECK(at.state[0] == Approx(-0.003 * std::cos(0.4)).epsilon(1e-9));
  CHECK(at.state[1] == Approx(0.003 * std::sin(0.4)).epsilon(1e-9));
}

TEST_CASE("A and B of a plant agree with differences in quad precision") {
  const Scenario scene = crooked_scene();
  const model::LinearPoint at = somewhere();
  const Linearization made = linear(scene, LinearKind::plant, at);
  const auto built = model::assemble_rig<false>(scene, {});
  model::RigLoop<> held(built.loop.radius(), built.loop.gravity(), built.loop.rolling(), {},
                        built.loop.servo(), {}, built.loop.mode);
  constexpr int n = model::RigLoop<>::size;
  REQUIRE(made.system.a.rows() == n);  // with the spin, which matters if the plane turns
  const auto rates = [&](int state, double step, int command, double push) {
    Quad z[n], dz[n];
    for (int i = 0; i < n; ++i) z[i] = Quad(at.state[static_cast<std::size_t>(i)]);
    if (state >= 0) z[state] += step;
    for (int i = 0; i < 2; ++i) held.mode.command[i] = at.command[static_cast<std::size_t>(i)];
    if (command >= 0) held.mode.command[command] += push;
    held.derivative_of(std::array<model::Jet<Quad>, 2>{}, z, dz);
    return std::vector<Quad>(dz, dz + n);
  };
  // Central differences omit the squared step times the third derivative, some 1e3.
  const double step = std::ldexp(1.0, -40);
  for (int j = 0; j < n; ++j) {
    const auto more = rates(j, step, -1, 0), less = rates(j, -step, -1, 0);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double difference = plain((more[k] - less[k]) / Quad(2 * step));
      CAPTURE(i, j);
      CHECK(std::abs(made.system.a(i, j) - difference) <= 1e-12 * (1 + std::abs(difference)));
    }
  }
  // The command enters linearly; the step is large enough to be added to the doubles exactly.
  for (int j = 0; j < 2; ++j) {
    const auto more = rates(-1, 0, j, 1), less = rates(-1, 0, j, 0);
    const double push =
        (at.command[static_cast<std::size_t>(j)] + 1) - at.command[static_cast<std::size_t>(j)];
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double difference = plain((more[k] - less[k]) / Quad(push));
      CAPTURE(i, j);
      CHECK(std::abs(made.system.b(i, j) - difference) <= 1e-12 * (1 + std::abs(difference)));
    }
  }
}

TEST_CASE("A and B of a loop are its differences in quad precision") {
  Scenario scene = crooked_scene();
  const bool compensates = GENERATE(false, true);
  if (compensates) {
    scene.controller->law = Law::gravity_compensation;
    scene.controller->kp = {{{0.4, 0}, {0, 0.4}}};
    scene.controller->kv = {{{0.3, 0}, {0, 0.3}}};
  }
  const model::LinearPoint at = somewhere();
  const Linearization made = linear(scene, LinearKind::loop, at);
  const auto loop = model::assemble_rig<false>(scene, {}).loop;
  constexpr int n = model::RigLoop<>::size;
  REQUIRE(made.system.a.rows() == n);
  CHECK(made.system.inputs.size() == (compensates ? 6 : 4));
  const auto rates = [&](int place, double step) {
    Quad z[n], dz[n];
    for (int i = 0; i < n; ++i) z[i] = Quad(at.state[static_cast<std::size_t>(i)]);
    std::array<model::Jet<Quad>, 2> reference;
    for (std::size_t i = 0; i < 2; ++i) {
      reference[i] = {Quad(at.reference[i].value), Quad(at.reference[i].rate),
                      Quad(at.reference[i].acceleration)};
    }
    if (place < n) {
      z[place] += step;
    } else {
      auto& jet = reference[static_cast<std::size_t>((place - n) % 2)];
      const int order = (place - n) / 2;
      (order == 0 ? jet.value : order == 1 ? jet.rate : jet.acceleration) += step;
    }
    loop.derivative_of(reference, z, dz);
    return std::vector<Quad>(dz, dz + n);
  };
  const double step = std::ldexp(1.0, -40);
  for (int j = 0; j < n + static_cast<int>(made.system.inputs.size()); ++j) {
    const auto more = rates(j, step), less = rates(j, -step);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double difference = plain((more[k] - less[k]) / Quad(2 * step));
      const double found = j < n ? made.system.a(i, j) : made.system.b(i, j - n);
      CAPTURE(compensates, i, j);
      CHECK(std::abs(found - difference) <= 1e-12 * (1 + std::abs(difference)));
    }
  }
}

TEST_CASE("margins agree with the closed form (M13)") {
  const Scenario scene = pd_scene();
  const Linearization made = linear(scene, LinearKind::loop);
  // s^2 (s^2 + P s + Q) + (Kv s + Kp)(a - r s^2), K = Q k.
  const double r = 0.02, a = 5 * scene.gravity / 7, wn = 30, zeta = 0.8;
  const double p = 2 * zeta * wn, q = wn * wn, kp = q * 0.4, kv = q * 0.35;
  // A factor on both gains gives a3 a2 a1 = a1^2 + a3^2 a0, in which its square cancels.
  const double gain = p * (q * kv - p * kp) / (kv * (kv * (q * r + a) - p * r * kp));
  const double at = std::sqrt(gain * a * kv / (p - gain * r * kv));
  REQUIRE(made.margins.size() == 2);
  for (const model::LoopMargins& loop : made.margins) {
    const model::Margins& margins = loop.margins;
    CAPTURE(loop.command);
    CHECK(margins.gain == Approx(gain).epsilon(1e-11));
    CHECK(margins.gain_at == Approx(at).epsilon(1e-11));
    CHECK(margins.reduction == 0);
    const double w = margins.phase_at, w2 = w * w;
    const double numerator = (kv * kv * w2 + kp * kp) * (a + r * w2) * (a + r * w2);
    const double denominator = w2 * w2 * ((q - w2) * (q - w2) + p * p * w2);
    CHECK(numerator == Approx(denominator).epsilon(1e-11));
    const double phase = std::atan2(kv * w, kp) - std::atan2(p * w, q - w2);  // and pi from 1/s^2
    CHECK(margins.phase == Approx(phase).epsilon(1e-11));
    CHECK(margins.delay == Approx(phase / w).epsilon(1e-11));
  }
  // With the gain at its margin the loop has poles on the imaginary axis.
  Scenario border = scene;
  for (auto* matrix : {&border.controller->kp, &border.controller->kv}) {
    for (auto& row : *matrix) {
      for (double& one : row) one *= made.margins[0].margins.gain;
    }
  }
  CHECK(std::abs(linear(border, LinearKind::loop).poles.front().real()) < 1e-10);

  // |T| = 1 / sqrt 2, T = L / (1 + L).
  REQUIRE(made.bandwidths.size() == 2);
  const Complex s(0, made.bandwidths[0].value);
  const Complex l = (kv * s + kp) * (a - r * s * s) / (s * s * (s * s + p * s + q));
  CHECK(std::abs(l / (1.0 + l)) == Approx(1 / std::numbers::sqrt2).epsilon(1e-11));
}

TEST_CASE("a law that gets accelerations has the bandwidth of its feedback") {
  Scenario scene = pd_scene();
  scene.controller->law = Law::gravity_compensation;
  scene.controller->kp = {{{4, 0}, {0, 4}}};
  scene.controller->kv = {{{3, 0}, {0, 3}}};
  const Linearization made = linear(scene, LinearKind::loop);
  const double r = 0.02, a = 5 * scene.gravity / 7, wn = 30, zeta = 0.8;
  const auto response = [&](double w, double told) {
    const Complex s(0, w);
    const Complex ball = wn * wn / a * (a - r * s * s) / (s * s + 2 * zeta * wn * s + wn * wn);
    return (told * s * s + 3.0 * s + 4.0) * ball / (s * s + (3.0 * s + 4.0) * ball);
  };
  REQUIRE(made.bandwidths.size() == 2);
  for (const model::Bandwidth& one : made.bandwidths) {
    // The plane's accelerations push the ball: at high frequencies by r wn^2 / a.
    CHECK(std::isinf(one.value));
    CHECK(std::abs(response(1e4, 1)) > 1);
    CHECK(std::abs(response(one.of_feedback, 0)) == Approx(1 / std::numbers::sqrt2).epsilon(1e-11));
  }
  const Linearization plain = linear(pd_scene(), LinearKind::loop);
  CHECK(plain.bandwidths[0].of_feedback == plain.bandwidths[0].value);
}

TEST_CASE("zeros of plant and loop agree with equation (27) about home") {
  const Scenario scene = pd_scene();
  const double beyond = std::sqrt(5 * scene.gravity / 7 / 0.02);  // a = r s^2
  const model::Eigenvalues plant = linear(scene, LinearKind::plant).zeros;
  // Double zeros, which rounding may split by its square root.
  CHECK(distance(plant, {beyond, beyond, -beyond, -beyond}) < 1e-7);
  const double law = -0.4 / 0.35;
  const model::Eigenvalues loop = linear(scene, LinearKind::loop).zeros;
  CHECK(distance(loop, {beyond, beyond, -beyond, -beyond, law, law}) < 1e-7);
  // The number of zeros is exact: none for one output without, two with a direct term.
  MatrixXd a(2, 2), b(2, 1), c(1, 2);
  a << 0, 1, -2, -3;
  b << 0, 1;
  c << 5, 1;
  CHECK(distance(model::transmission_zeros(a, b, c, MatrixXd::Zero(1, 1)), {-5}) < 1e-13);
  c << 1, 0;
  CHECK(model::transmission_zeros(a, b, c, MatrixXd::Zero(1, 1)).empty());
  // s^2 + 3 s + 2 + 1 with the same denominator.
  CHECK(distance(model::transmission_zeros(a, b, c, MatrixXd::Ones(1, 1)),
                 {Complex(-1.5, std::sqrt(0.75)), Complex(-1.5, -std::sqrt(0.75))}) < 1e-13);
}

TEST_CASE("margins of a sampled loop agree with its lifted matrix") {
  const Scenario scene = sampled_scene();
  const Linearization made = linear(scene, LinearKind::loop);
  REQUIRE(made.margins.size() == 2);
  const model::Margins& margins = made.margins[0].margins;
  REQUIRE(std::isfinite(margins.gain));
  REQUIRE(margins.gain > 1);
  const auto largest_with = [&](double factor) {
    Scenario changed = scene;
    for (auto* matrix : {&changed.controller->kp, &changed.controller->kv}) {
      for (double& one : (*matrix)[0]) one *= factor;  // only phi's loop
    }
    return std::abs(linear(changed, LinearKind::loop).poles.front());
  };
  CHECK(largest_with(margins.gain) == Approx(1).epsilon(1e-10));
  CHECK(largest_with(0.99 * margins.gain) < 1);

  // The plant under a held command, and the law's polynomial in z.
  const Linearization plant = linear(scene, LinearKind::sampled);
  CHECK(plant.system.outputs[0].name == "x_measured");
  const model::FrequencyResponse response(plant.system.a, plant.system.b, plant.system.c,
                                          plant.system.d, 0.02);
  const Complex z = std::polar(1.0, margins.phase_at * 0.02);
  const double keep = 0.03 / 0.05;
  const Complex law = 0.4 + 0.35 * (1 - keep) / 0.02 * (z - 1.0) / (z - keep);
  const Complex l = law * response.at(margins.phase_at, 0, 0);
  CHECK(std::abs(l) == Approx(1).epsilon(1e-11));
  CHECK(std::arg(-l) == Approx(margins.phase).epsilon(1e-11));
}

TEST_CASE("a plant under a held command is the plant's exponential, delayed") {
  const Scenario scene = sampled_scene();
  const Linearization plant = linear(scene, LinearKind::plant);
  const Linearization sampled = linear(scene, LinearKind::sampled);
  // At low frequency they differ only by the delays and half a hold period.
  const double w = 0.05;
  const model::FrequencyResponse slow(plant.system.a, plant.system.b, plant.system.c,
                                      plant.system.d, 0);
  const model::FrequencyResponse held(sampled.system.a, sampled.system.b, sampled.system.c,
                                      sampled.system.d, 0.02);
  const Complex ratio = held.at(w, 0, 0) / slow.at(w, 0, 0);
  // The next term of the hold's series is (w T)^2 / 24.
  CHECK(std::abs(ratio) == Approx(1).epsilon(1e-6));
  CHECK(std::arg(ratio) == Approx(-w * (0.013 + 0.055 + 0.01)).epsilon(1e-6));
  // Poles: the plant's over a period, and those of the delays at zero.
  for (const Complex& pole : plant.poles) {
    const Complex expected = std::exp(pole * 0.02);
    const double nearest =
        std::abs(*std::min_element(sampled.poles.begin(), sampled.poles.end(),
                                   [&](const auto& a, const auto& b) {
                                     return std::abs(a - expected) < std::abs(b - expected);
                                   }) -
                 expected);
    CHECK(nearest < 1e-6);  // the plant's four poles at zero are two double ones
  }
}

TEST_CASE("at an equilibrium everything rests") {
  Scenario scene = crooked_scene();
  scene.controller->reference = PointReference{{0.04, -0.03}};
  const auto law = GENERATE(Law::pd, Law::pid, Law::gravity_compensation);
  scene.controller->law = law;
  if (law == Law::pid) scene.controller->ki = {{{0.1, 0}, {0, -0.1}}};
  if (law == Law::gravity_compensation) {
    scene.controller->kp = {{{4, 0}, {0, 4}}};
    scene.controller->kv = {{{3, 0}, {0, 3}}};
  }
  const model::LinearPoint at = model::equilibrium(scene);
  const model::Model model = model::assemble(scene, false);
  std::visit(
      [&](const auto& system) {
        std::vector<double> rates(static_cast<std::size_t>(system.size));
        system.derivative(0.0, at.state.data(), rates.data());
        // Newton's last step leaves rounding errors, which the servo multiplies by 900 1/s^2.
        for (const double one : rates) CHECK(std::abs(one) < 1e-12);
      },
      model.system);
  if (law == Law::pid) {
    CHECK(at.state[0] == Approx(0.04).epsilon(1e-14));
  } else {
    CHECK(std::abs(at.state[0] - 0.04) > 1e-3);  // the sensor offsets move the ball away
  }
  CHECK(linear(scene, LinearKind::loop, at).poles.size() ==
        linear(scene, LinearKind::loop).poles.size());
}

TEST_CASE("a scene is refused if it lacks what a linear model needs") {
  Scenario scene = fig2a();
  CHECK_THROWS_AS(linear(scene, LinearKind::loop), InputError);
  CHECK_THROWS_AS(linear(scene, LinearKind::sampled), InputError);
  const Linearization plant = linear(scene, LinearKind::plant);
  CHECK(plant.system.inputs[0].name == "phi_acceleration");
  CHECK(plant.system.states.size() == 8);
  CHECK_THROWS_AS(linear(pd_scene(), LinearKind::sampled), InputError);
  Scenario first_order = sampled_scene();
  first_order.gimbal.servo = Servo{};
  first_order.gimbal.servo->time_constant = 0.05;
  CHECK_THROWS_AS(linear(first_order, LinearKind::plant), InputError);
  // No angles level a plane whose base stands upright.
  Scenario upright = crooked_scene();
  upright.gimbal.mounting.base_tilt = std::numbers::pi / 2;
  upright.gimbal.mounting.skew = 0;
  upright.gravity = 0;
  CHECK_NOTHROW(model::equilibrium(upright));
}

namespace {

// A gimbal driven by motors, and a ball with viscous losses.
const std::string body =
    "gravity: 9.81\n"
    "ball: {radius: 0.02, mass: 0.05, position: [0.06, -0.04], losses: {viscous: 4e-6}}\n"
    "plate: {inertia: [4e-3, 6e-3, 1e-2], mass: 0.5, centre_of_mass: -0.01}\n"
    "time: {end: 2, step: 0.1}\n";
const std::string motor =
    "gimbal: {ring_inertia: 2e-3, motor: {rotor_inertia: 1e-3, viscous: 0.02}}\n";

std::string torque_lqr(const std::string& beside = "") {
  return body + motor +
         "controller: {lqr: {position: 400, velocity: 20, angle: 1, rate: 0.1, command: 20}, "
         "drives: torque, reference: {point: [0.01, 0.02]}" +
         beside + "}\n";
}

// Three servos under a law without samples.
std::string three_legs(const std::string& beside = "") {
  return "gravity: 9.81\n"
         "ball: {radius: 0.02, mass: 0.0027, inertia_factor: 0.667, position: [0.05, 0.02]}\n"
         "time: {end: 2, step: 0.1}\n"
         "gimbal: {servo: {natural_frequency: 40, damping: 0.9}, three_servos: {radius_base: 0.06, "
         "radius_plate: 0.09, horn: 0.04, rod: 0.1, height: 0.11}}\n"
         "controller: {gravity_compensation: {kp: 6, kv: 5}, drives: angle, reference: {point: "
         "[0, 0]}" +
         beside + "}\n";
}

// Random states of the scene's own system, near home.
template <class Loop>
model::LinearPoint somewhere_of(int seed, double size) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> number(-size, size);
  model::LinearPoint at;
  at.state.assign(Loop::size, 0);
  for (int i = 0; i < Loop::Layout::integral; ++i) {
    at.state[static_cast<std::size_t>(i)] = number(random);
  }
  for (double& one : at.command) one = number(random);
  return at;
}

// Compares A of a loop with the system's derivative, for the states that share a name.
template <class Loop>
void check_loop(const Scenario& scene, model::LinearPoint at, const std::vector<int>& states) {
  const model::Model model = model::assemble(scene, false);
  const auto& loop = std::get<Loop>(model.system);
  at.reference = loop.reference().at(0.0);
  Eigen::Matrix<double, Loop::size, Loop::size> full;
  model::jacobian(model.system, 0.0, at.state.data(), full.data());
  const Linearization made = model::linearize(scene, model, LinearKind::loop, at);
  REQUIRE(made.system.a.rows() == std::ssize(states));
  CHECK((made.system.a - full(states, states)).cwiseAbs().maxCoeff() <
        1e-13 * full.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("three servos off home follow their closed chain") {
  using Loop = model::CoupledLoop<model::SignalPair, model::ThreeServos>;
  const Scenario scene = test::parse(three_legs());
  const model::LinearPoint at = somewhere_of<Loop>(3, 0.2);
  check_loop<Loop>(scene, at, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  const Linearization away = linear(scene, LinearKind::loop, at);
  CHECK(away.system.states[5].name == "servo_phi");
  CHECK(away.system.states[10].name == "servo_third_rate");
  // If the plate is level and everything rests, the servos' six states have the poles of two ideal
  // servos and of the height, which affects nothing.
  model::LinearPoint rest = model::equilibrium(scene);
  for (const double one : rest.state) CHECK(std::abs(one) < 1e-12);
  model::Eigenvalues expected = linear(scene, LinearKind::loop).poles;
  for (const int sign : {1, -1}) {
    expected.emplace_back(-0.9 * 40, sign * 40 * std::sqrt(1 - 0.9 * 0.9));
  }
  CHECK(distance(linear(scene, LinearKind::loop, rest).poles, expected) < 1e-6);
  // Off home at least the slowest pole changes.
  rest.state[6] = 0.3;
  const auto tilted = linear(scene, LinearKind::loop, rest).poles;
  CHECK(std::abs(tilted.front() - linear(scene, LinearKind::loop).poles.front()) > 1e-3);
}

TEST_CASE("three sampled servos at rest have the poles of two") {
  const Scenario scene =
      test::parse(three_legs(", sampling: {period: 0.02, delay: 0.005}, sensor: {delay: 0.01}"));
  const auto poles = linear(scene, LinearKind::loop, model::equilibrium(scene)).poles;
  // Two more states than at home: those of the plate's height.
  CHECK(poles.size() == linear(scene, LinearKind::loop).poles.size() + 2);
  CHECK(std::abs(poles.front() - linear(scene, LinearKind::loop).poles.front()) < 1e-9);
  // Impulses of first-order servos kick the ball in the same way.
  Scenario kicks = scene;
  kicks.gimbal.servo = Servo{};
  kicks.gimbal.servo->time_constant = 0.04;
  const auto kicked = linear(kicks, LinearKind::loop, model::equilibrium(kicks)).poles;
  CHECK(std::abs(kicked.front() - linear(kicks, LinearKind::loop).poles.front()) < 1e-9);
}

TEST_CASE("a gimbal under torques is linear with the ball's losses and the plate's weight") {
  using Loop = model::CoupledLoop<>;
  const Scenario scene = test::parse(torque_lqr());
  check_loop<Loop>(scene, somewhere_of<Loop>(5, 0.4), {0, 1, 2, 3, 4, 5, 6, 7, 8});
  const model::Model model = model::assemble(scene, false);
  CHECK(distance(linear(scene, LinearKind::loop).poles, model::closed_loop_poles(model)) < 1e-9);
  const Linearization plant = linear(scene, LinearKind::plant);
  CHECK(distance(plant.poles, model::plant_poles(model)) < 1e-9);
  CHECK(plant.system.inputs[0].name == "phi_command");
  CHECK(plant.system.inputs[0].unit == "N m");
  const Linearization loop = linear(scene, LinearKind::loop);
  REQUIRE(loop.margins.size() == 2);
  // An LQR regulator tolerates half the gain and 60 degrees.
  for (const model::LoopMargins& one : loop.margins) {
    CHECK(one.margins.reduction < 0.5);
    CHECK(std::abs(one.margins.phase) > std::numbers::pi / 3 - 1e-6);
  }
}

TEST_CASE("an open loop that is closed by 1 + L = 0 is the loop") {
  const std::string sampled = ", sampling: {period: 0.02, delay: 0.025}, sensor: {delay: 0.01}";
  for (const Scenario& scene :
       {pd_scene(), test::parse(torque_lqr()), test::parse(three_legs(sampled))}) {
    const Linearization made = linear(scene, LinearKind::loop);
    REQUIRE(made.margins.size() == 2);
    for (const model::LoopMargins& loop : made.margins) {
      const model::LinearSystem& open = loop.open;
      CHECK(open.period == made.system.period);
      CHECK(open.inputs[0].name == loop.command);
      CHECK(static_cast<Eigen::Index>(open.states.size()) == open.a.rows());
      const Eigen::MatrixXd closed = open.a - open.b * open.c;
      CHECK(
          distance(open.period ? model::poles_of_period(closed) : model::sorted_eigenvalues(closed),
                   made.poles) < 1e-6);
    }
  }
}

TEST_CASE("B of torques and of three servos' commands agrees with differences") {
  const auto check = [](const Scenario& scene, auto loop, const model::LinearPoint& at) {
    const Linearization made = linear(scene, LinearKind::plant, at);
    // Under a held command the system is the plant; commanding three servos is the law's part.
    const double step = 1e-5;
    for (int j = 0; j < 2; ++j) {
      std::vector<double> more(at.state.size()), less(at.state.size());
      for (const double side : {step, -step}) {
        double command[2] = {at.command[0], at.command[1]};
        command[j] += side;
        auto& mode = loop.loop.mode;
        if constexpr (decltype(loop)::servos == 3) {
          double commands[3];
          loop.loop.link.commands_for(command, commands);
          std::copy_n(commands, 3, mode.command);
        } else {
          std::copy_n(command, 2, mode.command);
        }
        loop.derivative(0.0, at.state.data(), (side > 0 ? more : less).data());
      }
      for (int i = 0; i < made.system.b.rows(); ++i) {
        const auto k = static_cast<std::size_t>(i);  // all states exist, in order
        const double difference = (more[k] - less[k]) / (2 * step);
        CAPTURE(i, j);
        // The squared step, and rounding of rates up to 1e3 divided by the step.
        CHECK(std::abs(made.system.b(i, j) - difference) < 1e-6 * (1 + std::abs(difference)));
      }
    }
  };
  const auto held = [](const auto& of) {
    using Rig = std::decay_t<decltype(of.loop)>;
    return std::decay_t<decltype(of)>(of.parts, of.by, of.motor,
                                      Rig(of.loop.radius(), of.loop.gravity(), of.loop.rolling(),
                                          {}, of.loop.servo(), {}, of.loop.mode, of.loop.link),
                                      of.push);
  };
  using Motors = model::CoupledLoop<>;
  const Scenario torques = test::parse(torque_lqr());
  check(torques, held(std::get<Motors>(model::assemble(torques, false).system)),
        somewhere_of<Motors>(8, 0.4));
  using Legs = model::CoupledLoop<model::SignalPair, model::ThreeServos>;
  const Scenario legs = test::parse(three_legs());
  check(legs, held(std::get<Legs>(model::assemble(legs, false).system)),
        somewhere_of<Legs>(9, 0.15));
}

TEST_CASE("a motor's integrator and sampled torques are in the poles") {
  const Scenario holds = test::parse(
      body +
      "gimbal: {motor: {rotor_inertia: 1e-3, viscous: 0.02, position_loop: {kp: 4, kd: 0.3, ki: "
      "2}}}\n"
      "controller: {pd: {kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}, drives: angle, "
      "reference: {point: [0, 0]}}\n");
  const Linearization made = linear(holds, LinearKind::loop);
  CHECK(made.system.states.back().name == "theta_integral");
  CHECK(distance(made.poles, model::closed_loop_poles(model::assemble(holds, false))) < 1e-9);
  const Scenario sampled = test::parse(torque_lqr(", sampling: {period: 0.01, delay: 0.003}"));
  CHECK(distance(large_ones(linear(sampled, LinearKind::loop).poles),
                 large_ones(model::sampled_poles(model::assemble(sampled, false)))) < 1e-9);
  CHECK(linear(sampled, LinearKind::sampled).system.inputs[0].unit == "N m");
}

TEST_CASE("a plant with viscous losses has the corresponding pole") {
  Scenario scene = fig2a();
  scene.ball.mass = 0.05;
  scene.ball.losses.viscous = 4e-6;
  const Linearization plant = linear(scene, LinearKind::plant);
  CHECK(plant.system.inputs[0].name == "phi_acceleration");
  REQUIRE(plant.system.a.rows() == 8);
  const double rate = 4e-6 / (1.4 * 0.05 * 0.01 * 0.01);
  for (const int i : {2, 3}) CHECK(plant.system.a(i, i) == Approx(-rate).epsilon(1e-14));
  CHECK(plant.system.a(2, 4) == Approx(5.0 / 7 * scene.gravity).epsilon(1e-14));
}

TEST_CASE("everything rests if a push and the plate's weight are balanced") {
  const std::string text =
      GENERATE(torque_lqr(),
               body +
                   "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
                   "controller: {gravity_compensation: {kp: 6, kv: 5}, drives: angle, "
                   "reference: {point: [0.01, 0]}}\n",
               three_legs());
  Scenario scene = test::parse(text);
  const bool pushed = GENERATE(false, true);
  if (pushed) scene.ball.push = BallPush{{0.004}, {-0.003}};
  CAPTURE(text, pushed);
  const model::LinearPoint at = model::equilibrium(scene);
  const model::Model model = model::assemble(scene, false);
  std::visit(
      [&](const auto& system) {
        std::vector<double> rates(static_cast<std::size_t>(system.size));
        system.derivative(0.0, at.state.data(), rates.data());
        // Newton's last step leaves rounding errors, which servos multiply by 1600 1/s^2.
        for (const double one : rates) CHECK(std::abs(one) < 1e-11);
      },
      model.system);
  if (pushed) CHECK(std::abs(at.state[5]) > 1e-4);
}

TEST_CASE("a tiny loss switches to other equations but moves no pole") {
  // One is differentiated as a rig, the other as a scene with forces.
  const std::string name = GENERATE("pushrod", "hold", "step", "rig");
  const bool rests = GENERATE(false, true);
  const Scenario scene = read_scenario(BBSIM_SOURCE_DIR "/configs/" + name + ".yaml");
  Scenario loses = scene;
  loses.ball.losses.viscous = 1e-13 * scene.ball.mass;
  const auto poles = [&](const Scenario& of) {
    return large_ones(
        linear(of, LinearKind::loop, rests ? model::equilibrium(of) : model::home_point()).poles);
  };
  CAPTURE(name, rests);
  // Double poles, of two equal axes, differ by the square root of rounding.
  CHECK(distance(poles(loses), poles(scene)) < 1e-6);
}

TEST_CASE("dry friction is refused as nonlinear, with the reason") {
  const auto refusal = [](const Scenario& scene) -> std::string {
    try {
      static_cast<void>(linear(scene, LinearKind::plant));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  Scenario scene = fig2a();
  scene.ball.mass = 0.05;
  scene.ball.losses.rolling = 0.01;
  CHECK_THAT(refusal(scene), Catch::Contains("found ball.losses.rolling, which is dry"));
  scene.ball.losses = {};
  scene.ball.losses.pivoting = 1e-4;
  CHECK_THAT(refusal(scene), Catch::Contains("found ball.losses.pivoting, which is dry"));
  scene.ball.losses = {};
  scene.events.slip = SlipEvent{0.3, OnEvent::note, 0.2};
  CHECK_THAT(refusal(scene), Catch::Contains("found events.slip with action: slide"));
  CHECK_THAT(refusal(test::parse(torque_lqr(), {"gimbal.motor.friction=0.01"})),
             Catch::Contains("found gimbal.motor.friction, which is dry"));
}

}  // namespace bbsim_test::test_linearize
