// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scenario's exercise: read with the other sections, checked only when someone asks.
#include "base/error.hpp"
#include "catch.hpp"
#include "scenario/exercise.hpp"
#include "scenario/family.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_exercise {

using Catch::Matchers::Contains;
using namespace bbsim::test;
using bbsim::scenario::checked_exercise;

namespace {

const std::string closed_loop =
    "ball: {radius: 0.01}\n"
    "time: {end: 1, step: 0.1}\n"
    "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
    "controller: {drives: angle, gravity_compensation: {kp: 4, kv: 4}, reference: {point: [0, "
    "0]}}\n"
    "exercise: ";

// What checked_exercise() says of the section.
std::string faults(const std::string& section) {
  const bbsim::Scenario scenario = parse(closed_loop + section + '\n');
  return message_of<bbsim::InputError>([&] { static_cast<void>(checked_exercise(scenario)); });
}

}  // namespace

TEST_CASE("an exercise has tasks and free keys, and a scenario needs none") {
  const auto exercise = checked_exercise(parse(
      closed_loop +
      "\n  tasks: [{text: Keep it close., expect: max_distance from 0.5 s < 3 mm}]"
      "\n  free: [controller.gravity_compensation.kp, solver.method, ball.losses.rolling]\n"));
  REQUIRE(exercise);
  REQUIRE(exercise->tasks.size() == 1);
  CHECK(exercise->tasks[0].text == "Keep it close.");
  CHECK(exercise->tasks[0].expect == "max_distance from 0.5 s < 3 mm");
  CHECK(exercise->free.size() == 3);
  CHECK_FALSE(checked_exercise(parse(open_loop)));
}

TEST_CASE("bounds and free keys are checked when an exercise is asked for") {
  const auto [section, said] = GENERATE(table<std::string, std::vector<std::string>>({
      {"{tasks: [{text: a, expect: max_tilt}]}",
       {"scenario.yaml:5:38: exercise.tasks.0.expect: found \"max_tilt\"; allowed: "}},
      {"{tasks: [{text: a, expect: max_tilt < 1}, {text: b, expect: max_tlt < 1}]}",
       {"exercise.tasks.1.expect: found max_tlt (did you mean max_tilt?)"}},
      {"{tasks: [{text: a, expect: max_tilt < 3 mm}]}", {"max_tilt is in rad"}},
      {"{tasks: [{text: a, expect: max_tilt from 5 s < 1}]}",
       {"exercise.tasks.0.expect: found max_tilt from 5 s"}},
      {"{free: [controller.gravity_compensation.kq]}",
       {"scenario.yaml:5:19: exercise.free.0: found ",
        "(did you mean controller.gravity_compensation.kp?)"}},
      {"{free: [title]}", {"exercise.free.0: found title, which is neither; allowed: "}},
      {"{free: [controller.pd.kp]}", {"this scenario has no controller.pd"}},
      {"{free: [gimbal.motor.viscous]}", {"exercise.free.0"}},
      // All problems at once.
      {"{tasks: [{text: a, expect: max_tilt}], free: [title]}",
       {"exercise.tasks.0.expect", "exercise.free.0"}},
  }));
  CAPTURE(section);
  for (const std::string& part : said) CHECK_THAT(faults(section), Contains(part));
}

TEST_CASE("an exercise does not change a family's scenarios") {
  const bbsim::ScenarioFamily family(
      bbsim::Source{"a.yaml", closed_loop + "{tasks: [{text: a, expect: no bound}]}\n", {}});
  CHECK(family.read({{"ball.radius", "0.02"}}).ball.radius == 0.02);
}

}  // namespace bbsim_test::test_exercise
