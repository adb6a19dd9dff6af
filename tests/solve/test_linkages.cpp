// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of gimbals with linkages between servos and plane.
#include <cmath>
#include <limits>
#include <utility>

#include "catch.hpp"
#include "model/servo/linkages.hpp"
#include "support/energy_balance.hpp"
#include "support/reading.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_linkages {

using namespace bbsim;

namespace {

constexpr double most_double = std::numeric_limits<double>::infinity();

RodLinkage desk() {
  return {0.025, 0.08, {}, {0.06, 0.09}};
}

Scenario linked() {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.ball.mass = 0.05;
  scene.gimbal.servo = Servo{30, 0.8};
  scene.gimbal.linkage = {desk(), desk()};
  scene.controller->kp = {{{0.7, 0}, {0, -0.7}}};
  scene.controller->kv = {{{0.6, 0}, {0, -0.6}}};
  scene.controller->assumes = Assumes::exact;
  scene.time = {4, 0.05};
  return scene;
}

Run run_of(const Scenario& scene, Method method = Method::automatic) {
  return whole_run(scene, method, {1e-10, 1e-12});
}

double distance(const Run& a, const Run& b) {
  REQUIRE(a.samples.size() == b.samples.size());
  double most = 0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    const model::Sample &p = a.samples[i], &q = b.samples[i];
    most = std::max({most, std::abs(p.ball.x - q.ball.x), std::abs(p.ball.y - q.ball.y),
                     std::abs(p.gimbal.phi - q.gimbal.phi),
                     std::abs(p.gimbal.theta - q.gimbal.theta)});
  }
  return most;
}

}  // namespace

TEST_CASE("with a push rod the plane follows the curve, and so do its rates") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  Scenario scene = linked();
  scene.ball.position = {0.15, 0.1};
  scene.time.step = 0.005;
  const model::Linkage linkage = make_linkage(desk(), model::Assumed::exact);
  const Run run = run_of(scene, method);
  double tilted = 0, turned = 0, rate_before = 0;
  for (const model::Sample& now : run.samples) {
    CHECK(std::abs(linkage.angle(now.servo[0]) - now.gimbal.phi) < 1e-15);
    CHECK(std::abs(linkage.angle(now.servo[1]) - now.gimbal.theta) < 1e-15);
    tilted = std::max(tilted, std::abs(now.gimbal.phi));
    // The rates' integral is the angle, to h^2/12 of the acceleration's change, 90 rad/s^2.
    turned += scene.time.step * (rate_before + now.gimbal.phi_dot) / 2;
    rate_before = now.gimbal.phi_dot;
    CHECK(std::abs(turned - now.gimbal.phi) < 3e-4);
  }
  CHECK(tilted > 0.005);
}

TEST_CASE("a parallelogram has no effect as a linkage") {
  // Equal parallel horn and arm: the plate's angle is the servo's.
  Scenario parallel = linked(), ideal = linked();
  parallel.gimbal.linkage = {RodLinkage{0.03, 0.03, {}, {0.02, 0.05}},
                             RodLinkage{0.03, 0.03, {}, {0.02, 0.05}}};
  ideal.gimbal.linkage = {};
  ideal.controller->assumes.reset();
  const Run without = run_of(ideal);
  for (const Assumes assumes : {Assumes::exact, Assumes::ratio}) {
    parallel.controller->assumes = assumes;
    // The tolerance, accumulated over four seconds.
    CHECK(distance(run_of(parallel), without) < 1e-8);
  }
  parallel.controller->sampling = ideal.controller->sampling = Sampling{0.02, 0.01, 0.0, 0.03};
  CHECK(distance(run_of(parallel), run_of(ideal)) < 1e-8);
}

TEST_CASE("a measured curve behaves as the measured linkage, better with more rows") {
  const model::Linkage exact = make_linkage(desk(), model::Assumed::exact);
  const bool sampled = GENERATE(false, true);
  Scenario scene = linked();
  if (sampled) scene.controller->sampling = Sampling{0.02, 0.01, 0.0, 0.03};
  const Run rods = run_of(scene);
  double last = most_double;
  for (const int rows : {9, 17, 33}) {
    CurveLinkage curve;
    for (int i = 0; i < rows; ++i) {
      curve.servo.push_back(-0.6 + 1.1 * i / (rows - 1));
      curve.plate.push_back(exact.angle(curve.servo.back()));
    }
    scene.gimbal.linkage = {curve, curve};
    const double off = distance(run_of(scene), rods);
    CHECK(off < last / 4);
    last = off;
  }
  CHECK(last < 1e-6);
}

TEST_CASE("a controller that inverts the curve reaches its command, one with a ratio does not") {
  // A reference so far away that the command stays at its limit.
  const Assumes assumes = GENERATE(Assumes::exact, Assumes::ratio);
  const bool sampled = GENERATE(false, true);
  Scenario scene = linked();
  scene.controller->reference = PointReference{{1000, 1000}};
  scene.controller->limit = 0.08;
  scene.controller->assumes = assumes;
  if (sampled) scene.controller->sampling = Sampling{0.02, 0.01, 0.0, 0.03};
  scene.time = {2, 0.5};
  const model::Linkage linkage = make_linkage(desk(), model::Assumed::exact);
  const model::Sample last = run_of(scene).samples.back();
  const double slope = linkage.curve.slope;
  // exp(-0.8 * 30 * 2) of the servo's motion remains.
  if (assumes == Assumes::exact) {
    CHECK(std::abs(last.gimbal.phi - 0.08) < 1e-12);
    CHECK(std::abs(last.gimbal.theta + 0.08) < 1e-12);
  } else {
    CHECK(std::abs(last.gimbal.phi - linkage.angle(0.08 / slope)) < 1e-12);
    CHECK(std::abs(last.gimbal.theta - linkage.angle(-0.08 / slope)) < 1e-12);
    CHECK(std::abs(last.gimbal.phi - 0.08) > 5e-3);
  }
  CHECK(std::abs(last.command[0] - last.servo[0]) < 1e-12);
}

TEST_CASE("a dead point ends the run, at its time up to rounding") {
  // A command beyond it, with a servo at its rate limit: the horn turns at 2 rad/s.
  const bool up = GENERATE(true, false);
  // Horn and rod become aligned; rod and arm, where the plane's rate diverges; and all three, in a
  // parallelogram.
  const auto [rods, why] = GENERATE(values<std::pair<RodLinkage, const char*>>({
      {desk(), "horn and rod are in line"},
      {{0.08, 0.03, {}, {0.05, 0.09}}, "rod and arm are in line"},
      {{0.03, 0.03, {}, {0, 0.1}}, "horn, rod and arm are in line"},
  }));
  Scenario scene = linked();
  scene.gimbal.linkage = {rods, {}};
  const model::Linkage linkage = make_linkage(rods, model::Assumed::ratio);
  const double dead = up ? linkage.curve.high : linkage.curve.low;
  REQUIRE(std::abs(dead) < 3);
  const double rate = up ? 2 : -2;
  scene.gimbal.start.phi = dead - rate * 0.1;
  scene.gimbal.start.phi_rate = rate;
  scene.gimbal.servo = Servo{30, 0.8};
  scene.gimbal.servo->rate_limit = 2;
  scene.controller->assumes = Assumes::ratio;
  scene.controller->kp = {{{0, 0}, {0, 0}}};
  scene.controller->kv = {{{0, 0}, {0, 0}}};
  // A constant command: proportional feedback to a distant reference.
  scene.controller->kp[0][0] = up ? 1 : -1;
  scene.controller->reference = PointReference{{1000, 0}};
  const Run run = run_in_memory(scene, Method::automatic, {1e-9, 1e-11});
  REQUIRE(run.outcome.ending == solve::Ending::stopped);
  REQUIRE(run.outcome.occurrences.size() == 1);
  const model::Occurrence& end = run.outcome.occurrences[0];
  CHECK(end.name == "dead_point");
  CHECK((up ? linkage.high_end : linkage.low_end) == why);
  CHECK(std::abs(end.t - 0.1) < 1e-14);
}

TEST_CASE("near a dead point, where the plane's rate diverges, the plane follows the curve") {
  // The arm is shorter than the horn. Where it aligns with the rod, a servo angle e away has turned
  // the plane by sqrt(e), and its rate grows as 1 / sqrt(e).
  const RodLinkage rods{0.05, 0.02, {}, {0.03, 0.06}};
  const model::Linkage linkage = make_linkage(rods, model::Assumed::exact);
  REQUIRE(linkage.high_end == "rod and arm are in line");
  const double away = GENERATE(1e-2, 1e-4, 1e-6);
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  CAPTURE(away, static_cast<int>(method));
  // A first-order servo leaves that point at its highest rate, for any curve.
  Scenario scene = linked();
  scene.gimbal.linkage = {rods, rods};
  scene.gimbal.servo = Servo{};
  scene.gimbal.servo->time_constant = 0.05;
  scene.gimbal.servo->rate_limit = 0.5;
  scene.gimbal.start.phi = linkage.curve.high - away;
  scene.controller->kp = scene.controller->kv = {};
  scene.ball.position = {0, 0};
  scene.time = {0.3, 0.01};
  const Run run = run_of(scene, method);
  REQUIRE(run.samples.size() == 31);
  for (const model::Sample& now : run.samples) {
    const double servo = scene.gimbal.start.phi - 0.5 * now.t;
    CHECK(std::abs(now.servo[0] - servo) < 1e-11);
    // The servo's rounding, magnified by the slope.
    const double slope = std::abs(linkage.curve.plain_turn(servo).slope);
    CHECK(std::abs(now.gimbal.phi - linkage.angle(servo)) < 1e-11 * (1 + slope));
    CHECK(
        now.gimbal.phi_dot ==
        Approx(-0.5 * linkage.curve.plain_turn(servo).slope).epsilon(1e-10 * (1 + slope * slope)));
  }
  if (method != Method::radau) return;
  CHECK(std::abs(run.samples.front().gimbal.phi_dot) > 0.2 / std::sqrt(away));
  CHECK(energy_gap(scene, run) < 1e-9);
}

TEST_CASE("stops and backlash belong to the servo, not to the plane") {
  Scenario scene = linked();
  scene.gimbal.servo->angle_limit = 0.05;
  scene.gimbal.servo->backlash = 0.01;
  scene.ball.position = {0.3, 0};
  const model::Linkage linkage = make_linkage(desk(), model::Assumed::exact);
  const Run run = run_of(scene);
  double most = 0, play = 0;
  for (const model::Sample& now : run.samples) {
    most = std::max(most, std::abs(now.servo[0]));
    play = std::max(play, std::abs(linkage.servo_for(now.gimbal.phi) - now.servo[0]));
  }
  CHECK(most == 0.05);
  CHECK(play == Approx(0.005).epsilon(1e-9));
}

TEST_CASE("three fast servos move the ball as two ideal ones do") {
  Scenario ideal = linked();
  ideal.gimbal.linkage = {};
  ideal.controller->assumes.reset();
  Scenario three = ideal;
  three.gimbal.three_servos = ThreeServoPlate{{0.06, 0.09, 0.04, 0.1, 0.11}, {}};
  three.controller->assumes = Assumes::exact;
  const bool sampled = GENERATE(false, true);
  if (sampled) {
    ideal.controller->sampling = three.controller->sampling = Sampling{0.02, 0.01, 0.0, 0.03};
  }
  ideal.ball.position = three.ball.position = {0.15, 0.1};
  // The servos' dynamics remain: the same lag, but along another curve.
  CHECK(distance(run_of(ideal), run_of(three)) < 1e-3);
  // Near home they agree for any servos, better for smaller tilts.
  double last = 0;
  for (const double size : {1.0, 0.1}) {
    for (Scenario* one : {&ideal, &three}) {
      one->ball.position = {0.1 * size, 0};
      one->controller->reference = PointReference{{0, 0}};
    }
    const double off = distance(run_of(ideal), run_of(three));
    if (last > 0) CHECK(off < last / 50);
    last = off;
  }
}

TEST_CASE("an axis may have its own servo and limits") {
  Scenario scene = linked();
  scene.gimbal.linkage = {};
  scene.controller->assumes.reset();
  scene.gimbal.theta_servo = Servo{12, 1.1};
  scene.gimbal.theta_servo->rate_limit = 0.1;
  scene.controller->axis_limits = {{{0.02}, {0.03}}};
  scene.ball.position = {0.2, 0.2};
  const Run run = run_of(scene);
  double command[2] = {0, 0}, rate[2] = {0, 0};
  for (const model::Sample& now : run.samples) {
    for (std::size_t i = 0; i < 2; ++i) command[i] = std::max(command[i], std::abs(now.command[i]));
    rate[0] = std::max(rate[0], std::abs(now.gimbal.phi_dot));
    rate[1] = std::max(rate[1], std::abs(now.gimbal.theta_dot));
  }
  CHECK(command[0] == 0.02);
  CHECK(command[1] == 0.03);
  CHECK(rate[0] > 0.2);
  CHECK(rate[1] == 0.1);

  // Equal axes written separately behave as common ones.
  Scenario alike = linked();
  alike.gimbal.linkage = {};
  alike.controller->assumes.reset();
  alike.controller->limit = 0.1;
  Scenario apart = alike;
  apart.gimbal.theta_servo = apart.gimbal.servo;
  apart.controller->limit.reset();
  apart.controller->axis_limits = {{{0.1}, {0.1}}};
  CHECK(distance(run_of(alike), run_of(apart)) == 0);
}

TEST_CASE("with a linkage the command's resolution stays within the controller's limit") {
  const bool exact = GENERATE(false, true);
  Scenario scene = test::parse(
      "ball: {radius: 0.01, position: [-0.5, 0]}\n"
      "gimbal:\n"
      "  servo: {natural_frequency: 30, damping: 0.8}\n"
      "  linkage: {horn: 0.02, arm: 0.05, offset: [0.05, 0.05]}\n"
      "controller: {drives: angle, limit: 0.0634, pd: {kp: [[0.5, 0], [0, -0.5]], kv: 0},\n"
      "  reference: {point: [0, 0]}, sampling: {period: 0.02, resolution: 0.003}}\n"
      "time: {end: 0.1, step: 0.02}\n");
  scene.controller->assumes = exact ? Assumes::exact : Assumes::ratio;
  const Run run = run_in_memory(scene, Method::radau, {1e-9, 1e-11});
  // The greatest multiples of 0.003 rad of the servo within 0.0634 rad of the plane: with the slope
  // 0.4 it is 0.1585 rad, with the curve 0.1745 rad.
  CHECK(run.samples.back().command[0] == Approx(exact ? 0.174 : 0.156).epsilon(1e-14));
}

}  // namespace bbsim_test::test_linkages
