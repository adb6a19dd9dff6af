// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys whose numbers are inserted without reading the scenario again.
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/model.hpp"
#include "scenario/independent.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_independent {

using namespace bbsim;

namespace {

// Numbers that characterize the scene's model, as far as rows show it.
std::vector<double> traits(const Scenario& scenario) {
  const model::Model model = model::assemble(scenario, false);
  std::vector<double> numbers = model.initial;
  std::vector<double> z = model.initial;
  for (std::size_t i = 0; i < z.size(); ++i) z[i] += 0.01 * static_cast<double>(i + 1);
  for (const double t : {0.0, 0.7}) {
    const model::Sample now = model.sample(t, z.data());
    numbers.insert(numbers.end(), {now.gimbal.phi, now.gimbal.theta_ddot, now.gimbal.phi_ddot,
                                   now.reference[0], now.reference[1], now.ball.gamma_dot});
    std::vector<double> dz(z.size());
    std::visit([&](const auto& system) { model::derivative(system, t, z.data(), dz.data()); },
               model.system);
    numbers.insert(numbers.end(), dz.begin(), dz.end());
  }
  return numbers;
}

void check_keys(const std::string& text, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    INFO(key);
    Scenario placed = test::parse(text);
    const std::vector<double*> places = independent_number(placed, key);
    REQUIRE_FALSE(places.empty());
    for (double* const place : places) *place = 0.0375;
    const Scenario read = test::parse(text, {key + "=0.0375"});
    CHECK(traits(placed) == traits(read));
    CHECK(traits(placed) != traits(test::parse(text)));
  }
}

}  // namespace

TEST_CASE("an inserted number equals the number read: prescribed motion") {
  check_keys(
      "ball: {radius: 0.01, position: [0.1, 0.2], velocity: [0.3, 0.4], spin: 5}\n"
      "time: {end: 10, step: 0.1}\n"
      "gimbal:\n"
      "  motion:\n"
      "    phi: {sinusoid: {amplitude: 0.02, frequency: 2, phase: 0.5, offset: 0.01}}\n"
      "    theta: [0.03, {ramp: {start: 0.01, rate: 0.2}}, {sinusoid: {amplitude: 0.1, frequency: "
      "3}}]\n",
      {"gravity", "ball.radius", "ball.position.0", "ball.position.1", "ball.velocity.0",
       "ball.velocity.1", "ball.spin", "gimbal.motion.phi.sinusoid.amplitude",
       "gimbal.motion.phi.sinusoid.frequency", "gimbal.motion.phi.sinusoid.phase",
       "gimbal.motion.phi.sinusoid.offset", "gimbal.motion.theta.0",
       "gimbal.motion.theta.1.ramp.start", "gimbal.motion.theta.1.ramp.rate",
       "gimbal.motion.theta.2.sinusoid.amplitude"});
}

TEST_CASE("an inserted number equals the number read: a loop") {
  check_keys(test::closed_loop, {"controller.pd.kp", "controller.pd.kv"});
  const std::string text =
      "ball: {radius: 0.01, position: [0.1, 0.2]}\n"
      "time: {end: 10, step: 0.1}\n"
      "gimbal: {servo: {natural_frequency: 10, damping: 1}}\n"
      "controller:\n"
      "  pd: {kv: [[1, 2], [3, 4]], kp: [[5, 0], [0, -5]]}\n"
      "  drives: angle\n"
      "  reference: {circle: {radius: 0.05, rate: 2, phase: 1, centre: [0.01, 0.02]}}\n";
  check_keys(text,
             {"controller.pd.kv.0.1", "controller.pd.kv.1.0", "controller.pd.kp.1.1",
              "gimbal.start.phi", "gimbal.start.theta", "gimbal.start.phi_rate",
              "gimbal.start.theta_rate", "gimbal.servo.natural_frequency", "gimbal.servo.damping",
              "controller.reference.circle.radius", "controller.reference.circle.rate",
              "controller.reference.circle.phase", "controller.reference.circle.centre.0"});
}

TEST_CASE("other keys need the scenario read again") {
  Scenario scene = test::parse(test::open_loop);
  for (const char* key : {"time.end", "solver.rtol", "ball.inertia_factor", "ball", "ball.position",
                          "ball.position.2", "ball.position.x", "gimbal.motion.phi", "nothing"}) {
    INFO(key);
    CHECK(independent_number(scene, key).empty());
  }
  Scenario rig = test::parse(test::closed_loop + "events: {lift_off: stop}\n");
  CHECK(independent_number(rig, "gravity").empty());
}

}  // namespace bbsim_test::test_independent
