// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Servos at their limits: when they switch, and the effect on the ball.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>
#include <utility>

#include "catch.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_servo {

using namespace bbsim;

namespace {

constexpr solve::Tolerances tight{1e-11, 1e-13};

// phi follows one step of the command; theta stays level.
Scenario step_scene(double command) {
  Scenario scene = fig2b();
  scene.controller->kv = {};
  scene.controller->kp = {{{1, 0}, {0, 0}}};
  // A sampled controller sees the ball only once, at x = 0, so the command stays constant.
  scene.ball.position = {0, 0};
  scene.controller->reference = PointReference{{command, 0}};
  scene.controller->sampling = Sampling{1e3, 0, 0, 0};
  scene.gimbal.servo = Servo{10, 0.5};
  scene.time = {2, 0.01};
  return scene;
}

Run run_of(const Scenario& scene, Method method) {
  return whole_run(scene, method, tight, false);
}

// q'' = w^2 (u - q) - 2 zeta w q' from (q, v), after the given time.
std::pair<double, double> free_servo(double q, double v, double u, double w, double zeta,
                                     double time) {
  const double wd = w * std::sqrt(1 - zeta * zeta), e = std::exp(-zeta * w * time);
  const double c = std::cos(wd * time), s = std::sin(wd * time);
  const double b = (v + zeta * w * (q - u)) / wd;
  const double d = (q - u) * c + b * s;
  return {u + e * d, e * (-zeta * w * d + wd * (b * c - (q - u) * s))};
}

}  // namespace

namespace {

// When a component of the free servo's step to `u` reaches a value, by bisection until `latest`.
double reaches(double value, double std::pair<double, double>::*of, double u, double latest) {
  double from = 0, to = latest;
  for (int i = 0; i < 60; ++i) {
    const double middle = (from + to) / 2;
    (free_servo(0, 0, u, 10, 0.5, middle).*of < value ? from : to) = middle;
  }
  return to;
}

}  // namespace

TEST_CASE("a servo at its limits switches at the times of the closed form, in both directions") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  const double sign = GENERATE(1.0, -1.0);
  struct Part {
    double until;  // s
    std::function<std::pair<double, double>(double)> at;
  };
  std::vector<Part> parts;
  double u = 0.2;
  const double w = 10, zeta = 0.5;
  Servo servo{w, zeta};
  const std::string limit = GENERATE("acceleration", "rate", "angle");
  CAPTURE(int(method), sign, limit);
  if (limit == "acceleration") {
    servo.acceleration_limit = 12;
    // q = most t^2 / 2 until w^2 (u - q) - 2 zeta w q' = most. Then the demand stays above -most
    // for a quarter of a turn.
    const double most = 12, a = w * w * most / 2, b = 2 * zeta * w * most, c = most - w * w * u;
    const double t1 = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    parts = {{t1,
              [=](double t) {
                return std::pair{most * t * t / 2, most * t};
              }},
             {t1 + 0.1, [=](double t) {
                return free_servo(most * t1 * t1 / 2, most * t1, u, w, zeta, t - t1);
              }}};
  } else if (limit == "rate") {
    servo.rate_limit = 1;
    u = 0.5;
    // At the limit until w^2 (u - q) = 2 zeta w fastest.
    const double t1 = reaches(1, &std::pair<double, double>::second, u, 0.1);
    const double q1 = free_servo(0, 0, u, w, zeta, t1).first;
    const double q2 = u - 2 * zeta / w, t2 = t1 + q2 - q1;
    REQUIRE(t2 < 0.6);
    parts = {{t1, [=](double t) { return free_servo(0, 0, u, w, zeta, t); }},
             {t2,
              [=](double t) {
                return std::pair{q1 + t - t1, 1.0};
              }},
             {t2 + 0.3, [=](double t) { return free_servo(q2, 1, u, w, zeta, t - t2); }}};
  } else {
    servo.angle_limit = 0.15;
    const double t1 = reaches(0.15, &std::pair<double, double>::first, u, 0.25);
    parts = {{t1, [=](double t) { return free_servo(0, 0, u, w, zeta, t); }},
             {2, [](double) {
                return std::pair{0.15, 0.0};
              }}};
  }
  Scenario scene = step_scene(sign * u);
  scene.gimbal.servo = servo;
  for (const model::Sample& sample : run_of(scene, method).samples) {
    std::size_t part = 0;
    while (part < parts.size() && sample.t > parts[part].until) ++part;
    if (part == parts.size()) break;
    const auto [q, v] = parts[part].at(sample.t);
    CHECK(std::abs(sign * sample.gimbal.phi - q) < 1e-9);
    CHECK(std::abs(sign * sample.gimbal.phi_dot - v) < 1e-8);
    if (limit == "acceleration") CHECK(std::abs(sample.gimbal.phi_ddot) <= 12 * (1 + 1e-9));
    // At a rate limit or a stop, exactly.
    if (limit == "rate") CHECK(sign * sample.gimbal.phi_dot <= 1);
    const bool held = part == 1 && sample.t > parts[0].until + 1e-6;
    if (limit == "rate" && held) CHECK(sign * sample.gimbal.phi_dot == 1);
    if (limit != "angle" || !held) continue;
    CHECK(sign * sample.gimbal.phi == 0.15);
    CHECK(sample.gimbal.phi_dot == 0);
    CHECK(sample.gimbal.phi_ddot == 0);
  }
}

// The angle and rate of a trapezoidal ramp from (q, v) to a target, after a time, by the durations
// of its parts.
std::pair<double, double> ramp(double q, double v, double target, double fastest, double most,
                               double time) {
  const double halt = q + v * std::abs(v) / (2 * most);
  if ((target - halt) * v < 0) {
    const double whole = std::abs(v) / most, a = v > 0 ? -most : most;
    if (time < whole) return {q + v * time + a * time * time / 2, v + a * time};
    return ramp(halt, 0, target, fastest, most, time - whole);
  }
  const double way = target < q ? -1 : 1, length = std::abs(target - q), speed = std::abs(v);
  const double peak = std::min(fastest, std::sqrt(most * length + v * v / 2));
  const double rise = (peak - speed) / most, fall = peak / most;
  const double even = (length - (speed + peak) / 2 * rise - peak / 2 * fall) / peak;
  const double left = rise + even + fall - time;
  if (left <= 0) return {target, 0};
  if (left < fall) return {target - way * most * left * left / 2, way * most * left};
  if (time < rise) return {q + v * time + way * most * time * time / 2, v + way * most * time};
  return {q + way * ((speed + peak) / 2 * rise + peak * (time - rise)), way * peak};
}

TEST_CASE("a stepper follows a trapezoidal ramp to its command, whatever its motion") {
  const Method method = GENERATE(Method::radau, Method::bdf);
  struct Move {
    double angle, rate, command;
  };
  // A trapezoid, a triangle, one that turns first, one that cannot halt in time, one on its way.
  const auto [angle, rate, command] = GENERATE(values<Move>(
      {{0, 0, 0.6}, {0, 0, -0.01}, {0.1, -0.6, 0.4}, {0, 0.9, 0.02}, {-0.1, -0.5, -0.3}}));
  constexpr double fastest = 0.9, most = 12;
  Scenario scene = step_scene(command);
  scene.gimbal.start = {angle, 0, rate, 0};
  scene.gimbal.servo = Servo{};
  scene.gimbal.servo->stepper = StepperMotor{400, 32, 2};
  scene.gimbal.servo->rate_limit = fastest;
  scene.gimbal.servo->acceleration_limit = most;
  const double step = 2 * std::numbers::pi / (400 * 32 * 2);
  const double target = step * std::round(command / step);
  const double close = method == Method::radau ? 1e-12 : 1e-9;
  for (const model::Sample& sample : run_of(scene, method).samples) {
    const auto [q, v] = ramp(angle, rate, target, fastest, most, sample.t);
    CHECK(std::abs(sample.gimbal.phi - q) < close);
    CHECK(std::abs(sample.gimbal.phi_dot - v) < 10 * close);
    CHECK(sample.gimbal.theta == 0);
  }
}

TEST_CASE("a stepper beyond its torque stalls, and follows again whole periods behind") {
  const double load = GENERATE(0.99, 1.01, 0.8);
  Scenario scene = step_scene(0.6);
  scene.gimbal.start = {};
  scene.gimbal.servo = Servo{};
  scene.gimbal.servo->stepper = StepperMotor{200, 16, 1};
  scene.gimbal.servo->stepper->torque = 0.4;
  scene.gimbal.servo->stepper->inertia = 0.4 / 60;  // at most 60 rad/s^2
  if (load == 0.8) scene.gimbal.servo->stepper->corner_speed = 1.6;
  scene.gimbal.servo->rate_limit = 4;
  scene.gimbal.servo->acceleration_limit = 60 * load;
  const Run run = run_of(scene, Method::radau);
  const double period = 2 * std::numbers::pi / 50;
  const double believed = run.samples.back().counted[0], phi = run.samples.back().gimbal.phi;
  CHECK(std::abs(believed - 0.6) < std::numbers::pi / 3200);
  CHECK(run.samples.back().servo[0] == phi);
  if (load == 0.99) {
    CHECK(run.outcome.occurrences.empty());
    CHECK(std::abs(phi - believed) < 1e-12);
    return;
  }
  REQUIRE(run.outcome.occurrences.size() == 1);
  const model::Occurrence& lost = run.outcome.occurrences.front();
  CHECK(lost.name == "steps_lost");
  // At once; or at 1.6 / 0.8 = 2 rad/s, which takes 2 / 48 s, beyond the corner.
  const double rate = load == 0.8 ? 2 : 0;
  CHECK(std::abs(lost.t - rate / (60 * load)) < 1e-12);
  const double stalled = rate * rate / (2 * 60 * load);
  const double periods = std::floor((believed - stalled) / period);
  CHECK(std::abs(believed - phi - periods * period) < 1e-9);
}

// The driver's parts, each of constant acceleration, and the shaft that rings about them: a
// parabola that solves its equation, and a free swing about that.
struct Ringing {
  double w, zeta;
  double angle = 0, rate = 0;            // of the shaft at the start of a part
  double counted = 0, counted_rate = 0;  // of the driver

  [[nodiscard]] std::pair<double, double> after(double time, double a) const {
    const double ratio = 2 * zeta / w, drift = counted_rate - ratio * a;
    const double center = counted - ratio * drift - a / (w * w);
    const auto [q, v] = free_servo(angle - center, rate - drift, 0, w, zeta, time);
    return {center + time * (drift + a * time / 2) + q, drift + a * time + v};
  }
  void pass(double time, double a) {
    std::tie(angle, rate) = after(time, a);
    counted += time * (counted_rate + a * time / 2);
    counted_rate += a * time;
  }
};

Scenario ringing_scene(double command) {
  Scenario scene = step_scene(command);
  scene.gimbal.start = {};
  scene.gimbal.servo = Servo{};
  scene.gimbal.servo->stepper = StepperMotor{};
  scene.gimbal.servo->stepper->natural_frequency = 40;
  scene.gimbal.servo->stepper->damping = 0.15;
  scene.gimbal.servo->rate_limit = 0.9;
  scene.gimbal.servo->acceleration_limit = 12;
  return scene;
}

TEST_CASE("a stepper's shaft rings about its ramp by the closed form") {
  const Method method = GENERATE(Method::radau, Method::bdf);
  const double command = GENERATE(0.6, -0.01);
  const Scenario scene = ringing_scene(command);
  const double microstep = scene.gimbal.servo->stepper->microstep();
  const double target = microstep * std::round(command / microstep), way = target < 0 ? -1 : 1;
  const double peak = std::min(0.9, std::sqrt(12 * std::abs(target)));
  const double rise = peak / 12, even = std::abs(target) / peak - rise;
  const double close = method == Method::radau ? 1e-12 : 1e-9;
  double swing = 0;
  for (const model::Sample& sample : run_of(scene, method).samples) {
    Ringing shaft{40, 0.15};
    double left = sample.t, part = 0;
    for (const double a : {way * 12, 0.0, -way * 12}) {
      const double length = part++ == 1 ? even : rise;
      if (left <= length) {
        shaft.pass(std::exchange(left, 0), a);
        break;
      }
      shaft.pass(length, a);
      left -= length;
    }
    if (left > 0) {
      shaft.counted_rate = 0;
      shaft.pass(left, 0);
    }
    CHECK(std::abs(sample.gimbal.phi - shaft.angle) < close);
    CHECK(std::abs(sample.gimbal.phi_dot - shaft.rate) < 100 * close);
    CHECK(std::abs(sample.counted[0] - shaft.counted) < close);
    CHECK(sample.servo[0] == sample.gimbal.phi);
    CHECK(sample.gimbal.theta == 0);
    swing = std::max(swing, way * (sample.gimbal.phi - target));
  }
  CHECK(swing > 0.1 * 12 / (40 * 40));  // it goes beyond the target
}

TEST_CASE("a ringing shaft that loses steps swings about the driver's field") {
  Scenario scene = ringing_scene(0.6);
  StepperMotor& motor = *scene.gimbal.servo->stepper;
  motor.torque = 0.4;
  motor.inertia = 0.4 / 11;  // less than the ramp asks for
  const Run run = run_of(scene, Method::radau);
  REQUIRE(run.outcome.occurrences.size() == 1);
  CHECK(run.outcome.occurrences.front().name == "steps_lost");
  const model::Sample& end = run.samples.back();
  const double period = 2 * std::numbers::pi / 50, believed = end.counted[0];
  CHECK(std::abs(believed - 0.6) < std::numbers::pi / 3200);
  // Its swings have decayed by exp(-0.15 * 40 * 1.2) at the end.
  CHECK(std::abs(believed - end.gimbal.phi - std::floor(believed / period) * period) < 1e-3);
}

TEST_CASE("a hard stop kicks the ball by r times the servo's rate") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  const double sign = GENERATE(1.0, -1.0);
  Scenario scene = step_scene(sign * 0.2);
  const double stop = sign * 0.15, r = scene.ball.radius;
  scene.gimbal.servo->angle_limit = 0.15;
  const Run run = run_of(scene, method);
  const double t1 = reaches(0.15, &std::pair<double, double>::first, 0.2, 0.25);
  // Equation (27) with y = 0 = theta is (x' + r phi')' = 5/7 (g sin phi + x phi'^2), without a
  // jump. Simpson's rule integrates it over the run, separately before and after the stop.
  const auto integrand = [&](const model::Sample& s) {
    return 5.0 / 7 *
           (scene.gravity * std::sin(s.gimbal.phi) +
            s.ball.x * s.gimbal.phi_dot * s.gimbal.phi_dot);
  };
  Scenario fine = scene;
  fine.time = {t1, t1 / 2000};
  fine.gimbal.servo->angle_limit = unlimited;
  const Run before = run_of(fine, method);
  double momentum = 0;
  for (std::size_t i = 0; i + 2 < before.samples.size(); i += 2) {
    momentum += t1 / 2000 / 3 *
                (integrand(before.samples[i]) + 4 * integrand(before.samples[i + 1]) +
                 integrand(before.samples[i + 2]));
  }
  const model::Sample& end = run.samples.back();
  momentum += 5.0 / 7 * scene.gravity * std::sin(stop) * (end.t - t1);
  // A hundred times the tolerance of a step; BDF and Adams take thousands of steps.
  const double bound = method == Method::radau ? 1e-9 : 1e-7;
  CHECK(end.ball.x_dot + r * end.gimbal.phi_dot == Approx(momentum).epsilon(bound));
}

TEST_CASE("backlash: the plane follows only where the servo pushes it") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  const double sign = GENERATE(1.0, -1.0);
  Scenario scene = step_scene(sign * 0.2);
  const double gap = 0.04;
  scene.gimbal.servo->backlash = gap;
  const Run run = run_of(scene, method);
  // The servo overshoots (zeta 0.5) and returns by less than the gap: the plane stays where the
  // overshoot left it, half a gap behind the servo's largest angle.
  const double overshoot = 0.2 * (1 + std::exp(-std::acos(-1.0) * 0.5 / std::sqrt(0.75)));
  CHECK(overshoot - 0.2 < gap);
  CHECK(sign * run.samples.back().gimbal.phi == Approx(overshoot - gap / 2).epsilon(1e-9));
  CHECK(run.samples.back().gimbal.phi_dot == 0);
  // It does not move until the servo has crossed half the gap.
  CHECK(run.samples[3].gimbal.phi == 0);
}

TEST_CASE("a first-order servo follows its command exponentially, and kicks the ball immediately") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  Scenario scene = step_scene(0.01);
  Servo servo;
  servo.time_constant = 0.1;
  scene.gimbal.servo = servo;
  scene.gravity = 0;
  const Run run = run_of(scene, method);
  const double r = scene.ball.radius, rate = 0.01 / 0.1;
  CHECK(run.samples.front().gimbal.phi_dot == Approx(rate).epsilon(1e-14));
  CHECK(run.samples.front().ball.x_dot == Approx(-r * rate).epsilon(1e-13));
  for (const model::Sample& sample : run.samples) {
    const double q = 0.01 * (1 - std::exp(-sample.t / 0.1));
    CHECK(std::abs(sample.gimbal.phi - q) < 1e-11);
  }
}

TEST_CASE("a dead band keeps small command changes from the servo") {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.controller->kp = {{{0.5, 0}, {0, -0.5}}};
  scene.controller->kv = {{{0.5, 0}, {0, -0.5}}};
  scene.controller->sampling = Sampling{0.02, 0, 0, 0.02};
  scene.gimbal.servo = Servo{30, 0.8};
  scene.gimbal.servo->dead_band = 0.004;
  const Run run = run_of(scene, Method::automatic);
  double before = run.samples.front().command[0];
  int kept = 0;
  for (const model::Sample& sample : run.samples) {
    if (sample.command[0] == before) {
      ++kept;
    } else {
      CHECK(std::abs(sample.command[0] - before) > 0.004);
    }
    before = sample.command[0];
  }
  CHECK(kept > 10);
}

}  // namespace bbsim_test::test_servo
