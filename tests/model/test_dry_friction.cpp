// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// When dry friction holds and its direction, against closed forms.
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/hybrid/hybrid_system.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_dry_friction {

using namespace bbsim;
using namespace bbsim::model;

namespace {

constexpr double gravity = 9.81;

// A ball with dry losses on a plate tilted by theta.
std::string ball_on(double theta, const std::string& losses, const std::string& more = "") {
  return "gravity: 9.81\n"
         "ball: {radius: 0.02, mass: 0.05, losses: {" +
         losses +
         "}}\n"
         "gimbal: {motion: {theta: " +
         std::to_string(theta) +
         "}}\n"
         "time: {end: 1, step: 0.1}\n" +
         more;
}

// A run at its start, with the given ball velocities.
struct Start {
  explicit Start(const std::string& text, double vx = 0, double vy = 0)
      : model(assemble(test::parse(text), false)), run(model, 1e-8), z(model.initial) {
    z[2] = vx;
    z[3] = vy;
    run.handle_time_event(0, z.data());
  }
  [[nodiscard]] const ContactMode& contact() const {
    return std::get<CoupledGiven<>>(run.model().system).parts.contact;
  }
  [[nodiscard]] const MotorMode& motor(std::size_t i) const {
    return std::get<CoupledLoop<>>(run.model().system).motors[i];
  }
  [[nodiscard]] std::vector<double> guards() const {
    std::vector<double> values(run.guards());
    run.evaluate_guards(0, z.data(), values.data());
    return values;
  }

  Model model;
  HybridSystem run;
  std::vector<double> z;
};

}  // namespace

// Forces act on a ball of 1 kg.
TEST_CASE("rolling resistance holds a ball while the slope is below its coefficient") {
  Start start(ball_on(0.0019, "rolling: 0.002"));
  CHECK(start.contact().rests);
  CHECK(start.guards()[0] ==
        Approx(gravity * (0.002 * std::cos(0.0019) - std::sin(0.0019))).epsilon(1e-9));
}

TEST_CASE("a ball on a steeper slope starts downhill") {
  const double theta = GENERATE(0.003, -0.003);
  Start start(ball_on(theta, "rolling: 0.002"));
  CHECK_FALSE(start.contact().rests);
  const auto& along = start.contact().roll.along;
  CHECK(std::abs(along[1]) == Approx(1));
  CHECK(std::abs(along[0]) < 1e-12);
  // The acceleration has the same sign.
  std::vector<double> rates(start.z.size());
  std::get<CoupledGiven<>>(start.run.model().system).derivative(0.0, start.z.data(), rates.data());
  CHECK(rates[3] * along[1] ==
        Approx(gravity * (std::sin(0.003) - 0.002 * std::cos(0.003)) / 1.4).epsilon(1e-9));
}

TEST_CASE("friction opposes a moving ball's velocity") {
  Start start(ball_on(0, "rolling: 0.002"), 0.3, -0.4);
  CHECK_FALSE(start.contact().rests);
  CHECK(start.contact().roll.moving == 1);
  std::vector<double> rates(start.z.size());
  std::get<CoupledGiven<>>(start.run.model().system).derivative(0.0, start.z.data(), rates.data());
  CHECK(rates[2] == Approx(-0.6 * 0.002 * gravity / 1.4).epsilon(1e-12));
  CHECK(rates[3] == Approx(0.8 * 0.002 * gravity / 1.4).epsilon(1e-12));
}

TEST_CASE("a velocity that has crossed zero against its held direction becomes zero") {
  Start start(ball_on(0, "rolling: 0.002"), 1e-9, 0);  // below the resolution
  CHECK(start.contact().roll.moving == 0);
  CHECK(start.guards()[0] == Approx(1e-9));
  start.z[2] = -1e-15;
  CHECK(start.run.handle_state_event(0, 0.01, start.z.data()) == Effect::restart);
  CHECK(start.z[2] == 0);
  CHECK(start.contact().rests);
}

TEST_CASE("pivoting friction stops a spin") {
  Start start(ball_on(0, "pivoting: 0.0001"));
  CHECK(start.contact().held);
  start.z[4] = 0.1;
  CHECK(start.run.handle_state_event(0, 0.01, start.z.data()) == Effect::restart);
  CHECK_FALSE(start.contact().held);
  CHECK(start.contact().turns == 1);
  CHECK(start.guards()[4] == 0.1);
}

TEST_CASE("a ball slides if rolling needs more than static friction") {
  // Rolling down a slope needs a friction coefficient of 2/7 of its tangent.
  const std::string slip =
      "events: {slip: {friction: 0.1, sliding_friction: 0.08, action: slide}}\n";
  Start rolls(ball_on(0.3, "rolling: 0", slip));
  CHECK_FALSE(rolls.contact().slides);
  const double n = gravity * std::cos(0.3);
  CHECK(rolls.guards()[2] == Approx(n * (0.1 - std::tan(0.3) * 2 / 7)).epsilon(1e-9));
  Start slides(ball_on(0.4, "rolling: 0", slip));
  CHECK(slides.contact().slides);
  std::vector<double> rates(slides.z.size());
  std::get<CoupledGiven<>>(slides.run.model().system)
      .derivative(0.0, slides.z.data(), rates.data());
  CHECK(std::abs(rates[3]) ==
        Approx(gravity * (std::sin(0.4) - 0.08 * std::cos(0.4))).epsilon(1e-9));
  // The start of sliding is a separate event.
  CHECK(slides.run.check_events(0, slides.z.data()) == Effect::none);
  REQUIRE(slides.run.log().occurrences().size() == 1);
  CHECK(slides.run.log().occurrences()[0].name == "slip");
}

TEST_CASE("a motor's friction holds its axis against a smaller torque") {
  const auto text = [](double torque, const std::string& motor) {
    return "ball: {radius: 0.02, mass: 0.05}\n"
           "plate: {inertia: [4e-3, 6e-3, 1e-2]}\n"
           "gimbal: {torque: {phi: " +
           std::to_string(torque) + "}, motor: {" + motor +
           "}}\n"
           "time: {end: 1, step: 0.1}\n";
  };
  Start held(text(0.01, "friction: 0.02"));
  CHECK(held.motor(0).free == 0);
  CHECK(held.guards()[5] == Approx(0.01));  // 0.02 minus the required torque
  Start turns(text(0.03, "friction: 0.02"));
  CHECK(turns.motor(0).free == 1);
  CHECK(turns.motor(0).opposed == 1);
  CHECK(turns.motor(1).free == 0);
}

TEST_CASE("a motor's torque stays within its limit") {
  const std::string text =
      "ball: {radius: 0.02, mass: 0.05, position: [0, 0.05]}\n"
      "plate: {inertia: [4e-3, 6e-3, 1e-2]}\n"
      "gimbal: {motor: {torque_limit: 0.1}}\n"
      "controller: {pd: {kp: 10, kv: 0}, drives: torque, reference: {point: [0, 0]}}\n"
      "time: {end: 1, step: 0.1}\n";
  Start start(text);  // demands 0.5 N m of phi
  const std::size_t phi = std::abs(start.motor(0).side) == 1 ? 0 : 1;
  CHECK(start.motor(phi).factor == 0);
  CHECK(std::abs(start.motor(phi).set) == Approx(0.1));
  CHECK(start.motor(1 - phi).factor == 1);
  CHECK(start.guards()[4 * phi + 2] == Approx(0.4));  // beyond the limit
  CHECK(start.guards()[4 * (1 - phi) + 2] == Approx(0.1));
}

}  // namespace bbsim_test::test_dry_friction
