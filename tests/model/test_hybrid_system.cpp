// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run of a scene with switches: its time events, guards and jumps.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/hybrid/hybrid_system.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_hybrid_system {

using namespace bbsim;
using namespace bbsim::model;

namespace {

const std::string sampled =
    "ball: {radius: 0.02, position: [0.05, 0]}\n"
    "time: {end: 10, step: 0.1}\n"
    "gimbal: {servo: {natural_frequency: 30, damping: 0.8, rate_limit: 5}}\n"
    "controller: {gravity_compensation: {kp: 4, kv: 4}, drives: angle, limit: 0.2,\n"
    "  reference: {circle: {radius: 0.05, rate: 1}}, sampling: {period: 0.02, delay: 0.005}}\n";

const std::string continuous =
    "ball: {radius: 0.02, position: [0.05, 0]}\n"
    "time: {end: 10, step: 0.1}\n"
    "gimbal: {servo: {natural_frequency: 30, damping: 0.8, angle_limit: 0.1}}\n"
    "controller: {pd: {kp: [[4, 0], [0, -4]], kv: [[1, 0], [0, -1]]}, drives: angle, limit: 0.15, "
    "reference: {point: [0, 0]}}\n";

const std::string prescribed =
    "ball: {radius: 0.02}\n"
    "plate: {size: [0.2, 0.2]}\n"
    "time: {end: 10, step: 0.1}\n"
    "gimbal: {motion: {phi: {pulse: {start: 0.5, duration: 0.2, value: 0.4}}}}\n"
    "events: {edge: note, tilt: {limit: 0.3, action: stop}}\n";

Model model_of(const std::string& text) {
  return assemble(test::parse(text), false);
}

std::vector<double> guards_of(const HybridSystem& run, double t, const std::vector<double>& z) {
  std::vector<double> values(run.guards());
  run.evaluate_guards(t, z.data(), values.data());
  return values;
}

// The first guard that is not positive.
std::size_t crossed(const HybridSystem& run, double t, const std::vector<double>& z) {
  const std::vector<double> values = guards_of(run, t, z);
  return static_cast<std::size_t>(
      std::find_if(values.begin(), values.end(), [](double value) { return !(value > 0); }) -
      values.begin());
}

}  // namespace

TEST_CASE("a sampled rig has time events at its samples and command arrivals") {
  const Model model = model_of(sampled);
  HybridSystem run(model, 1e-8);
  std::vector<double> z = model.initial;
  CHECK(run.is_due(0));
  run.handle_time_event(0, z.data());
  CHECK(run.touched());
  const double times[] = {0.005, 0.02, 0.025, 0.04, 0.045};
  for (const double t : times) {
    const double sample = std::floor(t / 0.02 + 1e-9) * 0.02;
    const bool commands = t - sample > 1e-9;
    CAPTURE(t);
    CHECK(run.next_time_event() == Approx(t).epsilon(1e-14));
    CHECK(run.is_due(t));
    CHECK_FALSE(run.is_due(t - 1e-6));
    CHECK(run.changes_at(t) == commands);
    run.handle_time_event(t, z.data());
    // A sample alone does not affect the motion.
    CHECK(run.touched() == commands);
  }
}

TEST_CASE("only switching parts have guards") {
  const auto guards = [](const std::string& text) {
    return HybridSystem(model_of(text), 0).guards();
  };
  CHECK(guards(sampled) == 2 * ServoAxis::guards);
  CHECK(guards(continuous) == 2 * ServoAxis::guards + 4);  // two limits of each command
  CHECK(guards(prescribed) == 2);                          // two events
  const HybridSystem run(model_of(continuous + "events: {lift_off: stop}\n"), 0);
  CHECK(run.guards() == 2 * ServoAxis::guards + 5);
  CHECK(run.first_monitor() == run.guards() - 1);
  CHECK(run.guard_scales().size() == run.guards());
  for (const double scale : run.guard_scales()) CHECK(scale > 0);
}

TEST_CASE("a command saturates at its limit and is free again within it") {
  const Model model = model_of(continuous);
  HybridSystem run(model, 0);
  std::vector<double> z = model.initial;  // demands 0.2 rad
  run.handle_time_event(0, z.data());
  const auto axis = [&] { return std::get<RigLoop<>>(run.model().system).mode.axis[0]; };
  CHECK(std::abs(axis().side) == 1);
  CHECK(axis().command_factor == 0);
  CHECK(std::abs(axis().set_command) == Approx(0.15));
  CHECK(crossed(run, 0, z) == run.guards());  // all are positive
  z[0] = 0.0375 * (1 - 1e-9);
  const std::size_t guard = crossed(run, 0, z);
  REQUIRE(guard < 4);
  CHECK(run.handle_state_event(guard, 0.01, z.data()) == Effect::restart);
  CHECK(axis().side == 0);
  CHECK(axis().command_factor == 1);
  CHECK(crossed(run, 0, z) == run.guards());
}

TEST_CASE("a servo's stop kicks the ball by the jump of the plane's rate") {
  const Model model = model_of(continuous);
  HybridSystem run(model, 0);
  std::vector<double> z = model.initial;
  z[0] = 0.01;
  run.handle_time_event(0, z.data());
  z[RigLayout::angle] = 0.1;
  z[RigLayout::rate] = 2;
  const auto& loop = std::get<RigLoop<>>(run.model().system);
  const auto kick = loop.impulse(z.data(), -2, 0);
  const std::size_t guard = crossed(run, 0, z);
  REQUIRE(guard < run.guards());
  const std::vector<double> before = z;
  CHECK(run.handle_state_event(guard, 0.01, z.data()) == Effect::restart);
  CHECK_FALSE(run.unsettled());
  CHECK(z[RigLayout::rate] == 0);
  CHECK(z[RigLayout::angle] == 0.1);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(z[2 + i] - before[2 + i] == Approx(kick[i]).margin(1e-15));
  }
}

TEST_CASE("monitors note an event once, until it ends") {
  const Model model = model_of(prescribed);
  HybridSystem run(model, 0);
  std::vector<double> z = model.initial;
  CHECK(run.check_events(0, z.data()) == Effect::none);
  CHECK(guards_of(run, 0, z)[0] == Approx(0.1));
  z[0] = 0.11;
  CHECK(run.check_events(0.1, z.data()) == Effect::none);
  CHECK(run.check_events(0.2, z.data()) == Effect::none);
  REQUIRE(run.log().occurrences().size() == 1);
  CHECK(run.log().occurrences()[0].name == "edge");
  CHECK(run.log().occurrences()[0].t == 0.1);
  CHECK(run.occurring()[0] == 1);
  CHECK(guards_of(run, 0.2, z)[0] == Approx(0.01));  // guard of the event's end
  CHECK(run.handle_state_event(0, 0.3, z.data()) == Effect::none);
  CHECK(run.occurring()[0] == 0);
  // The other event stops the run.
  CHECK_FALSE(run.stops(0));
  CHECK(run.stops(1));
  CHECK(guards_of(run, 0.6, z)[1] == Approx(-0.1));
  CHECK(run.handle_state_event(1, 0.6, z.data()) == Effect::stop);
  CHECK_FALSE(run.stops(1));
}

TEST_CASE("stops of the input are passed in order") {
  const Model model = model_of(prescribed);
  HybridSystem run(model, 0);
  std::vector<double> z = model.initial;
  run.handle_time_event(0, z.data());
  for (const double t : {0.5, 0.6, 0.7}) {  // the pulse's start, middle and end
    CHECK(run.next_time_event() == Approx(t));
    CHECK(run.next_change() == run.next_time_event());
    run.handle_time_event(t, z.data());
  }
  CHECK(run.next_time_event() == unlimited);
}

}  // namespace bbsim_test::test_hybrid_system
