// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Warnings of completed runs about what their user may not have meant.
#include <nlohmann/json.hpp>
#include <string>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_warnings {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A rig with the same gains for phi and theta on a 30 cm plate.
const char* const wrong_sign =
    "ball: {radius: 0.01, position: [0.01, 0.01]}\n"
    "plate: {size: [0.3, 0.3]}\n"
    "gimbal: {servo: {natural_frequency: 20, damping: 1}}\n"
    "controller: {pd: {kv: [[0.6, 0], [0, 0.6]], kp: [[0.7, 0], [0, 0.7]]}, drives: angle,\n"
    "  reference: {point: [0, 0]}}\n"
    "time: {end: 1, step: 0.02}\n";

const char* const right_sign =
    "controller.pd={kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}";
const char* const hint =
    "theta's gains have the wrong sign: positive phi drives the ball towards +x, positive theta "
    "towards -y";

}  // namespace

TEST_CASE("run and check both report gains that drive theta the wrong way, with the sign") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  const Result run = bbsim({"run", "s.yaml", "--summary", "s.json"}, folder.path());
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err, "warning: the closed loop is unstable about home: "));
  CHECK(contains(run.err, hint));
  const Result check = bbsim({"check", "s.yaml"}, folder.path());
  CHECK(contains(check.out, "WARNING      the closed loop is unstable about home: "));
  CHECK(contains(check.out, hint));
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  CHECK(contains(summary["warnings"][0], hint));

  const Result right = bbsim({"run", "s.yaml", "--set", right_sign}, folder.path());
  CHECK(right.exit_code == 0);
  CHECK_FALSE(contains(right.err, "warning"));
  CHECK(bbsim({"run", "s.yaml", "-q"}, folder.path()).err.empty());
}

TEST_CASE("the sign hint covers a sampled loop, a PID and state feedback") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  const auto said = [&](const std::string& key) {
    return bbsim({"run", "s.yaml", "--set", key}, folder.path()).err;
  };
  CHECK(contains(said("controller.sampling={period: 0.02}"), hint));
  CHECK(contains(said("controller.sampling={period: 0.02}"), "the sampled loop is unstable"));
  CHECK(contains(said("controller={pid: {kv: [[0.6, 0], [0, 0.6]], kp: [[0.7, 0], [0, 0.7]], "
                      "ki: [[0.1, 0], [0, 0.1]]}, drives: angle, reference: {point: [0, 0]}}"),
                 hint));
  CHECK(contains(said("controller={state_feedback: {gain: [[0.7, 0, 0.6, 0], [0, 0.7, 0, 0.6]]}, "
                      "drives: angle, reference: {point: [0, 0]}}"),
                 hint));
}

TEST_CASE("the sign hint names the rows whose signs are wrong") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  for (const auto& [gains, told] :
       {std::pair{"[[-0.7, 0], [0, -0.7]]", "; phi's gains have the wrong sign"},
        std::pair{"[[-0.7, 0], [0, 0.7]]",
                  "; the gains of phi and of theta have the wrong sign"}}) {
    for (const char* more : {"controller.sampling={period: 0.02}", "ball.radius=0.01"}) {
      const Result result =
          bbsim({"run", "s.yaml", "--set", std::string("controller.pd.kp=") + gains, "--set",
                 std::string("controller.pd.kv=") + gains, "--set", more},
                folder.path());
      CAPTURE(gains, more, result.err);
      CHECK(contains(result.err, told));
    }
  }
}

TEST_CASE("a PD that feeds a fast servo's rate back through the contact point is told so") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  const auto said = [&](const std::string& frequency) {
    return bbsim({"run", "s.yaml", "--set", right_sign, "--set", "ball.radius=0.02", "--set",
                  "gimbal.servo.natural_frequency=" + frequency},
                 folder.path())
        .err;
  };
  CHECK_FALSE(contains(said("20"), "warning"));
  CHECK(contains(said("400"), "; the derivative of the contact point causes this"));
}

TEST_CASE("a loop that no sign makes stable is reported without the hint") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  // Without damping, the ball diverges with either sign.
  const Result result = bbsim({"run", "s.yaml", "--set", "controller.pd.kv=0"}, folder.path());
  CHECK(contains(result.err, "unstable about home"));
  CHECK_FALSE(contains(result.err, hint));
}

TEST_CASE("a failed run reports its poles once, with the sign") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  const Result result =
      bbsim({"run", "s.yaml", "--set", "time.end=200", "--set", "time.step=1"}, folder.path());
  CHECK(result.exit_code == 1);
  const std::size_t first = result.err.find("unstable about home");
  REQUIRE(first != std::string::npos);
  CHECK(result.err.find("unstable about home", first + 1) == std::string::npos);
  CHECK(contains(result.err, hint));
}

TEST_CASE("a ball that leaves a plate of known size is reported without events") {
  const Folder folder;
  folder.write("s.yaml",
               "ball: {radius: 0.01, velocity: [0.1, 0.02]}\n"
               "plate: {size: [0.3, 0.2]}\n"
               "gimbal: {motion: {phi: 0}}\n"
               "time: {end: 5, step: 0.1}\n");
  const Result result = bbsim({"run", "s.yaml", "--summary", "s.json"}, folder.path());
  CHECK(result.exit_code == 0);
  CHECK(contains(result.err,
                 "warning: the ball is off the plate in the row at t = 1.6 s, at x = 0.16 m, y = "
                 "0.032 m, and the run continues as if the plate were larger: plate.size is [0.3, "
                 "0.2] m; events.edge: stop ends it there"));
  CHECK(nlohmann::json::parse(folder.read("s.json"))["warnings"].size() == 1);

  const auto said = [&](const std::string& key) {
    return bbsim({"run", "s.yaml", "--set", key}, folder.path()).err;
  };
  CHECK_FALSE(contains(said("plate.size=[2, 2]"), "warning"));
  CHECK(contains(said("plate={diameter: 0.3}"), "t = 1.5 s"));
  CHECK(contains(said("plate={diameter: 0.3}"), "plate.diameter is 0.3 m"));
  CHECK(contains(said("ball.velocity=[0, 0.1]"), "t = 1.1 s"));  // planar scene along y
  CHECK(contains(said("ball.position=[1, 0]"), "t = 0 s"));
  // With an edge event, it is reported once, at its exact time.
  CHECK(contains(said("events={edge: note}"), "noted: edge, once at t = 1.5"));
  CHECK_FALSE(contains(said("events={edge: note}"), "warning"));
  // With an error bound, the rows take another path.
  CHECK(contains(bbsim({"run", "s.yaml", "--error", "1e-9"}, folder.path()).err, "t = 1.6 s"));
}

TEST_CASE("the command line's error bound overrides the file's tolerances") {
  const Folder folder;
  folder.write("s.yaml",
               "ball: {radius: 0.01, position: [0, -0.1]}\n"
               "gimbal: {motion: {phi: {sinusoid: {amplitude: 0.01, frequency: 1}}}}\n"
               "time: {end: 5, step: 0.1}\n"
               "solver: {rtol: 1e-3, atol: 1e-4}\n");
  const Result run =
      bbsim({"run", "s.yaml", "--error", "1e-9", "--summary", "s.json"}, folder.path());
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err,
                 "s.yaml:4:16: note: solver.rtol: not used: the command line's bound on the error "
                 "chooses the tolerances"));
  CHECK(contains(run.err, "s.yaml:4:28: note: solver.atol: not used"));
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  CHECK(summary["error_bound"] == 1e-9);
  CHECK(summary["error_estimate"] <= 1e-9);
  const Result sweep =
      bbsim({"sweep", "s.yaml", "--vary", "ball.radius=list:0.01,0.02", "--error", "1e-9"},
            folder.path());
  CHECK(sweep.exit_code == 0);
  CHECK(contains(sweep.err, "note: solver.rtol: not used"));
  CHECK(contains(bbsim({"check", "s.yaml", "--set", "solver.error=1e-9"}, folder.path()).out,
                 "note: solver.rtol: not used"));

  // Both on one command line are refused.
  for (const std::string tolerance :
       {"solver.rtol=1e-5", "solver.atol=1e-5", "solver={rtol: 1e-5, atol: 1e-6}"}) {
    for (const std::string command : {"run", "sweep"}) {
      const Result both = bbsim({command, "s.yaml", "--error", "1e-6", "--set", tolerance, "--set",
                                 "sweep.vary={ball.radius: 'list:0.01,0.02'}"},
                                folder.path());
      CAPTURE(tolerance, both.err);
      CHECK(both.exit_code == 2);
      CHECK(contains(both.err, "given together with error"));
    }
  }
  // Both in one file are refused too.
  CHECK(bbsim({"run", "s.yaml", "--set", "solver.error=1e-9", "--set", "solver.rtol=1e-5"},
              folder.path())
            .exit_code == 2);
}

TEST_CASE("the command line's tolerances override the file's error bound") {
  const Folder folder;
  folder.write("s.yaml",
               "ball: {radius: 0.01, position: [0, -0.1]}\n"
               "gimbal: {motion: {phi: {sinusoid: {amplitude: 0.01, frequency: 1}}}}\n"
               "time: {end: 5, step: 0.1}\n"
               "solver: {error: 1e-6}\n");
  const Result run =
      bbsim({"run", "s.yaml", "--set", "solver.rtol=1e-5", "--summary", "s.json"}, folder.path());
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err,
                 "s.yaml:4:17: note: solver.error: not used: the command line gives "
                 "tolerances instead"));
  CHECK(nlohmann::json::parse(folder.read("s.json"))["rtol"] == 1e-5);
}

TEST_CASE("an angle of more than a turn without a unit gives a warning") {
  const Folder folder;
  folder.write("s.yaml", std::string(wrong_sign) + "events: {tilt: {limit: 30}}\n");
  const std::string angle_limit = "gimbal.servo.angle_limit=25";
  const Result run =
      bbsim({"run", "s.yaml", "--set", right_sign, "--set", angle_limit}, folder.path());
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err,
                 "s.yaml:7:24: warning: events.tilt.limit: found 30, which is read in rad; did "
                 "you mean \"30 deg\"?"));
  CHECK(contains(run.err,
                 "--set gimbal.servo.angle_limit=25: warning: gimbal.servo.angle_limit: "
                 "found 25, which is read in rad"));
  CHECK(contains(bbsim({"check", "s.yaml"}, folder.path()).out, "warning: events.tilt.limit"));
  CHECK(contains(bbsim({"sweep", "s.yaml", "--vary", "ball.radius=list:0.01"}, folder.path()).err,
                 "warning: events.tilt.limit"));
  const auto said = [&](const std::string& key) {
    return bbsim(
               {"run", "s.yaml", "--set", right_sign, "--set", "events.tilt.limit=1", "--set", key},
               folder.path())
        .err;
  };
  CHECK(contains(said("controller.limit=20"), "warning: controller.limit"));
  CHECK_FALSE(contains(said("gimbal.servo.angle_limit=6.2"), "warning"));
  CHECK_FALSE(contains(said("gimbal.servo.angle_limit=25 rad"),
                       "warning"));  // explicit unit
  CHECK_FALSE(contains(said("gimbal.servo.angle_limit=400 deg"), "warning"));
}

TEST_CASE("a regulator without a gain is reported at its place") {
  const Folder folder;
  folder.write("s.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {servo: {natural_frequency: 20, damping: 1}}\n"
               "controller:\n"
               "  drives: angle\n"
               "  lqr: {position: 1, command: 1e300}\n"
               "  reference: {point: [0, 0]}\n"
               "time: {end: 1, step: 0.1}\n");
  for (const char* command : {"run", "check", "accuracy"}) {
    const Result result = bbsim({command, "s.yaml"}, folder.path());
    CAPTURE(command, result.err);
    CHECK(result.exit_code == 2);
    CHECK(contains(result.err, "s.yaml:5:3: controller.lqr: no gain stabilizes this rig"));
  }
  const Result set = bbsim(
      {"run", "s.yaml", "--set", "controller.lqr={position: 1, command: 1e300}"}, folder.path());
  CHECK(contains(set.err, "--set controller.lqr={position: 1, command: 1e300}: controller.lqr: "));
}

}  // namespace bbsim_test::test_warnings
