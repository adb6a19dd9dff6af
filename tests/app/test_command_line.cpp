// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Behavior common to all commands: help, -q, errors, standard input and a reader that closes early.
#include <algorithm>
#include <filesystem>
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

TEST_CASE("on a terminal, reports break between words below their text") {
  const Folder folder;
  const std::string shown = on_terminal("check @rig.yaml", 80, folder, 5);
  CAPTURE(shown);
  CHECK(contains(shown, "\r\n             "));
  for (const std::string& line : lines(shown)) CHECK(line.size() <= 80);  // with its "\r"
  const std::string loop = on_terminal("linearize @rig.yaml", 60, folder, 5);
  CAPTURE(loop);
  // Poles and zeros that differ from zero by rounding are zero.
  CHECK_FALSE(contains(loop, "e-1"));
  // A pipe gets whole lines.
  expect(0, "check @rig.yaml", folder, {}, {"; phase 35.7 deg at 4.81 rad/s; delay"});
}

TEST_CASE("examples are the scenarios of configs") {
  const Folder folder;
  const Result list = expect(0, call("examples"));
  CHECK(list.err.empty());
  std::size_t scenarios = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BBSIM_SOURCE_DIR "/configs")) {
    if (entry.path().extension() != ".yaml") continue;
    ++scenarios;
    const std::string name = entry.path().stem(), text = folder.read(entry.path());
    CAPTURE(name);
    CHECK(contains('\n' + list.out, '\n' + name + ' '));
    expect(0, "examples " + name + " -q --force", folder);
    CHECK(folder.read(name + ".yaml") == text);
    CHECK(call("examples " + name + " -o - -q").out == text);
  }
  CHECK(lines(list.out).size() == scenarios);
}

#ifdef BBSIM_PYTHON
// "+AAo-" is a line break in UTF-7; in the name, it could make Python read the file as UTF-7.
TEST_CASE("a scenario's name stays text in the programs that linearize writes") {
  const Folder folder;
  const std::string name = "coding: utf-7 +AAo-open('ran', 'w')+AAo- \xce\xb8 \xff.yaml";
  std::filesystem::copy_file(config("fig2b.yaml"), folder / name);
  for (const std::string program : {"plant.py", "plant.m"}) {
    expect(0, bbsim({"linearize", name, "-o", program}, folder.path()));
    const std::string text = folder.read(program);
    CHECK(std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
    for (const std::size_t line : {0U, 1U}) CHECK_FALSE(contains(lines(text).at(line), "coding"));
    CHECK(contains(text,
                   "coding: utf-7 +AAo-open('ran', 'w')+AAo- \\xce\\xb8 \\xff.yaml about home"));
  }
  const Result run = expect(0, shell("mkdir empty && echo 'array = list' > empty/numpy.py && "
                                     "PYTHONPATH=empty python3 plant.py",
                                     folder));
  CHECK(run.err.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "ran"));
}
#endif

}  // namespace bbsim_test::test_command_line
