// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The end of a stopped run's scene; transcripts/replay.txt has more of scenes.
#include <cmath>

#include "catch.hpp"
#include "replay/scene.hpp"
#include "replay/sources.hpp"
#include "results/result.hpp"
#include "scenario/reader.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_sources {

using namespace bbsim;
using namespace bbsim::replay;

TEST_CASE(
    "the instant at which an event stops a run is its last row, and the ball rolls up to it") {
  const Folder folder;
  const std::string file = folder.put("r.csv",
                                      "t,x,y,ball_qw,ball_qx,ball_qy,ball_qz,phi\n"
                                      "0,0,0,1,0,0,0,0\n1,0.1,0,1,0,0,0,0\n");
  folder.put("r.json", R"({"version": "7", "status": "stopped", "output": "r.csv", "title": "",
    "scenario_text": "", "reason": "", "end_time": 1.5, "rows": 2,
    "events": [{"event": "edge", "action": "stop", "t": 1.5, "x": 0.11, "y": 0.0, "phi": 0.3}]})");
  results::Result result =
      results::read_result(file, {"", BBSIM_SOURCE_DIR "/configs/fig2a.yaml", {}});
  const Scenario scenario = *result.scenario;
  Run run = run_of_result(std::move(result), "r.csv");
  CHECK(run.has_end_row);
  CHECK(row_count(run) == 3);
  CHECK(rows_of_file(run) == 2);
  CHECK(run.end_time == 1.5);
  CHECK(run.find("x")->numbers.back() == 0.11);
  CHECK(run.find("phi")->numbers.back() == 0.3);
  run.rolls = true;
  describe_sight(run, scenario);
  // One centimeter with a radius of one: one radian about y.
  CHECK(run.orientation.back()[0] == Approx(std::cos(0.5)));
  CHECK(run.orientation.back()[2] == Approx(std::sin(0.5)));
}

}  // namespace bbsim_test::test_sources
