// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tuning a hobby rig, starting from its scenario.
#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "api/tune.hpp"
#include "base/error.hpp"
#include "catch.hpp"

namespace bbsim_test::test_tune {

using namespace bbsim;

namespace {

const std::string kp = "controller.gravity_compensation.kp";
const std::string kv = "controller.gravity_compensation.kv";

const ScenarioFamily& rig() {
  static const ScenarioFamily family(BBSIM_SOURCE_DIR "/configs/rig.yaml", {"time.end=6"});
  return family;
}

api::TuneRequest request_of(std::vector<std::string> free) {
  return {rig(), std::move(free), "rms_tracking_error"};
}

// Two gains on eight rigs.
api::TuneRequest small() {
  api::TuneRequest request = request_of({kp + "=4:30", kv + "=3:20"});
  request.require = {"max_tilt < 1.2 deg"};
  request.vary = {"gimbal.servo.natural_frequency=normal:5 Hz:0.3 Hz"};
  request.samples = 8;
  return request;
}

api::TuneResult tune(const api::TuneRequest& request, bool with_scenario = false) {
  api::Watch watch;
  return api::tune(request, with_scenario, watch);
}

std::string fault(const api::TuneRequest& request, bool with_scenario = false) {
  try {
    static_cast<void>(tune(request, with_scenario));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("gains are tuned on random rigs and tested on others") {
  api::TuneRequest request = small();
  request.hold_out = 16;
  const api::TuneResult made = tune(request, true);
  REQUIRE(made.tuned);
  const api::Tuned& tuned = *made.tuned;
  CHECK(made.code == ExitCode::done);
  CHECK(made.reason.empty());
  REQUIRE(tuned.parameters.size() == 2);
  CHECK(tuned.parameters[0].before == 8);
  CHECK(tuned.rigs == 8);
  CHECK(tuned.objective < tuned.before);
  REQUIRE(tuned.requirements.size() == 1);
  CHECK(tuned.requirements[0].holds);
  CHECK(tuned.requirements[0].value < 0.020944);
  CHECK(tuned.held_out == 16);
  CHECK(tuned.share_that_holds > 0.5);

  SECTION("the scenario has the gains, and its own comments") {
    const ScenarioFamily written(Source{rig().source().file, made.scenario, {}});
    CHECK(written.number_at(kp, {}) == tuned.parameters[0].value);
    CHECK(written.number_at(kv, {}) == tuned.parameters[1].value);
    CHECK(written.number_at("time.end", {}) == 6);
    CHECK(contains(made.scenario, "# Tuned by bbsim "));
    CHECK(contains(made.scenario, "on the worst of 8 rigs\n"));
    CHECK(contains(made.scenario, "# hard stops"));
  }
  SECTION("JSON contains what programs need") {
    const auto json = nlohmann::json::parse(made.json);
    CHECK(json["parameters"][1]["key"] == kv);
    CHECK(json["parameters"][1]["value"] == tuned.parameters[1].value);
    CHECK(json["objective"] == tuned.objective);
    CHECK(json["requirements"][0]["text"] == "max_tilt < 1.2 deg");
    CHECK(json["requirements"][0]["holds"] == true);
    CHECK(json["hold_out"]["cases"] == 16);
    CHECK(json["hold_out"]["share_that_holds"] == tuned.share_that_holds);
  }
  SECTION("another call gives the same result, with any number of threads") {
    request.threads = 1;
    const api::TuneResult again = tune(request, true);
    CHECK(again.json == made.json);
    CHECK(again.scenario == made.scenario);
  }
}

TEST_CASE("a margin can be required together with measures, on random rigs") {
  api::TuneRequest request = small();
  request.require = {"max_tilt < 1.5 deg", "phi_delay_margin > 150 ms"};
  const api::TuneResult made = tune(request);
  REQUIRE(made.tuned);
  CHECK(made.code == ExitCode::done);
  const auto& requirements = made.tuned->requirements;
  REQUIRE(requirements.size() == 2);
  CHECK(requirements[0].holds);
  CHECK(requirements[1].holds);
  CHECK(requirements[1].before < 0.15);  // the example's rig tolerates 129 ms
  CHECK(requirements[1].value > 0.15);
  // Without the requirement the gains are higher and the margin smaller.
  request.require.pop_back();
  const api::TuneResult bold = tune(request);
  REQUIRE(bold.tuned);
  CHECK(bold.tuned->objective < made.tuned->objective);
}

TEST_CASE("tuning the slowest mode needs no run, and an infinite margin meets any bound") {
  api::TuneRequest request = request_of({kp + "=4:30", kv + "=3:20"});
  request.minimize = "spectral_abscissa";
  // The response stays above -3 dB up to half the sampling rate: infinite bandwidth.
  request.require = {"phi_phase_margin > 30 deg", "x_bandwidth > 1"};
  const api::TuneResult made = tune(request);
  REQUIRE(made.tuned);
  CHECK(made.code == ExitCode::done);
  CHECK(made.tuned->objective < made.tuned->before);
  CHECK(made.tuned->requirements[0].value > 0.523);
  CHECK(made.tuned->requirements[1].holds);
  CHECK(nlohmann::json::parse(made.json)["requirements"][1]["value"].is_null());

  request.require = {"x_bandwidth < 1"};
  CHECK(tune(request).code == ExitCode::ended_early);
}

TEST_CASE("gains for which no rig is stable do not meet a margin") {
  api::TuneRequest request = request_of({kp + "=60:80"});
  const ScenarioFamily stiff(BBSIM_SOURCE_DIR "/configs/rig.yaml",
                             {"time.end=2", kp + "=70", kv + "=1"});
  api::TuneRequest other{stiff, request.free, "spectral_radius", {"phi_delay_margin > 1 ms"}};
  const api::TuneResult made = tune(other);
  CHECK(made.code == ExitCode::ended_early);
  CHECK(contains(made.reason, "found no values with phi_delay_margin > 1 ms"));
  CHECK(contains(made.reason, "the loop is not stable"));
}

TEST_CASE("without --vary there is one rig, and tied keys share a number") {
  api::TuneRequest request = request_of({kp + "=4:30", kv + ".0.0," + kv + ".1.1=3:20"});
  const ScenarioFamily two(BBSIM_SOURCE_DIR "/configs/rig.yaml",
                           {"time.end=3", kv + "=[[8, 0], [0, 8]]"});
  const api::TuneResult made = tune({two, request.free, request.minimize});
  REQUIRE(made.tuned);
  CHECK(made.tuned->rigs == 1);
  REQUIRE(made.tuned->parameters.size() == 3);
  CHECK(made.tuned->parameters[1].value == made.tuned->parameters[2].value);
  CHECK(made.tuned->objective <= made.tuned->before);
  CHECK(nlohmann::json::parse(made.json)["hold_out"]["share_that_holds"].is_null());
}

TEST_CASE("a requirement that cannot be met gives exit code 1 and the best result") {
  api::TuneRequest request = small();
  request.require = {"max_tilt < 0.1 deg"};
  const api::TuneResult made = tune(request);
  CHECK(made.code == ExitCode::ended_early);
  CHECK(contains(made.reason, "tune: found no values with max_tilt < 0.1 deg; the best has "));
  REQUIRE(made.tuned);
  CHECK_FALSE(made.tuned->requirements[0].holds);
  CHECK(nlohmann::json::parse(made.json)["requirements"][0]["holds"] == false);
}

TEST_CASE("an event that never occurs counts as infinite, and is null in JSON") {
  api::TuneRequest request = small();
  request.minimize = "when x=1";  // the plate is smaller
  request.require.clear();
  const api::TuneResult made = tune(request);
  CHECK(made.code == ExitCode::ended_early);
  CHECK(contains(made.reason, "tune: found no values with a finite when x=1"));
  CHECK(nlohmann::json::parse(made.json)["objective"].is_null());
}

TEST_CASE("an interruption keeps the best result") {
  class Impatient : public api::Watch {
   public:
    void update(double, const std::string&) override { stop_ = ++updates_ > after; }
    const std::atomic<bool>* stop() override { return &stop_; }
    int after = 0;

   private:
    int updates_ = 0;
    std::atomic<bool> stop_{false};
  } watch;
  watch.after = 2;
  const api::TuneResult made = api::tune(small(), true, watch);
  CHECK(made.code == ExitCode::interrupted);
  REQUIRE(made.tuned);
  CHECK_FALSE(made.scenario.empty());
  CHECK(contains(made.reason, "tune: interrupted after "));
}

TEST_CASE("faults of the input are reported before tuning starts") {
  const auto free = [](const std::string& text) { return fault(request_of({text})); };
  CHECK(free(kp) == "--free: " + kp +
                        ": found no range; allowed: KEY=FROM:TO, such as "
                        "controller.gravity_compensation.kp=1:20");
  CHECK(contains(free(kp + "=3"), "FROM:TO with FROM below TO"));
  CHECK(contains(free(kp + "=9:3"), "FROM:TO with FROM below TO"));
  CHECK(contains(free("ball.raduis=1:2"), "did you mean ball.radius?"));
  CHECK(contains(free("ball.radius=1 s:2 s"), "ball.radius"));
  CHECK(contains(free("ball.radius=-1 cm:2 cm"), "allowed: values from 0"));
  CHECK(contains(free("2*" + kp + "=1:2"), "found a factor before the first key"));
  CHECK(fault(request_of({kp + "=1:2", kp + "=1:3"})) == "--free: " + kp + " is given twice");
  CHECK_FALSE(contains(free("ball.position.0=1 cm:2 cm"), "window"));

  const auto with = [](const auto& change, bool with_scenario = false) {
    api::TuneRequest request = small();
    change(request);
    return fault(request, with_scenario);
  };
  CHECK(contains(with([](auto& r) { r.minimize = "rms_trakcing_error"; }), "--minimize: "));
  CHECK(contains(with([](auto& r) { r.require = {"max_tilt"}; }),
                 "--require: found \"max_tilt\"; allowed: \"MEASURE < VALUE\""));
  CHECK(contains(with([](auto& r) { r.require = {"max_tilt < 3 mm"}; }), "max_tilt is in rad"));
  CHECK(contains(with([](auto& r) { r.samples.reset(); }), "--samples N"));
  CHECK(contains(with([](auto& r) { r.vary.clear(); }), "--samples: found, but no value is drawn"));
  CHECK(contains(with([](auto& r) {
                   r.vary = {"ball.radius=list:0.02,0.03"}, r.samples.reset(), r.hold_out = 5;
                 }),
                 "--hold-out: found, but no value is drawn"));
  CHECK(contains(with([](auto& r) { r.vary.push_back(kp + "=uniform:1:2"); }),
                 "found among the free keys, too"));
  CHECK(contains(with([](auto& r) { r.quantile = 1.5; }), "--quantile: found 1.5"));
  CHECK(contains(with([](auto& r) { r.quantile = 0; }), "--quantile: found 0"));
}

}  // namespace bbsim_test::test_tune
