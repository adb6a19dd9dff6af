// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Behavior common to all commands: help, -q, errors, standard input and a reader that closes early.
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "catch.hpp"
#include "shell.hpp"

namespace bbsim_test::test_command_line {

using Names = std::vector<std::string>;

namespace {

const Names commands{"run",       "check",     "measure",  "compare",  "new",
                     "sketch",    "design",    "fit",      "tune",     "sweep",
                     "merge",     "plot",      "replay",   "verify",   "columns",
                     "summarize", "linearize", "accuracy", "examples", "help"};

}  // namespace

TEST_CASE("each command has its help, in three ways, at most 80 columns wide") {
  const Result all = expect(0, call("--help"), {},
                            {"Exit codes", "\nRun and check:\n", "\nRigs:\n", "\nSweeps:\n",
                             "\nAnalysis:\n", "\nPictures:\n", "\nSetup:\n"});
  CHECK(call("help").out == all.out);
  std::string helps = all.out;
  for (const std::string& command : commands) {
    const Result help =
        expect(0, call(command + " --help"), {}, {"Usage: bbsim " + command, "-q,--quiet"});
    CHECK(help.err.empty());
    CHECK(call("help " + command).out == help.out);
    CHECK(call(command + " -q --help").out == help.out);
    helps += help.out;
  }
  for (const std::string& line : lines(helps)) {
    CAPTURE(line);
    CHECK(line.size() <= 80);
    CHECK_FALSE(contains(line, "e+"));  // a bound that is the greatest integer of a double
  }
  for (const char* const other : {"summarise --help", "help summarise"}) {
    CHECK(call(other).out == call("summarize --help").out);
  }
}

TEST_CASE("run and sweep show examples, and the examples run") {
  const Folder folder;
  const std::string configs =
      "bbsim() { \"$BBSIM\" \"$@\"; }; ln -sfn '" BBSIM_SOURCE_DIR "/configs' configs;";
  std::string example;
  bool among_examples = false;
  int examples = 0;
  for (const std::string& line : lines(call("run --help").out + call("sweep --help").out)) {
    if (line.empty() || line.front() != ' ') among_examples = line == "Examples:";
    if (!among_examples || line == "Examples:") continue;
    example += line + "\n";
    if (line.back() == '\\') continue;
    const Result result = shell(configs + example, folder);
    CAPTURE(example, result.err);
    // If the reader closes early, exit code 3 is not a fault of the example.
    CHECK((result.exit_code == 0 || (contains(example, "head") && result.exit_code == 3)));
    CHECK_FALSE(contains(result.err, "allowed"));
    example.clear();
    ++examples;
  }
  CHECK(examples >= 8);
}

TEST_CASE("a misspelled command or option is answered with the nearest one") {
  const auto [line, told] = GENERATE(table<std::string, std::string>({
      {"", "found no command; known: run check"},
      {"fly", "unknown command fly; known: run check"},
      {"swep a.yaml", "unknown command swep; did you mean sweep?"},
      {"comapre a b", "did you mean compare?"},
      {"sumarize", "did you mean summarize?"},
      {"sumarise", "did you mean summarise?"},
      {"run a.yaml --sumary s.json",
       "unknown option --sumary of bbsim run; did you mean --summary?"},
      {"run --eror=1e-6 a.yaml", "unknown option --eror of bbsim run; did you mean --error?"},
      {"run --sumary", "did you mean --summary?"},  // rather than: SCENARIO is required
      {"sweep a.yaml --sampels 3", "did you mean --samples?"},
      {"run a.yaml --quite", "did you mean --quiet?"},
      {"run a.yaml --wings", "unknown option --wings of bbsim run\n"},
      {"--verison", "unknown option --verison of bbsim; did you mean --version?"},
      {"-o a.csv run a.yaml", "-o: found before run; allowed: the options of a command after it."},
      {"run a.yaml b.yaml", "found b.yaml, which bbsim run does not take."},
      {"run", "SCENARIO is required"},
      {"help rnu", "unknown command rnu; did you mean run?"},
  }));
  const Result result = expect(2, call(line), {told, "--help"});
  CHECK(result.out.empty());
}

TEST_CASE("an option's invalid number is answered with the allowed range") {
  const std::string number = GENERATE("0", "-1", "2.5", "x", "1e300");
  expect(2, call("sweep a.yaml --samples " + number),
         {"found " + number + "; allowed: a whole number from 1 up"});
  expect(2, call("sweep a.yaml -j 4096"), {"found 4096; allowed: a whole number from 1 to 1024"});
}

TEST_CASE("the flag -q may stand anywhere, and keeps the reason for a nonzero exit code") {
  const Folder folder;
  CHECK(call("check -q @fig2a.yaml").out == call("-q check @fig2a.yaml").out);
  CHECK(expect(0, "run @fig2a.yaml -q -o a.csv", folder).err.empty());
  expect(0, "compare -q a.csv a.csv", folder);
  expect(0, "columns -q", folder);
  expect(1, "run @fig2b-literal.yaml -q", folder, {"the run ended early, at t = 0.74"});
  expect(1, "run @falls.yaml -q", folder, {"the run stopped at t = ", "!rows"});
  expect(1, "run @fig2a.yaml --error 1e-20 -q", folder, {"is out of reach"});
  expect(130,
         bbsim(Launch{words_of("sweep @fig2a.yaml -q -j 1 --vary "
                               "gimbal.motion.phi.sinusoid.phase=linear:0:1:10000000 -o s.csv"),
                      folder.path(), SIGINT, std::chrono::milliseconds(1500)}),
         {"interrupted "});
}

TEST_CASE("a scenario may come from standard input") {
  const Folder folder;
  folder.write("incline.yaml",
               folder.read(config("incline.yaml")) + "sweep: {vary: {gravity: 'linear:9:10:3'}}\n");
  const Result file = expect(0, "run incline.yaml -o - -q", folder);
  const auto piped = [&](int code, const std::string& line, const Names& errors = {},
                         const Names& output = {}) {
    return expect(code, shell(line, folder), errors, output);
  };
  // Without -o, a scenario from standard input writes its result to standard output.
  CHECK(piped(0, "cat incline.yaml | $BBSIM run - -q").out == file.out);
  piped(0, "$BBSIM run - -o a.csv --set time.end=1 < incline.yaml", {"a.csv: "});
  // A slow writer is waited for, longer than for a file.
  CHECK(piped(0, "(sleep 6; cat incline.yaml) | $BBSIM run - -q").out == file.out);
  piped(0, "cat incline.yaml | $BBSIM check -", {},
        {"standard input is valid", "3 cases of bbsim sweep, over gravity"});
  piped(0, "$BBSIM sweep - < incline.yaml", {}, {"case,gravity,status"});
  piped(2, "echo 'ball: {raduis: 1}' | $BBSIM run -",
        {"standard input:1:8: ball.raduis: unknown key"});
  piped(2, "$BBSIM run - < /dev/null");
  expect(2, "run missing.yaml", folder, {"missing.yaml"});
}

TEST_CASE("a reader that closes early ends the program quietly with exit code 3") {
  const Folder folder;
  folder.write("s.yaml", short_scene);
  for (const std::string line :
       {"run s.yaml -q -o - --set time.step=0.00001 | head -3",
        "sweep s.yaml -q -o - --vary gravity=linear:9:10:100000 | head -3"}) {
    // Not 0, because part of the output was lost.
    const Result result = expect(3, shell("$BBSIM " + line, folder), {}, {"\n"});
    CHECK(result.err.empty());
  }
  for (const std::string line : {"columns", "--help"}) {
    CHECK(shell("$BBSIM " + line + " | true; sleep 0.1", folder).err.empty());
  }
}

TEST_CASE("reports that cannot be written give exit code 3") {
  const Folder folder;
  folder.write("s.yaml", short_scene);
  for (const std::string words : {"--help", "--version", "--schema", "--licenses", "run --help",
                                  "help run", "columns", "check s.yaml"}) {
    expect(3, shell("$BBSIM " + words + " > /dev/full", folder),
           {"cannot write standard output: no space left on device"});
  }
}

TEST_CASE("names from outside do not reach the terminal as control sequences") {
  const Folder folder;
  const std::string red = "\x1b[31mred", sweep = "sweep @fig2a.yaml --vary gravity=list:1,2 ";
  folder.write(red + ".yaml", "ball: {radius: 0.01}\n");
  folder.write("a.csv", "t,x\n0,1\n");
  folder.write("b.csv", "t,x\n0," + red + "\n");
  folder.write("c.csv", "t," + red + "\n0,1\n");
  for (const std::string& line : {red,
                                  "--" + red,
                                  "run " + red,
                                  "run " + red + ".yaml",
                                  "run @fig2a.yaml " + red,
                                  "run @fig2a.yaml -o " + red,
                                  "run @fig2a.yaml -o " + red + ".csv",
                                  "run @fig2a.yaml --set " + red,
                                  "run @fig2a.yaml --set ball.radius=" + red,
                                  "run @fig2a.yaml --error " + red,
                                  "run @fig2a.yaml --expect '" + red + " < 1'",
                                  "check " + red,
                                  sweep + "--measure " + red,
                                  sweep + "--shard " + red,
                                  sweep + "--samples " + red,
                                  "sweep @fig2a.yaml --vary " + red,
                                  sweep + "-o " + red + ".csv",
                                  "merge " + red + " -o m.csv",
                                  "compare " + red + " a.csv",
                                  std::string("compare a.csv b.csv"),
                                  std::string("compare a.csv c.csv"),
                                  "compare a.csv a.csv --columns " + red,
                                  "accuracy @fig2a.yaml --methods " + red,
                                  "accuracy @fig2a.yaml --rtol " + red,
                                  "help " + red}) {
    const Result result = call(line, folder);
    CAPTURE(line, result.out, result.err);
    CHECK_FALSE(contains(result.out + result.err, "\x1b"));
    CHECK(result.err.size() + result.out.size() > 0);
  }
}

}  // namespace bbsim_test::test_command_line
