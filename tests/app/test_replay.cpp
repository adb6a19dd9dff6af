// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim replay and run --replay as a user runs them. The pages' display is tested in a browser
// (tests/replay/browser).
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_replay {

namespace {

// The data in a page, as its script reads them.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"bbsim-data\">";
  const std::size_t from = page.find(begin);
  REQUIRE(from != std::string::npos);
  const std::size_t start = from + begin.size();
  return nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
}

nlohmann::json page_of(const Folder& folder, const std::string& name) {
  return data_of(folder.read(name));
}

nlohmann::json run_of(const Folder& folder, const std::string& name) {
  return page_of(folder, name).at("runs").at(0);
}

}  // namespace

TEST_CASE("a scenario is run and shown with everything known about it") {
  const Folder folder;
  expect(0, "replay @rig.yaml -o rig.html", folder, {"rig.html: 2001 rows, 1."});
  CHECK(folder.files() == std::vector<std::string>{"rig.html"});
  const auto scene = page_of(folder, "rig.html");
  const auto& run = scene.at("runs").at(0);
  CHECK(scene.at("title") == "A hobby rig on the circle of Fig. 2(b)");
  CHECK(run.at("name") == "rig.yaml");
  CHECK(run.at("status") == "done");
  CHECK(run.at("orientationGiven") == true);
  CHECK_FALSE(run.at("check").empty());
  CHECK_FALSE(run.at("poles").is_null());
  CHECK(run.at("summary").at("statistics").at("steps") > 0);
}

TEST_CASE("run --replay shows the run, and its result is the same byte for byte") {
  const Folder folder;
  expect(0, "run @fig2b.yaml -q -o a.csv", folder);
  expect(0, "run @fig2b.yaml -q -o b.csv --replay b.html", folder);
  CHECK(folder.read("a.csv") == folder.read("b.csv"));
  CHECK(folder.read("b.html").size() < 1'200'000);
  // The page has all columns that a picture needs, whichever columns the file has.
  expect(0, "run @fig2b.yaml --set output.columns=[t,gamma] -o c.csv --replay c.html -q", folder);
  CHECK(folder.read("c.csv").starts_with("t,gamma\n"));
  std::set<std::string> names;
  const auto run = run_of(folder, "c.html");
  for (const auto& column : run.at("columns")) names.insert(column.at("name"));
  for (const char* name : {"x", "y", "phi", "theta", "x_reference"}) CHECK(names.count(name) == 1);
}

TEST_CASE("a run stopped by an event is shown to its end, from every kind of file") {
  const Folder folder;
  expect(1, "run @falls.yaml -o f.csv --summary f.json --replay run.html", folder);
  expect(0, "replay f.csv -o csv.html", folder);
  expect(1, "run @falls.yaml -o f.h5", folder);
  expect(0, "replay f.h5", folder);
  expect(1, "replay @falls.yaml -o yaml.html", folder);
  for (const char* const page : {"run.html", "csv.html", "f.html", "yaml.html"}) {
    CAPTURE(page);
    const auto run = run_of(folder, page);
    CHECK(run.at("status") == "stopped");
    CHECK(contains(run.at("reason"), "the contact point left the plate"));
    CHECK(run.at("events").size() == 1);
    CHECK(run.at("rows") == 28);
  }
}

TEST_CASE("a sliding ball is shown with its turning, and with its final orientation") {
  const Folder folder;
  // The orientation is a column like any other.
  const Result rows = expect(1,
                             "run @slides.yaml --set "
                             "output.columns=[t,x,y,ball_qw,ball_qx,ball_qy,ball_qz] -o - -q",
                             folder);
  CHECK(rows.out.starts_with("t,x,y,ball_qw,"));
  expect(1, "replay @slides.yaml -o s.html -q", folder);
  const auto run = run_of(folder, "s.html");
  CHECK(run.at("orientationGiven") == true);
  CHECK(run.at("hasEndRow") == true);
  CHECK(run.at("rows") == 167);
  CHECK(run.at("time").is_string());  // the last time is no multiple of the step
  CHECK(run.at("reached") == Approx(3.33288).epsilon(1e-5));
}

TEST_CASE("runs and a rig's log share one scene, and a sweep has its own") {
  const Folder folder;
  folder.write("log.csv", "Time,Ballx,Bally\n0,-10,0\n100,-9,1\n200,,2\n");
  expect(0,
         "replay @fig2a.yaml @fig2b.yaml --data log.csv --map t=Time:ms,x=Ballx:mm,y=Bally:cm -o "
         "all.html",
         folder);
  const auto runs = page_of(folder, "all.html").at("runs");
  REQUIRE(runs.size() == 3);
  CHECK(runs.at(2).at("name") == "log.csv");
  CHECK(runs.at(2).at("time") == nlohmann::json::parse(R"({"start":0.0,"step":0.1,"count":3})"));

  folder.write("clock.csv", "when,x_mm,y\n0,10,0\n100,20,0\n");
  expect(0, "replay --data clock.csv --map t=when:ms -o clock.html", folder);
  CHECK(page_of(folder, "clock.html").at("runs").at(0).at("time").at("count") == 2);

  expect(0, "sweep @fig2b.yaml --vary ball.radius=linear:0.01:0.02:3 -o s.csv -q", folder);
  expect(0, "replay s.csv", folder);
  CHECK(page_of(folder, "s.html").at("sweeps").at(0).at("cases") == 3);
}

TEST_CASE("input that a replay cannot show is reported with its place, and nothing is written") {
  const Folder folder;
  folder.write("log.csv", "Time,Ballx\n0,-10\n100,far\n");
  const auto [words, code, told] = GENERATE(table<std::string, int, std::string>({
      {"", 2, "FILES: missing"},
      {"@fig2a.yaml -o a.png", 2, "--output: found a.png; allowed: a name that ends"},
      {"none.csv -o a.html", 2, "none.csv"},
      {"log.csv -o a.html", 2, "log.csv: cannot be replayed: it has neither a column x nor y"},
      {"--data log.csv --map t=Time:ms,x=Ballx:mm -o a.html", 2,
       "log.csv:3:5: column Ballx: found \"far\""},
      {"--data log.csv --map t=Time:mm -o a.html", 2, "t=Time:mm\", a length: t is in s"},
      {"--data log.csv --map t=time -o a.html", 2, "did you mean Time?"},
      {"--data log.csv --map xx=Ballx -o a.html", 2, "there is no column \"xx\""},
      {"--data log.csv --map t -o a.html", 2, "COLUMN=NAME:UNIT"},
      {"--data log.csv --map t=Time,t=Time -o a.html", 2, "t is given twice"},
      {"@fig2a.yaml --map t=Time -o a.html", 2, "allowed with --data"},
      {"log.csv --time-offset start", 2, "bbsim replay --data log.csv --time-offset start"},
      {"log.csv --set ball.radius=1 -o a.html", 2, "--set: allowed with a scenario"},
      {"@fig2a.yaml -o none/a.html", 3, "none/a.html"},
  }));
  expect(code, "replay " + words, folder, {told});
  CHECK(folder.files() == std::vector<std::string>{"log.csv"});
}

TEST_CASE("a missing page template is reported before the run") {
  const Folder folder;
  expect(
      3,
      call_with("BBSIM_SHARE_PATH", "/nowhere", "run @fig2a.yaml -o a.csv --replay a.html", folder),
      {"replay.html is not in /nowhere", "libjs-three"});
  CHECK(folder.files().empty());
}

TEST_CASE("a live page has the engine, keys, measures and tasks") {
  const Folder folder;
  folder.write("replay.html",
               "<!--still-->strict<!--/still--><!--live-->@BBSIM_ENGINE@<!--/live-->@BBSIM_TITLE@"
               "<script type=\"application/json\" id=\"bbsim-data\">@BBSIM_DATA@</script>");
  folder.write("tasks.yaml", R"(
title: tasks
ball: {radius: 1 cm, velocity: [0.2, 0]}
gimbal: {motion: {phi: 1 deg, theta: 0}}
time: {end: 1, step: 0.1}
exercise:
  tasks:
    - {text: Stay., expect: max_distance < 1 m}
    - {text: Stay still., expect: max_distance < 1 mm}
  free: [ball.radius]
)");
  const auto replay = [&](const std::string& more) {
    return call_with("BBSIM_SHARE_PATH", ".", "replay tasks.yaml --live " + more, folder);
  };
  expect(3, replay("-o a.html"), {"engine.html is not in .; `scripts/setup --wasm"});
  folder.write("engine.html", "THE ENGINE");
  expect(2, replay("tasks.yaml -o a.html"));
  expect(2, replay("-o engine.html"), {"the engine of live pages"});
  CHECK(folder.read("engine.html") == "THE ENGINE");

  // An open task is no failure of the page.
  expect(0, replay("-o a.html"));
  const std::string page = folder.read("a.html");
  CHECK(contains(page, "THE ENGINE"));
  CHECK_FALSE(contains(page, "strict"));
  const auto live = data_of(page).at("live");
  CHECK(live.at("free") == std::vector<std::string>{"ball.radius"});
  CHECK(live.at("tasks").at(0).at("holds") == true);
  CHECK(live.at("tasks").at(1).at("holds") == false);
  CHECK(live.at("measures").at("max_distance").at("value") > 0.2);
  const auto& keys = live.at("keys");
  const auto radius = std::ranges::find_if(
      keys, [](const nlohmann::json& key) { return key.at("key") == "ball.radius"; });
  REQUIRE(radius != keys.end());
  CHECK(radius->at("value") == 0.01);
  CHECK(radius->at("least") == 0);
  CHECK(radius->at("open") == true);
}

TEST_CASE("an interrupted run is shown as far as it got") {
  const Folder folder;
  Launch launch{words_of("run @fig2b.yaml --set time.end=1e8 --set time.step=10000 -o i.csv "
                         "--replay i.html"),
                folder.path(), 2};
  // On a busy machine the signal may arrive before the first row, and then nothing can be shown.
  for (const int wait : {300, 3000, 30000}) {
    launch.signal_after = std::chrono::milliseconds{wait};
    REQUIRE(bbsim(launch).exit_code == 130);
    if (std::filesystem::exists(folder / "i.html")) break;
  }
  const auto run = run_of(folder, "i.html");
  CHECK(run.at("status") == "interrupted");
  CHECK(contains(run.at("reason"), "interrupted at t = "));
}

}  // namespace bbsim_test::test_replay
