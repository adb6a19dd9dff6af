// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "catch.hpp"
#include "plot/run_parts.hpp"
#include "plot/run_picture.hpp"
#include "results.hpp"

namespace bbsim_test::test_run_picture {

using namespace bbsim;
using namespace bbsim::plot;
using Catch::Matchers::Contains;

namespace {

Function wave(double size, double offset = 0) {
  return [=](double t) { return offset + size * std::sin(t); };
}

bool has_curve(const Picture& picture, Curve::Shape shape) {
  return std::ranges::any_of(picture.panels, [&](const Panel& panel) {
    return std::ranges::any_of(panel.curves,
                               [&](const Curve& curve) { return curve.shape == shape; });
  });
}

// Whether the curve is the vertical line at an event.
bool is_upright(const Curve& curve) {
  return curve.stroke.dash == Dash::dotted && curve.x.size() == 2 && curve.x[0] == curve.x[1];
}

Result rig_run() {
  Result run = run_of({{"x", wave(0.05)},
                       {"y", wave(0.04)},
                       {"x_reference", wave(0.05)},
                       {"y_reference", wave(0.04)},
                       {"x_measured", wave(0.051)},
                       {"phi", wave(0.1)},
                       {"phi_command", wave(0.12)},
                       {"friction_demand", [](double t) { return 0.15 + 0.1 * std::sin(t); }}});
  run.scenario.emplace();
  run.scenario->plate.size = Pair{0.32, 0.24};
  run.scenario->events.slip = SlipEvent{0.3};
  run.scenario->controller.emplace().drives = Drives::angle;
  run.scenario->controller->sampling = Sampling{0.02};
  run.title = "A rig";
  run.status = "stopped";
  run.end_time = 10;
  run.events = {{"slip", false, 4, 0.01, 0.02}, {"edge", true, 10, 0.16, 0.01}};
  return run;
}

}  // namespace

TEST_CASE("a rig's run shows plate, events, limit, reference, measurements and steps") {
  const Picture picture = run_picture({rig_run()}, {});
  CHECK(collisions(picture) == "");
  for (const char* text :
       {"A rig", "run.csv, stopped at t = 10 s: edge", "plate's edge", "slip", "edge (stops)",
        "coefficient 0.3", "reference", "as seen", "command", "start", "end", "friction demand"}) {
    CAPTURE(text);
    CHECK(says(picture, text));
  }
  CHECK(has_curve(picture, Curve::Shape::steps));
  // The path's panel shows the whole plate.
  const Panel& path = picture.panels.front();
  CHECK(path.x.low <= -16);
  CHECK(path.x.high >= 16);
  // Events are marked in all panels over time.
  for (std::size_t p = 1; p < picture.panels.size(); ++p) {
    CHECK(std::ranges::count_if(picture.panels[p].curves, is_upright) == 2);
  }
}

TEST_CASE("a law without samples is not drawn in steps") {
  Result run = rig_run();
  run.scenario->controller->sampling.reset();
  std::erase_if(run.columns, [](const Column& column) { return column.name == "x_measured"; });
  CHECK_FALSE(has_curve(run_picture({run}, {}), Curve::Shape::steps));
}

TEST_CASE("a plate that would hide the path is omitted, and a distant limit is stated") {
  Result run = rig_run();
  run.events.clear();
  for (Column& column : run.columns) {
    if (column.name == "t") continue;
    for (double& value : column.numbers) value *= 0.001;
  }
  const Picture picture = run_picture({run}, {});
  CHECK_FALSE(says(picture, "plate's edge"));
  CHECK(says(picture, "coefficient 0.3, far above"));
}

TEST_CASE("the collision test detects a collision") {
  Picture picture = run_picture({rig_run()}, {});
  picture.panels[1].box = picture.panels[2].box;
  CHECK_THAT(collisions(picture), Contains("\"x (cm)\" over \"y (cm)\""));
  picture.panels.back().box.right = picture.width - 4;
  CHECK_THAT(collisions(picture), Contains("outside: 10"));
}

TEST_CASE("nothing collides, for any values, names and number of panels") {
  const std::vector<std::string> names = {"x",
                                          "y",
                                          "gamma",
                                          "phi",
                                          "theta",
                                          "vx",
                                          "vy",
                                          "spin",
                                          "x_reference",
                                          "y_reference",
                                          "phi_command",
                                          "friction_demand",
                                          "motor_power",
                                          "power",
                                          "normal_force",
                                          "friction_force",
                                          "motor_torque_phi",
                                          "motor_torque_theta",
                                          "a_column_of_somebody_else_with_a_very_long_name_indeed",
                                          "energy",
                                          "singularity_distance"};
  // Every size, number of panels and end time occurs with several of the others.
  const std::vector<double> sizes = {1e-300, 1e-9, 1e-4, 0.1, 3, 86, 1e5, 1.4e6, 1e300};
  const std::vector<double> offsets = {0, 1, 1e6}, ends = {1e-9, 0.3, 10, 1e6};
  for (std::size_t n = 0; n < 36; ++n) {
    const double size = sizes[n % 9], offset = offsets[n / 3 % 3], end = ends[n % 4];
    const std::size_t count = 1 + 3 * (n % 7);
    std::vector<std::pair<std::string, Function>> columns;
    for (std::size_t c = 0; c < count; ++c) {
      columns.emplace_back(names[c], [=](double t) {
        return size * (offset + std::sin(t / end + static_cast<double>(c)));
      });
    }
    Result run = run_of(columns, end, 50);
    run.title = std::string(300, 'W');
    run.file = "/a/folder/" + std::string(200, 'm') + ".csv";
    CAPTURE(size, offset, count, end);
    CHECK(collisions(run_picture({run}, {})) == "");
  }
}

TEST_CASE("comparisons name each run and distinguish them without color") {
  std::vector<Result> runs;
  for (int i = 0; i < 4; ++i) {
    runs.push_back(rig_run());
    runs.back().file = "folder-" + std::to_string(i) + "/rig.csv";
    runs.back().status = i == 2 ? "failed" : "done";
  }
  const Picture picture = run_picture(runs, {});
  CHECK(collisions(picture) == "");
  CHECK(says(picture, "folder-1/rig.csv"));
  CHECK(says(picture, "folder-2/rig.csv, failed at t = 10 s"));
  std::vector<Dash> dashes;
  for (const Curve& curve : picture.panels.back().curves) dashes.push_back(curve.stroke.dash);
  for (const Dash dash : {Dash::solid, Dash::dashed, Dash::dotted, Dash::dash_dotted}) {
    CHECK(std::ranges::find(dashes, dash) != dashes.end());
  }
}

TEST_CASE("the names of many runs fit, with wide or narrow letters") {
  for (const char letter : {'i', 'n', 'W'}) {
    for (const std::size_t length : {1, 8, 20, 40, 200}) {
      std::vector<Result> runs(17, run_of({{"x", wave(0.05)}, {"y", wave(0.04)}}));
      for (std::size_t r = 0; r < runs.size(); ++r) {
        runs[r].file = std::string(length, letter) + std::to_string(r) + ".csv";
      }
      CAPTURE(letter, length);
      CHECK(collisions(run_picture(runs, {})) == "");
    }
  }
}

TEST_CASE("all runs of a comparison are drawn equally wide, and measurements hide nothing") {
  const std::vector<Result> runs(8, rig_run());
  const Picture picture = run_picture(runs, {});
  for (const Panel& panel : picture.panels) {
    for (const Curve& curve : panel.curves) {
      const bool of_a_run = curve.stroke.width > 0 && curve.x.size() > 10 &&
                            curve.stroke.colour != band_of_reference.colour;
      if (of_a_run && curve.stroke.colour != "#404040") CHECK(curve.stroke.width == 2);
    }
  }
  const Picture one = run_picture({rig_run()}, {});
  const std::vector<Curve>& x = one.panels[1].curves;  // the path comes first
  const auto seen = std::ranges::find(x, Curve::Shape::steps, &Curve::shape);
  const auto main = std::ranges::find(x, "#0072b2", [](const Curve& c) { return c.stroke.colour; });
  REQUIRE(seen != x.end());
  REQUIRE(main != x.end());
  CHECK(seen < main);
}

TEST_CASE("a run stopped by an event is drawn up to the event") {
  Result run = run_of({{"x", wave(0.1)}, {"y", wave(0.2)}, {"phi", wave(0.1)}}, 1, 11);
  run.status = "stopped";
  run.events = {{"edge", true, 1.04, 0.16, 0.01, {{"phi", 0.3}, {"vx", 2}}}};
  add_end_row(run);
  CHECK(run.has_end_row);
  CHECK(run.rows == 12);
  CHECK(run.find("t")->numbers.back() == 1.04);
  CHECK(run.find("x")->numbers.back() == 0.16);
  CHECK(run.find("phi")->numbers.back() == 0.3);
  CHECK(run_picture({run}, {}).panels.front().curves[1].x.back() == Approx(16));  // cm
  Result at_a_row = run_of({{"x", wave(0.1)}}, 1, 11);
  at_a_row.status = "stopped";
  at_a_row.events = {{"edge", true, 1, 0.16, 0.01}};
  add_end_row(at_a_row);
  CHECK_FALSE(at_a_row.has_end_row);
}

TEST_CASE("a ball along one axis has no picture of the plane unless it shows a plate") {
  const Function none = [](double) { return 0.0; };
  Result beam = run_of({{"x", wave(0.1)}, {"y", none}});
  CHECK(run_picture({beam}, {}).panels.size() == 1);
  CHECK(run_picture({beam}, {{"path"}}).panels.size() == 1);
  beam.scenario.emplace();
  beam.scenario->plate.size = Pair{0.32, 0.24};
  CHECK(run_picture({beam}, {}).panels.size() == 2);
}

TEST_CASE("a number between two gaps is a dot") {
  Result run = run_of({{"x", wave(1)}}, 1, 11);
  run.columns[1].numbers[3] = run.columns[1].numbers[5] = NAN;
  const std::vector<Curve> curves = run_picture({run}, {}).panels.front().curves;
  REQUIRE(curves.size() == 2);
  CHECK(curves[0].stroke.marker == Marker::dot);
  CHECK(curves[0].x.size() == 1);
}

TEST_CASE("many events are marked only at the top") {
  Result run = rig_run();
  run.events.assign(500, {"slip", false, 4, 0.01, 0.02});
  const Picture picture = run_picture({run}, {});
  CHECK(says(picture, "slip, 500 times"));
  CHECK(std::ranges::none_of(picture.panels.back().curves, is_upright));
  CHECK(picture.panels.back().curves.back().x.size() == 500);
}

TEST_CASE("a run that is constant, or has one row, gaps, infinities or no time, is drawn") {
  const Function still = [](double) { return 0.1; };
  CHECK(collisions(run_picture({run_of({{"x", still}, {"y", still}})}, {})) == "");

  Result one_row;
  one_row.file = "one.csv";
  one_row.rows = 1;
  one_row.columns = {{"t", {0}}, {"x", {1}}, {"y", {2}}, {"phi", {0.1}}};
  const Picture point = run_picture({one_row}, {});
  CHECK(point.panels.back().curves.front().stroke.marker == Marker::dot);

  constexpr double infinity = std::numeric_limits<double>::infinity();
  Result gaps = run_of({{"x", wave(1)}, {"y", wave(1)}});
  gaps.columns[1].numbers[3] = NAN;
  gaps.columns[2].numbers[4] = infinity;
  gaps.columns[1].numbers[5] = -infinity;
  const Picture with_gaps = run_picture({gaps}, {});
  CHECK(with_gaps.panels.front().x.high < 200);  // cm
  CHECK(collisions(with_gaps) == "");

  Result timeless = run_of({{"x", wave(1)}});
  timeless.columns.erase(timeless.columns.begin());
  CHECK(says(run_picture({timeless}, {}), "row"));
}

TEST_CASE("a run without finite numbers cannot be drawn") {
  const Result run = run_of({{"x", [](double) { return NAN; }}});
  CHECK_THROWS_WITH(run_picture({run}, {}), Contains("nothing to draw"));
  CHECK_THROWS_WITH(run_picture({run_of({{"x", wave(1)}})}, {{"path"}}),
                    Contains("no numbers x and y"));
}

TEST_CASE("the path can be requested, alone or with columns") {
  const Result run = run_of({{"x", wave(1)}, {"y", wave(2)}, {"phi", wave(1)}});
  CHECK(run_picture({run}, {{"path"}}).panels.size() == 1);
  CHECK(run_picture({run}, {{"phi"}, {"path"}}).panels.size() == 2);
  CHECK(run_picture({run}, {{"phi"}}).panels.size() == 1);
}

}  // namespace bbsim_test::test_run_picture
