// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Names of measures, and the table of docs/reference/measures.md against the code. With
// BBSIM_WRITE_DOCS in the environment the test writes the page.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "base/error.hpp"
#include "catch.hpp"
#include "scenario/expectation.hpp"
#include "scenario/measures.hpp"

namespace bbsim_test::test_measures {

using namespace bbsim::scenario;
using Kind = Measure::Kind;

TEST_CASE("measures have names in SI, whatever the units given") {
  const auto [text, name] = GENERATE(table<std::string, std::string>({
      {"x.RiseTime", "x.RiseTime"},
      {"when x=5 cm", "when x=0.05 cross=1"},
      {" when x = 5 cm  rise=2 ", "when x=0.05 rise=2"},
      {"when phi=-1e-3 fall=last", "when phi=-0.001 fall=last"},
      {"when tracking_error stays below 2 mm", "when tracking_error stays below 0.002"},
      {"find vy when x stays above 0.1", "find vy when x stays above 0.1"},
      {"find y at 20 ms", "find y at 0.02"},
      // A window's text is unchanged.
      {" rms_x from 5 s ", "rms_x from 5 s"},
      {"x.Overshoot to 20 s", "x.Overshoot to 20 s"},
      {"when x=5 cm from 500 ms to 20 s", "when x=0.05 cross=1 from 500 ms to 20 s"},
  }));
  CAPTURE(text);
  REQUIRE(find_measure(text));
  CHECK(find_measure(text)->name == name);
  const std::string wrong[] = {
      "x.Risetime, z.RiseTime, ball_qw.Peak, RiseTime, when x, when x=, when z=1, when x=1 rise=0",
      "when x=1 rise=-1, when x=1 rise=one, when x=5 deg, when x=nan, when x stays 1",
      "when x stays below, find x, find x at, find x at 5 cm, find z at 1, find x of y",
      "find ball_qw at 1, rms_x from, rms_x from 5 cm, rms_x from 5 s to, rms_x to 5 s from 1 s",
      "from 5 s, max_, when, find"};
  for (const std::string& one : split_measures({std::begin(wrong), std::end(wrong)})) {
    CAPTURE(one);
    CHECK_FALSE(find_measure(one));
  }
}

TEST_CASE("measures have units and meanings, and know their requirements") {
  CHECK(find_measure("x.RiseTime")->unit() == "s");
  CHECK(find_measure("x.Overshoot")->unit() == "%");
  CHECK(find_measure("x.Peak")->unit() == "m");
  CHECK(find_measure("when phi=1")->unit() == "s");
  CHECK(find_measure("find phi when x=1")->unit() == "rad");
  CHECK(find_measure("max_tilt")->unit() == "rad");
  CHECK(
      find_measure("x.Peak")->meaning() ==
      "absolute value where it is farthest from its start: contact point along the plate's x axis");
  CHECK(find_measure("rms_x from 5 s")->unit() == "m");
  CHECK(find_measure("rms_x from 5 s")->meaning() ==
        "root mean square over the rows of: contact point along the plate's x axis, from 5 s");
  CHECK(find_measure("find x at 2")->meaning() == "at 2: contact point along the plate's x axis");
  CHECK(any_needs({*find_measure("find x when normal_force=0.1")}, Needs::dynamics));
  bbsim::Scenario open;
  CHECK(missing(*find_measure("find x when tracking_error=1 mm"), open));
  CHECK_FALSE(missing(*find_measure("when x=1"), open));
  CHECK(split_measures({"x.Peak, max_x", "when x=1"}) ==
        std::vector<std::string>{"x.Peak", "max_x", "when x=1"});
  CHECK_THROWS_AS(measures_named({"when x=1 cm", "when x=0.01"}, open), bbsim::InputError);
}

TEST_CASE("an unknown measure gets a hint at the likely one") {
  const std::string_view columns[] = {"t", "level"};
  const auto hint = [](const std::string& text) { return " (did you mean " + text + "?)"; };
  CHECK(measure_hint("x.RizeTime") == hint("x.RiseTime"));
  CHECK(measure_hint("x.risetime") == hint("x.RiseTime"));
  CHECK(measure_hint(" max_titl") == hint("max_tilt"));
  CHECK(measure_hint("x") == hint("end_x"));
  CHECK(measure_hint("max_levle", columns) == hint("max_level"));
  CHECK(measure_hint("max_titl", columns).empty());
  for (const char* none : {"ball_qw", "nothing like that"}) CHECK(measure_hint(none).empty());
}

TEST_CASE("a window is read, and refused if it is outside the run") {
  const auto measure = find_measure("max_x from 500 ms to 20 s");
  REQUIRE(measure);
  CHECK(measure->window.from == 0.5);
  CHECK(measure->window.to == 20);
  CHECK(find_measure("max_x")->window.is_whole());
  bbsim::Scenario scene;
  scene.time = {20, 1};
  CHECK_FALSE(missing(*measure, scene));
  CHECK(missing(*find_measure("max_x from 20 s"), scene));
  CHECK(missing(*find_measure("max_x to 21 s"), scene));
  for (const char* wrong : {"max_x from 5 s to 5 s", "max_x from 6 s to 5 s", "max_x from 20 s",
                            "max_x to 21 s", "max_x from -1 s", "max_x to 0 s"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(measures_named({wrong}, scene), bbsim::InputError);
  }
  // 3 * 0.1 rounds above 0.3, but the row there belongs to both.
  CHECK(Window{{}, 0.3}.holds(3 * 0.1));
  CHECK(Window{0.3, {}}.holds(3 * 0.1));
  CHECK_FALSE(Window{{}, 0.3}.holds(0.3 + 1e-12));
}

TEST_CASE("expectations are read with units and judged") {
  bbsim::Scenario scene;
  scene.time = {20, 1};
  const auto read = [&](const char* text) { return read_expectation("--expect", text, scene); };
  const Expectation below = read(" max_tilt < 180 deg ");
  CHECK(below.text == "max_tilt < 180 deg");
  CHECK(below.measure.name == "max_tilt");
  CHECK(below.value == Approx(3.14159265358979));
  CHECK(below.holds(3));
  CHECK_FALSE(below.holds(below.value));
  CHECK_FALSE(below.holds(std::nan("")));
  CHECK(read("max_x<=0.5").holds(0.5));
  CHECK_FALSE(read("max_x > 0.5").holds(0.5));
  CHECK(read("max_x >= 50 cm").holds(0.5));
  CHECK(read("x.Overshoot < 41 %").value == 41);
  CHECK(read("max_normal_force < 12 N").value == 12);
  CHECK(read("max_friction_demand < 1").value == 1);
  CHECK(read("when x=3 cm from 1 s < 2 s").measure.name == "when x=0.03 cross=1 from 1 s");
  for (const char* wrong :
       {"max_x", "max_x < ", "< 3", "max_x < 5 deg", "max_x < one", "max_x = 3", "max_z < 1",
        "max_x from 30 s < 1", "max_tracking_error < 1", "max_x << 3", "max_x < 3 < 4"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(read(wrong), bbsim::InputError);
  }
}

TEST_CASE("the page of measures has the loop measures' names, units and meanings") {
  const std::string file = std::string(BBSIM_SOURCE_DIR) + "/docs/reference/measures.md";
  std::stringstream read;
  read << std::ifstream(file).rdbuf();
  const std::string page = read.str(), head = "\n| measure | unit | is |\n|---|---|---|\n";
  const std::size_t section = page.find("\n## Measures of the loop\n");
  REQUIRE(section != std::string::npos);
  const std::size_t begin = page.find(head, section) + head.size();
  const std::size_t end = page.find("\n\n", begin - 1) + 1;
  std::string table;
  for (const LoopMeasure& measure : loop_measures) {
    table += "| `" + std::string(measure.name) + "` | " + std::string(measure.unit) + " | " +
             std::string(measure.meaning) + " |\n";
  }
  const std::string wanted = page.substr(0, begin) + table + page.substr(end);
  if (std::getenv("BBSIM_WRITE_DOCS") != nullptr) std::ofstream(file) << wanted;
  CHECK(page == wanted);
}

TEST_CASE("measures of the loop need a scene with a law, and no window") {
  const auto measure = find_measure(" phi_delay_margin ");
  CHECK_FALSE(find_measure("phi_delay_margin from 1 s"));
  CHECK_FALSE(find_measure("max_phi_delay_margin"));
  REQUIRE(find_measure("phi_delay_margin"));
  CHECK(find_measure("phi_delay_margin")->unit() == "s");
  CHECK(find_measure("theta_phase_margin")->unit() == "rad");
  CHECK(measure.has_value() == find_measure(" max_tilt ").has_value());
  CHECK(measure_hint("phi_bandwidth") == " (did you mean x_bandwidth?)");
  const std::vector<Measure> mixed{*find_measure("stable"), *find_measure("max_tilt"),
                                   *find_measure("x_bandwidth")};
  const SplitMeasures split = split_loop_measures(mixed);
  CHECK(split.loop_places == std::vector<std::size_t>{0, 2});
  CHECK(split.motion_places == std::vector<std::size_t>{1});
  CHECK(split.of_motion.at(0).name == "max_tilt");
  // An infinite margin needs no reason, a missing one does.
  const double infinite = std::numeric_limits<double>::infinity();
  const double numbers[] = {1, 0.1, infinite};
  CHECK(why_not_finite(mixed, numbers, {}).empty());
  const double none[] = {1, infinite, std::nan("")};
  CHECK(why_not_finite(mixed, none, {}) == "max_tilt is infinite; x_bandwidth is not a number");
}

}  // namespace bbsim_test::test_measures
