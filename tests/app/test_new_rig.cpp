// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenario of a rig that `bbsim new rig` writes.
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_new_rig {

namespace {

// Checks that the ball ends near its reference and nothing ends the run early.
void check_balances(const Folder& folder, const std::string& within) {
  const Result run = expect(
      0, "run my-rig.yaml -o /dev/null -q --expect 'max_tracking_error from 10 s < " + within + "'",
      folder);
  CHECK(run.err.empty());
}

}  // namespace

TEST_CASE("the rig scenario of every class balances its ball", "[slow]") {
  const Folder folder;
  const std::string plate = GENERATE("'300 mm x 200 mm'", "'250 mm'");
  const std::string ball = GENERATE("ping-pong", "steel", "rubber", "golf");
  const std::string servo = GENERATE("hobby-standard", "hobby-micro", "smart-serial");
  const std::string legs = GENERATE("2", "3");
  const std::string sensor = GENERATE("--camera '30 Hz'", "--touch '50 Hz'");
  expect(0,
         "new rig --plate " + plate + " --ball " + ball + " --servo " + servo + " --legs " + legs +
             " " + sensor,
         folder);
  check_balances(folder, servo == "hobby-micro" ? "8 mm" : "2 mm");
}

TEST_CASE("rigs at the limits of the options balance their ball") {
  const Folder folder;
  const std::string plate = GENERATE("'150 mm'", "'600 mm x 600 mm'");
  const std::string servo = GENERATE("hobby-standard", "smart-serial");
  const std::string sensor = GENERATE("--camera", "--touch"), rate = GENERATE("15 Hz", "200 Hz");
  expect(0, "new rig --plate " + plate + " --servo " + servo + " " + sensor + " '" + rate + "'",
         folder);
  check_balances(folder, rate == "15 Hz" ? "10 mm" : "2 mm");
}

TEST_CASE("rigs with stepper motors balance their ball") {
  const Folder folder;
  const std::string ball = GENERATE("ping-pong", "steel"), legs = GENERATE("2", "3");
  const std::string rig =
      "new rig --actuator stepper --legs " + legs + " --ball " + ball + " --force";
  for (const std::string motor : {"", "nema17"}) {
    expect(0, rig + (motor.empty() ? "" : " --servo " + motor), folder);
    const std::string text = folder.read("my-rig.yaml");
    CHECK(contains(text, "stepper:"));
    CHECK(contains(text, "model: nema17") == (motor == "nema17"));
    check_balances(folder, "2 mm");
  }
  expect(2, rig + " --servo hobby-micro", folder, {"--servo: found hobby-micro; allowed: nema14"});
  expect(2, "new rig --servo nema17", folder);
}

TEST_CASE("rigs have margins of at least 6 dB and 30 degrees") {
  const Folder folder;
  const std::string servos[] = {"hobby-standard", "hobby-micro", "smart-serial"};
  const std::string balls[] = {"ping-pong", "steel", "80 mm 20 g hollow"};
  const std::string rates[] = {"15 Hz", "60 Hz", "200 Hz"};
  for (std::size_t i = 0; i < 9; ++i) {  // each pair of servo, ball and rate
    expect(0,
           "new rig --servo " + servos[i / 3] + " --ball '" + balls[i % 3] + "' --camera '" +
               rates[(i / 3 + i) % 3] + "' --force",
           folder);
    expect(0, "check my-rig.yaml", folder, {}, {"\nmargins ", "!small margins"});
  }
}

TEST_CASE("a rig follows its options and asks nothing without a terminal") {
  const Folder folder;
  const Result made = expect(0, "new rig", folder,
                             {"my-rig.yaml: ", "  bbsim check my-rig.yaml\n",
                              "  bbsim run my-rig.yaml\n", "  bbsim replay my-rig.yaml\n"});
  CHECK(made.out.empty());
  const std::string text = folder.read("my-rig.yaml");
  for (const char* const part :
       {"plate: {size: [\"300 mm\", \"200 mm\"]} ", "model: hobby-standard ",
        "  linkage: ", "period: \"30 Hz\" ", "inertia_factor: 0.667 ", "a pixel",
        "\n# yaml-language-server: $schema="}) {
    CAPTURE(part);
    CHECK(contains(text, part));
  }
  CHECK_FALSE(contains(text, "three_servos"));
  CHECK_FALSE(contains(text, "@"));
  expect(0, "check my-rig.yaml", folder, {}, {"\n             stable: ", "!WARNING"});

  const Result other =
      expect(0,
             "new rig --plate 0.25 --ball '30 mm 110 g' --servo smart-serial "
             "--touch '100 Hz' --legs 3 -o -",
             folder, {},
             {"plate: {diameter: \"250 mm\"} ", "radius: \"15 mm\" ", "mass: \"110 g\" ",
              "inertia_factor: 0.4 ", "model: smart-serial ",
              "three_servos: ", "period: \"100 Hz\" ", "of a step", "!linkage: ", "!@"});
  CHECK(other.err.empty());
}

TEST_CASE("balls have several names, and a light one is hollow unless its option says otherwise") {
  const auto [ball, factor] =
      GENERATE(table<std::string, std::string>({{"40 mm 2.7 g", "0.667"},
                                                {"40mm 33g", "0.4"},
                                                {"4 cm 2.7 g solid", "0.4"},
                                                {"0.04 0.033 hollow", "0.667"},
                                                {"table tennis", "0.667"},
                                                {"Table-Tennis", "0.667"},
                                                {"ping pong", "0.667"},
                                                {"ping-pong", "0.667"}}));
  expect(0, call("new rig --ball '" + ball + "' -o -"), {},
         {"radius: \"20 mm\" ", "inertia_factor: " + factor + ' '});
}

TEST_CASE("inconsistent rig options are refused and nothing is written") {
  const Folder folder;
  const std::string plate =
      "; allowed: two sides, or the diameter of a disc, from 150 mm to 600 mm";
  const std::string rate = "; allowed: a rate from 15 Hz to 200 Hz";
  const std::string ball = "; allowed: ping-pong, steel, rubber, golf, or a diameter and a mass";
  const auto [words, message] = GENERATE_COPY(table<std::string, std::string>(
      {{"rig --plate '300 x 200 mm'", "--plate: found 300 x 200 mm" + plate},
       {"rig --plate '300 mm x'", "--plate: found 300 mm x" + plate},
       {"rig --plate '300 g'", "--plate: found 300 g" + plate},
       {"rig --ball tennis", "--ball: found tennis" + ball},
       {"rig --ball '40 mm'", "--ball: found 40 mm" + ball},
       {"rig --ball '40 mm -1 g'", "--ball: found 40 mm -1 g" + ball},
       {"rig --ball '12 cm 100 g'",
        "--ball: found 12 cm 100 g; allowed: a diameter from 5 mm to half of the plate's smaller "
        "side, 100 mm\n"},
       {"rig --camera 30", "--camera: found 30" + rate},
       {"rig --camera '1 Hz'", "--camera: found 1 Hz" + rate},
       {"rig --touch '33 ms'", "--touch: found 33 ms" + rate},
       {"rig python", "found python, which bbsim new rig does not take."},
       {"controller", "LANGUAGE is required"},
       {"controller c --ball golf", "--ball: an option of bbsim new rig"}}));
  CHECK(expect(2, "new " + words, folder).err.starts_with(message));
  CHECK(folder.files().empty());
}

TEST_CASE("on a terminal, a rig without options is set up by questions") {
  const Folder folder;
  const std::string ball = "[ping-pong]: ", servo = "[hobby-standard]: ";
  const auto check = [&](const std::string& words, const std::string& typed,
                         const std::vector<std::string>& shown,
                         const std::vector<std::string>& written) {
    const std::string screen = on_terminal("new rig -o my.yaml --force" + words, 120, folder, 20,
                                           "bbsim replay", "xterm", typed);
    expect(0, Result{words, 0, folder.read("my.yaml"), screen, 0}, shown, written);
  };
  // An invalid answer is asked again; Enter takes the default.
  check("", "250\n250 mm\n\nsmart-serial\ntouch 50 Hz\n3\n",
        {"for a disc [300 mm x 200 mm]: ", "--plate: found 250; allowed: two sides", ball, servo,
         "[camera 30 Hz]: ", "[2]: "},
        {"diameter: \"250 mm\"", "mass: \"2.7 g\"", "model: smart-serial ", "period: \"50 Hz\"",
         "of a step", "three_servos: "});
  // Ctrl-D takes all remaining defaults.
  check("", "250 mm\n\x04", {"!" + servo},
        {"diameter: \"250 mm\"", "model: hobby-standard ", "period: \"30 Hz\""});
  // With enough options, nothing is asked.
  check(" --legs 3", "", {"!" + ball}, {"three_servos: "});
}

}  // namespace bbsim_test::test_new_rig
