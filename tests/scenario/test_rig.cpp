// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys of real rigs: their values, and refused combinations with reasons.
#include <numbers>

#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_rig {

using namespace bbsim;
using namespace bbsim::test;

namespace {

const std::string base =
    "ball: {radius: 0.02}\n"
    "gimbal: {servo: {natural_frequency: \"5 Hz\", damping: 0.8}}\n"
    "controller:\n"
    "  pd: {kv: [[1, 0], [0, -1]], kp: [[1, 0], [0, -1]]}\n"
    "  drives: angle\n"
    "  reference: {point: [0, 0]}\n"
    "time: {end: 1, step: 0.1}\n";

const std::string prescribed =
    "ball: {radius: 0.02}\n"
    "gimbal: {motion: {phi: 0.1}}\n"
    "time: {end: 1, step: 0.1}\n";

}  // namespace

TEST_CASE("commands that are known beforehand take no path and no sensor") {
  const std::string played =
      "ball: {radius: 0.02}\n"
      "gimbal: {servo: {natural_frequency: \"5 Hz\", damping: 0.8}}\n"
      "controller:\n"
      "  commands: {phi: 0.01}\n"
      "  drives: angle\n"
      "time: {end: 1, step: 0.1}\n";
  const Scenario scene = parse(played);
  REQUIRE(commands_of(scene) != nullptr);
  CHECK(std::get<double>(commands_of(scene)->phi.front()) == 0.01);
  const Scenario pursued = parse(base);
  CHECK(commands_of(pursued) == nullptr);
  struct Case {
    std::vector<std::string> overrides;
    std::string says;
  };
  for (const Case& refused :
       {Case{{"controller.reference={point: [0, 0]}"},
             "controller.reference: found beside commands, which follow no path; allowed: without"},
        Case{{"controller.sampling.period=\"20 ms\"", "controller.sensor.noise=\"1 mm\""},
             "controller.sensor: found beside commands, which no measurement changes"},
        Case{{"controller.drives=null", "gimbal.servo=null"},
             "controller.commands: found, but controller.drives is not angle"},
        Case{{"controller.commands={}"}, "profiles of phi and theta, or of one of them"},
        Case{{"output.columns=[t, x_reference]"},
             "but commands follow no path; allowed: other columns, such as phi_command"}}) {
    CAPTURE(refused.overrides.front());
    CHECK_THAT(errors(played, refused.overrides), Catch::Contains(refused.says));
  }
}

TEST_CASE("the parts of a rig are read in SI units") {
  const Scenario scene =
      parse(base, {"gimbal.servo.rate_limit=\"300 deg/s\"", "gimbal.servo.angle_limit=\"25 deg\"",
                   "gimbal.servo.dead_band=0.001", "gimbal.servo.backlash=0.002",
                   "gimbal.servo.acceleration_limit=200", "gimbal.mounting.height=\"5 cm\"",
                   "controller.limit=\"12 deg\"", "controller.sampling.period=\"20 ms\"",
                   "controller.sampling.delay=\"5 ms\"", "controller.sensor.noise=\"0.2 mm\"",
                   "controller.sensor.seed=7", "controller.sensor.area=[\"20 cm\", 0.15]",
                   "plate.size=[0.3, 0.2]", "plate.inertia=[1e-3, 2e-3, 3e-3]", "events.edge=stop",
                   "events.slip={friction: 0.3}", "ball.inertia_factor=0.5"});
  const Servo& servo = *scene.gimbal.servo;
  CHECK(*servo.rate_limit == Approx(5.235987755982989).epsilon(1e-15));
  CHECK(*servo.angle_limit == Approx(0.4363323129985824).epsilon(1e-15));
  CHECK(servo.dead_band == 0.001);
  CHECK(servo.backlash == 0.002);
  CHECK(*servo.acceleration_limit == 200);
  CHECK(scene.gimbal.mounting.height == 0.05);
  CHECK(*scene.controller->limit == Approx(0.20943951023931956).epsilon(1e-15));
  CHECK(scene.controller->sampling->period == 0.02);
  CHECK(scene.controller->sampling->delay == 0.005);
  CHECK(scene.controller->sensor->noise == 2e-4);
  CHECK(scene.controller->sensor->seed == 7);
  CHECK(*scene.controller->sensor->area == Pair{0.2, 0.15});
  CHECK(*scene.plate.size == Pair{0.3, 0.2});
  CHECK(scene.plate.inertia->at(2) == 3e-3);
  CHECK(*scene.events.edge == OnEvent::stop);
  CHECK(scene.events.slip->friction == 0.3);
  CHECK(scene.events.slip->action == OnEvent::note);
  CHECK(scene.ball.inertia_factor == 0.5);
}

TEST_CASE("each law reads its own gains") {
  const auto law = [](const std::string& text) {
    return *parse(
                "ball: {radius: 0.02}\n"
                "gimbal: {servo: {natural_frequency: 30, damping: 1}}\n"
                "controller: {" +
                    text +
                    ", drives: angle, reference: {point: [0, 0]}}\n"
                    "time: {end: 1, step: 0.1}\n",
                {})
                .controller;
  };
  CHECK(law("pid: {kp: 0, kv: 0, ki: [[3, 0], [0, -3]]}").ki == Matrix2{{{3, 0}, {0, -3}}});
  const Controller feedback = law("state_feedback: {gain: [[1, 2, 3, 4], [5, 6, 7, 8]]}");
  CHECK(feedback.law == Law::state_feedback);
  CHECK(feedback.gain[1][3] == 8);
  CHECK(feedback.gain[1][4] == 0);
  CHECK(law("lqr: {position: 10, command: 0.5}").weights.command == 0.5);
  CHECK(law("gravity_compensation: {kp: 4, kv: 4}").law == Law::gravity_compensation);
}

TEST_CASE("combinations that mean nothing are refused, with why") {
  struct Case {
    std::string text;
    std::vector<std::string> overrides;
    std::string says;
  };
  for (const Case& refused : {
           Case{prescribed,
                {"gimbal.servo={rate_limit: 1, natural_frequency: 1, damping: 1}"},
                "gimbal.servo: found beside gimbal.motion, which no servo follows"},
           Case{base,
                {"controller.sensor.noise=0.001"},
                "controller.sensor: found, but no controller.sampling"},
           Case{base,
                {"controller.sampling.period=0.01", "controller.sensor.seed=3"},
                "controller.sensor.seed: found, but nothing here is random"},
           Case{base,
                {"gimbal.servo.dead_band=0.01"},
                "gimbal.servo.dead_band: found without controller.sampling"},
           Case{base,
                {"gimbal.servo={stepper: {}, rate_limit: 5, acceleration_limit: 60}"},
                "gimbal.servo.stepper: found without controller.sampling"},
           Case{base,
                {"gimbal.servo={stepper: {}, rate_limit: 5}", "controller.sampling.period=0.02"},
                "gimbal.servo.stepper: found without rate_limit and acceleration_limit"},
           Case{base,
                {"gimbal.servo={stepper: {}, rate_limit: 5, acceleration_limit: 60, angle_limit: "
                 "0.5}",
                 "controller.sampling.period=0.02"},
                "gimbal.servo.stepper: found beside angle_limit; allowed: controller.limit"},
           Case{base,
                {"gimbal.servo.stepper={}", "gimbal.servo.rate_limit=5",
                 "gimbal.servo.acceleration_limit=60", "controller.sampling.period=0.02"},
                "gimbal.servo.stepper: found beside natural_frequency"},
           Case{base,
                {"gimbal.servo={stepper: {steps: 1.5}, rate_limit: 5, acceleration_limit: 60}",
                 "controller.sampling.period=0.02"},
                "gimbal.servo.stepper.steps: found 1.5; allowed: a whole number"},
           Case{base,
                {"gimbal.servo={time_constant: 0.1}"},
                "gimbal.servo.time_constant: found without controller.sampling"},
           Case{base,
                {"gimbal.servo.time_constant=0.1"},
                "gimbal.servo.natural_frequency: given together with time_constant"},
           Case{base,
                {"controller.sampling.period=0.01",
                 "gimbal.servo={time_constant: 0.1, acceleration_limit: 10}"},
                "gimbal.servo.acceleration_limit: found with time_constant"},
           Case{base, {"events.edge=stop"}, "events.edge: found, but the plate has no edge"},
           Case{base,
                {"events.singularity.distance=0.2"},
                "events.singularity: found without controller.feedback_linearization"},
           Case{base,
                {"controller.pid={kp: 1, ki: 1, kv: 1}"},
                "controller.pid: found beside pd; allowed: one law"},
           Case{base,
                {"gimbal.servo.angle_limit=0.1", "gimbal.start.phi=0.2"},
                "gimbal.start: found beyond gimbal.servo.angle_limit"},
           Case{base, {"output.columns=[t, motor_torque_phi]"}, "plate.inertia is not known"},
           Case{base, {"output.columns=[t, x_measured]"}, "the controller takes no samples"},
           Case{
               base, {"events.slip={friction: 0.3, action: ignore}"}, "allowed: one of stop, note"},
           Case{base,
                {"plate={size: [0.1, 0.1], diameter: 0.2}"},
                "plate.diameter: given together with size"},
       }) {
    CAPTURE(refused.says);
    CHECK_THAT(errors(refused.text, refused.overrides), Catch::Matchers::Contains(refused.says));
  }
}

TEST_CASE("a number as the gain of a PD or PID that drives angles is refused with its matrix") {
  for (const std::string law : {"pd: {kp: 0.6, kv: 0}", "pid: {kp: 0, ki: -0.6, kv: 0}"}) {
    const auto refusal = [&](const std::string& drives) {
      return errors("ball: {radius: 0.02}\n" + drives + ", reference: {point: [0, 0]}, " + law +
                    "}\ntime: {end: 1, step: 0.1}\n");
    };
    CAPTURE(law);
    CHECK_THAT(
        refusal("gimbal: {servo: {natural_frequency: 9, damping: 1}}\n"
                "controller: {drives: angle"),
        Catch::Matchers::Contains(law.starts_with("pd:") ? "pd.kp: found 0.6"
                                                         : "pid.ki: found -0.6") &&
            Catch::Matchers::Contains(law.starts_with("pd:") ? "allowed: [[0.6, 0], [0, -0.6]]"
                                                             : "allowed: [[-0.6, 0], [0, 0.6]]"));
    CHECK(refusal("controller: {drives: acceleration").empty());
  }
}

TEST_CASE("a seed is allowed with random parts, even if they are switched off") {
  for (const char* drawn : {"noise=0.001", "noise=0", "dropout=0.1"}) {
    CHECK(errors(base, {"controller.sampling.period=0.01", "controller.sensor.seed=3",
                        std::string("controller.sensor.") + drawn})
              .empty());
  }
}

TEST_CASE("feedback linearization and gravity compensation drive their own outputs") {
  const auto error_with = [](const std::string& law, const std::string& rest) {
    return errors(
        "ball: {radius: 0.02}\n"
        "gimbal: {servo: {natural_frequency: 30, damping: 1}}\n"
        "controller: {" +
            law + ": {kp: 4, kv: 4}, reference: {point: [0, 0]}" + rest +
            "}\ntime: {end: 1, step: 0.1}\n",
        {});
  };
  CHECK_THAT(error_with("feedback_linearisation", ", drives: angle"),
             Catch::Matchers::Contains("controller.drives: found angle"));
  CHECK_THAT(error_with("gravity_compensation", ", drives: acceleration"),
             Catch::Matchers::Contains("controller.gravity_compensation: found, but"));
}

TEST_CASE("measured periods count toward the number of samples") {
  const TemporaryFolder folder;
  const auto problems = [&](const std::string& period) {
    const std::string file = folder.write("p.csv", "p\n" + period + "\n");
    return errors(
        "ball: {radius: 0.02}\n"
        "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
        "controller: {pd: {kv: [[0.6, 0], [0, -0.6]], kp: 0}, drives: angle, reference: {point: "
        "[0, 0]},\n"
        "  sampling: {period: 0.02, jitter: {file: " +
        file + ", period: p}}}\ntime: {end: 1, step: 0.1}\n");
  };
  CHECK(problems("0.019").empty());
  CHECK(problems("1e-9").find("controller.sampling.jitter: found more than 1e8 samples") !=
        std::string::npos);
}

TEST_CASE("a sensor's dead zones, contact force and misses are checked") {
  const auto read = [](const std::string& sensor, const std::string& mass = ", mass: 0.1") {
    return parse("ball: {radius: 0.02" + mass +
                 "}\ngimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
                 "controller: {gravity_compensation: {kp: 5, kv: 5}, drives: angle, reference: "
                 "{point: [0, 0]}, "
                 "sampling: {period: 0.02}, sensor: " +
                 sensor + "}\ntime: {end: 1, step: 0.1}\n");
  };
  CHECK(read("{contact_force: 0.9}").remarks.empty());
  const auto heavy = read("{contact_force: 1}").remarks;
  REQUIRE(heavy.size() == 1);
  CHECK_THAT(heavy[0], Catch::Matchers::Contains("exceeds the ball's weight of 0.98"));
  CHECK_THROWS_WITH(read("{contact_force: 0.9}", ""),
                    Catch::Matchers::Contains("found, but no ball.mass"));
  CHECK_NOTHROW(read("{contact_force: 20 mN, seed: 2, stuck: {probability: 0.1, duration: 1}}"));
  CHECK_THROWS_WITH(read("{burst: {probability: 0.1, duration: 50 ms}}"),
                    Catch::Matchers::Contains("found without sensor.period"));
  CHECK_THROWS_WITH(read("{stuck: {probability: 0.1}}"),
                    Catch::Matchers::Contains("sensor.stuck.duration: missing"));
  CHECK_THROWS_WITH(read("{stuck: {probability: 1.1, duration: 50 ms}}"),
                    Catch::Matchers::Contains("stuck.probability: found 1.1"));
  CHECK_THROWS_WITH(read("{on_miss: edge}"),
                    Catch::Matchers::Contains("found without sensor.area"));
  CHECK_THROWS_WITH(read("{dead_zones: [[0.1, 0, 0, 0.1]]}"),
                    Catch::Matchers::Contains("found corners in another order"));
}

TEST_CASE("a stepper's torque goes with its inertia, without backlash") {
  const auto fault = [](const std::string& servo, const std::string& events = "") {
    return "ball: {radius: 0.02}\ngimbal: {servo: {rate_limit: 5, acceleration_limit: 60, " +
           servo +
           "}}\ncontroller: {gravity_compensation: {kp: 5, kv: 5}, drives: angle, reference: "
           "{point: [0, 0]}, "
           "sampling: {period: 0.02}}\n" +
           events + "time: {end: 1, step: 0.1}\n";
  };
  CHECK_NOTHROW(
      parse(fault("stepper: {torque: 0.2, inertia: 1e-4}", "events: {steps_lost: stop}\n")));
  CHECK_THROWS_WITH(parse(fault("stepper: {torque: 0.2}")),
                    Catch::Matchers::Contains("one of torque and inertia"));
  CHECK_THROWS_WITH(parse(fault("stepper: {corner_speed: 9}")),
                    Catch::Matchers::Contains("but no torque"));
  CHECK_THROWS_WITH(parse(fault("stepper: {torque: 0.2, inertia: 1e-4}, backlash: 0.01")),
                    Catch::Matchers::Contains("beside backlash"));
  CHECK_THROWS_WITH(parse(fault("stepper: {}", "events: {steps_lost: note}\n")),
                    Catch::Matchers::Contains("no stepper loses steps"));
}

TEST_CASE("a stepper's class stands for its torque, inertia and steps") {
  const auto servo = [](const std::string& keys) {
    return parse("ball: {radius: 0.02}\ngimbal: {servo: {rate_limit: 5, acceleration_limit: 60, " +
                 keys +
                 "}}\ncontroller: {gravity_compensation: {kp: 5, kv: 5}, drives: angle, reference: "
                 "{point: [0, 0]}, sampling: {period: 0.02}}\nevents: {steps_lost: stop}\n"
                 "time: {end: 1, step: 0.1}\n")
        .gimbal.servo->stepper;
  };
  const auto motor = servo("stepper: {model: nema17, inertia: 2e-4}");
  CHECK(motor->steps == 200);
  CHECK(motor->torque == 0.175);  // half of its data sheet's 0.35 N m
  CHECK(motor->inertia == 2e-4);
  CHECK(*servo("stepper: {model: nema23}")->torque > *servo("stepper: {model: nema14}")->torque);
  CHECK_THROWS_WITH(servo("stepper: {model: nema18}"),
                    Catch::Matchers::Contains("stepper.model: found nema18"));
  CHECK_THROWS_WITH(servo("stepper: {model: nema17}, backlash: 0.01"),
                    Catch::Matchers::Contains("beside backlash"));
}

TEST_CASE("a stepper's swings have a natural frequency, and no backlash") {
  const auto servo = [](const std::string& keys) {
    return parse("ball: {radius: 0.02}\ngimbal: {servo: {rate_limit: 5, acceleration_limit: 60, " +
                 keys +
                 "}}\ncontroller: {gravity_compensation: {kp: 5, kv: 5}, drives: angle, reference: "
                 "{point: [0, 0]}, sampling: {period: 0.02}}\ntime: {end: 1, step: 0.1}\n")
        .gimbal.servo->stepper;
  };
  CHECK_FALSE(servo("stepper: {}")->natural_frequency);
  const auto rings = servo("stepper: {natural_frequency: 40 Hz}");
  CHECK(*rings->natural_frequency == Approx(80 * std::numbers::pi).epsilon(1e-15));
  CHECK(rings->damping == 0.1);
  CHECK_THROWS_WITH(servo("stepper: {damping: 0.1}"),
                    Catch::Matchers::Contains("damping: found without natural_frequency"));
  CHECK_THROWS_WITH(servo("stepper: {natural_frequency: 0.9}"),
                    Catch::Matchers::Contains("natural_frequency: found 0.9"));
  CHECK_THROWS_WITH(servo("stepper: {natural_frequency: 90}, backlash: 0.01"),
                    Catch::Matchers::Contains("beside backlash"));
}

}  // namespace bbsim_test::test_rig
