// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenario of a rig that `bbsim new rig` writes.
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_new_rig {

using Catch::Matchers::Contains;

namespace {

using Words = std::vector<std::string>;

Result new_rig(const Folder& folder, const Words& options) {
  Words words{"new", "rig"};
  words.insert(words.end(), options.begin(), options.end());
  return bbsim(words, folder.path());
}

// Checks that the ball ends near its reference and nothing ends the run early.
void check_balances(const Folder& folder, const std::string& within) {
  const Result run = bbsim({"run", "my-rig.yaml", "-o", "/dev/null", "-q", "--expect",
                            "max_tracking_error from 10 s < " + within},
                           folder.path());
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
}

}  // namespace

TEST_CASE("the rig scenario of every class balances its ball", "[slow]") {
  const Folder folder;
  const std::string plate = GENERATE("300 mm x 200 mm", "250 mm");
  const std::string ball = GENERATE("ping-pong", "steel", "rubber", "golf");
  const std::string servo = GENERATE("hobby-standard", "hobby-micro", "smart-serial");
  const std::string legs = GENERATE("2", "3");
  const auto [sensor, rate] =
      GENERATE(table<std::string, std::string>({{"--camera", "30 Hz"}, {"--touch", "50 Hz"}}));
  CAPTURE(plate, ball, servo, legs, sensor);
  const Result made = new_rig(
      folder, {"--plate", plate, "--ball", ball, "--servo", servo, "--legs", legs, sensor, rate});
  REQUIRE(made.exit_code == 0);
  check_balances(folder, servo == "hobby-micro" ? "8 mm" : "2 mm");
}

TEST_CASE("rigs at the limits of the options balance their ball") {
  const Folder folder;
  const std::string plate = GENERATE("150 mm", "600 mm x 600 mm");
  const std::string servo = GENERATE("hobby-standard", "smart-serial");
  const auto [sensor, rate] = GENERATE(table<std::string, std::string>({{"--camera", "15 Hz"},
                                                                        {"--camera", "200 Hz"},
                                                                        {"--touch", "15 Hz"},
                                                                        {"--touch", "200 Hz"}}));
  CAPTURE(plate, servo, sensor, rate);
  REQUIRE(new_rig(folder, {"--plate", plate, "--servo", servo, sensor, rate}).exit_code == 0);
  check_balances(folder, rate == "15 Hz" ? "10 mm" : "2 mm");
}

TEST_CASE("rigs with stepper motors balance their ball") {
  const Folder folder;
  const std::string legs = GENERATE("2", "3");
  const std::string ball = GENERATE("ping-pong", "steel");
  CAPTURE(legs, ball);
  REQUIRE(new_rig(folder, {"--actuator", "stepper", "--legs", legs, "--ball", ball}).exit_code ==
          0);
  CHECK_THAT(folder.read("my-rig.yaml"), Contains("stepper:") && !Contains("model:"));
  check_balances(folder, "2 mm");
  REQUIRE(new_rig(folder, {"--actuator", "stepper", "--legs", legs, "--ball", ball, "--servo",
                           "nema17", "--force"})
              .exit_code == 0);
  CHECK_THAT(folder.read("my-rig.yaml"), Contains("model: nema17"));
  check_balances(folder, "2 mm");
  const Result both = new_rig(folder, {"--actuator", "stepper", "--servo", "hobby-micro"});
  CHECK(both.exit_code == 2);
  CHECK_THAT(both.err, Contains("--servo: found hobby-micro; allowed: nema14"));
  CHECK(new_rig(folder, {"--servo", "nema17"}).exit_code == 2);
}

TEST_CASE("rigs have margins of at least 6 dB and 30 degrees") {
  const Folder folder;
  const std::string servos[] = {"hobby-standard", "hobby-micro", "smart-serial"};
  const std::string balls[] = {"ping-pong", "steel", "80 mm 20 g hollow"};
  const std::string rates[] = {"15 Hz", "60 Hz", "200 Hz"};
  for (std::size_t i = 0; i < 9; ++i) {  // each pair of servo, ball and rate
    const Words words{"--servo",  servos[i / 3],          "--ball", balls[i % 3],
                      "--camera", rates[(i / 3 + i) % 3], "--force"};
    CAPTURE(words);
    REQUIRE(new_rig(folder, words).exit_code == 0);
    CHECK_THAT(bbsim({"check", "my-rig.yaml"}, folder.path()).out,
               Contains("\nmargins ") && !Contains("small margins"));
  }
}

TEST_CASE("a rig follows its options and asks nothing without a terminal") {
  const Folder folder;
  const Result made = new_rig(folder, {});
  REQUIRE(made.exit_code == 0);
  CHECK(made.out.empty());
  CHECK(made.err ==
        "my-rig.yaml: a scenario of a rig. Its comments say how to find your rig's numbers. Next:\n"
        "  bbsim check my-rig.yaml\n  bbsim run my-rig.yaml\n  bbsim replay my-rig.yaml\n");
  const std::string text = folder.read("my-rig.yaml");
  CHECK_THAT(text, Contains("plate: {size: [\"300 mm\", \"200 mm\"]} ") &&
                       Contains("model: hobby-standard ") && Contains("  linkage: ") &&
                       Contains("period: \"30 Hz\" ") && Contains("inertia_factor: 0.667 ") &&
                       Contains("a pixel") && !Contains("three_servos") && !Contains("@") &&
                       Contains("\n# yaml-language-server: $schema="));
  const Result check = bbsim({"check", "my-rig.yaml"}, folder.path());
  CHECK(check.exit_code == 0);
  CHECK_THAT(check.out, Contains("\n             stable: ") && !Contains("WARNING"));

  const Result other =
      new_rig(folder, {"--plate", "0.25", "--ball", "30 mm 110 g", "--servo", "smart-serial",
                       "--touch", "100 Hz", "--legs", "3", "-o", "-"});
  REQUIRE(other.exit_code == 0);
  CHECK(other.err.empty());
  CHECK_THAT(other.out, Contains("plate: {diameter: \"250 mm\"} ") &&
                            Contains("radius: \"15 mm\" ") && Contains("mass: \"110 g\" ") &&
                            Contains("inertia_factor: 0.4 ") && Contains("model: smart-serial ") &&
                            Contains("three_servos: ") && Contains("period: \"100 Hz\" ") &&
                            Contains("of a step") && !Contains("linkage: ") && !Contains("@"));
}

TEST_CASE("a light ball is assumed hollow unless its option says otherwise") {
  const Folder folder;
  const auto [ball, factor] =
      GENERATE(table<std::string, std::string>({{"40 mm 2.7 g", "0.667"},
                                                {"40mm 33g", "0.4"},
                                                {"4 cm 2.7 g solid", "0.4"},
                                                {"0.04 0.033 hollow", "0.667"}}));
  CAPTURE(ball);
  const Result made = new_rig(folder, {"--ball", ball, "-o", "-"});
  CHECK(made.exit_code == 0);
  CHECK_THAT(made.out,
             Contains("radius: \"20 mm\" ") && Contains("inertia_factor: " + factor + ' '));
}

TEST_CASE("a table tennis ball has several names") {
  const Folder folder;
  const std::string name = GENERATE("table tennis", "Table-Tennis", "ping pong", "ping-pong");
  const Result made = new_rig(folder, {"--ball", name, "-o", "-"});
  CAPTURE(name, made.err);
  CHECK(made.exit_code == 0);
  CHECK_THAT(made.out, Contains("radius: \"20 mm\" "));
}

TEST_CASE("inconsistent rig options are refused and nothing is written") {
  const Folder folder;
  const std::string plate =
      "; allowed: two sides, or the diameter of a disc, from 150 mm to 600 mm, such as \"300 mm x "
      "200 mm\" or \"250 mm\"\n";
  const std::string rate = "; allowed: a rate from 15 Hz to 200 Hz, such as \"30 Hz\"\n";
  const std::string ball =
      "; allowed: ping-pong, steel, rubber, golf, or a diameter and a mass, such as \"40 mm 2.7 "
      "g\","
      " with or without hollow or solid\n";
  const std::string help = "\nRun bbsim new --help for more information.\n";
  const auto [words, message] = GENERATE_COPY(table<Words, std::string>(
      {{Words{"rig", "--plate", "300 x 200 mm"}, "--plate: found 300 x 200 mm" + plate},
       {Words{"rig", "--plate", "300 mm x"}, "--plate: found 300 mm x" + plate},
       {Words{"rig", "--plate", "300 g"}, "--plate: found 300 g" + plate},
       {Words{"rig", "--ball", "tennis"}, "--ball: found tennis" + ball},
       {Words{"rig", "--ball", "40 mm"}, "--ball: found 40 mm" + ball},
       {Words{"rig", "--ball", "40 mm -1 g"}, "--ball: found 40 mm -1 g" + ball},
       {Words{"rig", "--ball", "12 cm 100 g"},
        "--ball: found 12 cm 100 g; allowed: a diameter from 5 mm to half of the plate's smaller "
        "side, 100 mm\n"},
       {Words{"rig", "--camera", "30"}, "--camera: found 30" + rate},
       {Words{"rig", "--camera", "1 Hz"}, "--camera: found 1 Hz" + rate},
       {Words{"rig", "--touch", "33 ms"}, "--touch: found 33 ms" + rate},
       {Words{"rig", "python"}, "found python, which bbsim new rig does not take." + help},
       {Words{"controller"}, "LANGUAGE is required" + help},
       {Words{"controller", "c", "--ball", "golf"}, "--ball: an option of bbsim new rig" + help}}));
  Words all{"new"};
  all.insert(all.end(), words.begin(), words.end());
  const Result result = bbsim(all, folder.path());
  CHECK(result.exit_code == 2);
  CHECK(result.err == message);
  CHECK(folder.files().empty());
}

TEST_CASE("on a terminal, a rig without options is set up by questions") {
  const Folder folder;
  // An invalid answer is asked again; Enter takes the default.
  std::string shown = on_terminal({"new", "rig"}, 120, folder.path(), 20, "bbsim replay", "xterm",
                                  "250\n250 mm\n\nsmart-serial\ntouch 50 Hz\n3\n");
  CHECK_THAT(shown, Contains("for a disc [300 mm x 200 mm]: ") &&
                        Contains("--plate: found 250; allowed: two sides") &&
                        Contains("[ping-pong]: ") && Contains("[hobby-standard]: ") &&
                        Contains("[camera 30 Hz]: ") && Contains("[2]: "));
  CHECK_THAT(folder.read("my-rig.yaml"),
             Contains("diameter: \"250 mm\"") && Contains("mass: \"2.7 g\"") &&
                 Contains("model: smart-serial ") && Contains("period: \"50 Hz\"") &&
                 Contains("of a step") && Contains("three_servos: "));

  // Ctrl-D takes all remaining defaults.
  shown = on_terminal({"new", "rig", "-o", "rest.yaml"}, 120, folder.path(), 20, "bbsim replay",
                      "xterm", "250 mm\n\x04");
  CHECK_THAT(shown, !Contains("[hobby-standard]: "));
  CHECK_THAT(folder.read("rest.yaml"), Contains("diameter: \"250 mm\"") &&
                                           Contains("model: hobby-standard ") &&
                                           Contains("period: \"30 Hz\""));

  // With enough options, nothing is asked.
  shown = on_terminal({"new", "rig", "--legs", "3", "-o", "legs.yaml"}, 120, folder.path(), 20,
                      "bbsim replay");
  CHECK_THAT(shown, !Contains("[ping-pong]: "));
  CHECK_THAT(folder.read("legs.yaml"), Contains("three_servos: "));
}

}  // namespace bbsim_test::test_new_rig
