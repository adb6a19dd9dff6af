// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `run --sensitivity` (api/run_sensitivity.cpp): derivatives against closed forms and exact
// numbers, and what is said where there is none.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "api/run.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "catch.hpp"
#include "scenario/reader.hpp"
#include "support/reading.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_sensitivity {

using namespace bbsim;

namespace {

using Texts = std::vector<std::string>;

Texts operator+(Texts a, const Texts& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string file_of(const std::string& name) {
  return name.find('/') == std::string::npos ? bbsim_test::data_file("scenarios/" + name + ".yaml")
                                             : BBSIM_SOURCE_DIR "/" + name + ".yaml";
}

api::RunResult run(Scenario scenario, const Texts& keys, const Texts& measures = {}) {
  api::RunRequest request{std::move(scenario)};
  request.sensitivity = keys;
  request.measures = measures;
  api::Watch watch;
  return api::run(request, watch);
}

api::RunResult run(const std::string& name, const Texts& overrides, const Texts& keys,
                   const Texts& measures = {}) {
  return run(read_scenario(file_of(name), overrides), keys, measures);
}

const std::vector<double>& column(const api::RunResult& made, const std::string& name) {
  INFO(name);
  const auto at = std::ranges::find(made.rows.names, name);
  REQUIRE(at != made.rows.names.end());
  return made.rows.columns[static_cast<std::size_t>(at - made.rows.names.begin())];
}

const std::vector<double>& derivative(const api::RunResult& made, const std::string& of,
                                      const std::string& key) {
  return column(made, "d(" + of + ")/d(" + key + ")");
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

// What is unreliable, each as "KEY COLUMN".
Texts unreliable(const api::RunResult& made) {
  Texts all;
  REQUIRE(made.summary.unreliable);
  for (const auto& one : *made.summary.unreliable) all.push_back(one.key + ' ' + one.column);
  return all;
}

bool is_said(const api::RunResult& made, const std::string& part) {
  return std::ranges::any_of(made.summary.warnings, [&](const std::string& warning) {
    return warning.find("unreliable") != std::string::npos &&
           warning.find(part) != std::string::npos;
  });
}

double largest_size(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

TEST_CASE("derivatives on an incline agree with the closed form", "[sensitivity]") {
  // x = (5/14) g sin(phi) t^2
  const std::string time = "find x at 1.25", factor = "ball.inertia_factor";
  const auto made =
      run("configs/incline", {"ball.position=[0, 0]", "output.columns=[t, x, y, vx, phi, spin]"},
          {"gravity, ball.position.1", "ball.radius", factor},
          {"end_x", "rms_x", "max_vx", "when x=0.1", time, "end_y"});
  REQUIRE(made.code == ExitCode::done);
  CHECK(unreliable(made).empty());
  const double g = 9.80665, slope = 5.0 / 14 * std::sin(5 * std::numbers::pi / 180);
  const std::vector<double>& t = column(made, "t");
  const std::vector<double>& x = column(made, "x");
  // Differences of runs that are accurate to 1e-13 of x, over 2^-12 of the key.
  constexpr double close = 1e-9;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double end = slope * 4;  // value at the end of 2 s
    CHECK(derivative(made, "x", "gravity")[i] == Approx(slope * t[i] * t[i]).margin(close * end));
    CHECK(derivative(made, "vx", "gravity")[i] == Approx(2 * slope * t[i]).margin(close * end));
    CHECK(std::abs(derivative(made, "phi", "gravity")[i]) < close);
    CHECK(std::abs(derivative(made, "x", "ball.radius")[i]) < close);
    // The system of the run has no y; that of its neighbors does.
    CHECK(derivative(made, "y", "ball.position.1")[i] == Approx(1));
    CHECK(std::abs(derivative(made, "x", "ball.position.1")[i]) < close);
    // x = g sin(phi) t^2 / (2 (1 + k)), at k = 0.4; the run itself has the paper's equation.
    CHECK(derivative(made, "x", factor)[i] == Approx(-x[i] / 1.4).margin(close * x.back()));
  }
  CHECK(gradient(made, "end_x", "gravity") == Approx(slope * 4).epsilon(close));
  CHECK(gradient(made, "end_x", factor) == Approx(-x.back() / 1.4).epsilon(close));
  CHECK(gradient(made, "max_vx", "gravity") == Approx(slope * 4).epsilon(close));
  CHECK(gradient(made, time, "gravity") == Approx(slope * 1.25 * 1.25).epsilon(close));
  CHECK(gradient(made, "end_y", "ball.position.1") == Approx(1).epsilon(close));
  CHECK(gradient(made, "rms_x", "gravity") == Approx(made.summary.measures[1].second / g));
  // t = sqrt(x / (slope g)). Crossings are found to about 1e-12 s.
  const std::string when = made.summary.measures[3].first;
  CHECK(gradient(made, when, "gravity") ==
        Approx(-std::sqrt(0.1 / (slope * g)) / (2 * g)).epsilon(1e-7));
}

namespace {

// A derivative in one row by bbsim 0.3, which integrated the equation of the derivatives with exact
// Jacobians and jumps at switches, at solver.rtol 1e-13. It agreed with differences of
// quad-precision solutions and with CVODES.
struct Exact {
  std::string scene;
  Texts overrides;
  std::string key, column;
  std::size_t row;
  double value;
};

// The gains of these scenarios in version 0.3, where they differ.
Texts gains_then(const std::string& scene) {
  if (scene != "configs/rig") return {};
  return {"controller.gravity_compensation={kp: 10, kv: 8}"};
}

// `close`: relative to the column's largest derivative.
void require_exact(const std::vector<Exact>& all, double close) {
  for (const Exact& one : all) {
    CAPTURE(one.scene, one.key, one.overrides);
    const auto made =
        run(one.scene,
            gains_then(one.scene) + one.overrides + Texts{"output.columns=[t, " + one.column + "]"},
            {one.key});
    REQUIRE(made.code == ExitCode::done);
    CHECK(unreliable(made).empty());
    const std::vector<double>& found = derivative(made, one.column, one.key);
    CHECK(found[one.row] == Approx(one.value).epsilon(0).margin(close * largest_size(found)));
  }
}

// No rounding. Rows, samples, exposures and commands are at different instants.
const Texts plain_rig = {"controller.sensor.resolution=0", "controller.sampling.resolution=0",
                         "gimbal.servo.dead_band=0",       "controller.sampling.delay=6.9 ms",
                         "controller.sensor.delay=8.3 ms", "time.end=3"};

}  // namespace

TEST_CASE("derivatives of smooth scenes agree with exact ones", "[sensitivity]") {
  require_exact(
      {
          {"configs/fig2b", {}, "gravity", "x", 787, 0.000219835294824},
          {"configs/fig2b", {}, "gimbal.servo.natural_frequency", "y", 787, -1.28209599016e-05},
          {"configs/fig2b", {}, "controller.reference.circle.rate", "x", 787, -0.78079714489},
          {"configs/fig2b", {}, "controller.pd.kv.0.1", "x", 787, 1.97871170379e-05},
          {"configs/fig2b", {}, "ball.inertia_factor", "x", 787, -0.00154042025711},
          {"configs/fig2a", {}, "ball.radius", "y", 750, 0.0656447317624},
          {"configs/fig2a", {}, "gimbal.motion.phi.sinusoid.frequency", "x", 750, 0.401463095457},
          {"configs/fig2a", {}, "ball.position.0", "x", 750, 1.00098884495},
          {"spin", {"time.end=4"}, "ball.spin", "y", 30, -0.000409574703057},
          {"spin",
           {"time.end=4"},
           "gimbal.motion.phi.sinusoid.phase",
           "phi_rate",
           30,
           0.136669539283},
          {"torque-open", {}, "gimbal.motor.viscous", "theta", 22, -3.68970058881},
          {"configs/recorded", {}, "ball.radius", "x", 300, 0.341765204246},
          {"configs/lissajous", {}, "gravity", "x", 787, 0.000335310451557},
      },
      1e-8);
}

TEST_CASE("derivatives through samples and switches agree with exact ones", "[sensitivity]") {
  const Texts frames = {"controller.sensor.period=27 ms", "controller.sensor.phase=0.0031"};
  const Texts turned = {"controller.sensor.rotation=0.05", "controller.sensor.scale=[1.02, 1]",
                        "controller.sensor.dropout=0.1"};
  const Texts jitter = {"controller.sampling.jitter=0.001", "time.step=19.77 ms"};
  const Texts first_order = {"gimbal.servo={time_constant: 0.04}"};
  const Texts slow = {"gimbal.servo.rate_limit=0.1"};
  const Texts dead_band = {"gimbal.servo.dead_band=0.1 deg"};
  const Texts viscous = {"ball.mass=0.03", "ball.losses.viscous=1e-5"};
  const Texts pid = {"controller.sensor.resolution=0", "controller.limit=0.03", "time.end=3"};
  const Texts lqr = {"controller.sensor.resolution=0", "gimbal.servo.acceleration_limit=40",
                     "gimbal.servo.rate_limit=1", "time.end=2"};
  const Texts unrounded = {"controller.sensor.resolution=0", "controller.sampling.resolution=0",
                           "controller.sampling.delay=6.9 ms", "time.end=2"};
  const Texts linkage =
      unrounded + Texts{"gimbal.servo.backlash=0", "gimbal.servo.dead_band=0",
                        "controller.sensor.noise=0", "controller.sensor.phase=7.1 ms"};
  const Texts legs = unrounded + Texts{"controller.sensor.delay=8.3 ms"};
  const Texts slide = {"events.slip={friction: 0.1, sliding_friction: 0.08, action: slide}",
                       "time.end=0.5"};
  const Texts voltage = {"gimbal.motor.dc.voltage_limit=0.15", "time.end=8"};
  const Texts torque = {"gimbal.motor.torque_limit=0.02",
                        "gimbal.motor.position_loop={kp: 4, kd: 0.12, ki: 2}", "time.end=8"};
  // A circle that the plate can only follow at its limits.
  const auto circle = [](const std::string& servo, const std::string& rest = {}) {
    return Texts{"gimbal={servo: {natural_frequency: 30, damping: 0.8" + servo + "}}",
                 "controller={gravity_compensation: {kp: 6, kv: 5}, drives: angle, "
                 "reference: {circle: {radius: 0.05, rate: -2}}" +
                     rest + "}",
                 "time.end=4"};
  };
  const Texts stop = circle(", angle_limit: 0.02"), gap = circle(", backlash: 0.01"),
              slow_servo = circle(", rate_limit: 0.1, acceleration_limit: 4"),
              limit = circle("", ", limit: 0.02");
  const Texts curve =
      circle("") + Texts{"gimbal.linkage={table: {file: " + bbsim_test::data_file("curve.csv") +
                         ", servo: alpha, plate: beta, unit: deg}}"};
  const std::string rig = "configs/rig";
  require_exact(
      {
          {rig, plain_rig, "ball.radius", "theta", 112, 0.407151643206},
          {rig, plain_rig, "gravity", "theta", 112, -0.000998189539428},
          {rig, plain_rig, "controller.gravity_compensation.kp", "theta_rate", 112,
           0.00326626365326},
          {rig, plain_rig, "controller.sampling.delay", "phi_rate", 112, -0.854957979696},
          {rig, plain_rig, "controller.sampling.period", "theta_rate", 112, -439.024514414},
          {rig, plain_rig, "controller.sensor.delay", "theta_rate", 112, 4.27576920408},
          {rig, plain_rig + frames, "controller.sensor.phase", "theta", 112, 0.52644607401},
          {rig, plain_rig + frames, "controller.sensor.period", "theta", 112, 17.1583665716},
          {rig, plain_rig + turned, "controller.sensor.rotation", "y", 112, -0.037710938741},
          {rig, plain_rig + jitter, "controller.sampling.jitter", "theta_rate", 114,
           -65.1813567798},
          {rig, plain_rig + slow, "gimbal.servo.rate_limit", "theta_rate", 112, 6.93486268379},
          {rig, plain_rig + first_order, "gimbal.servo.time_constant", "theta_rate", 112,
           -1.63015982563},
          {rig, plain_rig + dead_band, "gravity", "theta", 112, -0.000906342722055},
          {"configs/step", pid, "controller.pid.ki.0.0", "x", 112, 0.0152428511965},
          {"configs/step", pid, "controller.limit", "x", 112, -0.0622373448029},
          {"configs/step", pid, "gimbal.mounting.phi_offset", "x", 112, 0.851156741771},
          {"configs/catch", lqr, "controller.lqr.position", "y", 75, 7.43941795962e-06},
          {"configs/catch", lqr, "gimbal.servo.acceleration_limit", "x", 75, -1.71925924191e-06},
          {rig, plain_rig + viscous, "ball.losses.viscous", "y", 112, 70.9702132122},
          {"configs/pushrod", linkage, "gimbal.linkage.horn", "y", 75, -0.0024478035235},
          {"configs/pushrod", linkage, "controller.sampling.delay", "phi_rate", 75, 2.14748013564},
          {"configs/three-servos", legs, "gimbal.three_servos.rod", "y", 75, 7.10218428083e-05},
          {"configs/slides",
           {"events.rest=note", "time.end=5"},
           "ball.radius",
           "x",
           187,
           -69.4881112149},
          {"configs/rolls-to-rest", {}, "gravity", "x", 300, -0.0366680964165},
          {"configs/slips", slide, "gravity", "y", 75, -0.000366999531706},
          {"configs/slips", slide, "events.slip.friction", "y", 75, -0.000407472458372},
          {"configs/sags", {"time.end=8"}, "gimbal.motor.friction", "x", 120, -0.530443014839},
          {"configs/sags", torque, "gimbal.motor.torque_limit", "theta", 120, -0.651902945887},
          {"configs/sags", voltage, "gimbal.motor.dc.voltage_limit", "theta", 120,
           -0.0482031371866},
          {"fig2b", stop, "gimbal.servo.angle_limit", "x", 30, 6.19474890902},
          {"fig2b", slow_servo, "gimbal.servo.rate_limit", "theta", 30, 2.41064859284},
          {"fig2b", gap, "gimbal.servo.backlash", "x", 30, 0.328905036865},
          {"fig2b", limit, "controller.limit", "x", 30, 6.38412100571},
          {"fig2b", curve, "ball.radius", "y", 30, -0.011938709458},
      },
      1e-6);
}

TEST_CASE("gradients of measures agree with exact ones", "[sensitivity]") {
  struct OfMeasures {
    std::string scene;
    Texts overrides;
    std::string key;
    std::vector<std::pair<std::string, double>> gradients;  // by bbsim 0.3, as above
  };
  const std::vector<OfMeasures> all = {
      {"configs/rig",
       plain_rig,
       "ball.radius",
       {{"max_tilt", 0.1854115712},
        {"rms_x", -0.00014227322},
        {"rms_phi_command", 0.03004967133},
        {"end_theta_command", -0.3806290274},
        {"x.Peak", -0.02134560572},
        {"end_vy", -0.1880292528}}},
      {"configs/rig",
       plain_rig,
       "controller.sampling.delay",
       {{"max_tilt", -0.003146401774},
        {"rms_x", 0.0002954820396},
        {"rms_phi_command", -0.0001012741988},
        {"end_theta_command", -0.1117393657},
        {"x.Peak", -0.00244363118},
        {"end_vy", -0.2136331829}}},
      {"configs/slides",
       {"events.rest=note", "time.end=5"},
       "gravity",
       {{"rms_x", -0.01337353606},
        {"max_x", -0.02123984903},
        {"end_y", 0.02370078054},
        {"max_friction_demand", 0}}},
      {"fig2b",
       {"time.end=3"},
       "ball.radius",
       {{"max_tilt", 0.02359494407},
        {"rms_x", 2.202165047e-05},
        {"max_tracking_error", 0.003393815161},
        {"x.Peak", -3.817812649e-05},
        {"find y at 1.5", -0.005106484044},
        {"rms_tracking_error from 1 s", 0.0005911240257},
        {"min_x", -3.817812649e-05}}},
      {"fig2b",
       {"time.end=3"},
       "controller.pd.kv.0.0",
       {{"max_tilt", 1.735549951e-05},
        {"rms_x", -0.0007785092755},
        {"max_tracking_error", -2.733272014e-06},
        {"x.Peak", -0.001649189485},
        {"find y at 1.5", 2.12635752e-07},
        {"rms_tracking_error from 1 s", -0.0006969264374},
        {"min_x", -0.001649189485}}},
      {"fig2b",
       {"time.end=3"},
       "gimbal.servo.damping",
       {{"max_tilt", -0.004718143513},
        {"rms_x", 0.0001012903267},
        {"max_tracking_error", 0.000934050686},
        {"x.Peak", 9.086443864e-05},
        {"find y at 1.5", 0.0009972435331},
        {"rms_tracking_error from 1 s", -8.08037009e-05},
        {"min_x", 9.086443864e-05}}},
  };
  for (const OfMeasures& one : all) {
    Texts measures;
    for (const auto& [name, value] : one.gradients) measures.push_back(name);
    const auto made = run(one.scene, gains_then(one.scene) + one.overrides, {one.key}, measures);
    for (const auto& [name, value] : one.gradients) {
      CAPTURE(one.scene, one.key, name);
      // Rounding of a run, some 1e-15, over the smallest step, 2^-23.
      CHECK(gradient(made, name, one.key) == Approx(value).epsilon(1e-6).margin(1e-8));
    }
  }
}

TEST_CASE("eight keys of a scene without rounding are reliable", "[sensitivity]") {
  const auto reliable = [](const std::string& name, const Texts& overrides, const Texts& keys) {
    CAPTURE(name);
    const Texts measures = {"max_tilt", "rms_tracking_error", "max_tracking_error", "end_x"};
    CHECK(unreliable(run(name, overrides, keys, measures)).empty());
  };
  reliable("configs/fig2b", {},
           {"ball.radius", "gravity", "controller.pd.kv.0.0", "controller.pd.kp.0.0",
            "gimbal.servo.natural_frequency", "gimbal.servo.damping",
            "controller.reference.circle.radius", "ball.position.0"});
  reliable("configs/step", {"controller.sensor.resolution=0"},
           {"ball.radius", "gravity", "controller.pid.kp.0.0", "controller.pid.ki.0.0",
            "gimbal.servo.natural_frequency", "controller.sampling.delay",
            "controller.sampling.period", "gimbal.mounting.phi_offset"});
  reliable("configs/pushrod",
           {"controller.sampling.resolution=0", "gimbal.servo.backlash=0", "time.end=5"},
           {"ball.radius", "gravity", "controller.gravity_compensation.kp", "gimbal.linkage.horn",
            "gimbal.linkage.arm", "controller.sampling.delay", "controller.sampling.period",
            "controller.sensor.scale"});
}

TEST_CASE("a derivative that does not exist is null, and said", "[sensitivity]") {
  // All peaks of the tilt are equal until one axis gets another frequency: then later peaks grow,
  // for a higher frequency and for a lower one.
  const std::string key = "gimbal.motion.phi.sinusoid.frequency";
  const auto peaks = run("configs/fig2a", {}, {key}, {"max_tilt", "end_x"});
  CHECK(std::isnan(gradient(peaks, "max_tilt", key)));
  CHECK(gradient(peaks, "end_x", key) == Approx(derivative(peaks, "x", key).back()));
  CHECK(unreliable(peaks) == Texts{key + " max_tilt"});
  CHECK(std::isnan(peaks.summary.unreliable->front().time));
  CHECK(is_said(peaks, key));

  // Rounded commands jump.
  const auto rounded = run("configs/rig", {}, {"gravity"}, {"rms_tracking_error"});
  CHECK(rounded.code == ExitCode::done);
  CHECK(std::isnan(gradient(rounded, "rms_tracking_error", "gravity")));
  const auto of = unreliable(rounded);
  CHECK(std::ranges::find(of, "gravity y") != of.end());
  CHECK(rounded.summary.unreliable->front().time > 0);
  CHECK(is_said(rounded, "gravity"));
  for (const double one : derivative(rounded, "y", "gravity")) CHECK(std::isfinite(one));
}

TEST_CASE("beside a kink and at the reach of a linkage, gradients are right", "[sensitivity]") {
  struct Beside {
    std::string text, measure, key;
    double right;  // central differences at several steps agree on these digits
  };
  const std::string servo = "servo: {natural_frequency: 34, damping: 1}";
  const std::string rods =
      "gravity: 9.80665\nball: {radius: 0.02, position: [0.1, 0]}\n"
      "gimbal: {" +
      servo +
      ", linkage: {phi: {horn: 0.024, arm: 0.052, offset: [0.046, 0.04]}}}\n"
      "controller: {drives: angle, assumes: exact, reference: {point: [0, 0]}, sampling: {period: "
      "0.03}, pd: {kp: [[3, 0], [0, -9]], kv: [[6, 0], [0, -6]]}}\n"
      "time: {end: 1, step: 0.01}\noutput: {columns: [t, x, phi]}\n";
  const std::string legs =
      "gravity: 9.80665\nball: {radius: 0.02, position: [0.1, -0.07]}\n"
      "gimbal: {" +
      servo +
      ", three_servos: {radius_base: 0.06, radius_plate: 0.09, horn: 0.04, "
      "rod: 0.1, height: 0.11}}\n"
      "controller: {drives: angle, reference: {point: [0, 0]}, sampling: {period: 0.03}, "
      "pd: {kp: [[3, 0], [0, -3]], kv: [[2.5, 0], [0, -2.5]]}}\n"
      "time: {end: 1, step: 0.01}\noutput: {columns: [t, x, phi]}\n";
  // Two peaks of the error are nearly equal.
  const std::string noisy =
      "gravity: 9.80665\n"
      "ball: {radius: 0.02273642670710872, position: [0.00746042462055975, 0.02900346757385533], "
      "velocity: [0.05206944296732752, 0.037629311105384367], spin: 1.7299806728008047, "
      "inertia_factor: 0.41686811764594656, mass: 0.1391128709728184}\n"
      "gimbal: {mounting: {phi_offset: -0.011581010841810287, base_tilt: 0.0018576103011547981}, "
      "servo: {natural_frequency: 30.787278034679318, damping: 0.9577030302775706}}\n"
      "controller: {drives: angle, limit: 0.07800905595227041, "
      "reference: {lissajous: {amplitude: [0.048640066992057085, 0.031689356232398144], "
      "rate: [1.268588542527, 0.7551287974572336], phase: [2.1069740492266775, 1]}}, "
      "lqr: {position: 24.411473882343312, velocity: 1, angle: 0.842220454122443, "
      "command: 17.74767462869148}, sampling: {period: 0.012018253882821827, "
      "delay: 0.020629421202331404, jitter: 0.000710572634818805}, "
      "sensor: {delay: 0.0012309714673582855, noise: 0.0005, seed: 75}}\n"
      "time: {end: 3.7998871454639302, step: 0.16259679698176852}\noutput: {columns: [t, x, y]}\n";
  for (const Beside& one :
       {Beside{rods, "end_x", "gravity", 0.75615},
        Beside{rods, "end_x", "ball.position.0", -200.99},
        Beside{legs, "max_tilt", "gravity", 8.736e-4}, Beside{legs, "end_x", "gravity", 9.18701e-4},
        Beside{noisy, "max_tracking_error", "controller.lqr.command", 4.7219e-5}}) {
    CAPTURE(one.measure, one.key);
    const auto made = run(test::parse(one.text), {one.key}, {one.measure});
    CHECK(gradient(made, one.measure, one.key) == Approx(one.right).epsilon(1e-4));
    for (const double value : derivative(made, "x", one.key)) CHECK(std::isfinite(value));
  }
}

TEST_CASE("if an event stops the run, the measures' end moves with the key", "[sensitivity]") {
  // The ball leaves the plate at x = size / 2 with vx = sqrt(a size), a = (5/7) g sin(phi).
  const double a = 5.0 / 7 * 9.80665 * std::sin(5 * std::numbers::pi / 180);
  // Neighbors at greater gravity end before the last row, just before the end.
  const double last = 0.8, size = a * last * last * (1 + 1e-5);
  const auto made = run("configs/incline",
                        {"plate.size=[" + number_text(size) + ", 1]", "events.edge=stop",
                         "output.columns=[t, x]", "time.step=0.1"},
                        {"gravity,plate.size.0"}, {"end_vx", "max_x", "max_vx"});
  REQUIRE(made.summary.status == "stopped");
  CHECK(unreliable(made).empty());
  const double end = std::sqrt(a * size);
  constexpr double close = 1e-8;
  CHECK(gradient(made, "end_vx", "gravity") == Approx(end / (2 * 9.80665)).epsilon(close));
  CHECK(gradient(made, "max_vx", "gravity") == Approx(end / (2 * 9.80665)).epsilon(close));
  CHECK(gradient(made, "end_vx", "plate.size.0") == Approx(end / 2 / size).epsilon(close));
  CHECK(gradient(made, "max_x", "plate.size.0") == Approx(0.5).epsilon(close));
  CHECK(std::abs(gradient(made, "max_x", "gravity")) < close);
  // The plate's edge does not affect the rows, not even the last one.
  for (const double one : derivative(made, "x", "plate.size.0")) CHECK(std::abs(one) < close);
  const std::vector<double>& rows = derivative(made, "x", "gravity");
  REQUIRE(column(made, "t").back() == Approx(last));
  // From one side, of second order.
  CHECK(rows.back() == Approx(a / 2 * last * last / 9.80665).epsilon(1e-6));
}

TEST_CASE("the strength of noise has a derivative; its seed does not", "[sensitivity]") {
  const std::string key = "controller.sensor.noise";
  const auto made = run("configs/rig", plain_rig, {key}, {"rms_tracking_error"});
  CHECK(unreliable(made).empty());
  const auto at = [&](double noise) {
    return run("configs/rig",
               plain_rig + Texts{key + "=" + number_text(noise), "solver.rtol=1e-12"}, {},
               {"rms_tracking_error"})
        .summary.measures.front()
        .second;
  };
  // Runs are accurate to 1e-11 or so; the difference divides that by its step.
  constexpr double step = 1e-6;
  CHECK(gradient(made, "rms_tracking_error", key) ==
        Approx((at(2e-4 + step) - at(2e-4 - step)) / (2 * step)).epsilon(1e-4));
  CHECK_THROWS_AS(run("configs/rig", {}, {"controller.sensor.seed"}), InputError);
}

TEST_CASE("rows with derivatives equal those without", "[sensitivity]") {
  for (const char* scene : {"configs/fig2b", "configs/rig", "configs/incline"}) {
    // Some values of the key need other equations than the run has.
    const auto with = run(scene, {}, {"ball.inertia_factor"}, {"max_tilt"});
    const auto without = run(scene, {}, {}, {"max_tilt"});
    CHECK(with.summary.measures == without.summary.measures);
    CHECK(without.summary.gradients.empty());
    CHECK_FALSE(without.summary.unreliable);
    for (const std::string& name : without.rows.names) {
      CHECK(column(with, name) == column(without, name));
    }
  }
}

TEST_CASE("an interrupt among the neighbors keeps the rows", "[sensitivity]") {
  class Interrupted : public api::Watch {
   public:
    void start(double) override { now_ = ++starts_ == 2; }  // after the run itself
    const std::atomic<bool>* stop() override { return &now_; }

   private:
    int starts_ = 0;
    std::atomic<bool> now_ = false;
  } watch;
  api::RunRequest request{read_scenario(file_of("configs/rig"), {"time.end=2"})};
  request.sensitivity = {"gravity"};
  const auto made = api::run(request, watch);
  CHECK(made.code == ExitCode::interrupted);
  CHECK(made.summary.status == "interrupted");
  CHECK(column(made, "x") == column(run("configs/rig", {"time.end=2"}, {}), "x"));
  CHECK(std::isnan(derivative(made, "x", "gravity").back()));
  CHECK(is_said(made, "gravity"));
}

TEST_CASE("keys and scenes without derivatives are refused", "[sensitivity]") {
  const auto message = [](const std::string& name, const Texts& overrides,
                          const std::string& keys) {
    try {
      static_cast<void>(run(name, overrides, {keys}));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  const auto refuses = [&](const std::string& name, const std::string& key, const std::string& part,
                           const Texts& overrides = {}) {
    const std::string said = message(name, overrides, key);
    CAPTURE(key, said);
    CHECK(said.find(part) != std::string::npos);
  };
  refuses("fig2a", "time.end", "a key of the computation");
  refuses("fig2a", "ball.radius,ball.radius", "is given twice");
  refuses("configs/fig2b-literal", "controller.pd.kv,controller.pd.kv.0.1", "overlap");
  refuses("fig2a", "ball.raduis", "did you mean");
  refuses("fig2a", "gravity", "needs valid values", {"gravity=0"});
  refuses("fig2a", "ball.radius", "repeats the run", {"solver.error=1e-6"});
}

}  // namespace bbsim_test::test_sensitivity
