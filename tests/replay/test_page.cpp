// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene in its page: numbers with their intended precision, texts as texts.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "circling.hpp"
#include "replay/numbers.hpp"
#include "replay/page.hpp"
#include "replay/scene.hpp"
#include "replay/template.hpp"
#include "scenario/columns.hpp"
#include "support/folder.hpp"
#include "support/text.hpp"

namespace bbsim_test::test_page {

using bbsim::InputError;
using bbsim::OutputError;
using bbsim::replay::page;
using bbsim::replay::Run;
using bbsim::replay::Scene;

namespace {

Scene scene_of(Run run) {
  Scene scene;
  scene.title = run.title;
  scene.version = "1.2.3";
  scene.runs.push_back(std::move(run));
  return scene;
}

// A sweep of 41 x 21 cases over two keys, with some failed cases.
bbsim::replay::Sweep swept() {
  bbsim::replay::Sweep sweep;
  sweep.name = "swept.csv";
  sweep.source.file = "configs/my scene.yaml";
  sweep.keys = {{{"ball.radius", {}}}, {{"ball.position.0", {}}}};
  sweep.measures = {{{"max_distance", {}, {}, "m"}}};
  for (int i = 0; i < 41; ++i) {
    for (int k = 0; k < 21; ++k) {
      sweep.cases.push_back(21 * i + k);
      sweep.keys[0].numbers.push_back(0.01 + 0.001 * i);
      sweep.keys[1].numbers.push_back(-0.1 + 0.01 * k);
      const bool failed = i + k > 50;
      sweep.status.emplace_back(failed ? "failed at 0.7 s: it grew, \"fast\"" : "done");
      sweep.measures[0].numbers.push_back(failed ? std::nan("") : std::hypot(i / 40.0, k / 20.0));
    }
  }
  return sweep;
}

// A small template like the real one.
const std::string small_template =
    "<title>@BBSIM_TITLE@</title><!--runs-->three "
    "dimensions<!--/runs--><!--sweeps-->maps<!--/sweeps-->"
    "<script type=\"application/json\">@BBSIM_DATA@</script>";

// The JSON in a page made from it.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

template <class Number>
std::vector<Number> numbers_of(const std::string& base64) {
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 0xFF);
    }
  }
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

}  // namespace

TEST_CASE("numbers too large for a float are infinite in a page, without undefined conversions") {
  const std::vector<double> values{1e300, -1e300, 0.1, std::nan("")};
  const auto back = numbers_of<float>(bbsim::replay::Numbers(nullptr).floats(values));
  CHECK(back[0] == std::numeric_limits<float>::infinity());
  CHECK(back[1] == -std::numeric_limits<float>::infinity());
  CHECK(back[2] == 0.1F);
  CHECK(std::isnan(back[3]));
}

TEST_CASE("a run's rows read back from its page") {
  const Run run = circling(500);
  const auto data = data_of(page(scene_of(run), small_template));
  const auto& made = data.at("runs").at(0);
  CHECK(data.at("version") == "1.2.3");
  CHECK(made.at("rows") == 500);
  CHECK(made.at("buckets") == 0);  // nothing was left out
  CHECK(made.at("ball").at("radius") == 0.01);
  CHECK(data.at("stage").at("width") == 0.3);
  CHECK(data.at("stage").at("plateGiven") == true);
  REQUIRE(made.at("columns").size() == run.columns.size() - 1);  // t is stored separately
  for (std::size_t c = 1; c < run.columns.size(); ++c) {
    const auto& column = made.at("columns").at(c - 1);
    CHECK(column.at("name") == run.columns[c].name);
    const auto values = numbers_of<float>(column.at("data"));
    REQUIRE(values.size() == 500);
    for (std::size_t row = 0; row < values.size(); ++row) {
      CHECK(values[row] == static_cast<float>(run.columns[c].numbers[row]));
    }
  }
  const auto quaternions = numbers_of<std::int16_t>(made.at("orientation"));
  REQUIRE(quaternions.size() == 4 * 500);
  CHECK(quaternions[0] == 32767);
  CHECK(quaternions[1] == 0);
}

TEST_CASE("times are exact: three numbers if evenly spaced, else all of them") {
  Run run = circling(100);
  std::vector<double>& t = run.columns[0].numbers;
  const auto time_of = [&] {
    return data_of(page(scene_of(run), small_template)).at("runs").at(0).at("time");
  };
  auto time = time_of();
  REQUIRE(time.is_object());
  for (std::size_t i = 0; i < t.size(); ++i) {
    CHECK(time.at("start").get<double>() + static_cast<double>(i) * time.at("step").get<double>() ==
          t[i]);
  }
  t.back() += 1e-9;
  time = time_of();
  REQUIRE(time.is_string());
  CHECK(numbers_of<double>(time) == t);
}

TEST_CASE("hostile text stays text everywhere") {
  const std::string hostile =
      "</script><script>alert(1)</script><!-- \" ' ` & \\ \x1b[31m \xE2\x80\xA8 \xE2\x80\xA9 "
      "\xE2\x80\xAE @BBSIM_DATA@ \xff";
  Run run = circling(3);
  run.name = run.title = run.status = run.reason = hostile;
  bbsim::Source& source = run.scenario->source;
  source.file = source.text = hostile;
  run.check = {hostile};
  source.overrides = {hostile};
  run.version = hostile;
  run.summary = R"({"title": "</script>"})";
  run.columns.push_back({hostile, {1, 2, 3}, {}, hostile});
  run.events.push_back({hostile, true, 0.01, 0, 0});
  Scene scene = scene_of(run);
  scene.version = hostile;
  scene.sweeps.push_back(swept());
  scene.sweeps[0].name = scene.sweeps[0].keys[0].name = scene.sweeps[0].status[0] = hostile;

  const std::string made = page(scene, small_template);
  CHECK(count(made, "</script>") == 1);  // the template's own
  CHECK(count(made, "<script") == 1);
  CHECK(count(made, "<!--") == 4);          // the template's own
  CHECK(count(made, "\xE2\x80\xA8") == 1);  // in the title, where it is an ordinary character
  CHECK_FALSE(contains(made, "\x1b"));
  CHECK_FALSE(contains(made, "\xff"));
  CHECK(contains(made, "&lt;/script&gt;"));

  const auto data = data_of(made);
  const std::string arrived = hostile.substr(0, hostile.size() - 1) + "\xEF\xBF\xBD";
  CHECK(data.at("title") == arrived);
  CHECK(data.at("runs").at(0).at("scenario").at("text") == arrived);
  CHECK(data.at("runs").at(0).at("events").at(0).at("name") == arrived);
  CHECK(data.at("runs").at(0).at("summary").at("title") == "</script>");
  CHECK(data.at("sweeps").at(0).at("statuses").at(0) == arrived);
}

TEST_CASE("a page has the libraries that it uses") {
  const auto [has_run, has_sweep] =
      GENERATE(table<bool, bool>({{true, false}, {false, true}, {true, true}}));
  Scene scene;
  if (has_run) scene = scene_of(circling(3));
  if (has_sweep) scene.sweeps.push_back(swept());
  const std::string made = page(scene, small_template);
  CHECK(contains(made, "three dimensions<!--/runs-->") == has_run);
  CHECK(contains(made, "maps") == has_sweep);
}

TEST_CASE("a million rows of many columns stay below 5 MB and lose no peak") {
  Run run = circling(1'000'000);
  // Noise and a single-row peak.
  for (int extra = 0; extra < 10; ++extra) {
    std::vector<double> noise(1'000'000);
    unsigned state = 1U + static_cast<unsigned>(extra);
    for (double& value : noise) {
      state = state * 1664525U + 1013904223U;
      value = static_cast<double>(state >> 8) * 1e-9;
    }
    noise[700'001] = 5;
    run.columns.push_back({"noise_" + std::to_string(extra), std::move(noise), {}, "N"});
  }
  const std::string made = page(scene_of(run), small_template);
  CHECK(made.size() < 3'800'000);  // the template has 1.15 MB
  const auto data = data_of(made).at("runs").at(0);
  CHECK(data.at("rows") == 1'000'000);
  const auto values = numbers_of<float>(data.at("columns").back().at("data"));
  CHECK(std::count(values.begin(), values.end(), 5.0F) == 1);
}

TEST_CASE("several runs share a page's space") {
  Scene scene = scene_of(circling(30'000));
  const std::size_t alone = bbsim::replay::rows_allowed(scene);
  scene.runs.push_back(scene.runs.front());
  CHECK(bbsim::replay::rows_allowed(scene) == alone / 2);
}

TEST_CASE("the plate is the scene's, or one that holds the path") {
  Scene scene = scene_of(circling(2100));
  auto stage = bbsim::replay::stage_of(scene);
  CHECK(stage.width == 0.3);
  CHECK(stage.depth == 0.2);
  CHECK(stage.plate_given);
  scene.runs[0].scenario->plate = {};
  stage = bbsim::replay::stage_of(scene);
  CHECK_FALSE(stage.plate_given);
  CHECK(stage.width == Approx(2 * 1.2 * 0.05));
  scene.runs[0].scenario->plate.diameter = 0.25;
  CHECK(bbsim::replay::stage_of(scene).round);
  // The path fits even if the ball is mostly in one place.
  scene.runs[0].scenario->plate = {};
  scene.runs[0].columns[1].numbers.front() = 50;
  CHECK(bbsim::replay::stage_of(scene).width == Approx(2 * 1.2 * 50));
  scene.runs[0].columns[1].numbers.front() = 0.05;
  // A last row that diverges does not shrink the rest; so far out nothing is drawn.
  scene.runs[0].scenario->plate = {};
  scene.runs[0].columns[1].numbers.back() = 1e200;
  CHECK(bbsim::replay::stage_of(scene).width <= 2 * 1.2 * 20 * 0.05);
}

TEST_CASE("a scene along one axis has a beam-shaped plate, and needs no column of the other") {
  Scene scene = scene_of(circling(2100));
  scene.runs[0].scenario->plate = {};
  scene.runs[0].columns[2].numbers.assign(2100, 0.0);
  for (double& y : scene.runs[0].columns.back().numbers) y = 0;
  const auto stage = bbsim::replay::stage_of(scene);
  CHECK(stage.width == Approx(2 * 1.2 * 0.05));
  CHECK(stage.depth < stage.width / 2);
  CHECK(stage.depth >= 4 * 0.01);  // wider than the ball
  scene.runs[0].columns.erase(scene.runs[0].columns.begin() + 2);
  CHECK_NOTHROW(page(scene, small_template));
}

TEST_CASE("a page gives what is known of turns, units and the end") {
  Run run = circling(50);
  run.rolls = false;
  run.units_known = false;
  run.has_end_row = true;
  run.end_time = 0.495;
  const auto made = data_of(page(scene_of(run), small_template)).at("runs").at(0);
  CHECK(made.at("orientation") == "");
  CHECK(made.at("orientationGiven") == false);
  CHECK(made.at("unitsKnown") == false);
  CHECK(made.at("rows") == 49);
  CHECK(made.at("reached") == 0.495);
}

TEST_CASE("unusable replay input is refused with the reason") {
  const auto refusal = [](const Scene& scene) {
    return message_of<InputError>([&] { static_cast<void>(page(scene, small_template)); });
  };
  CHECK(contains(refusal({}), "neither a run nor a sweep"));
  const auto of_run = [&](std::size_t rows, auto change) {
    Scene scene = scene_of(circling(rows));
    change(scene.runs[0].columns);
    return refusal(scene);
  };
  const std::string file = "circle.csv: cannot be replayed: ";
  CHECK(of_run(3, [](auto& columns) { columns[2].numbers.pop_back(); }) ==
        file + "column y has 2 rows, and t has 3");
  CHECK(contains(of_run(3, [](auto& columns) { columns[0].numbers[2] = 0.01; }),
                 file + "t in row 3 is 0.01, after 0.01"));
  CHECK(contains(
      of_run(3, [](auto& columns) { columns.erase(columns.begin() + 1, columns.begin() + 3); }),
      file + "it has neither a column x nor y"));
  CHECK(of_run(0, [](auto&) {}) == file + "it has no rows");
  Scene scene;
  scene.sweeps.push_back(swept());
  scene.sweeps[0].measures[0].numbers.pop_back();
  CHECK(refusal(scene) ==
        "swept.csv: cannot be replayed: column max_distance has 860 rows, and status has 861");
}

TEST_CASE("an invalid or missing template") {
  const Scene scene = scene_of(circling(3));
  for (const std::string& wrong :
       {std::string("<title></title>@BBSIM_DATA@"), small_template + small_template,
        std::string("@BBSIM_DATA@ @BBSIM_TITLE@")}) {
    CHECK_THROWS_AS(page(scene, wrong), InputError);
  }
  const std::string missing = message_of<OutputError>([] {
    static_cast<void>(bbsim::replay::read_template("replay.html", {"/nowhere", "/else"}));
  });
  CHECK(contains(missing, "replay.html is not in /nowhere and /else"));
  CHECK(contains(missing, "libjs-three, libjs-dygraphs"));
}

TEST_CASE("a sweep's cases read back: exact keys, each kind of ending once") {
  Scene scene;
  scene.sweeps.push_back(swept());
  const auto data = data_of(page(scene, small_template)).at("sweeps").at(0);
  CHECK(data.at("cases") == 861);
  CHECK(numbers_of<double>(data.at("keys").at(0).at("doubles")) == scene.sweeps[0].keys[0].numbers);
  CHECK(data.at("statuses") == nlohmann::json{"done", "failed at 0.7 s: it grew, \"fast\""});
  for (std::size_t i = 0; i < 861; ++i) {
    CHECK(data.at("statuses").at(data.at("status").at(i).get<std::size_t>()) ==
          scene.sweeps[0].status[i]);
  }
}

TEST_CASE("a page has the plots of all columns, with commands beside their targets") {
  const auto plots = data_of(page(scene_of(circling(50)), small_template)).at("plots");
  std::map<std::string, std::string> found;  // titles by column and unit
  for (const auto& plot : plots) {
    for (const auto& column : plot.at("columns")) {
      const std::string name = column.at("name"), unit = column.at("unit");
      const bool is_new = found.emplace(name + ' ' + unit, plot.at("title")).second;
      CHECK(is_new);
    }
  }
  for (const bbsim::scenario::Column& column : bbsim::scenario::catalogue) {
    if (column.name == "t" || column.panel == "orientation") continue;
    CAPTURE(column.name);
    CHECK(found.contains(std::string(column.name) + ' ' + std::string(column.unit)));
  }
  CHECK(found.at("push_y N") == "Push");
  CHECK(found.at("position_error m") == "Error of x, y");
  CHECK(found.at("phi_command rad") == "Gimbal");
  CHECK(found.at("phi_command N m") == found.at("phi_torque N m"));
}

}  // namespace bbsim_test::test_page
