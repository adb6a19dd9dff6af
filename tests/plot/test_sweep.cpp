// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include "base/error.hpp"
#include "catch.hpp"
#include "plot/sweep_picture.hpp"
#include "results.hpp"
#include "results/sweep_table.hpp"

namespace bbsim_test::test_sweep {

using namespace bbsim;
using namespace bbsim::plot;
using namespace bbsim::results;
using Catch::Matchers::Contains;

namespace {

// A sweep with the given key values per case; end_x is `measure` of the case number.
Result sweep_of(
    const std::vector<Column>& keys,
    const Function& measure = [](double n) { return std::cos(n); }) {
  Result sweep;
  sweep.file = "sweep.csv";
  sweep.rows = keys.front().numbers.size();
  Column number{"case", {}}, status{"status", {}}, end{"end_time", {}}, x{"end_x", {}};
  for (std::size_t i = 0; i < sweep.rows; ++i) {
    number.numbers.push_back(static_cast<double>(i));
    status.numbers.push_back(NAN);
    status.texts.emplace_back("done");
    end.numbers.push_back(10);
    x.numbers.push_back(measure(static_cast<double>(i)));
  }
  sweep.columns.push_back(number);
  sweep.columns.insert(sweep.columns.end(), keys.begin(), keys.end());
  sweep.columns.insert(sweep.columns.end(), {status, end, x});
  return sweep;
}

void end_as(Result& sweep, std::size_t a_case, const std::string& status) {
  for (Column& column : sweep.columns) {
    if (column.name == "status") column.texts[a_case] = status;
  }
}

Column repeated(const std::string& name, std::size_t cases, std::size_t inner, std::size_t count) {
  Column column{name, {}};
  for (std::size_t i = 0; i < cases; ++i) {
    column.numbers.push_back(0.1 * static_cast<double>(i / inner % count + 1));
  }
  return column;
}

// Unordered: multiples of the golden ratio, modulo 1.
Column drawn(const std::string& name, std::size_t cases) {
  Column column{name, {}};
  for (std::size_t i = 0; i < cases; ++i) {
    column.numbers.push_back(std::fmod(0.6180339887 * static_cast<double>(i + 1), 1.0));
  }
  return column;
}

std::size_t cells(const Picture& picture) {
  std::size_t count = 0;
  for (const Panel& panel : picture.panels) count = std::max(count, panel.cells.size());
  return count;
}

bool has_band(const Picture& picture) {
  return std::ranges::any_of(picture.panels.front().curves,
                             [](const Curve& curve) { return curve.shape == Curve::Shape::band; });
}

}  // namespace

TEST_CASE("listed, random, tied and constant keys are distinguished") {
  const std::size_t cases = 60;
  const SweepTable table = sweep_table(
      sweep_of({repeated("a", cases, 10, 6), repeated("b", cases, 10, 6), drawn("c", cases),
                repeated("constant", cases, 1, 1), drawn("d", cases)}));
  REQUIRE(table.keys.size() == 4);
  CHECK_FALSE(table.keys[0].drawn);
  CHECK(table.keys[0].distinct.size() == 6);
  CHECK(table.keys[1].leader == 0);
  CHECK(table.followers(table.keys[0]) == std::vector<std::string>{"b"});
  CHECK(table.keys[2].drawn);
  CHECK(table.keys[3].drawn);
  CHECK(table.keys[3].leader == 3);   // random values are never tied, though all are distinct
  CHECK(table.measures.size() == 1);  // all ended at the same time
}

TEST_CASE("a file that states its random keys is believed") {
  Result sweep = sweep_of({drawn("a", 20), repeated("b", 20, 1, 20)});
  sweep.tells_drawn = true;
  sweep.drawn_keys = {"b"};
  const SweepTable table = sweep_table(sweep);
  CHECK_FALSE(table.keys[0].drawn);
  CHECK(table.keys[1].drawn);
}

TEST_CASE("only the first word of a status counts") {
  Result sweep = sweep_of({repeated("a", 4, 1, 4)});
  end_as(sweep, 0, "failed at 0.744 s: the step shrank");
  end_as(sweep, 1, "refused: ball.radius");
  end_as(sweep, 2, "stopped");
  CHECK(sweep_table(sweep).status ==
        std::vector<std::string>{"failed", "refused", "stopped", "done"});
}

TEST_CASE("one key gives lines, with unfinished cases marked at the bottom") {
  Result sweep = sweep_of({repeated("ball.radius", 20, 1, 20)});
  end_as(sweep, 3, "failed");
  end_as(sweep, 4, "failed");
  end_as(sweep, 9, "stopped");
  const Picture picture = sweep_picture(sweep, {});
  CHECK(collisions(picture) == "");
  REQUIRE(picture.panels.size() == 1);
  const auto& curves = picture.panels[0].curves;
  REQUIRE(curves.size() == 3);
  CHECK(std::isnan(curves[0].y[3]));  // a failed case is not part of the line
  CHECK(curves[1].x.size() == 2);
  CHECK(curves[2].x.size() == 1);
  CHECK(curves[1].stroke.marker != curves[2].stroke.marker);
  CHECK(says(picture, "failed: 2 cases"));
  CHECK(says(picture, "stopped: 1 case"));
  CHECK(says(picture, "ball.radius"));  // the file gives no unit
}

TEST_CASE("a key has only the unit that its file gives") {
  Result sweep = sweep_of({repeated("ball.radius", 20, 1, 20)});
  sweep.columns[1].unit = "m";
  CHECK(says(sweep_picture(sweep, {}), "ball.radius (m)"));
  sweep.columns[1].unit = "1";
  CHECK(says(sweep_picture(sweep, {}), "ball.radius"));
}

TEST_CASE("two keys give a map; a key with few values gives one line each") {
  Result grid = sweep_of({repeated("a", 120, 12, 10), repeated("b", 120, 1, 12)});
  end_as(grid, 7, "failed");
  const Picture map = sweep_picture(grid, {});
  CHECK(collisions(map) == "");
  CHECK(cells(map) == 120);
  CHECK(map.panels.size() == 1);
  CHECK(map.panels[0].colours);
  CHECK(says(map, "failed: 1 case"));
  const Picture lines =
      sweep_picture(sweep_of({repeated("a", 60, 3, 20), repeated("b", 60, 1, 3)}), {});
  CHECK(cells(lines) == 0);
  CHECK(lines.panels[0].curves.size() == 3);
  CHECK(says(lines, "b = 0.2"));
  CHECK(sweep_picture(grid, {{}, {"b"}}).panels[0].cells.empty());
}

TEST_CASE("random values give histograms, a median and a band over listed keys, or points") {
  const Picture histogram = sweep_picture(sweep_of({drawn("a", 200), drawn("b", 200)}), {});
  CHECK(collisions(histogram) == "");
  double counted = 0;
  for (const Cell& bar : histogram.panels[0].cells) counted += bar.top;
  CHECK(counted == 200);
  const Result mixed = sweep_of({repeated("a", 200, 20, 10), drawn("b", 200)});
  const Picture lines = sweep_picture(mixed, {});
  CHECK(has_band(lines));
  CHECK(says(lines, "sweep.csv"));
  CHECK_THAT(lines.subtitle, Contains("over draws of b"));
  const Picture points = sweep_picture(mixed, {{}, {"b"}});
  CHECK(points.panels[0].curves[0].x.size() == 200);
  CHECK(points.panels[0].curves[0].stroke.width == 0);
}

TEST_CASE("a key with text values is drawn with its texts") {
  Column method{"solver.method",
                std::vector<double>(6, NAN),
                {"radau", "bdf", "50 %s", "radau", "bdf", "50 %s"}};
  const Picture picture =
      sweep_picture(sweep_of({method, repeated("a", 6, 3, 2)}), {{}, {"solver.method"}});
  CHECK(collisions(picture) == "");
  REQUIRE(picture.panels[0].x.tics.size() == 3);
  CHECK(picture.panels[0].x.tics[1].label == "bdf");
  CHECK(picture.panels[0].curves[0].stroke.width == 0);
  // gnuplot must not take the label for a format.
  CHECK_THAT(svg_of(picture), Contains(">50 %s<"));
}

TEST_CASE("measures over decades, constant measures and unfinished sweeps are drawn") {
  const Result decades =
      sweep_of({repeated("a", 20, 1, 20)}, [](double n) { return std::pow(10.0, n - 5); });
  CHECK(sweep_picture(decades, {}).panels[0].y.log);
  CHECK(collisions(sweep_picture(decades, {})) == "");
  const Result constant = sweep_of({repeated("a", 20, 1, 20)}, [](double) { return 3.0; });
  CHECK(collisions(sweep_picture(constant, {})) == "");
  Result map = sweep_of({repeated("a", 100, 10, 10), repeated("b", 100, 1, 10)});
  for (std::size_t i = 0; i < 100; ++i) end_as(map, i, "failed");
  CHECK(collisions(sweep_picture(map, {})) == "");
  CHECK_THAT(gnuplot_script(sweep_picture(map, {}), Format::svg, {}), Contains("unset colorbox"));
  Result draws = sweep_of({drawn("a", 50)});
  for (std::size_t i = 0; i < 50; ++i) end_as(draws, i, "failed");
  CHECK(says(sweep_picture(draws, {}), "failed: 50 cases"));
}

TEST_CASE("numbers beside a histogram are distinguishable, and a common one appears once") {
  const Result near =
      sweep_of({drawn("a", 200)}, [](double n) { return 1.304 + 2e-5 * std::sin(n); });
  Result same = sweep_of({drawn("a", 200)}, [](double) { return 1.304; });
  const Picture picture = sweep_picture(near, {}), constant = sweep_picture(same, {});
  CHECK(collisions(picture) == "");
  CHECK(says(picture, "end_x − 1.304 m (µm)"));
  CHECK_FALSE(says(picture, "median 1.304"));
  CHECK(says(constant, "all 1.304"));
  CHECK_FALSE(says(constant, "median"));
  CHECK(picture.panels[0].x.decimals() <= 2);  // so all tics have different labels
}

TEST_CASE("a map's colors and cells are distinct to three digits") {
  const Result sweep = sweep_of({repeated("a", 100, 10, 10), repeated("b", 100, 1, 10)},
                                [](double n) { return 0.2966 + 2e-6 * n; });
  const Picture picture = sweep_picture(sweep, {});
  CHECK(says(picture, "end_x − 0.297 m (mm)"));
  CHECK(collisions(picture) == "");
}

TEST_CASE("a map of a million cases has no more cells than are visible") {
  const Picture picture =
      sweep_picture(sweep_of({repeated("a", 250000, 500, 500), repeated("b", 250000, 1, 500)}), {});
  CHECK(cells(picture) <= 160 * 160);
  CHECK(cells(picture) >= 100 * 100);
}

TEST_CASE("nothing collides, for keys of any name and size") {
  for (const double size : {1e-300, 1e-9, 1e-3, 1.0, 1e7, 1e300}) {
    for (const std::size_t inner : {std::size_t{1}, std::size_t{3}, std::size_t{12}}) {
      Column a = repeated(std::string(120, 'k') + ".0", 144, inner, 144 / inner);
      for (double& value : a.numbers) value *= size;
      Result sweep = sweep_of({a, repeated("b\nc", 144, 1, inner)},
                              [=](double n) { return size * std::cos(n); });
      sweep.columns.push_back(sweep.columns.back());
      sweep.columns.back().name = "max_tilt";
      CAPTURE(size, inner);
      CHECK(collisions(sweep_picture(sweep, {})) == "");
    }
  }
}

TEST_CASE("keys and measures missing from a sweep cannot be drawn") {
  const Result sweep = sweep_of({repeated("a", 12, 4, 3), repeated("b", 12, 1, 4)});
  CHECK_THROWS_WITH(sweep_picture(sweep, {{"end_y"}, {}}),
                    Contains("measures of sweep.csv: end_x"));
  CHECK_THROWS_WITH(sweep_picture(sweep, {{}, {"c"}}), Contains("what varies: a, b"));
  CHECK_THROWS_WITH(sweep_picture(sweep, {{}, {"a", "a"}}), Contains("twice"));
  CHECK_THROWS_WITH(sweep_picture(sweep, {{}, {"a", "b", "c"}}), Contains("one key, or two"));
  CHECK_THROWS_WITH(sweep_picture(sweep_of({repeated("a", 3, 1, 1)}), {}),
                    Contains("no key varies"));
}

}  // namespace bbsim_test::test_sweep
