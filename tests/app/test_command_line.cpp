// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Behavior common to all commands: help, -q, errors, standard input and a reader that closes early.
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "shell.hpp"

namespace bbsim_test::test_command_line {

using Names = std::vector<std::string>;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const Names commands{"run",     "check",    "sweep", "merge",    "compare", "verify",
                     "columns", "accuracy", "new",   "examples", "help"};

}  // namespace

TEST_CASE("no line of any help is wider than 80 columns") {
  std::vector<Names> words{{"--help"}};
  for (const std::string& command : commands) words.push_back({command, "--help"});
  for (const Names& arguments : words) {
    const Result help = bbsim(arguments);
    CHECK(help.exit_code == 0);
    CHECK(help.err.empty());
    std::istringstream lines(help.out);
    for (std::string line; std::getline(lines, line);) {
      CAPTURE(arguments, line);
      CHECK(line.size() <= 80);
    }
    CHECK_FALSE(contains(help.out, "e+"));  // a bound that is the greatest integer of a double
  }
}

TEST_CASE("run and sweep show examples, and the examples run") {
  for (const std::string command : {"run", "sweep"}) {
    CHECK(contains(bbsim(Names{command, "--help"}).out,
                   "Examples:\n  bbsim " + command + " configs/"));
  }
  const Folder folder;
  const std::string source(BBSIM_SOURCE_DIR);
  std::istringstream help(bbsim({"run", "--help"}).out + bbsim({"sweep", "--help"}).out);
  std::string example;
  bool among_examples = false;
  int count = 0;
  for (std::string line; std::getline(help, line);) {
    if (line.empty() || line.front() != ' ') among_examples = line == "Examples:";
    if (!among_examples || line == "Examples:") continue;
    example += line + "\n";
    if (line.back() == '\\') continue;
    std::string script =
        "bbsim() { \"$BBSIM\" \"$@\"; }; ln -sfn '" + source + "/configs' configs;";
    const Result result = shell(script + example, folder.path());
    CAPTURE(example, result.err);
    // If the reader closes early, exit code 3 is not a fault of the example.
    CHECK((result.exit_code == 0 || (contains(example, "head") && result.exit_code == 3)));
    CHECK_FALSE(contains(result.err, "allowed"));
    example.clear();
    ++count;
  }
  CHECK(count >= 8);
}

TEST_CASE("help of a single command") {
  CHECK(bbsim({"help"}).out == bbsim({"--help"}).out);
  for (const std::string& command : commands) {
    const Result help = bbsim(Names{"help", command});
    CHECK(help.exit_code == 0);
    CHECK(help.out == bbsim(Names{command, "--help"}).out);
    CHECK(contains(help.out, "Usage: bbsim " + command));
  }
  const Result unknown = bbsim({"help", "rnu"});
  CHECK(unknown.exit_code == 2);
  CHECK(contains(unknown.err, "unknown command rnu; did you mean run?"));
}

TEST_CASE("summarise is accepted for summarize") {
  const Result help = bbsim({"summarize", "--help"});
  CHECK(help.exit_code == 0);
  CHECK(contains(help.out, "Usage: bbsim summarize"));
  CHECK(bbsim({"summarise", "--help"}).out == help.out);
  CHECK(bbsim({"help", "summarise"}).out == help.out);
}

TEST_CASE("a misspelled command or option is answered with the nearest one") {
  CHECK(contains(bbsim(Names{"swep", "a.yaml"}).err, "unknown command swep; did you mean sweep?"));
  CHECK(contains(bbsim({"comapre", "a", "b"}).err, "did you mean compare?"));
  CHECK(contains(bbsim(Names{"sumarize"}).err, "did you mean summarize?"));
  CHECK(contains(bbsim(Names{"sumarise"}).err, "did you mean summarise?"));
  CHECK(contains(bbsim({"fly"}).err, "unknown command fly; known: run check"));
  CHECK(contains(bbsim(Names{}).err, "found no command; known: run check"));

  struct Case {
    Names arguments;
    std::string said;
  };
  const std::vector<Case> cases{
      {{"run", "a.yaml", "--sumary", "s.json"},
       "unknown option --sumary of bbsim run; did you mean --summary?"},
      {{"run", "--eror=1e-6", "a.yaml"},
       "unknown option --eror of bbsim run; did you mean --error?"},
      {{"run", "--sumary"}, "did you mean --summary?"},  // rather than: SCENARIO is required
      {{"sweep", "a.yaml", "--sampels", "3"}, "did you mean --samples?"},
      {{"run", "a.yaml", "--quite"}, "did you mean --quiet?"},
      {{"run", "a.yaml", "--wings"}, "unknown option --wings of bbsim run\n"},
      {{"--verison"}, "unknown option --verison of bbsim; did you mean --version?"},
      {{"-o", "a.csv", "run", "a.yaml"},
       "-o: found before run; allowed: the options of a command after it."},
      {{"run", "a.yaml", "b.yaml"}, "found b.yaml, which bbsim run does not take."},
      {{"run"}, "SCENARIO is required"},
  };
  for (const Case& one : cases) {
    const Result result = bbsim(one.arguments);
    CAPTURE(one.arguments, result.err);
    CHECK(result.exit_code == 2);
    CHECK(contains(result.err, one.said));
    CHECK(contains(result.err, "--help for more information."));
  }
}

TEST_CASE("an option's invalid number is answered with the allowed range") {
  for (const std::string number : {"0", "-1", "2.5", "x", "1e300"}) {
    const Result result = bbsim({"sweep", "a.yaml", "--samples", number});
    CAPTURE(result.err);
    CHECK(result.exit_code == 2);
    CHECK(contains(result.err, "found " + number + "; allowed: a whole number from 1 up"));
  }
  CHECK(contains(bbsim({"sweep", "a.yaml", "-j", "4096"}).err,
                 "found 4096; allowed: a whole number from 1 to 1024"));
}

TEST_CASE("the flag -q may precede or follow every command") {
  for (const std::string& command : commands) {
    if (command == "help") continue;
    const Result after = bbsim(Names{command, "-q", "--help"});
    CHECK(after.exit_code == 0);
    CHECK(contains(after.out, "-q,--quiet"));
  }
  const Folder folder;
  const std::string fig2a = config("fig2a.yaml");
  CHECK(bbsim({"check", "-q", fig2a}).out == bbsim({"-q", "check", fig2a}).out);
  CHECK(bbsim({"columns", "-q"}).exit_code == 0);
  CHECK(bbsim({"run", fig2a, "-q", "-o", "a.csv"}, folder.path()).err.empty());
  CHECK(bbsim({"compare", "-q", "a.csv", "a.csv"}, folder.path()).exit_code == 0);
}

TEST_CASE("the flag -q keeps the reason for a nonzero exit code") {
  const Folder folder;
  const Result failed = bbsim({"run", config("fig2b-literal.yaml"), "-q"}, folder.path());
  CHECK(failed.exit_code == 1);
  CHECK(contains(failed.err, "the run ended early, at t = 0.74"));
  const Result stopped = bbsim({"run", config("falls.yaml"), "-q"}, folder.path());
  CHECK(stopped.exit_code == 1);
  CHECK(contains(stopped.err, "the run stopped at t = "));
  CHECK_FALSE(contains(stopped.err, "rows"));
  const Result beyond =
      bbsim({"run", config("fig2a.yaml"), "--error", "1e-20", "-q"}, folder.path());
  CHECK(beyond.exit_code == 1);
  CHECK(contains(beyond.err, "is out of reach"));
}

TEST_CASE("an interrupted sweep reports it even with -q") {
  const Folder folder;
  Launch launch{{"sweep", config("fig2a.yaml"), "-q", "-j", "1", "--vary",
                 "gimbal.motion.phi.sinusoid.phase=linear:0:1:10000000", "-o", "s.csv"},
                folder.path(),
                SIGINT,
                std::chrono::milliseconds(1500)};
  const Result result = bbsim(launch);
  CHECK(result.exit_code == 130);
  CHECK(contains(result.err, "interrupted "));
}

TEST_CASE("a scenario may come from standard input") {
  const Folder folder;
  const std::string text = [] {
    std::ifstream stream(config("incline.yaml"));
    return std::string(std::istreambuf_iterator<char>(stream), {});
  }();
  folder.write("incline.yaml", text);
  const Result file = bbsim({"run", "incline.yaml", "-o", "-", "-q"}, folder.path());
  REQUIRE(file.exit_code == 0);

  // Without -o, a scenario from standard input writes its result to standard output.
  const Result piped = shell("cat incline.yaml | \"$BBSIM\" run - -q", folder.path());
  CHECK(piped.exit_code == 0);
  CHECK(piped.out == file.out);
  const Result redirected =
      shell("\"$BBSIM\" run - -o a.csv --set time.end=1 < incline.yaml", folder.path());
  CHECK(redirected.exit_code == 0);
  CHECK(contains(redirected.err, "a.csv: "));
  // A slow writer is waited for, longer than for a file.
  const Result slow = shell("(sleep 6; cat incline.yaml) | \"$BBSIM\" run - -q", folder.path());
  CHECK(slow.exit_code == 0);
  CHECK(slow.out == file.out);

  const Result check = shell("\"$BBSIM\" check - < incline.yaml", folder.path());
  CHECK(check.exit_code == 0);
  CHECK(contains(check.out, "standard input is valid"));
  const Result sweep =
      shell("\"$BBSIM\" sweep - --vary gravity=list:9,10 < incline.yaml", folder.path());
  CHECK(sweep.exit_code == 0);
  CHECK(contains(sweep.out, "case,gravity,status"));
  const Result faulty = shell("echo 'ball: {raduis: 1}' | \"$BBSIM\" run -", folder.path());
  CHECK(faulty.exit_code == 2);
  CHECK(contains(faulty.err, "standard input:1:8: ball.raduis: unknown key"));
  CHECK(shell("\"$BBSIM\" run - < /dev/null", folder.path()).exit_code == 2);
}

TEST_CASE("check reads standard input once for a scenario with a sweep") {
  const Folder folder;
  folder.write("s.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: 0.01}}\n"
               "time: {end: 1, step: 0.1}\n"
               "sweep: {vary: {ball.radius: 'linear:0.01:0.02:3'}}\n");
  const Result result = shell("cat s.yaml | \"$BBSIM\" check -", folder.path());
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "3 cases of bbsim sweep, over ball.radius"));
}

TEST_CASE("a reader that closes early ends the program quietly with exit code 3") {
  const Folder folder;
  const std::string fig2a = config("fig2a.yaml");
  for (const std::string& line :
       {"run '" + fig2a + "' -q -o - --set time.step=0.0001 | head -3",
        "sweep '" + fig2a + "' -q -o - --vary gravity=linear:9:10:100000 | head -3"}) {
    const Result result = shell("\"$BBSIM\" " + line, folder.path());
    CAPTURE(line, result.err);
    CHECK(result.exit_code == 3);  // not 0, because part of the output was lost
    CHECK(result.err.empty());
    CHECK(contains(result.out, "\n"));
  }
  CHECK(shell("\"$BBSIM\" columns | true; sleep 0.1", folder.path()).err.empty());
  CHECK(shell("\"$BBSIM\" --help | true; sleep 0.1", folder.path()).err.empty());
}

TEST_CASE("reports that cannot be written give exit code 3") {
  const Folder folder;
  const std::string fig2a = config("fig2a.yaml");
  for (const std::string& words :
       {std::string("--help"), std::string("--version"), std::string("--schema"),
        std::string("--licenses"), std::string("run --help"), std::string("help run"),
        std::string("columns"), "check '" + fig2a + "'"}) {
    const Result result = shell("\"$BBSIM\" " + words + " > /dev/full", folder.path());
    CAPTURE(words, result.err);
    CHECK(result.exit_code == 3);
    CHECK(contains(result.err, "cannot write standard output: no space left on device"));
  }
}

TEST_CASE("names from outside do not reach the terminal as control sequences") {
  const Folder folder;
  const std::string red = "\x1b[31mred";
  folder.write(red + ".yaml", "ball: {radius: 0.01}\n");
  folder.write("a.csv", "t,x\n0,1\n");
  folder.write("b.csv", "t,x\n0," + red + "\n");
  folder.write("c.csv", "t," + red + "\n0,1\n");
  const std::string fig2a = config("fig2a.yaml");
  const std::vector<Names> cases{
      {red},
      {"--" + red},
      {"run", red},
      {"run", red + ".yaml"},
      {"run", fig2a, red},
      {"run", fig2a, "-o", red},
      {"run", fig2a, "-o", red + ".csv"},
      {"run", fig2a, "--set", red},
      {"run", fig2a, "--set", "ball.radius=" + red},
      {"run", fig2a, "--error", red},
      {"run", fig2a, "--expect", red + " < 1"},
      {"check", red},
      {"sweep", fig2a, "--vary", "gravity=list:1,2", "--measure", red},
      {"sweep", fig2a, "--vary", "gravity=list:1,2", "--shard", red},
      {"sweep", fig2a, "--vary", "gravity=list:1,2", "--samples", red},
      {"sweep", fig2a, "--vary", red},
      {"sweep", fig2a, "--vary", "gravity=list:1,2", "-o", red + ".csv"},
      {"merge", red, "-o", "m.csv"},
      {"compare", red, "a.csv"},
      {"compare", "a.csv", "b.csv"},
      {"compare", "a.csv", "c.csv"},
      {"compare", "a.csv", "a.csv", "--columns", red},
      {"accuracy", fig2a, "--methods", red},
      {"accuracy", fig2a, "--rtol", red},
      {"help", red},
  };
  for (const Names& arguments : cases) {
    const Result result = bbsim(arguments, folder.path());
    CAPTURE(arguments, result.out, result.err);
    CHECK_FALSE(contains(result.out, "\x1b"));
    CHECK_FALSE(contains(result.err, "\x1b"));
    CHECK(result.err.size() + result.out.size() > 0);
  }
}

}  // namespace bbsim_test::test_command_line
