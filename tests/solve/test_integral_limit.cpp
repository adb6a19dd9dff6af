// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrals that wait at a limit (docs/explanation/rig-model.md, (M64)): a run agrees with the law
// smoothed over a width, whose solution converges to it linearly as the width tends to 0.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/control/law.hpp"
#include "solve/scene_table.hpp"
#include "support/largest.hpp"
#include "support/reading.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_integral_limit {

using namespace bbsim;

namespace {

// Fraction of an outward error that is integrated: 1 within the limit, 0 beyond, and linear over
// `width` before it.
double share(double u, double low, double high, double push, double width) {
  const double room = push > 0 ? high - u : u - low;
  return std::isfinite(room) ? std::clamp(room / width, 0.0, 1.0) : 1.0;
}

// Sets a system to the mode of the smoothed law at a state.
void smooth(const model::Model& model, model::RigLoop<true>& loop, double t, const double* z,
            double width) {
  const auto reference = loop.inputs(t);
  const auto axes = loop.axes(reference, z);
  for (std::size_t i = 0; i < 2; ++i) {
    const model::CommandRange& limit = model.rig->command_limit[i];
    model::AxisMode& axis = loop.mode.axis[i];
    const double raw = axes.command.raw[i];
    const double push = model::integral_rate(loop.law(), i, z, reference);
    axis.command_factor = 0;
    axis.set_command = std::clamp(raw, limit.low, limit.high);
    axis.integrate = share(raw, limit.low, limit.high, push, width * limit.high);
  }
}
void smooth(const model::Model& model, model::CoupledLoop<>& loop, double t, const double* z,
            double width) {
  using Layout = model::CoupledLoop<>::Layout;
  const auto in = loop.inputs(t);
  const auto now = loop.balance(in, z);
  const auto axes = loop.loop.axes(in, z);
  for (int i = 0; i < 2; ++i) {
    const double rate = z[Layout::rate + i], most = model.dry->torque_limit;
    const double high = std::min(most, model.dry->by_voltage(1, rate));
    const double low = std::max(-most, model.dry->by_voltage(-1, rate));
    const double push = loop.motor.from_integral * (axes.command.value[i] - z[Layout::angle + i]);
    model::MotorMode& motor = loop.motors[i];
    motor.factor = 0;
    motor.set = std::clamp(now.asked[i], low, high);
    motor.integrate = share(now.asked[i], low, high, push, width * most);
  }
}

// States at the rows' times, with the classical Runge-Kutta method in steps of at most `step`.
template <class System>
std::vector<std::vector<double>> smoothed(const model::Model& model, const OutputTimes& times,
                                          double width, double step) {
  System system = std::get<System>(model.system);
  std::vector<double> z = model.initial, stage = z, sum = z;
  std::vector<double> dz(z.size());
  const solve::OutputGrid grid(times);
  std::vector<std::vector<double>> rows{z};
  for (std::size_t row = 1; row < grid.size(); ++row) {
    const double from = grid[row - 1], all = grid[row] - from;
    const int steps = static_cast<int>(std::ceil(all / step));
    const double h = all / steps;
    for (int k = 0; k < steps; ++k) {
      const double t = from + k * h;
      sum = z;
      const double after[] = {0, 0.5, 0.5, 1}, weight[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
      for (int s = 0; s < 4; ++s) {
        for (std::size_t i = 0; i < z.size(); ++i) stage[i] = z[i] + after[s] * h * dz[i] * (s > 0);
        smooth(model, system, t + after[s] * h, stage.data(), width);
        model::derivative(system, t + after[s] * h, stage.data(), dz.data());
        for (std::size_t i = 0; i < z.size(); ++i) sum[i] += weight[s] * h * dz[i];
      }
      z = sum;
    }
    rows.push_back(z);
  }
  return rows;
}

std::vector<std::vector<double>> smoothed(const model::Model& model, const OutputTimes& times,
                                          double width) {
  // The smoothed integral settles within a time of width / push, some 0.02 s times the width.
  const double step = 0.02 * width;
  return std::holds_alternative<model::RigLoop<true>>(model.system)
             ? smoothed<model::RigLoop<true>>(model, times, width, step)
             : smoothed<model::CoupledLoop<>>(model, times, width, step);
}

// A position loop in a row: its error, and its integral from what the motor was asked for.
struct LoopRow {
  double error, integral, rate, command, beyond;  // the demand minus the actual torque
};
LoopRow loop_row(const Run& run, const Scenario& scene, std::size_t row, std::size_t axis) {
  const PositionLoop& loop = *scene.gimbal.motor->position_loop;
  const model::Sample& now = run.samples[row];
  const double angle = axis == 0 ? now.gimbal.phi : now.gimbal.theta;
  const double rate = axis == 0 ? now.gimbal.phi_dot : now.gimbal.theta_dot;
  const double error = now.command[axis] - angle, asked = now.coupled->asked[axis];
  return {error, (asked - loop.kp * error + loop.kd * rate) / loop.ki, rate, now.command[axis],
          asked - now.coupled->given[axis]};
}

}  // namespace

TEST_CASE("a run whose integral waits at a limit is the limit of the smoothed law") {
  const Method method = GENERATE(Method::radau, Method::bdf);
  for (const SceneCase& one : scene_cases()) {
    if (!one.waits) continue;
    CAPTURE(one.what, int(method));
    const Scenario scene = load(one);
    const Run run = whole_run(scene, method, {1e-10, 1e-12});
    CHECK(run.outcome.statistics.steps < 20000);
    const model::Model model = model::assemble(scene, false);
    const auto wide = smoothed(model, scene.time, 2e-3), narrow = smoothed(model, scene.time, 1e-3);
    double own = 0, apart = 0;
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      const double at[] = {run.samples[i].ball.x, run.samples[i].ball.y};
      for (std::size_t k = 0; k < 2; ++k) {
        own = largest_finite(own, {std::abs(narrow[i][k] - wide[i][k])});
        apart = largest_finite(apart, {std::abs(2 * narrow[i][k] - wide[i][k] - at[k])});
      }
    }
    CAPTURE(own, apart);
    CHECK(own > 1e-8);  // it waits at some time
    // Extrapolation removes the error linear in the width. The rest falls faster, but not by much
    // if a command leaves its limit tangentially.
    CHECK(apart < 0.5 * own);
  }
}

TEST_CASE("the integral of a position loop moves no faster than its error, in rows too") {
  const char* const sampling = GENERATE("", "  sampling: {period: 0.00781}\n");
  CAPTURE(sampling);
  const std::string text =
      R"(ball: {radius: 0.01, mass: 0.045, position: [0.084, -0.096], velocity: [0.192, -0.143]}
plate: {inertia: [0.0097, 0.0094, 0.013]}
gimbal: {motor: {position_loop: {kp: 3.28, kd: 0.171, ki: 59.7}, torque_limit: 0.0566}}
controller:
  pd: {kv: [[0.19, -0.068], [-0.087, -0.193]], kp: [[0.099, -0.017], [-0.045, -0.115]]}
  drives: angle
  reference: {point: [0.0036, 0.075]}
time: {end: 1, step: 0.0005}
)";
  std::string with = text;
  with.insert(with.find("time:"), sampling);
  const Scenario scene = test::parse(with);
  const Run run = whole_run(scene, Method::radau, {1e-9, 1e-11});
  double most = 0, steepest = 0;
  for (std::size_t row = 1; row < run.samples.size(); ++row) {
    const double dt = run.samples[row].t - run.samples[row - 1].t;
    for (const std::size_t axis : {0U, 1U}) {
      const LoopRow from = loop_row(run, scene, row - 1, axis),
                    to = loop_row(run, scene, row, axis);
      // Between two rows the error is at most the larger of the two plus the change by the command.
      const double error = std::max(std::abs(from.error), std::abs(to.error)) +
                           std::max(std::abs(from.rate), std::abs(to.rate)) * dt +
                           std::abs(to.command - from.command);
      most = largest_finite(most, {std::abs(to.integral - from.integral) / (error * dt)});
      steepest = largest_finite(steepest, {std::abs(run.samples[row].coupled->asked[axis])});
    }
  }
  CHECK(steepest > 0.0566);  // the motors are asked for more than they can give
  CHECK(most < 1.01);        // rates change between rows by at most 1 %
}

TEST_CASE(
    "an integral waits while its error drives outward, also where a motor turns too fast to brake "
    "less") {
  // At rest the voltage gives 0.0019 N m; at 1.2 rad/s it draws at least 0.022 N m. The motor then
  // always gives its limit, so the two limits of the demand coincide.
  const Scenario scene = test::parse(
      R"(ball: {radius: 0.0067, mass: 0.035, position: [-0.04, -0.024]}
plate: {inertia: [0.00069, 0.00052, 0.00108]}
gimbal:
  motor:
    position_loop: {kp: 0.125, kd: 0.02, ki: 0.16}
    torque_limit: 0.0022
    dc: {resistance: 2, torque_constant: 0.02, gear: 10, voltage_limit: 0.019}
  start: {phi: -0.044, theta: 0.018, theta_rate: -1.2}
controller:
  pd: {kv: [[0.38, 0], [0, -0.38]], kp: [[0.4, 0], [0, -0.4]]}
  drives: angle
  reference: {point: [0.02, 0.03]}
time: {end: 0.4, step: 0.0001}
)");
  const Run run = whole_run(scene, Method::radau, {1e-10, 1e-12});
  const double from_rate = 0.2 * 0.2 / 2, stall = 0.2 * 0.019 / 2;
  const auto overruns = [&](const LoopRow& at) {
    return std::abs(at.rate) * from_rate - stall > 0.0022;
  };
  double apart = 0;
  int waits = 0, moves = 0;
  for (std::size_t row = 1; row < run.samples.size(); ++row) {
    for (const std::size_t axis : {0U, 1U}) {
      const LoopRow from = loop_row(run, scene, row - 1, axis),
                    to = loop_row(run, scene, row, axis);
      // Two rows in the same mode have no switch between them.
      const bool alike = overruns(from) && overruns(to) && from.beyond * to.beyond > 0 &&
                         from.error * to.error > 0;
      if (!alike) continue;
      const bool outward = from.beyond * from.error > 0;
      ++(outward ? waits : moves);
      const double dt = run.samples[row].t - run.samples[row - 1].t;
      const double moved = outward ? 0.0 : (from.error + to.error) / 2 * dt;
      apart = largest_finite(apart, {std::abs(to.integral - from.integral - moved)});
    }
  }
  CHECK(waits > 100);
  CHECK(moves > 100);
  CHECK(apart < 1e-9);  // relative to some 1e-6 between rows; the trapezoidal error is 1e-10
}

TEST_CASE("at a limit, the waiting rest and the error's rate determine how a command continues") {
  using model::AtLimit;
  using model::OutwardRate;
  CHECK(OutwardRate{1, 1}.at_limit() == AtLimit::beyond);
  CHECK(OutwardRate{1, -0.5}.at_limit() == AtLimit::beyond);  // and its integral returns
  CHECK(OutwardRate{1, -2}.at_limit() == AtLimit::within);
  CHECK(OutwardRate{-1, 2}.at_limit() == AtLimit::along);
  CHECK(OutwardRate{-1, 0.5}.at_limit() == AtLimit::within);
  CHECK(OutwardRate{-1, -1}.at_limit() == AtLimit::within);
}

}  // namespace bbsim_test::test_integral_limit
