// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a terminal shows: the progress bar, reports and questions.
#include <cmath>
#include <string>

#include "base/progress_line.hpp"
#include "catch.hpp"
#include "shell.hpp"

namespace bbsim_test::test_progress {

using bbsim::progress_line;
using bbsim::widest;

TEST_CASE("a progress line fits its terminal at every width, and loses what is least important") {
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

TEST_CASE("a terminal gets no escape sequences that it lacks") {
  const Folder folder;
  folder.write("s.yaml", long_scene);
  const std::string kind = GENERATE("xterm", "dumb");
  const std::string drawn = on_terminal("run s.yaml", 80, folder, 1.6, "", kind);
  CAPTURE(kind, drawn);
  CHECK(contains(drawn, "\x1b") == (kind == "xterm"));
  CHECK(contains(drawn, "interrupted at t = "));
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
