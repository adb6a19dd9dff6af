// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Derivatives of runs with respect to keys: closed forms, differences of quad-precision solutions
// and differences of runs, including sampled controllers.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "api/run.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/quad.hpp"
#include "catch.hpp"
#include "model/model.hpp"
#include "scenario/reader.hpp"
#include "study/reference.hpp"
#include "support/run_in_memory.hpp"

using namespace bbsim;

namespace {

using Overrides = std::vector<std::string>;

std::string file_of(const std::string& name) {
  return name.find('/') == std::string::npos ? bbsim_test::data_file("scenarios/" + name + ".yaml")
                                             : BBSIM_SOURCE_DIR "/" + name + ".yaml";
}

api::RunResult run(const std::string& name, const Overrides& overrides, const Overrides& keys,
                   const Overrides& measures = {}) {
  api::RunRequest request{read_scenario(file_of(name), overrides)};
  request.sensitivity = keys;
  request.measures = measures;
  api::Watch watch;
  return api::run(request, watch);
}

const std::vector<double>& column(const api::RunResult& made, const std::string& name) {
  INFO(name);
  const auto at = std::ranges::find(made.rows.names, name);
  REQUIRE(at != made.rows.names.end());
  return made.rows.columns[static_cast<std::size_t>(at - made.rows.names.begin())];
}

std::string gradient_name(const std::string& of, const std::string& key) {
  return "d(" + of + ")/d(" + key + ")";
}

double gradient(const api::RunResult& made, const std::string& measure, const std::string& key) {
  for (const auto& [name, by_key] : made.summary.gradients) {
    if (name != measure) continue;
    for (const auto& [one, value] : by_key) {
      if (one == key) return value;
    }
  }
  FAIL("no gradient of " << measure << " by " << key);
  return 0;
}

// Fourth-order central differences of the quad-precision solution. `change` is a power of two, so
// that the key's values are exact doubles.
struct Difference {
  std::vector<std::string> states;
  std::vector<std::vector<double>> of;  // a number per state and row
};

Difference quad_difference(const std::string& name, const Overrides& overrides,
                           const std::string& key, double value, double change) {
  Difference difference;
  const std::vector<std::pair<int, double>> weights = {
      {-2, 1.0 / 12}, {-1, -2.0 / 3}, {1, 2.0 / 3}, {2, -1.0 / 12}};
  std::vector<std::vector<Quad>> sums;
  for (const auto& [offset, weight] : weights) {
    Overrides with = overrides;
    with.push_back(key + "=" + number_text(value + offset * change));
    const Scenario scenario = read_scenario(file_of(name), with);
    const model::Model model = model::assemble(scenario, false, model::Form::full);
    const solve::OutputGrid grid(scenario.time);
    const study::ReferenceSolution solution = study::solve_reference(model, grid);
    REQUIRE(solution.complete);
    difference.states = model.state_names();
    sums.resize(solution.row_size, std::vector<Quad>(solution.rows(), Quad(0.0)));
    for (std::size_t row = 0; row < solution.rows(); ++row) {
      for (std::size_t i = 0; i < solution.row_size; ++i) {
        sums[i][row] = sums[i][row] + Quad(weight / change) * solution.row(row)[i];
      }
    }
  }
  for (const std::vector<Quad>& sum : sums) {
    std::vector<double>& plain_sum = difference.of.emplace_back();
    for (const Quad& one : sum) plain_sum.push_back(plain(one));
  }
  return difference;
}

double largest_size(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

const std::string tight_rtol = "solver.rtol=1e-13", tight_atol = "solver.atol=1e-15";

}  // namespace

TEST_CASE("derivatives on an incline agree with the closed form", "[sensitivity]") {
  // x = (5/14) g sin(phi) t^2
  const std::string time = "find x at 1.25";
  const auto made =
      run("configs/incline", {"ball.position=[0, 0]", "output.columns=[t, x, y, vx, phi, spin]"},
          {"gravity, ball.position.1", "ball.radius"},
          {"end_x", "rms_x", "max_vx", "when x=0.1", time});
  REQUIRE(made.code == ExitCode::done);
  const double g = 9.80665, slope = 5.0 / 14 * std::sin(5 * std::numbers::pi / 180);
  const std::vector<double>& t = column(made, "t");
  const auto by = [&](const char* of, const char* key) -> const std::vector<double>& {
    return column(made, gradient_name(of, key));
  };
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double end = slope * 4;  // value at the end of 2 s
    CHECK(by("x", "gravity")[i] == Approx(slope * t[i] * t[i]).margin(1e-12 * end));
    CHECK(by("vx", "gravity")[i] == Approx(2 * slope * t[i]).margin(1e-12 * end));
    CHECK(std::abs(by("phi", "gravity")[i]) < 1e-12);
    CHECK(std::abs(by("x", "ball.radius")[i]) < 1e-12);
    // The reduced system has no y, so the run uses the full one.
    CHECK(by("y", "ball.position.1")[i] == Approx(1));
    CHECK(std::abs(by("x", "ball.position.1")[i]) < 1e-12);
  }
  CHECK(gradient(made, "end_x", "gravity") == Approx(slope * 4).epsilon(1e-9));
  CHECK(gradient(made, "max_vx", "gravity") == Approx(slope * 4).epsilon(1e-9));
  CHECK(gradient(made, time, "gravity") == Approx(slope * 1.25 * 1.25).epsilon(1e-9));
  CHECK(gradient(made, "rms_x", "gravity") ==
        Approx(std::find_if(made.summary.measures.begin(), made.summary.measures.end(),
                            [](const auto& one) { return one.first == "rms_x"; })
                   ->second /
               g)
            .epsilon(1e-9));
  // t = sqrt(x / (slope g)). Crossings are found to about 1e-12 s.
  const std::string when = made.summary.measures[3].first;
  CHECK(gradient(made, when, "gravity") ==
        Approx(-std::sqrt(0.1 / (slope * g)) / (2 * g)).epsilon(1e-7));
}

TEST_CASE("a key that the paper's equation lacks gives the run the general one", "[sensitivity]") {
  // x = g sin(phi) t^2 / (2 (1 + k)), at k = 0.4
  const auto made = run("configs/incline", {"ball.position=[0, 0]", "output.columns=[t, x]"},
                        {"ball.inertia_factor"}, {"end_x"});
  REQUIRE(made.code == ExitCode::done);
  const std::vector<double>& x = column(made, "x");
  const std::vector<double>& by = column(made, gradient_name("x", "ball.inertia_factor"));
  for (std::size_t i = 0; i < x.size(); ++i) {
    CHECK(by[i] == Approx(-x[i] / 1.4).margin(1e-12 * std::abs(x.back())));
  }
  // A closed loop, compared with runs at nearby values.
  const auto end = [](const std::string& k) {
    return column(run("configs/fig2b",
                      {"ball.inertia_factor=" + k, tight_rtol, tight_atol, "time.end=5"}, {}, {}),
                  "x")
        .back();
  };
  const auto loop = run("configs/fig2b", {tight_rtol, tight_atol, "time.end=5"},
                        {"ball.inertia_factor", "gimbal.mounting.skew"}, {});
  CHECK(column(loop, "x").back() == Approx(end("0.4")).epsilon(1e-11));
  CHECK(column(loop, gradient_name("x", "ball.inertia_factor")).back() ==
        Approx((end("0.4001") - end("0.3999")) / 2e-4).epsilon(1e-6));
}

TEST_CASE("derivatives agree with quad-precision solutions", "[sensitivity]") {
  struct Case {
    std::string scene;
    Overrides overrides;
    std::string key;
    double value;
  };
  const std::vector<Case> cases = {
      {"fig2a", {"time.end=4"}, "ball.radius", 0.01},
      {"fig2a", {}, "gimbal.motion.phi.sinusoid.frequency", 1},
      {"fig2a", {"time.end=4"}, "ball.position.0", 0},
      {"spin", {"time.end=4"}, "ball.spin", 50},
      {"spin", {"time.end=4"}, "gimbal.motion.phi.sinusoid.phase", std::numbers::pi / 2},
      {"fig2b", {"time.end=4"}, "gravity", 9.81},
      {"fig2b", {"time.end=4"}, "controller.pd.kv.0.1", 0},
      {"fig2b", {"time.end=4"}, "controller.reference.circle.rate", -0.3},
      {"stiff-servo", {"time.end=2"}, "gimbal.servo.natural_frequency", 2000},
      {"torque-open", {}, "gimbal.motor.viscous", 0.02},
  };
  for (const Case& one : cases) {
    CAPTURE(one.scene, one.key);
    Overrides overrides = one.overrides;
    overrides.insert(overrides.end(),
                     {tight_rtol, tight_atol,
                      "output.columns=[t, x, y, vx, vy, phi, theta, phi_rate, theta_rate]"});
    const auto made = run(one.scene, overrides, {one.key});
    REQUIRE(made.code == ExitCode::done);
    const double size = one.value == 0 ? 1 : std::abs(one.value);
    const double change = std::exp2(std::floor(std::log2(size)) - 12);
    const Difference exact = quad_difference(one.scene, overrides, one.key, one.value, change);
    double largest = 0;
    for (std::size_t i = 0; i < exact.states.size(); ++i) {
      const std::string name = gradient_name(exact.states[i], one.key);
      if (std::ranges::find(made.rows.names, name) == made.rows.names.end()) continue;  // r*spin
      const std::vector<double>& found = column(made, name);
      REQUIRE(found.size() == exact.of[i].size());
      const double scale = largest_size(exact.of[i]);
      largest = std::max(largest, scale);
      double apart = 0;
      for (std::size_t row = 0; row < found.size(); ++row) {
        apart = std::max(apart, std::abs(found[row] - exact.of[i][row]));
      }
      CAPTURE(name, scale, apart);
      // Components that symmetry keeps at zero may have rounding errors beyond the relative bound.
      CHECK(apart <= 1e-9 * scale + 1e-13);
    }
    CHECK(largest > 0);
  }
}

namespace {

// A key of a scene, its value, and a change that is small for the smooth parts.
struct Beside {
  std::string scene;
  Overrides overrides;
  std::string key;
  double value, change;
};

// The runs at value - 2 change, ..., value + 2 change.
std::vector<api::RunResult> runs_beside(const Beside& one, const Overrides& overrides,
                                        const Overrides& measures = {}) {
  std::vector<api::RunResult> beside;
  for (const int offset : {-2, -1, 1, 2}) {
    Overrides with = overrides;
    with.push_back(one.key + "=" + number_text(one.value + offset * one.change));
    beside.push_back(run(one.scene, with, {}, measures));
  }
  return beside;
}

double fourth_order_difference(double a, double b, double c, double d, double change) {
  return (8 * (c - b) - (d - a)) / (12 * change);
}

// Quantization has no derivative. Rows, samples, exposures and commands are at different instants,
// because differences at a moving instant mix both its sides.
const Overrides plain_rig = {"controller.sensor.resolution=0", "controller.sampling.resolution=0",
                             "gimbal.servo.dead_band=0",       "controller.sampling.delay=6.9 ms",
                             "controller.sensor.delay=8.3 ms", "time.end=3"};

Overrides operator+(Overrides a, const Overrides& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Compares derivatives of all states with differences of runs at nearby values.
void require_runs_beside(const Beside& one) {
  CAPTURE(one.scene, one.key, one.overrides);
  const Overrides states = {"x", "y", "vx", "vy", "spin", "phi", "theta", "phi_rate", "theta_rate"};
  const Overrides overrides =
      Overrides{tight_rtol, tight_atol,
                "output.columns=[t, x, y, vx, vy, spin, phi, theta, phi_rate, theta_rate]"} +
      one.overrides + Overrides{one.key + "=" + number_text(one.value)};
  const auto made = run(one.scene, overrides, {one.key});
  REQUIRE(made.code == ExitCode::done);
  const auto beside = runs_beside(one, overrides);
  double largest = 0;
  for (const std::string& state : states) {
    const std::vector<double>& found = column(made, gradient_name(state, one.key));
    double scale = 0, apart = 0;
    for (std::size_t row = 0; row < found.size(); ++row) {
      const auto at = [&](std::size_t i) { return column(beside[i], state)[row]; };
      const double expected = fourth_order_difference(at(0), at(1), at(2), at(3), one.change);
      scale = std::max(scale, std::abs(expected));
      apart = std::max(apart, std::abs(found[row] - expected));
    }
    largest = std::max(largest, scale);
    CAPTURE(state, scale, apart);
    // Runs are accurate to some 1e-13 of the state, which the difference divides by the change.
    CHECK(apart <= 1e-6 * scale + 1e-13 * largest_size(column(made, state)) / one.change);
  }
  CHECK(largest > 0);
}

// Compares gradients of measures with differences of runs at nearby values.
void require_gradients_beside(const Beside& one, const Overrides& measures) {
  const Overrides overrides = one.overrides + Overrides{tight_rtol, tight_atol};
  const auto made = run(one.scene, overrides, {one.key}, measures);
  const auto beside = runs_beside(one, overrides, measures);
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const auto& [name, value] = made.summary.measures[m];
    CAPTURE(one.key, name, one.overrides);
    const auto at = [&](std::size_t i) { return beside[i].summary.measures[m].second; };
    CHECK(gradient(made, name, one.key) ==
          Approx(fourth_order_difference(at(0), at(1), at(2), at(3), one.change))
              .epsilon(1e-6)
              .margin(1e-11 * std::abs(value) / one.change));
  }
}

}  // namespace

TEST_CASE("derivatives through a sampled controller agree with differences", "[sensitivity]") {
  const Overrides frames = {"controller.sensor.period=27 ms", "controller.sensor.phase=0.0031"};
  const Overrides turned = {"controller.sensor.rotation=0.05", "controller.sensor.scale=[1.02, 1]",
                            "controller.sensor.dropout=0.1"};
  const Overrides jitter = {"controller.sampling.jitter=0.001", "time.step=19.77 ms"};
  const Overrides first_order = {"gimbal.servo={time_constant: 0.04}"};
  const Overrides slow = {"gimbal.servo.rate_limit=0.1"};
  const Overrides pid = {"controller.sensor.resolution=0", "controller.limit=0.03", "time.end=3"};
  const Overrides lqr = {"controller.sensor.resolution=0", "gimbal.servo.acceleration_limit=40",
                         "gimbal.servo.rate_limit=1", "time.end=2"};
  const Overrides unrounded = {"controller.sensor.resolution=0", "controller.sampling.resolution=0",
                               "controller.sampling.delay=6.9 ms", "time.end=2"};
  const Overrides plain_linkage =
      unrounded + Overrides{"gimbal.servo.backlash=0", "gimbal.servo.dead_band=0",
                            "controller.sensor.noise=0", "controller.sensor.phase=7.1 ms"};
  const Overrides plain_legs = unrounded + Overrides{"controller.sensor.delay=8.3 ms"};
  const std::string rig = "configs/rig", law = "controller.gravity_compensation.";
  const std::vector<Beside> cases = {
      {rig, plain_rig, "ball.radius", 0.02, 0x1p-14},
      {rig, plain_rig, "ball.inertia_factor", 0.4, 0x1p-9},
      {rig, plain_rig, "ball.position.0", 0.05, 0x1p-13},
      {rig, plain_rig, "gravity", 9.81, 0x1p-6},
      {rig, plain_rig, law + "kp", 10, 0x1p-5},
      {rig, plain_rig, law + "kv", 8, 0x1p-5},
      {rig, plain_rig, "gimbal.servo.natural_frequency", 30, 0x1p-4},
      {rig, plain_rig, "controller.reference.circle.radius", 0.05, 0x1p-13},
      {rig, plain_rig, "controller.reference.circle.rate", -0.3, 0x1p-10},
      {rig, plain_rig, "controller.sampling.derivative_filter", 0.03, 0x1p-12},
      {rig, plain_rig, "controller.sampling.delay", 0.0069, 0x1p-15},
      {rig, plain_rig, "controller.sampling.period", 0.02, 0x1p-20},
      {rig, plain_rig, "controller.sensor.delay", 0.0083, 0x1p-15},
      {rig, plain_rig + frames, "controller.sensor.phase", 0.0031, 0x1p-20},
      {rig, plain_rig + frames, "controller.sensor.period", 0.027, 0x1p-22},
      {rig, plain_rig + turned, "controller.sensor.rotation", 0.05, 0x1p-13},
      {rig, plain_rig + turned, "controller.sensor.scale.0", 1.02, 0x1p-13},
      {rig, plain_rig + jitter, "controller.sampling.jitter", 0.001, 0x1p-20},
      {rig, plain_rig + slow, "gimbal.servo.rate_limit", 0.1, 0x1p-16},
      {rig, plain_rig + slow, "controller.sampling.delay", 0.0069, 0x1p-18},
      {rig, plain_rig + first_order, "gimbal.servo.time_constant", 0.04, 0x1p-12},
      {rig, plain_rig + first_order, "controller.sampling.delay", 0.0069, 0x1p-15},
      {rig, plain_rig + Overrides{"gimbal.servo.dead_band=0.1 deg"}, "gravity", 9.81, 0x1p-18},
      {"configs/step", pid, "controller.pid.ki.0.0", 0.35, 0x1p-10},
      {"configs/step", pid, "controller.limit", 0.03, 0x1p-17},
      {"configs/step", pid, "gimbal.mounting.phi_offset", 0.0122, 0x1p-14},
      {"configs/catch", lqr, "controller.lqr.position", 60, 0x1p-3},
      {rig, plain_rig + Overrides{"ball.mass=0.03", "ball.losses.viscous=1e-5"},
       "ball.losses.viscous", 1e-5, 0x1p-26},
      {"configs/pushrod", plain_linkage, "ball.radius", 0.02, 0x1p-20},
      {"configs/pushrod", plain_linkage, "gimbal.linkage.horn", 0.024, 0x1p-20},
      {"configs/pushrod", plain_linkage, "gimbal.linkage.arm", 0.06, 0x1p-19},
      {"configs/pushrod", plain_linkage, law + "kp", 5, 0x1p-12},
      {"configs/pushrod", plain_linkage, "controller.sampling.delay", 0.0069, 0x1p-22},
      {"configs/three-servos", plain_legs, "gravity", 9.81, 0x1p-11},
      {"configs/three-servos", plain_legs, "gimbal.three_servos.rod", 0.1, 0x1p-18},
      {"configs/three-servos", plain_legs, "controller.sampling.delay", 0.0069, 0x1p-22},
      {"configs/catch", lqr, "gimbal.servo.acceleration_limit", 40, 0x1p-4},
      {"configs/catch", lqr, "gimbal.servo.rate_limit", 1, 0x1p-10},
  };
  for (const Beside& one : cases) require_runs_beside(one);
}

TEST_CASE("derivatives across switches agree with differences of runs", "[sensitivity]") {
  const Overrides slide = {"events.slip={friction: 0.1, sliding_friction: 0.08, action: slide}",
                           "time.end=0.5"};
  const Overrides voltage = {"gimbal.motor.dc.voltage_limit=0.15", "time.end=8"};
  const Overrides torque = {"gimbal.motor.torque_limit=0.02",
                            "gimbal.motor.position_loop={kp: 4, kd: 0.12, ki: 2}", "time.end=8"};
  // A circle that the plate can only follow at its limits.
  const auto circle = [](const std::string& servo, const std::string& rest = {}) {
    return Overrides{"gimbal={servo: {natural_frequency: 30, damping: 0.8" + servo + "}}",
                     "controller={gravity_compensation: {kp: 6, kv: 5}, drives: angle, "
                     "reference: {circle: {radius: 0.05, rate: -2}}" +
                         rest + "}",
                     "time.end=4"};
  };
  const Overrides stop = circle(", angle_limit: 0.02"), gap = circle(", backlash: 0.01"),
                  slow = circle(", rate_limit: 0.1, acceleration_limit: 4"),
                  limit = circle("", ", limit: 0.02");
  const Overrides curve =
      circle("") + Overrides{"gimbal.linkage={table: {file: " + bbsim_test::data_file("curve.csv") +
                             ", servo: alpha, plate: beta, unit: deg}}"};
  const std::string law = "controller.gravity_compensation.", slip = "events.slip.";
  const std::vector<Beside> cases = {
      // Pivoting friction, sliding, rolling, and rest.
      {"configs/slides", {"events.rest=note", "time.end=5"}, "ball.radius", 0.026, 0x1p-20},
      {"configs/slides", {"events.rest=note", "time.end=5"}, "gravity", 9.81, 0x1p-11},
      // Rest, and the start of a motion.
      {"configs/rolls-to-rest", {}, "ball.radius", 0.02, 0x1p-20},
      {"configs/rolls-to-rest", {}, "gravity", 9.81, 0x1p-11},
      // Rolling becomes sliding.
      {"configs/slips", slide, "gravity", 9.81, 0x1p-11},
      {"configs/slips", slide, slip + "friction", 0.1, 0x1p-18},
      {"configs/slips", slide, slip + "sliding_friction", 0.08, 0x1p-18},
      {"configs/slips", slide, "ball.position.0", 0.03, 0x1p-19},
      // Motors with dry friction and limits.
      {"configs/sags", {"time.end=8"}, "gimbal.motor.friction", 0.002, 0x1p-23},
      {"configs/sags", torque, "gimbal.motor.torque_limit", 0.02, 0x1p-20},
      {"configs/sags", torque, "ball.mass", 0.1, 0x1p-18},
      {"configs/sags", voltage, "gimbal.motor.dc.voltage_limit", 0.15, 0x1p-17},
      // Servos.
      {"fig2b", stop, "gimbal.servo.angle_limit", 0.02, 0x1p-20},
      {"fig2b", stop, "ball.radius", 0.01, 0x1p-21},
      {"fig2b", slow, "gimbal.servo.rate_limit", 0.1, 0x1p-18},
      {"fig2b", slow, "gimbal.servo.acceleration_limit", 4, 0x1p-12},
      {"fig2b", gap, "gimbal.servo.backlash", 0.01, 0x1p-21},
      {"fig2b", gap, law + "kp", 6, 0x1p-12},
      {"fig2b", limit, "controller.limit", 0.02, 0x1p-20},
      // Across the pieces of a measured curve.
      {"fig2b", curve, "ball.radius", 0.01, 0x1p-21},
  };
  for (const Beside& one : cases) require_runs_beside(one);
}

TEST_CASE("gradients of measures across switches agree with differences of runs", "[sensitivity]") {
  require_gradients_beside(
      {"configs/slides", {"events.rest=note", "time.end=5"}, "gravity", 9.81, 0x1p-11},
      {"rms_x", "max_x", "end_y", "max_friction_demand"});
}

TEST_CASE("gradients of measures of a sampled rig agree with differences", "[sensitivity]") {
  const Overrides measures = {"max_tilt", "rms_x",  "rms_phi_command",          "end_theta_command",
                              "x.Peak",   "end_vy", "rms_tracking_error from 1"};
  // Keys that move the instants of commands, also if the servos' rates jump with them.
  for (const Overrides& servo : {Overrides{}, Overrides{"gimbal.servo={time_constant: 0.04}"}}) {
    const Overrides rig = plain_rig + servo + Overrides{"time.end=3.01"};
    for (const Beside& one :
         {Beside{"configs/rig", rig, "ball.radius", 0.02, 0x1p-16},
          Beside{"configs/rig", rig, "controller.sampling.delay", 0.0069, 0x1p-17},
          Beside{"configs/rig", rig, "controller.sampling.period", 0.02, 0x1p-23}}) {
      require_gradients_beside(one, measures);
    }
  }
}

TEST_CASE("derivatives pass through quantization", "[sensitivity]") {
  const Overrides fine = {"controller.sensor.resolution=1e-9",
                          "controller.sampling.resolution=1e-9"};
  const auto rounded = run("configs/rig", plain_rig + fine, {"gravity"});
  const auto plain = run("configs/rig", plain_rig, {"gravity"});
  const std::string name = gradient_name("y", "gravity");
  const std::vector<double>&one = column(rounded, name), &other = column(plain, name);
  const double scale = largest_size(other);
  for (std::size_t row = 0; row < other.size(); ++row) {
    CHECK(one[row] == Approx(other[row]).margin(1e-5 * scale));
  }
  // Also unchanged: with its quantization, noise and dead band.
  CHECK(run("configs/rig", {"time.end=5"}, {"gravity"}).code == ExitCode::done);
}

TEST_CASE("gradients of measures agree with differences of runs", "[sensitivity]") {
  const Overrides measures = {"max_tilt", "rms_x",         "max_tracking_error",
                              "x.Peak",   "find y at 1.5", "rms_tracking_error from 1",
                              "min_x"};
  const Overrides base = {tight_rtol, tight_atol, "time.end=3"};
  const std::vector<std::pair<std::string, double>> keys = {
      {"controller.pd.kv.0.0", 1}, {"ball.radius", 0.01}, {"gimbal.servo.damping", 1}};
  const auto made =
      run("fig2b", base, {"controller.pd.kv.0.0,ball.radius,gimbal.servo.damping"}, measures);
  for (const auto& [key, value] : keys) {
    const double change = value * 0x1p-11;
    std::vector<record::RunSummary::Numbers> beside;
    for (const int offset : {-2, -1, 1, 2}) {
      Overrides with = base;
      with.push_back(key + "=" + number_text(value + offset * change));
      beside.push_back(run("fig2b", with, {}, measures).summary.measures);
    }
    for (std::size_t m = 0; m < made.summary.measures.size(); ++m) {
      const auto& [name, at] = made.summary.measures[m];
      CAPTURE(key, name);
      const double expected = (8 * (beside[2][m].second - beside[1][m].second) -
                               (beside[3][m].second - beside[0][m].second)) /
                              (12 * change);
      // Extremes are accurate to a relative 1e-12 or so.
      CHECK(gradient(made, name, key) ==
            Approx(expected).epsilon(1e-6).margin(1e-11 * std::abs(at) / change));
    }
  }
}

TEST_CASE("if an event stops the run, the measures' end moves with the key", "[sensitivity]") {
  // The ball leaves the plate at x = size / 2 with vx = sqrt(a size), a = (5/7) g sin(phi).
  const auto made = run("configs/incline",
                        {"plate.size=[0.4, 0.4]", "events.edge=stop", "output.columns=[t, x]",
                         tight_rtol, tight_atol},
                        {"gravity,plate.size.0"}, {"end_vx", "max_x", "max_vx"});
  REQUIRE(made.summary.status == "stopped");
  const double a = 5.0 / 7 * 9.80665 * std::sin(5 * std::numbers::pi / 180);
  const double end = std::sqrt(a * 0.4);
  CHECK(made.summary.measures[0].second == Approx(end));
  CHECK(gradient(made, "end_vx", "gravity") == Approx(end / (2 * 9.80665)).epsilon(1e-9));
  CHECK(gradient(made, "max_vx", "gravity") == Approx(end / (2 * 9.80665)).epsilon(1e-9));
  CHECK(gradient(made, "end_vx", "plate.size.0") == Approx(end / 0.8).epsilon(1e-9));
  CHECK(gradient(made, "max_x", "plate.size.0") == Approx(0.5).epsilon(1e-9));
  CHECK(std::abs(gradient(made, "max_x", "gravity")) < 1e-10);
  // The plate's edge does not affect the rows.
  for (const double one : column(made, gradient_name("x", "plate.size.0"))) CHECK(one == 0);
}

TEST_CASE("rows with derivatives equal those without", "[sensitivity]") {
  const auto with = run("fig2b", {}, {"ball.radius"}, {"max_tilt"});
  const auto without = run("fig2b", {}, {}, {"max_tilt"});
  CHECK(with.summary.measures == without.summary.measures);
  CHECK(without.summary.gradients.empty());
  for (const char* name : {"t", "x", "y"}) {
    if (std::ranges::find(without.rows.names, name) == without.rows.names.end()) continue;
    CHECK(column(with, name) == column(without, name));
  }
}

TEST_CASE("keys and scenes without derivatives are refused", "[sensitivity]") {
  const auto message = [](const std::string& name, const Overrides& overrides,
                          const std::string& keys) {
    try {
      static_cast<void>(run(name, overrides, {keys}));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  const auto refuses = [&](const std::string& name, const std::string& key, const std::string& part,
                           const Overrides& overrides = {}) {
    const std::string said = message(name, overrides, key);
    CAPTURE(key, said);
    CHECK(said.find(part) != std::string::npos);
  };
  refuses("configs/pushrod", "ball.radius", "found with backlash");
  refuses("configs/rig", "ball.radius", "dry friction",
          {"ball.mass=0.03", "ball.losses.rolling=0.001"});
  refuses("configs/rig", "ball.radius", "backlash", {"gimbal.servo.backlash=0.5 deg"});
  refuses("configs/rig", "controller.sensor.noise", "rounding, noise");
  refuses("configs/rig", "gimbal.servo.dead_band", "a dead band");
  refuses("configs/rig", "ball.radius", "a servo reaches its stop",
          {"gimbal.servo.angle_limit=0.5 deg"});
  refuses("fig2a", "time.end", "a key of the computation");
  refuses("fig2a", "ball.radius,ball.radius", "is given twice");
  refuses("fig2a", "ball.raduis", "did you mean");
  refuses("fig2a", "gravity", "needs valid values", {"gravity=0"});
  refuses("fig2a", "ball.radius", "repeats the run", {"solver.error=1e-6"});
}
