// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Designs of synthetic rigs, from the scenario to the fit of a log.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "api/design.hpp"
#include "api/fit.hpp"
#include "api/run.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "catch.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_design {

using namespace bbsim;

namespace {

// A plate above the gimbal's center, which moves the ball sideways as it tilts.
const std::string open_rig = R"(# Mine.
ball: {radius: 1 cm, mass: 33 g}
plate: {size: [30 cm, 30 cm]}
gimbal:
  mounting: {height: 2 cm}
  motion:  # as recorded
    phi: {table: {file: gone.csv, time: t, value: phi, scale: 1.1, offset: 0.004}}
    theta: 0
time: {end: 6, step: 20 ms}
output: {columns: [t, x, y]}
)";

api::DesignRequest request_of(const ScenarioFamily& family, std::vector<std::string> free) {
  api::DesignRequest request{family, std::move(free)};
  request.threads = 2;
  return request;
}

api::DesignResult made_of(const api::DesignRequest& request, api::DesignParts parts = {}) {
  api::Watch watch;
  return api::design(request, parts, watch);
}

std::string fault(const ScenarioFamily& family, const std::vector<std::string>& free,
                  const std::function<void(api::DesignRequest&)>& change = {},
                  api::DesignParts parts = {}) {
  try {
    api::DesignRequest request = request_of(family, free);
    request.length = "2 s";
    if (change) change(request);
    static_cast<void>(made_of(request, parts));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

ScenarioFamily scene(const std::string& text) {
  return ScenarioFamily(Source{"rig.yaml", text, {}});
}

const std::string level_rig = R"(
ball: {radius: 1 cm, mass: 33 g}
plate: {diameter: 30 cm}
gimbal: {motion: {phi: 0, theta: 0}}
time: {end: 3, step: 20 ms}
)";

// Writes a log of the scenario, with noise of 1 mm.
std::string log_of(const std::string& file) {
  const ScenarioFamily family(file, {});
  api::RunRequest request{family.read({})};
  request.keeps_rows = true;
  api::Watch watch;
  const api::RunResult made = api::run(request, watch);
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 1e-3);
  std::string text = "t,x,y\n";
  const auto& columns = made.rows.columns;
  for (std::size_t row = 0; row < columns.front().size(); ++row) {
    text += number_text(columns[0][row]) + "," + number_text(columns[1][row] + noise(random)) +
            "," + number_text(columns[2][row] + noise(random)) + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("a designed log leaves at most half the deviations of the best circle: a high plate") {
  const ScenarioFamily family = scene(R"(
ball: {radius: 1 cm}
plate: {size: [30 cm, 30 cm]}
gimbal: {mounting: {height: 2 cm}, motion: {phi: 0, theta: 0}}
time: {end: 6, step: 20 ms}
)");
  const api::DesignResult made = made_of(
      request_of(family, {"ball.inertia_factor", "gimbal.mounting.height",
                          "gimbal.motion.phi.table.scale", "gimbal.motion.theta.table.scale"}));
  INFO(made.text);
  for (const design::Expected& one : made.designed.parameters) {
    REQUIRE(one.circle);
    CHECK(one.sd <= 0.5 * *one.circle);
  }
}

TEST_CASE("a designed log leaves at most half the deviations of the best circle: a beam") {
  const ScenarioFamily family(BBSIM_SOURCE_DIR "/configs/beam.yaml", {"plate.size=[60 cm, 10 cm]"});
  const api::DesignResult made = made_of(request_of(
      family, {"gimbal.servo.natural_frequency", "gimbal.servo.damping", "ball.inertia_factor"}));
  INFO(made.text);
  for (const design::Expected& one : made.designed.parameters) {
    REQUIRE(one.circle);
    CHECK(one.sd <= 0.5 * *one.circle);
    REQUIRE(one.step);
    CHECK(one.sd <= 0.5 * *one.step);
  }
}

TEST_CASE("a designed log leaves at most half the deviations of the best circle: a hobby rig") {
  const ScenarioFamily family(BBSIM_SOURCE_DIR "/configs/rig.yaml",
                              {"gimbal.servo={time_constant: 80 ms, rate_limit: 300 deg/s}",
                               "controller.gravity_compensation={kp: 10, kv: 8}"});
  api::DesignRequest request = request_of(
      family, {"gimbal.servo.time_constant", "controller.sampling.delay", "ball.inertia_factor"});
  request.length = "8 s";
  const api::DesignResult made = made_of(request);
  INFO(made.text);
  for (const design::Expected& one : made.designed.parameters) {
    REQUIRE(one.circle);
    CHECK(one.sd <= 0.5 * *one.circle);
  }
}

TEST_CASE("a designed log leaves at most half the deviations of the best circle: commands") {
  const Folder folder;
  folder.put("gone.csv", "t,phi,theta\n0,0,0\n1,0,0\n3,0,0\n4,0,0\n");
  folder.put("rig.yaml", R"(
ball: {radius: 2 cm}
plate: {size: [30 cm, 24 cm]}
gimbal: {servo: {natural_frequency: 5 Hz, damping: 0.8}}
controller:
  commands:
    phi: {table: {file: gone.csv, time: t, value: phi}}
    theta: {table: {file: gone.csv, time: t, value: theta}}
  drives: angle
time: {end: 4, step: 20 ms}
)");
  const ScenarioFamily family(folder / "rig.yaml", {});
  const api::DesignResult made = made_of(request_of(
      family, {"gimbal.servo.natural_frequency", "gimbal.servo.damping", "ball.inertia_factor"}));
  INFO(made.text);
  for (const design::Expected& one : made.designed.parameters) {
    REQUIRE(one.circle);
    CHECK(one.sd <= 0.5 * *one.circle);
  }
}

TEST_CASE("a design keeps the limits, is written, and predicts the fit of its log") {
  const Folder folder;
  folder.put("rig.yaml", open_rig);
  folder.put("gone.csv", "t,phi\n0,0\n3,0\n6,0\n9,0\n");
  const ScenarioFamily family(folder / "rig.yaml", {"ball.velocity=[1 cm/s, 0]"});
  const std::vector<std::string> free{"ball.inertia_factor", "gimbal.motion.phi.table.scale",
                                      "gimbal.motion.phi.table.offset",
                                      "gimbal.motion.phi.table.delay"};
  api::DesignRequest request = request_of(family, free);
  request.table = "moves it's.csv";  // a name that YAML must quote
  request.tilt = "8 deg";
  const api::DesignResult made = made_of(request, {true, true});
  INFO(made.text);
  REQUIRE(made.code == ExitCode::done);
  const std::string written = folder.put("designed.yaml", made.scenario);
  folder.put(request.table, made.table);

  SECTION("the scenario keeps its comments, and free keys keep their values") {
    CHECK(contains(made.scenario, "# Mine."));
    CHECK(contains(made.scenario, "  # as recorded"));
    CHECK_FALSE(contains(made.scenario, "gone.csv"));
    CHECK(contains(made.scenario, "velocity: [0, 0]"));
    const ScenarioFamily designed(written, {});
    CHECK(designed.number_at("gimbal.motion.phi.table.scale", {}) == 1.1);
    CHECK(designed.number_at("gimbal.motion.phi.table.offset", {}) == 0.004);
    CHECK(designed.number_at("time.end", {}) == 6.0);
  }
  SECTION("the ball stays on the plate, and the plate within its tilt") {
    api::RunRequest run{ScenarioFamily(written, {"output.columns=[t, x, y, phi, theta, phi_rate, "
                                                 "theta_rate]"})
                            .read({})};
    run.keeps_rows = true;
    api::Watch watch;
    const api::RunResult ran = api::run(run, watch);
    constexpr double degree = 0.017453292519943295;
    // x and y: half the plate minus a tenth; 60 deg/s is the default rate. Rounding the start to a
    // millimeter moves the path by little more.
    const double most[] = {6, 0.12, 0.12, 8 * degree, 8 * degree, 60 * degree, 60 * degree};
    for (std::size_t c = 1; c < 7; ++c) {
      CAPTURE(ran.rows.names[c]);
      for (const double value : ran.rows.columns[c]) REQUIRE(std::abs(value) < 1.03 * most[c]);
    }
    CHECK(std::abs(ran.rows.columns[3].front()) < 1e-6);
    CHECK(std::abs(ran.rows.columns[3].back()) < 1e-6);
    const double used =
        std::max(made.designed.use.greatest_edge(), made.designed.use.greatest_tilt());
    CHECK(used > 0.9);
  }
  SECTION("a fit has the deviations that the design expects") {
    folder.put("log.csv", log_of(written));
    const ScenarioFamily designed(written, {});
    api::FitRequest fit{designed, {folder / "log.csv"}, {}, free};
    api::Watch watch;
    const api::FitResult fitted = api::fit(fit, false, watch);
    INFO(fitted.text);
    for (std::size_t k = 0; k < free.size(); ++k) {
      const fit::Parameter& one = fitted.fitted.parameters[k];
      CAPTURE(one.key);
      // The fit estimates the noise from 602 numbers, to 3 %; its estimates change the derivatives
      // by about as much.
      CHECK(one.sd == Approx(made.designed.parameters[k].sd).epsilon(0.15));
      CHECK(std::abs(one.estimate - made.designed.parameters[k].value) < 3.9 * one.sd);
    }
  }
  SECTION("JSON contains what programs need") {
    const auto json = nlohmann::json::parse(made.json);
    REQUIRE(json["parameters"].size() == 4);
    CHECK(json["parameters"][0]["key"] == "ball.inertia_factor");
    CHECK(json["parameters"][0]["sd"] == made.designed.parameters[0].sd);
    CHECK(json["parameters"][0]["step_sd"] > json["parameters"][0]["sd"]);
    CHECK(json["identifiable"] == true);
    CHECK(json["length"] == 6);
    CHECK(json["rate"] == 50);
    CHECK(json["noise"]["x"] == 1e-3);
    CHECK(json["sines"]["phi"].size() == 4);
  }
  SECTION("another call gives the same result, with any number of threads") {
    request.threads = 1;
    const api::DesignResult again = made_of(request, {true, true});
    CHECK(again.table == made.table);
    CHECK(again.json == made.json);
    CHECK(again.scenario == made.scenario);
    CHECK(again.sketch == made.sketch);
  }
}

TEST_CASE("keys that no motion can separate are named") {
  // Two offsets of the same angle.
  const ScenarioFamily family = scene(level_rig);
  api::DesignRequest request = request_of(
      family,
      {"gimbal.motion.phi.table.offset", "gimbal.mounting.phi_offset", "ball.inertia_factor"});
  request.noise = {"x=2mm"};
  const api::DesignResult made = made_of(request);
  INFO(made.text);
  CHECK(contains(made.text, "not identifiable: gimbal.motion.phi.table.offset, which a log"));
  CHECK(contains(made.text, "not identifiable: gimbal.mounting.phi_offset, which a log"));
  CHECK(std::isfinite(made.designed.parameters[2].sd));
  const auto json = nlohmann::json::parse(made.json);
  CHECK(json["parameters"][0]["sd"].is_null());
  CHECK(json["identifiable"] == false);
  CHECK(json["noise"]["x"] == 2e-3);
  CHECK(json["noise"]["y"] == 1e-3);
}

TEST_CASE("an impossible design is refused, with the possible ones") {
  const ScenarioFamily rig = scene(level_rig);
  const std::string inertia = "ball.inertia_factor";
  CHECK(contains(fault(scene("ball: {radius: 1 cm}\n"
                             "gimbal: {motion: {phi: 0, theta: 0}}\ntime: {end: 3, step: 1}\n"),
                       {inertia}),
                 "plate: has no size, but the ball must stay on it"));
  CHECK(contains(fault(scene("ball: {radius: 1 cm, mass: 33 g}\n"
                             "plate: {size: [30 cm, 30 cm], inertia: [4e-3, 6e-3, 1e-2]}\n"
                             "gimbal: {torque: {phi: 0, theta: 0}}\ntime: {end: 3, step: 1}\n"),
                       {inertia}),
                 "gimbal.torque: found, which a design cannot choose"));
  CHECK(contains(fault(rig, {"ball.position.0"}), "each window's start is fitted anyway"));
  CHECK(contains(fault(rig, {inertia, inertia}), "ball.inertia_factor is given twice"));
  CHECK(contains(fault(rig, {"ball.mass"}), "ball.mass: has no effect on x, y"));
  CHECK(contains(fault(rig, {inertia}, [](auto& request) { request.length = "0 s"; }),
                 "--length: found \"0 s\""));
  CHECK(contains(fault(rig, {inertia}, [](auto& request) { request.length = "0.1 s"; }),
                 "allowed: a log of 16 to 100000 rows"));
  CHECK(contains(fault(rig, {inertia}, [](auto& request) { request.rate = -1; }),
                 "--rate: found -1"));
  CHECK(contains(fault(rig, {inertia}, [](auto& request) { request.noise = {"ball=1"}; }),
                 "--noise: found \"ball=1\"; allowed: COLUMN=SIZE"));
  CHECK(contains(fault(rig, {inertia}, [](auto& request) { request.margin = "15 cm"; }),
                 "--margin: found 0.15 m; allowed: a length from 0 to below half the plate"));
  CHECK(contains(fault(rig, {inertia}, [](auto& request) { request.tilt = "8 cm"; }),
                 "--max-tilt: found \"8 cm\""));
  const ScenarioFamily leaning(Source{"rig.yaml", level_rig, {"gimbal.mounting.phi_offset=5 deg"}});
  CHECK(contains(fault(leaning, {inertia}),
                 "without a motion, the ball or the plate goes beyond its limits"));
  const ScenarioFamily loop(BBSIM_SOURCE_DIR "/configs/rig.yaml", {});
  CHECK(contains(fault(loop, {inertia}, {}, {false, true}),
                 "--sketch: the scenario has a controller"));
}

TEST_CASE("an interrupted design has no result") {
  class Stopped : public api::Watch {
   public:
    const std::atomic<bool>* stop() override { return &stop_; }

   private:
    std::atomic<bool> stop_{true};
  };
  const ScenarioFamily family = scene(level_rig);
  Stopped watch;
  const api::DesignResult made =
      api::design(request_of(family, {"ball.inertia_factor"}), {}, watch);
  CHECK(made.code == ExitCode::interrupted);
  CHECK(made.table.empty());
}

}  // namespace bbsim_test::test_design
