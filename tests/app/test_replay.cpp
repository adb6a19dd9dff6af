// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim replay and run --replay as a user runs them. The pages' display is tested in a browser
// (tests/replay/browser).
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_replay {

using Catch::Matchers::Contains;

namespace {

// The data in a page, as its script reads them.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"bbsim-data\">";
  const std::size_t from = page.find(begin);
  REQUIRE(from != std::string::npos);
  const std::size_t start = from + begin.size();
  return nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
}

std::vector<std::string> names_of(const nlohmann::json& run) {
  std::vector<std::string> names;
  for (const auto& column : run.at("columns")) names.push_back(column.at("name"));
  return names;
}

}  // namespace

TEST_CASE("a scenario is run and shown with everything known about it") {
  const Folder folder;
  const Result made = bbsim({"replay", config("rig.yaml"), "-o", "rig.html"}, folder.path());
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.err, Contains("rig.html: 2001 rows, 1."));
  CHECK(folder.files() == std::vector<std::string>{"rig.html"});
  const auto scene = data_of(folder.read("rig.html"));
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
  REQUIRE(bbsim({"run", config("fig2b.yaml"), "-o", "a.csv", "-q"}, folder.path()).exit_code == 0);
  REQUIRE(
      bbsim({"run", config("fig2b.yaml"), "-o", "b.csv", "--replay", "b.html", "-q"}, folder.path())
          .exit_code == 0);
  CHECK(folder.read("a.csv") == folder.read("b.csv"));
  // The page has all columns that a picture needs, whichever columns the file has.
  REQUIRE(bbsim({"run", config("fig2b.yaml"), "--set", "output.columns=[t,gamma]", "-o", "c.csv",
                 "--replay", "c.html", "-q"},
                folder.path())
              .exit_code == 0);
  CHECK(folder.read("c.csv").starts_with("t,gamma\n"));
  const auto names = names_of(data_of(folder.read("c.html")).at("runs").at(0));
  for (const char* name : {"x", "y", "phi", "theta", "x_reference"}) {
    CHECK(std::find(names.begin(), names.end(), name) != names.end());
  }
  CHECK(folder.read("b.html").size() < 1'200'000);
}

TEST_CASE("a run stopped by an event is shown to its end, from every kind of file") {
  const Folder folder;
  const auto check_page = [&](const std::string& name) {
    const auto run = data_of(folder.read(name)).at("runs").at(0);
    CHECK(run.at("status") == "stopped");
    CHECK_THAT(run.at("reason").get<std::string>(), Contains("the contact point left the plate"));
    CHECK(run.at("events").size() == 1);
    CHECK(run.at("rows") == 28);
  };
  CHECK(bbsim({"run", config("falls.yaml"), "-o", "f.csv", "--summary", "f.json", "--replay",
               "f.html"},
              folder.path())
            .exit_code == 1);
  check_page("f.html");
  CHECK(bbsim({"replay", "f.csv", "-o", "csv.html"}, folder.path()).exit_code == 0);
  check_page("csv.html");
  CHECK(bbsim({"run", config("falls.yaml"), "-o", "f.h5"}, folder.path()).exit_code == 1);
  CHECK(bbsim({"replay", "f.h5"}, folder.path()).exit_code == 0);
  check_page("f.html");
  CHECK(bbsim({"replay", config("falls.yaml"), "-o", "yaml.html"}, folder.path()).exit_code == 1);
  check_page("yaml.html");
}

TEST_CASE("a sliding ball is shown with its turning, and with its final orientation") {
  const Folder folder;
  // The orientation is a column like any other.
  REQUIRE(bbsim({"run", config("slides.yaml"), "--set",
                 "output.columns=[t,x,y,ball_qw,ball_qx,ball_qy,ball_qz]", "-o", "s.csv", "-q"},
                folder.path())
              .exit_code == 1);
  CHECK(folder.read("s.csv").starts_with("t,x,y,ball_qw,"));
  CHECK(bbsim({"replay", config("slides.yaml"), "-o", "s.html", "-q"}, folder.path()).exit_code ==
        1);
  const auto run = data_of(folder.read("s.html")).at("runs").at(0);
  CHECK(run.at("orientationGiven") == true);
  CHECK(run.at("hasEndRow") == true);
  CHECK(run.at("rows") == 167);
  CHECK(run.at("time").is_string());  // the last time is no multiple of the step
  CHECK(run.at("reached") == Approx(3.33288).epsilon(1e-5));
}

TEST_CASE("runs and a rig's log share one scene, and a sweep has its own") {
  const Folder folder;
  const std::string log = folder.write("log.csv", "Time,Ballx,Bally\n0,-10,0\n100,-9,1\n200,,2\n");
  CHECK(bbsim({"replay", config("fig2a.yaml"), config("fig2b.yaml"), "--data", log, "--map",
               "t=Time:ms,x=Ballx:mm,y=Bally:cm", "-o", "all.html"},
              folder.path())
            .exit_code == 0);
  const auto runs = data_of(folder.read("all.html")).at("runs");
  REQUIRE(runs.size() == 3);
  CHECK(runs.at(2).at("name") == "log.csv");
  CHECK(runs.at(2).at("time") == nlohmann::json::parse(R"({"start":0.0,"step":0.1,"count":3})"));

  REQUIRE(bbsim({"sweep", config("fig2b.yaml"), "--vary", "ball.radius=linear:0.01:0.02:3", "-o",
                 "s.csv", "-q"},
                folder.path())
              .exit_code == 0);
  CHECK(bbsim({"replay", "s.csv"}, folder.path()).exit_code == 0);
  CHECK(data_of(folder.read("s.html")).at("sweeps").at(0).at("cases") == 3);
}

TEST_CASE("input that a replay cannot show is reported with its place, and nothing is written") {
  const Folder folder;
  const std::string log = folder.write("log.csv", "Time,Ballx\n0,-10\n100,far\n");
  struct Fault {
    std::vector<std::string> arguments;
    int exit_code;
    std::string message;
  };
  const std::vector<Fault> faults = {
      {{}, 2, "FILES: missing"},
      {{config("fig2a.yaml"), "-o", "a.png"},
       2,
       "--output: found a.png; allowed: a name that ends"},
      {{"none.csv", "-o", "a.html"}, 2, "none.csv"},
      {{log, "-o", "a.html"}, 2, "log.csv: cannot be replayed: it has neither a column x nor y"},
      {{"--data", log, "--map", "t=Time:ms,x=Ballx:mm", "-o", "a.html"},
       2,
       "log.csv: column Ballx, row 2: found \"far\""},
      {{"--data", log, "--map", "t=Time:mm", "-o", "a.html"}, 2, "t=Time:mm\": t is in s"},
      {{"--data", log, "--map", "t=time", "-o", "a.html"}, 2, "did you mean Time?"},
      {{"--data", log, "--map", "xx=Ballx", "-o", "a.html"}, 2, "there is no column \"xx\""},
      {{"--data", log, "--map", "t", "-o", "a.html"}, 2, "COLUMN=NAME:UNIT"},
      {{"--data", log, "--map", "t=Time,t=Time", "-o", "a.html"}, 2, "t is given twice"},
      {{config("fig2a.yaml"), "--map", "t=Time", "-o", "a.html"}, 2, "allowed with --data"},
      {{log, "--set", "ball.radius=1", "-o", "a.html"}, 2, "--set: allowed with a scenario"},
      {{config("fig2a.yaml"), "-o", "none/a.html"}, 3, "none/a.html"},
  };
  for (const Fault& fault : faults) {
    std::vector<std::string> arguments{"replay"};
    arguments.insert(arguments.end(), fault.arguments.begin(), fault.arguments.end());
    const Result made = bbsim(arguments, folder.path());
    CAPTURE(fault.message, made.err);
    CHECK(made.exit_code == fault.exit_code);
    CHECK_THAT(made.err, Contains(fault.message));
  }
  CHECK(folder.files() == std::vector<std::string>{"log.csv"});
}

TEST_CASE("a missing page template is reported before the run") {
  const Folder folder;
  Launch launch;
  launch.arguments = {"run", config("fig2a.yaml"), "-o", "a.csv", "--replay", "a.html"};
  launch.folder = folder.path();
  launch.prepare = [] { setenv("BBSIM_SHARE_PATH", "/nowhere", 1); };
  const Result made = bbsim(launch);
  CHECK(made.exit_code == 3);
  CHECK_THAT(made.err, Contains("replay.html is not in /nowhere") && Contains("libjs-three"));
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
  const auto replay = [&](std::vector<std::string> more) {
    Launch launch;
    launch.arguments = {"replay", "tasks.yaml", "--live"};
    launch.arguments.insert(launch.arguments.end(), more.begin(), more.end());
    launch.folder = folder.path();
    launch.prepare = [] { setenv("BBSIM_SHARE_PATH", ".", 1); };
    return bbsim(launch);
  };
  const Result without = replay({"-o", "a.html"});
  CHECK(without.exit_code == 3);
  CHECK_THAT(without.err, Contains("engine.html is not in .; `scripts/setup --wasm"));
  folder.write("engine.html", "THE ENGINE");
  CHECK(replay({"tasks.yaml", "-o", "a.html"}).exit_code == 2);
  const Result over = replay({"-o", "engine.html"});
  CHECK(over.exit_code == 2);
  CHECK_THAT(over.err, Contains("the engine of live pages"));
  CHECK(folder.read("engine.html") == "THE ENGINE");

  // An open task is no failure of the page.
  const Result made = replay({"-o", "a.html"});
  CHECK(made.exit_code == 0);
  const std::string page = folder.read("a.html");
  CHECK_THAT(page, Contains("THE ENGINE") && !Contains("strict"));
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
  Launch launch;
  launch.arguments = {
      "run",   config("fig2b.yaml"), "--set", "time.end=1e8", "--set", "time.step=10000", "-o",
      "i.csv", "--replay",           "i.html"};
  launch.folder = folder.path();
  launch.signal = 2;
  // On a busy machine the signal may arrive before the first row, and then nothing can be shown.
  for (const int wait : {300, 3000, 30000}) {
    launch.signal_after = std::chrono::milliseconds{wait};
    REQUIRE(bbsim(launch).exit_code == 130);
    if (std::filesystem::exists(folder / "i.html")) break;
  }
  const auto run = data_of(folder.read("i.html")).at("runs").at(0);
  CHECK(run.at("status") == "interrupted");
  CHECK_THAT(run.at("reason").get<std::string>(), Contains("interrupted at t = "));
}

}  // namespace bbsim_test::test_replay
