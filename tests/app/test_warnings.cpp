// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Warnings of completed runs about what their user may not have meant.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_warnings {

using Texts = std::vector<std::string>;

namespace {

// A rig with the same gains for phi and theta on a 30 cm plate.
const std::string wrong_sign =
    "ball: {radius: 0.01, position: [0.01, 0.01]}\n"
    "plate: {size: [0.3, 0.3]}\n"
    "gimbal: {servo: {natural_frequency: 20, damping: 1}}\n"
    "controller: {pd: {kv: [[0.6, 0], [0, 0.6]], kp: [[0.7, 0], [0, 0.7]]}, drives: angle,\n"
    "  reference: {point: [0, 0]}}\n"
    "time: {end: 1, step: 0.02}\n";

const std::string right_sign =
    " --set 'controller.pd={kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}'";
const std::string hint =
    "theta's gains have the wrong sign: positive phi drives the ball towards +x, positive theta "
    "towards -y";

}  // namespace

TEST_CASE("run and check both report gains that drive theta the wrong way, with the sign") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  expect(0, "run s.yaml --summary s.json", folder,
         {"warning: the closed loop is unstable about home: ", hint});
  expect(0, "check s.yaml", folder, {},
         {"WARNING      the closed loop is unstable about home: ", hint});
  CHECK(contains(summary_of(folder, "s.json")["warnings"][0], hint));
  CHECK(call("run s.yaml -q", folder).err.empty());
  // A failed run reports its poles once.
  const Result failed =
      expect(1, "run s.yaml --set time.end=200 --set time.step=1", folder, {hint});
  CHECK(count(failed.err, "unstable about home") == 1);
}

TEST_CASE("the sign hint covers every law and each row, and only wrong signs") {
  const std::string both = "; the gains of phi and of theta have the wrong sign";
  const std::string law = ", drives: angle, reference: {point: [0, 0]}}'";
  const std::string sampled = " --set 'controller.sampling={period: 0.02}'";
  const std::string first =
      " --set 'controller.pd.kp=[[-0.7, 0], [0, -0.7]]' --set "
      "'controller.pd.kv=[[-0.7, 0], [0, -0.7]]'";
  const std::string twice =
      " --set 'controller.pd.kp=[[-0.7, 0], [0, 0.7]]' --set "
      "'controller.pd.kv=[[-0.7, 0], [0, 0.7]]'";
  const auto [options, told] = GENERATE_COPY(table<std::string, Texts>({
      {right_sign, {"!warning"}},
      {sampled, {hint, "the sampled loop is unstable"}},
      {" --set 'controller={pid: {kv: [[0.6, 0], [0, 0.6]], kp: [[0.7, 0], [0, 0.7]], ki: [[0.1, "
       "0], [0, 0.1]]}" +
           law,
       {hint}},
      {" --set 'controller={state_feedback: {gain: [[0.7, 0, 0.6, 0], [0, 0.7, 0, 0.6]]}" + law,
       {hint}},
      {first, {"; phi's gains have the wrong sign"}},
      {first + sampled, {"; phi's gains have the wrong sign"}},
      {twice, {both}},
      {twice + sampled, {both}},
      // Without damping, the ball diverges with either sign.
      {" --set controller.pd.kv=0", {"unstable about home", "!" + hint}},
      // A PD feeds a fast servo's rate back through the contact point.
      {right_sign + " --set ball.radius=0.02", {"!warning"}},
      {right_sign + " --set ball.radius=0.02 --set gimbal.servo.natural_frequency=400",
       {"; the derivative of the contact point causes this"}},
  }));
  const Folder folder;
  folder.write("s.yaml", wrong_sign);
  const Result run = call("run s.yaml" + options, folder);
  expect(run.exit_code, run, told);
}

TEST_CASE("a ball that leaves a plate of known size is reported without events") {
  const auto [options, told] = GENERATE(table<std::string, Texts>({
      {"",
       {"warning: the ball is off the plate in the row at t = 1.6 s, at x = 0.16 m, y = 0.032 m",
        "plate.size is [0.3, 0.2] m; events.edge: stop ends it there"}},
      {" --set 'plate.size=[2, 2]'", {"!warning"}},
      {" --set 'plate={diameter: 0.3}'", {"t = 1.5 s", "plate.diameter is 0.3 m"}},
      {" --set 'ball.velocity=[0, 0.1]'", {"t = 1.1 s"}},  // planar scene along y
      {" --set 'ball.position=[1, 0]'", {"t = 0 s"}},
      // With an edge event, it is reported once, at its exact time.
      {" --set 'events={edge: note}'", {"noted: edge, once at t = 1.5", "!warning"}},
      // With an error bound, the rows take another path.
      {" --error 1e-9", {"t = 1.6 s"}},
  }));
  const Folder folder;
  folder.write("s.yaml",
               "ball: {radius: 0.01, velocity: [0.1, 0.02]}\n"
               "plate: {size: [0.3, 0.2]}\n"
               "gimbal: {motion: {phi: 0}}\n"
               "time: {end: 5, step: 0.1}\n");
  expect(0, "run s.yaml --summary s.json" + options, folder, told);
  if (options.empty()) CHECK(summary_of(folder, "s.json")["warnings"].size() == 1);
}

TEST_CASE("the command line's tolerances and error bound override each other's in the file") {
  const Folder folder;
  const std::string scene =
      "ball: {radius: 0.01, position: [0, -0.1]}\n"
      "gimbal: {motion: {phi: {sinusoid: {amplitude: 0.01, frequency: 1}}}}\n"
      "time: {end: 5, step: 0.1}\n";
  folder.write("s.yaml", scene + "solver: {rtol: 1e-3, atol: 1e-4}\n");
  folder.write("e.yaml", scene + "solver: {error: 1e-6}\n");
  expect(0, "run s.yaml --error 1e-9 --summary s.json", folder,
         {"s.yaml:4:16: note: solver.rtol: not used", "s.yaml:4:28: note: solver.atol: not used"});
  CHECK(summary_of(folder, "s.json")["error_bound"] == 1e-9);
  CHECK(summary_of(folder, "s.json")["error_estimate"] <= 1e-9);
  expect(0, "sweep s.yaml --vary ball.radius=list:0.01,0.02 --error 1e-9", folder,
         {"note: solver.rtol: not used"});
  expect(0, "check s.yaml --set solver.error=1e-9", folder, {}, {"note: solver.rtol: not used"});
  expect(0, "run e.yaml --set solver.rtol=1e-5 --summary s.json", folder,
         {"e.yaml:4:17: note: solver.error: not used"});
  CHECK(summary_of(folder, "s.json")["rtol"] == 1e-5);

  // Both on one command line, or in one file, are refused.
  for (const std::string tolerance :
       {"solver.rtol=1e-5", "solver.atol=1e-5", "solver={rtol: 1e-5, atol: 1e-6}"}) {
    for (const std::string command : {"run s.yaml", "sweep s.yaml --vary gravity=list:9,10"}) {
      expect(2, command + " --error 1e-6 --set '" + tolerance + "'", folder,
             {"given together with error"});
    }
  }
  expect(2, "run s.yaml --set solver.error=1e-9 --set solver.rtol=1e-5", folder);
}

TEST_CASE("an angle of more than a turn without a unit gives a warning") {
  const Folder folder;
  folder.write("s.yaml", wrong_sign + "events: {tilt: {limit: 30}}\n");
  const std::string tilt = "warning: events.tilt.limit";
  expect(0, "run s.yaml" + right_sign + " --set gimbal.servo.angle_limit=25", folder,
         {"s.yaml:7:24: " + tilt + ": found 30, which is read in rad; did you mean \"30 deg\"?",
          "--set gimbal.servo.angle_limit=25: warning: gimbal.servo.angle_limit: found 25"});
  expect(0, "check s.yaml", folder, {}, {tilt});
  expect(0, "sweep s.yaml --vary ball.radius=list:0.01", folder, {tilt});
  for (const auto& [key, told] :
       {std::pair<std::string, std::string>{"controller.limit=20", "warning: controller.limit"},
        {"gimbal.servo.angle_limit=6.2", "!warning"},
        {"gimbal.servo.angle_limit=25 rad", "!warning"},  // explicit unit
        {"gimbal.servo.angle_limit=400 deg", "!warning"}}) {
    expect(0, "run s.yaml" + right_sign + " --set events.tilt.limit=1 --set '" + key + "'", folder,
           {told});
  }
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
  for (const std::string command : {"run", "check", "accuracy"}) {
    expect(2, command + " s.yaml", folder,
           {"s.yaml:5:3: controller.lqr: no gain stabilizes this rig"});
  }
  expect(2, "run s.yaml --set 'controller.lqr={position: 1, command: 1e300}'", folder,
         {"--set controller.lqr={position: 1, command: 1e300}: controller.lqr: "});
}

}  // namespace bbsim_test::test_warnings
