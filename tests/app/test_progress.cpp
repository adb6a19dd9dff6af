// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The progress bar: its text for every width, and what it sends to a terminal of that width.
#include <algorithm>
#include <cmath>
#include <string>

#include "base/progress_line.hpp"
#include "catch.hpp"
#include "shell.hpp"

namespace bbsim_test::test_progress {

using bbsim::log_line;
using bbsim::progress_line;
using bbsim::ProgressState;
using bbsim::widest;

namespace {

// Length of the longest line drawn, without cursor control sequences.
std::size_t longest_line(const std::string& drawn) {
  std::size_t longest = 0, length = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i] == '\r' || drawn[i] == '\n') {
      length = 0;
    } else if (drawn[i] == '\033') {
      while (i < drawn.size() && drawn[i] != 'K') ++i;
    } else {
      longest = std::max(longest, ++length);
    }
  }
  return longest;
}

}  // namespace

TEST_CASE("a progress line fits its terminal at every width, and loses what is least important") {
  const ProgressState known{"configs/fig2b.yaml", "130 cases/s", 0.47, 12};
  CHECK(progress_line(known, 100) ==
        "configs/fig2b.yaml [##############................]  47%, 130 cases/s, 12 s left");
  CHECK(progress_line(known, 50) == "fig2b.yaml [###.....]  47%, 130 cases/s, 12 s left");
  CHECK(progress_line(known, 20) == " 47%, 12 s left");
  CHECK(progress_line(known, 12) == " 47%");
  CHECK(log_line(known) == "configs/fig2b.yaml: 47.0%, 130 cases/s, 12 s left");

  const std::string label =
      GENERATE("configs/fig2b.yaml", "a/folder/of/" + std::string(100, 'x') + ".yaml",
               "\u7403\u7403\u7403\u7403\u7403\u7403.yaml");
  const std::string detail = GENERATE("", "1230000 cases/s", "checking the cases");
  for (const double done : {0.0, 0.004, 0.5, 0.999, 1.0}) {
    for (std::size_t columns = 10; columns < 250; ++columns) {
      const std::string line = progress_line({label, detail, done, 123456.0}, columns);
      CAPTURE(line, columns);
      REQUIRE(widest(line) <= columns);
      REQUIRE(contains(line, "%"));
    }
  }
}

TEST_CASE("a terminal never gets a line wider than itself, nor escape sequences it lacks") {
  const Folder folder;
  folder.write("a-scenario-with-a-name-that-is-rather-long.yaml", long_scene);
  const auto [columns, kind] = GENERATE(table<unsigned short, std::string>(
      {{20, "xterm"}, {40, "xterm"}, {80, "xterm"}, {80, "dumb"}}));
  const std::string drawn = on_terminal("run a-scenario-with-a-name-that-is-rather-long.yaml",
                                        columns, folder, 1.6, "", kind);
  CAPTURE(columns, kind, drawn);
  CHECK(contains(drawn, "\x1b") == (kind == "xterm"));
  if (kind == "dumb") {
    CHECK(contains(drawn, "interrupted at t = "));
    return;
  }
  const std::string bar = drawn.substr(0, drawn.find("interrupted"));
  CHECK(contains(bar, "%"));
  CHECK(longest_line(bar) < columns);
}

TEST_CASE("after --resume the time left is estimated from the current run") {
  // Counting the earlier cases would at least halve the estimate. Both runs are interrupted at
  // their first estimate, a second or more after their first case.
  const Folder folder;
  folder.write("long.yaml", long_scene + "solver: {method: adams}\n");
  const std::string sweep =
      "sweep long.yaml --set time.end=0.5 --vary ball.radius=linear:0.01:0.02:20000 -j 1 -o s.csv";
  (void)on_terminal(sweep, 120, folder, 120, " left");
  const std::string drawn = on_terminal(sweep + " --resume", 120, folder, 120, " left");
  // Reads the seconds of the first "47%, 123 cases/s, 12 s left".
  const std::size_t at = drawn.find(" left");
  REQUIRE(at != std::string::npos);
  const std::string line = drawn.substr(0, at);
  CAPTURE(line);
  const std::size_t rate_at = line.rfind("%, ") + 3;
  const double rate = std::stod(line.substr(rate_at));
  const std::size_t left_at = line.find("cases/s, ", rate_at) + 9;
  const double unit = contains(line, " min") ? 60 : 1;
  const double left = std::stod(line.substr(left_at)) * unit;
  const double part = std::stod(line.substr(line.rfind("] ") + 2)) / 100;
  const double all = 20000 / rate, expected = all * (1 - part);
  CHECK(std::abs(left - expected) < unit / 2 + all * 0.005 + 0.1 * expected);  // each is rounded
}

TEST_CASE("rates have three digits") {
  const Folder folder;
  const std::string drawn = on_terminal(
      "sweep @fig2a.yaml --vary gimbal.motion.phi.sinusoid.phase=linear:0:1:8000000 -j 1 -o s.csv",
      120, folder, 120, " cases/s");
  const std::size_t at = drawn.find(" cases/s");
  REQUIRE(at != std::string::npos);
  const std::size_t begin = drawn.rfind(' ', at - 1) + 1;
  std::string digits;
  for (const char c : drawn.substr(begin, at - begin)) {
    if (c != '.') digits += c;
  }
  CAPTURE(digits);
  CHECK(digits.find_first_not_of("0123456789") == std::string::npos);
  CHECK(digits.find_last_not_of('0') < 3);
}

TEST_CASE("without a scenario on a terminal, the program says that it waits for one") {
  const Folder folder;
  const std::string told = "reading a scenario from the terminal; Ctrl-D ends it";
  for (const std::string command : {"run", "check", "linearize", "accuracy", "verify"}) {
    CAPTURE(command);
    CHECK(contains(on_terminal(command + " -", 80, folder, 5, told), told));
  }
  CHECK(contains(on_terminal("measure - --measure max_x", 80, folder, 5, "reading"),
                 "reading a CSV from the terminal"));
  CHECK_FALSE(contains(on_terminal("run - -q", 80, folder, 0.5), "reading"));
}

}  // namespace bbsim_test::test_progress
