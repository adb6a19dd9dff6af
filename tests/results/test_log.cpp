// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Small logs as loggers, spreadsheets and sketches write them.
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "results/log.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_log {

using namespace bbsim;
using Catch::Matchers::Contains;
using results::LogChoice;

namespace {

constexpr double gap = NAN;

struct Log {
  const char* style;
  std::string content;
  LogChoice choice{};
  std::vector<double> t{}, x{};  // as read
  std::string says{};            // part of a note, or of the refusal if t is empty
};

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) && std::isnan(b[i])) continue;
    if (!(std::abs(a[i] - b[i]) <= 1e-8)) return false;
  }
  return true;
}

std::vector<double> numbers(const results::Result& log, const char* name) {
  const results::Column* const column = log.find(name);
  return column == nullptr ? std::vector<double>{} : column->numbers;
}

const std::vector<double> t{0, 0.5}, x{0.01, 0.02};

const std::vector<Log> logs = {
    {"plain", "t,x\n0,0.01\n0.5,0.02\n", {}, t, x},
    {"semicolons and decimal commas", "t;x\n0;0,01\n0,5;0,02\n", {}, t, x},
    {"tabs", "t\tx\n0\t0.01\n0.5\t0.02\n", {}, t, x},
    {"tabs and decimal commas", "t\tx\n0\t0,01\n0,5\t0,02\n", {}, t, x},
    {"mark and line ends of Windows", "\xEF\xBB\xBFt,x\r\n0,0.01\r\n0.5,0.02\r\n", {}, t, x},
    {"remarks", "# rig 3\nt,x\n# begin\n0,0.01\n0.5,0.02\n# end\n", {}, t, x},
    {"a header in a remark", "# t,x\n0,0.01\n0.5,0.02\n", {}, t, x},
    {"banner", "Ball balancer v2.1\nReady.\nt,x\n0,0.01\n0.5,0.02\n", {}, t, x, "line 3"},
    {"index of pandas", ",t,x\n0,0,0.01\n1,0.5,0.02\n", {}, t, x},
    {"quoted names and numbers", "\"t\",\"x\"\n\"0\",\"0.01\"\n0.5,\"0.02\"\n", {}, t, x},
    {"quoted decimal commas", "t,x\n\"0\",\"0,01\"\n\"0,5\",\"0,02\"\n", {}, t, x},
    {"no header", "0,0.01\n0.5,0.02\n", {{}, {"t", "x"}, "", ""}, t, x},
    {"no header, unasked", "0,0.01\n0.5,0.02\n", {}, {}, {}, "log.csv:1:1: found the number \"0\""},
    {"units in square brackets", "t [ms],x [mm]\n0,10\n500,20\n", {}, t, x},
    {"units in parentheses", "t (s),x (cm)\n0,1\n0.5,2\n", {}, t, x},
    {"units as endings", "t_ms,x_mm\n0,10\n500,20\n", {}, t, x},
    {"a line of units", "t,x\nms,mm\n0,10\n500,20\n", {}, t, x},
    {"units of mapped names",
     "timestamp_ms,ball [mm]\n0,10\n500,20\n",
     {{"t=timestamp_ms,x=ball"}, {}, "", ""},
     t,
     x},
    {"text that nobody asks for", "t,mode,x\n0,auto,0.01\n0.5,hold,0.02\n", {}, t, x},
    {"text that is asked for",
     "t,mode\n0,auto\n0.5,hold\n",
     {{"x=mode"}, {}, "", ""},
     {},
     {},
     "column mode, row 1: found \"auto\""},
    {"more fields than names",
     "t,x\n0,0.01,7\n0.5,0.02\n",
     {},
     t,
     x,
     "log.csv:2: found 3 numbers; the header names 2 columns"},
    {"a delimiter at the end of each line", "t,x,\n0,0.01,\n0.5,0.02,\n", {}, t, x},
    {"fewer fields than names",
     "t,x\n0,0.01\n0.2\n0.5,0.02\n",
     {},
     {},
     {},
     "log.csv:3:1: found 1 number; the header names 2 columns; complete the row, or remove it"},
    {"fewer fields in all rows", "t,x\n0\n0.5\n", {}, {}, {}, "found"},
    {"a cut last row",
     "t,x\n0,0.01\n0.5,0.02\n1.",
     {},
     t,
     x,
     "log.csv:4: found 1 number; the header names 2 columns; the last row is cut"},
    {"a cut first row",
     "t,y,x\n.3,4\n0,1,0.01\n0.5,2,0.02\n",
     {},
     t,
     x,
     "log.csv:2: found 2 numbers; the header names 3 columns; the first row is cut"},
    {"rows of two more numbers than names",
     "t,x\n0,0.01,3,4\n0.5,0.02,3,4\n",
     {},
     t,
     x,
     "the fields beyond are left out"},
    {"dates and times of day",
     "timestamp,x\n2026-02-28 23:59:59.75,0.01\n2026-03-01 00:00:00.25,0.02\n",
     {},
     t,
     x,
     "t is the column timestamp"},
    {"dates as in Germany",
     "time;x\n01.03.2026 12:00:01,250;0,01\n01.03.2026 12:00:01,750;0,02\n",
     {},
     t,
     x,
     "dates or times of day"},
    {"dates with a zone",
     "t,x\n2026-03-01T12:00:01Z,0.01\n2026-03-01T12:00:01.5Z,0.02\n",
     {},
     t,
     x,
     "the first row is t = 0"},
    {"times of day over midnight",
     "t,x\n23:59:59.9,0.01\n0:00:00.4,0.02\n",
     {},
     t,
     x,
     "the first row is t = 0"},
    {"a text that is no date",
     "t,x\n2026-02-30 12:00:00,0.01\n",
     {{"t=t"}, {}, "", ""},
     {},
     {},
     "column t, row 1: found \"2026-02-30 12:00:00\""},
    {"milliseconds since the start",
     "millis,x\n0,0.01\n500,0.02\n",
     {},
     t,
     x,
     "t is the column millis, in ms"},
    {"a time with a unit",
     "Time (ms),x\n0,0.01\n500,0.02\n",
     {},
     t,
     x,
     "t is the column Time (ms)"},
    {"a clock that starts again",
     "t,x\n0,1\n1,2\n2,3\n3,4\n4,5\n0,1\n1,2\n2,3\n3,4\n",
     {},
     {},
     {},
     "its clock starts again in row 6: t falls to 0 s; split the file there"},
    {"gaps", "t,x\n0,\n0.5,0.02\n", {}, t, {gap, 0.02}},
    {"gaps in words", "t,x\n0,NA\n0.5,0.02\n", {}, t, {gap, 0.02}},
    {"decimal commas between commas",
     "t,x\n0,0,0,01\n0,5,0,02\n",
     {},
     {},
     {},
     "separate the columns by semicolons or tabs"},
    {"a quote left open", "t,x\n0,\"0.01\n", {}, {}, {}, "log.csv:2:1: found a quotation mark"},
    {"a name twice", "t,x,x\n0,1,2\n", {}, {}, {}, "log.csv:1:5: column \"x\" appears twice"},
    {"a header again", "t,x\n0,0.01\nt,x\n0.5,0.02\n", {}, t, x, "the header is repeated in 1 row"},
    {"factor, offset and unit", "t,px\n0,200\n0.5,240\n", {{"x=0.25*px-40:mm"}, {}, "", ""}, t, x},
    {"another sign", "t,px\n0,-10\n0.5,-20\n", {{"x=-px:mm"}, {}, "", ""}, t, x},
    {"signs within names", "t,p-1\n0,-8\n0.5,-18\n", {{"x=-1*p-1+2:mm"}, {}, "", ""}, t, x},
    {"an unknown name",
     "t,px\n0,1\n0.5,2\n",
     {{"x=qx:mm"}, {}, "", ""},
     {},
     {},
     "has no column \"qx\"; it has t, px"},
    {"no clock", "x\n0.01\n0.02\n", {{}, {}, "500 ms", ""}, t, x},
    {"a clock beside a period", "t,x\n0,1\n1,2\n", {{}, {}, "1", ""}, {}, {}, "has a column t"},
    {"a clock that starts late", "t,x\n7,0.01\n7.5,0.02\n", {{}, {}, "", "start"}, t, x},
    {"a clock that is moved", "t,x\n7,0.01\n7.5,0.02\n", {{}, {}, "", "-7 s"}, t, x},
    {"epoch seconds", "t,x\n1700000000,0.01\n1700000000.5,0.02\n", {}, t, x, "an epoch"},
    {"millis() that wraps",
     "t,x\n4294967046,0.01\n250,0.02\n",
     {{"t=t:ms"}, {}, "", "start"},
     t,
     x,
     "wraps once, first in row 2"},
    {"doubled times", "t,x\n0,0.01\n0,0.01\n0.5,0.02\n", {}, t, x, "first in row 2"},
    {"unsorted times", "t,x\n0.5,0.02\n0,0.01\n", {}, t, x, "sorted by time"},
    {"a serial plotter's pairs", "x:0.01 t:0\nx:0.02 t:0.5\n", {}, t, x},
    {"pairs with commas, units and a banner",
     "Ready.\nt_ms:0,x_mm:10\nt_ms:500,x_mm:20\n",
     {},
     t,
     x,
     "rows begin in line 2"},
    {"pairs with tabs and blanks", "t: 0\tx: 0.01\nt: 0.5\tx: 0.02\n", {}, t, x},
    {"pairs that lack one",
     "t:0 x:0.01\nt:0.2 x:0.01\nt:0.3\nt:0.5 x:0.02\n",
     {},
     {},
     {},
     "log.csv:3:1: found \"t:0.3\"; the first row has 2 labels, t, x"},
    {"a header shorter than the rows",
     "t,x\n0,1,10,2\n5,2,20,3\n",
     {},
     {},
     {},
     "log.csv:2:1: found 4 numbers; the header names 2 columns; name the others"},
    {"times of day in halves",
     "t,x\n11:59:59.75 AM,0.01\n12:00:00.25 PM,0.02\n",
     {},
     t,
     x,
     "the first row is t = 0"},
    {"dates as in America",
     "t,x\n2/28/2026 11:59:59.75 pm,0.01\n3/1/2026 12:00:00.25 am,0.02\n",
     {},
     t,
     x,
     "the first row is t = 0"},
    {"a number for what was not seen",
     "t,px\n0,10\n0.2,-1\n0.3,-1\n0.5,20\n",
     {{"x=px:mm"}, {}, "", "", "-1"},
     t,
     x,
     "2 rows have a position of -1, first in row 2; left out"},
    {"the same in a log without a clock",
     "x,y\n0.01,0\n-1,-1\n0.02,0\n",
     {{}, {}, "250 ms", "", "-1"},
     t,
     x,
     "1 row has a position of -1"},
    {"a number that is none",
     "t,x\n0,0.01\n0.5,0.02\n",
     {{}, {}, "", "", "none"},
     {},
     {},
     "--missing: found \"none\"; allowed: the number"},
    {"blanks around a sign", "t,px\n0,52\n0.5,62\n", {{"x = px - 42 : mm"}, {}, "", ""}, t, x},
    {"blanks within a map", "t,px\n0,-2\n0.5,-7\n", {{"x=- 2 * px + 6 :mm"}, {}, "", ""}, t, x},
    {"a clock that is text",
     "time,x\nearly,0.01\nlate,0.02\n",
     {{"x=x"}, {}, "", "start"},
     {},
     {},
     "column time, row 1: found \"early\""},
    {"a clock of another name that is text",
     "when,x\nearly,0.01\nlate,0.02\n",
     {{}, {}, "", "start"},
     {},
     {},
     "has no column t with numbers; it has the text when, x; --map t=NAME:UNIT"},
    {"rows without a time", "t,x\n0,0.01\n,0.015\n0.5,0.02\n", {}, t, x, "1 row without a time"},
};

}  // namespace

TEST_CASE("logs of many styles are read, or refused with row and remedy") {
  for (const Log& log : logs) {
    const Folder folder;
    const std::string file = folder.put("log.csv", log.content);
    CAPTURE(log.style);
    std::vector<std::string> notes;
    std::string said;
    try {
      const results::Result read = results::read_log(file, log.choice, notes);
      CHECK(same(numbers(read, "t"), log.t));
      CHECK(same(numbers(read, "x"), log.x));
      for (const std::string& note : notes) said += note + '\n';
      CHECK(notes.empty() == log.says.empty());
    } catch (const InputError& error) {
      said = error.what();
      CAPTURE(said);
      CHECK(log.t.empty());
    }
    CHECK_THAT(said, Contains(log.says));
  }
}

TEST_CASE("a map is refused if its place is wrong") {
  const Folder folder;
  const std::string file = folder.put("log.csv", "t,px\n0,1\n1,2\n");
  const auto refused = [&](const LogChoice& choice) {
    std::vector<std::string> notes;
    try {
      static_cast<void>(results::read_log(file, choice, notes));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  CHECK_THAT(refused({{"x"}, {}, "", ""}), Contains("COLUMN=NAME:UNIT"));
  CHECK_THAT(refused({{"x=px:s"}, {}, "", ""}), Contains("x=px:s\": x is in m"));
  CHECK_THAT(refused({{"xx=px"}, {}, "", ""}), Contains("there is no column \"xx\""));
  CHECK_THAT(refused({{"x=px", "x=t"}, {}, "", ""}), Contains("x is given twice"));
  CHECK_THAT(refused({{}, {}, "", "later"}), Contains("--time-offset: found \"later\""));
  CHECK_THAT(refused({{}, {}, "0 s", ""}), Contains("--period"));
}

}  // namespace bbsim_test::test_log
