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
#include "model/control/linear_system.hpp"
#include "model/control/linearize.hpp"
#include "model/matched.hpp"
#include "model/systems/list.hpp"
#include "support/folder.hpp"
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

// Without the poles of delays at zero, which are defective: rounding moves n of them by its n-th
// root.
model::Eigenvalues large_ones(model::Eigenvalues poles) {
  std::erase_if(poles, [](const Complex& pole) { return std::abs(pole) < 0.05; });
  return poles;
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

TEST_CASE("poles of a loop, continuous or sampled, equal those that check prints") {
  struct Case {
    const char* what;
    Scenario scene;
  };
  std::vector<Case> cases{
      {"PD", pd_scene()},
      {"PD of accelerations, unstable", fig2b_literal()},
      {"crooked", crooked_scene()},
      {"sampled", sampled_scene()},
      {"torques", test::parse(torque_lqr())},
      {"sampled torques", test::parse(torque_lqr(", sampling: {period: 0.01, delay: 0.003}"))}};
  const auto add = [&cases](const char* what, Scenario scene) -> Scenario& {
    return cases.emplace_back(Case{what, std::move(scene)}).scene;
  };
  Scenario& planar = add("planar", pd_scene());
  planar.ball.position = {0.05, 0};
  planar.controller->kp[1] = planar.controller->kv[1] = {0, 0};
  Scenario& pid = add("PID", pd_scene());
  pid.controller->law = Law::pid;
  pid.controller->ki = {{{0.1, 0}, {0, 0}}};
  Scenario& lqr = add("LQR", pd_scene());
  lqr.controller->law = Law::lqr;
  lqr.controller->weights = {100, 1, 0, 0, 1};
  Scenario& accelerates = add("gravity compensation, whose reference is not home", pd_scene());
  accelerates.controller->law = Law::gravity_compensation;
  accelerates.controller->kp = {{{4, 0}, {0, 4}}};
  accelerates.controller->kv = {{{3, 0}, {0, 3}}};
  accelerates.controller->reference = CircleReference{0.1, 2, 0, {0, 0}};
  Scenario& first = add("sampled PID with a servo of first order, no delay", sampled_scene());
  first.controller->law = Law::pid;
  first.controller->ki = {{{0.1, 0}, {0, -0.1}}};
  first.controller->sampling->delay = 0;
  first.controller->sensor->delay = 0;
  first.gimbal.servo = Servo{};
  first.gimbal.servo->time_constant = 0.05;
  add("a motor's integrator",
      test::parse(
          body +
          "gimbal: {motor: {rotor_inertia: 1e-3, viscous: 0.02, position_loop: {kp: 4, kd: 0.3, "
          "ki: "
          "2}}}\n"
          "controller: {pd: {kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}, drives: angle, "
          "reference: {point: [0, 0]}}\n"));
  for (const auto& [what, scene] : cases) {
    CAPTURE(what);
    const model::Model model = model::assemble(scene, false);
    const Linearization made = linear(scene, LinearKind::loop);
    const auto& sampling = scene.controller->sampling;
    CHECK(made.system.period == (sampling ? std::optional(sampling->period) : std::nullopt));
    const auto poles = sampling ? model::sampled_poles(model) : model::closed_loop_poles(model);
    CHECK(made.poles.size() == poles.size());
    // Rounding in eigenvalues of a nonsymmetric matrix that was computed in two ways.
    const double bound = sampling || scene.plate.inertia ? 1e-9 : 1e-10;
    if (sampling) {
      CHECK(distance(large_ones(made.poles), large_ones(poles)) < bound);
    } else {
      CHECK(distance(made.poles, poles) < bound);
    }
  }
}

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
  three.gimbal.three_servos = ThreeServoPlate{{0.06, 0.09, 0.04, 0.1, 0.11}, {}};
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
  double z[model::CoupledLayout<2>::states] = {};
  std::copy(at.state.begin(), at.state.end(), z);
  double rates[model::CoupledLayout<2>::states];
  model::derivative(system, 0.0, z, rates);
  for (int i = 0; i < 9; ++i) CHECK(std::abs(rates[i]) < 1e-10);  // it is at rest
  constexpr int size = model::CoupledLayout<2>::states;
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

namespace {

// Compares A and B with central differences in quad precision of `rates`, whose argument is a state
// or an input. Inputs enter linearly, so their step may be large enough for doubles.
template <class Rates>
void check_differences(const Linearization& made, double input_step, const Rates& rates) {
  const auto n = static_cast<int>(made.system.a.rows());
  REQUIRE(n == model::RigLoop<>::size);  // with the spin, which matters if the plane turns
  for (int j = 0; j < n + static_cast<int>(made.system.inputs.size()); ++j) {
    // Differences omit the squared step times the third derivative, some 1e3.
    const double step = j < n ? std::ldexp(1.0, -40) : input_step;
    const std::vector<Quad> more = rates(j, step), less = rates(j, -step);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double difference = plain((more[k] - less[k]) / Quad(2 * step));
      const double found = j < n ? made.system.a(i, j) : made.system.b(i, j - n);
      CAPTURE(i, j);
      CHECK(std::abs(found - difference) <= 1e-12 * (1 + std::abs(difference)));
    }
  }
}

}  // namespace

TEST_CASE("A and B of a plant and of loops are differences in quad precision") {
  constexpr int n = model::RigLoop<>::size;
  Scenario scene = crooked_scene();
  const model::LinearPoint at = somewhere();
  const auto built = model::assemble_rig<false>(scene, {});
  model::RigLoop<> held(built.loop.radius(), built.loop.gravity(), built.loop.rolling(), {},
                        built.loop.servo(), {}, built.loop.mode);
  check_differences(linear(scene, LinearKind::plant, at), 1, [&](int place, double step) {
    Quad z[n], dz[n];
    for (int i = 0; i < n; ++i) z[i] = Quad(at.state[static_cast<std::size_t>(i)]);
    for (int i = 0; i < 2; ++i) held.mode.command[i] = at.command[static_cast<std::size_t>(i)];
    if (place < n) {
      z[place] += step;
    } else {
      held.mode.command[place - n] += step;
    }
    held.derivative_of(std::array<model::Jet<Quad>, 2>{}, z, dz);
    return std::vector<Quad>(dz, dz + n);
  });
  for (const bool compensates : {false, true}) {
    CAPTURE(compensates);
    if (compensates) {
      scene.controller->law = Law::gravity_compensation;
      scene.controller->kp = {{{0.4, 0}, {0, 0.4}}};
      scene.controller->kv = {{{0.3, 0}, {0, 0.3}}};
    }
    const Linearization made = linear(scene, LinearKind::loop, at);
    CHECK(made.system.inputs.size() == (compensates ? 6 : 4));
    const auto loop = model::assemble_rig<false>(scene, {}).loop;
    check_differences(made, std::ldexp(1.0, -40), [&](int place, double step) {
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
    });
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

TEST_CASE("the number of zeros is exact: none without a direct term, two with one") {
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

TEST_CASE("the phase margin of a sampled loop is that of its law and plant in z") {
  const Scenario scene = sampled_scene();
  const model::Margins margins = linear(scene, LinearKind::loop).margins.at(0).margins;
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

TEST_CASE("both axes have the same margins, also if first-order servos kick the ball") {
  Scenario scene = sampled_scene();
  scene.gimbal.servo = Servo{};
  scene.gimbal.servo->time_constant = 0.04;
  const auto loops = linear(scene, LinearKind::loop).margins;
  CHECK(loops.at(1).margins.phase == Approx(loops.at(0).margins.phase).epsilon(1e-11));
  CHECK(loops.at(1).margins.gain == Approx(loops.at(0).margins.gain).epsilon(1e-11));
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

TEST_CASE("at an equilibrium everything rests, also under a push and the plate's weight") {
  struct Case {
    Scenario scene;
    double
        bound;  // rounding of Newton's last step, which the servo multiplies by 900 or 1600 1/s^2
  };
  std::vector<Case> cases(3, {crooked_scene(), 1e-12});
  for (Case& one : cases) one.scene.controller->reference = PointReference{{0.04, -0.03}};
  Controller &pid = *cases[1].scene.controller, &compensates = *cases[2].scene.controller;
  pid.law = Law::pid;
  pid.ki = {{{0.1, 0}, {0, -0.1}}};
  compensates.law = Law::gravity_compensation;
  compensates.kp = {{{4, 0}, {0, 4}}};
  compensates.kv = {{{3, 0}, {0, 3}}};
  const std::string servos = body +
                             "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
                             "controller: {gravity_compensation: {kp: 6, kv: 5}, drives: angle, "
                             "reference: {point: [0.01, 0]}}\n";
  for (const std::string& text : {torque_lqr(), servos, three_legs()}) {
    cases.push_back({test::parse(text), 1e-11});
    cases.push_back(cases.back());
    cases.back().scene.ball.push = BallPush{{0.004}, {-0.003}};
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CAPTURE(i);
    const auto& [scene, bound] = cases[i];
    const model::LinearPoint at = model::equilibrium(scene);
    const model::Model model = model::assemble(scene, false);
    std::vector<double> rates(model.size());
    std::visit(
        [&](const auto& system) { model::derivative(system, 0.0, at.state.data(), rates.data()); },
        model.system);
    for (const double one : rates) CHECK(std::abs(one) < bound);
    if (scene.ball.push) CHECK(std::abs(at.state[5]) > 1e-4);
    if (i >= 3) continue;
    // Offsets of the mounting move the ball away, unless an integral removes them.
    const double off = std::abs(at.state[0] - 0.04);
    CHECK((i == 1 ? off < 1e-15 : off > 1e-3));
    CHECK(linear(scene, LinearKind::loop, at).poles.size() ==
          linear(scene, LinearKind::loop).poles.size());
  }
}

TEST_CASE("a scene that has no linear model is refused, with the key that prevents it") {
  Scenario first_order = sampled_scene(), rolling = fig2a(), pivoting = fig2a(), slides = fig2a();
  first_order.gimbal.servo = Servo{};
  first_order.gimbal.servo->time_constant = 0.05;
  rolling.ball.losses.rolling = 0.01;
  pivoting.ball.losses.pivoting = 1e-4;
  for (Scenario* one : {&rolling, &pivoting, &slides}) one->ball.mass = 0.05;
  slides.events.slip = SlipEvent{0.3, OnEvent::note, 0.2};
  struct Case {
    Scenario scene;
    LinearKind kind;
    const char* key;
  };
  const Case cases[] = {{fig2a(), LinearKind::loop, "controller"},
                        {fig2a(), LinearKind::sampled, "controller.sampling"},
                        {pd_scene(), LinearKind::sampled, "controller.sampling"},
                        {first_order, LinearKind::plant, "time_constant"},
                        {rolling, LinearKind::plant, "ball.losses.rolling"},
                        {pivoting, LinearKind::plant, "ball.losses.pivoting"},
                        {slides, LinearKind::plant, "events.slip"},
                        {test::parse(torque_lqr(), {"gimbal.motor.friction=0.01"}),
                         LinearKind::plant, "gimbal.motor.friction"}};
  for (const Case& one : cases) {
    const auto refused = [&] { static_cast<void>(linear(one.scene, one.kind)); };
    CHECK_THAT(message_of<InputError>(refused), Catch::Contains(one.key));
  }
  const Linearization plant = linear(fig2a(), LinearKind::plant);
  CHECK(plant.system.inputs[0].name == "phi_acceleration");
  CHECK(plant.system.states.size() == 8);
  // No angles level a plane whose base stands upright.
  Scenario upright = crooked_scene();
  upright.gimbal.mounting.base_tilt = std::numbers::pi / 2;
  upright.gimbal.mounting.skew = 0;
  upright.gravity = 0;
  CHECK_NOTHROW(model::equilibrium(upright));
}

namespace {

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
        model::derivative(loop, 0.0, at.state.data(), (side > 0 ? more : less).data());
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

}  // namespace bbsim_test::test_linearize
