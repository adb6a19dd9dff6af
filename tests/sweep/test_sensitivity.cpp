// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `run --sensitivity` (api/run_sensitivity.cpp): derivatives against closed forms and exact
// numbers, and what is said where there is none.
#include <yaml-cpp/yaml.h>

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
  const file::Column* const found = made.rows.find(name);
  REQUIRE(found != nullptr);
  return found->numbers;
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

const YAML::Node& exact() {
  static const YAML::Node page = YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/sweep/derivatives.yaml");
  return page;
}

// A list of overrides, of which some may be lists themselves.
Texts overrides_of(const YAML::Node& node) {
  if (!node.IsSequence()) return {node.as<std::string>()};
  Texts all;
  for (const YAML::Node& one : node) all = all + overrides_of(one);
  return all;
}

// `close`: relative to the column's largest derivative.
void require_exact(const std::string& list, double close) {
  REQUIRE(exact()[list].size() > 10);
  for (const YAML::Node& one : exact()[list]) {
    const auto scene = one[0].as<std::string>(), key = one[2].as<std::string>(),
               name = one[3].as<std::string>();
    const Texts overrides = overrides_of(one[1]);
    CAPTURE(scene, key, overrides);
    const auto made = run(scene, overrides + Texts{"output.columns=[t, " + name + "]"}, {key});
    REQUIRE(made.code == ExitCode::done);
    CHECK(unreliable(made).empty());
    const std::vector<double>& found = derivative(made, name, key);
    CHECK(found[one[4].as<std::size_t>()] ==
          Approx(one[5].as<double>()).epsilon(0).margin(close * largest_size(found)));
  }
}

}  // namespace

TEST_CASE("derivatives of smooth scenes agree with exact ones", "[sensitivity]") {
  require_exact("smooth", 1e-8);
}

TEST_CASE("derivatives through samples and switches agree with exact ones", "[sensitivity]") {
  require_exact("switched", 1e-6);
}

TEST_CASE("gradients of measures agree with exact ones", "[sensitivity]") {
  for (const YAML::Node& one : exact()["measures"]) {
    const auto scene = one[0].as<std::string>(), key = one[2].as<std::string>();
    Texts measures;
    for (const auto& of : one[3]) measures.push_back(of.first.as<std::string>());
    const auto made = run(scene, overrides_of(one[1]), {key}, measures);
    for (const auto& of : one[3]) {
      const auto name = of.first.as<std::string>();
      CAPTURE(scene, key, name);
      // Rounding of a run, some 1e-15, over the smallest step, 2^-23.
      CHECK(gradient(made, name, key) == Approx(of.second.as<double>()).epsilon(1e-6).margin(1e-8));
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
  for (const YAML::Node& one : exact()["beside"]) {
    const auto measure = one[1].as<std::string>(), key = one[2].as<std::string>();
    CAPTURE(measure, key);
    const YAML::Node text = exact()["texts"][one[0].as<std::string>()];
    const auto made = run(test::parse(text.as<std::string>()), {key}, {measure});
    CHECK(gradient(made, measure, key) == Approx(one[3].as<double>()).epsilon(1e-4));
    for (const double value : derivative(made, "x", key)) CHECK(std::isfinite(value));
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
  const Texts plain_rig = overrides_of(exact()["switched"][0][1]);
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
    for (const std::string& name : without.rows.names()) {
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
  struct Refused {
    std::string scene, keys, said;
    Texts overrides;
  };
  const auto [scene, keys, said, overrides] = GENERATE(values<Refused>({
      {"fig2a", "time.end", "a key of the computation", {}},
      {"fig2a", "ball.radius,ball.radius", "is given twice", {}},
      {"configs/fig2b-literal", "controller.pd.kv,controller.pd.kv.0.1", "overlap", {}},
      {"fig2a", "ball.raduis", "did you mean", {}},
      {"fig2a", "gravity", "needs valid values", {"gravity=0"}},
      {"fig2a", "ball.radius", "repeats the run", {"solver.error=1e-6"}},
  }));
  CAPTURE(keys);
  CHECK_THROWS_WITH(run(scene, overrides, {keys}), Catch::Matchers::Contains(said));
}

}  // namespace bbsim_test::test_sensitivity
