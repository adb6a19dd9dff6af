// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim run: its output, its messages and its exit codes.
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_run {

using Names = std::vector<std::string>;

TEST_CASE("run writes the scenario's name with .csv into the current folder") {
  const Folder folder;
  const Result result = expect(0, "run @fig2a.yaml", folder, {"fig2a.csv: 1001 of 1001 rows"});
  CHECK(result.out.empty());
  CHECK(folder.files() == Names{"fig2a.csv"});
  const auto rows = lines(folder.read("fig2a.csv"));
  REQUIRE(rows.size() == 1002);
  CHECK(rows[0] == "t,x,y,gamma,phi,theta");
  CHECK(rows[1] == "0,0,-0.1,0,0.01,0");
  CHECK(contains(rows[1001], "10,0.1289970"));  // the reference says 0.128997060042
}

TEST_CASE("option -o - writes the CSV to standard output, and -q silences everything else") {
  const Folder folder;
  const Result result = expect(0, "run @incline.yaml -o - -q", folder);
  CHECK(result.err.empty());
  CHECK(lines(result.out).size() == 202);
  CHECK(folder.files().empty());
  CHECK(call("-q run @incline.yaml -o -").out == result.out);
}

TEST_CASE("the same scene gives the same bytes") {
  const Result first = expect(0, call("run @hold.yaml -o -"));
  CHECK(call("run @hold.yaml -o -").out == first.out);
}

TEST_CASE("option --set changes a key with the same checks") {
  const Folder folder;
  const auto rows = lines(
      expect(0, "run @fig2a.yaml --set time.step=1 --set 'ball.position.1=5 cm' -o -", folder).out);
  REQUIRE(rows.size() == 12);
  CHECK(rows[1] == "0,0,0.05,0,0.01,0");
  expect(2, "run @fig2a.yaml --set ball.radius=-1", folder,
         {"--set ball.radius=-1: ball.radius: found -1; allowed:"});
  CHECK(folder.files().empty());
}

TEST_CASE("HDF5 is written, and compares equal to the CSV") {
  const Folder folder;
  expect(0, "run @fig2a.yaml -o a.h5", folder);
  expect(0, "run @fig2a.yaml -o a.csv", folder);
  CHECK(folder.files() == Names{"a.csv", "a.h5"});
  expect(0, "compare a.csv a.h5 --rtol 0 --atol 0", folder);
}

TEST_CASE("the summary tells how the run went, and in one word why it is incomplete") {
  const Folder folder;
  const auto [scene, code, word] = GENERATE(table<std::string, int, std::string>({
      {"@fig2b.yaml", 0, "none"},
      {"@falls.yaml", 1, "event"},
      {"@fig2b-literal.yaml", 1, "unbounded"},
      {"'" BBSIM_SOURCE_DIR "/tests/data/scenarios/fast.yaml' --error 1e-13", 1,
       "error_out_of_reach"},
  }));
  expect(code, "run " + scene + " -o r.csv --summary s.json", folder);
  const auto summary = summary_of(folder, "s.json");
  CHECK(summary.at("reason_code") == word);
  if (word != "none") return;
  CHECK(summary.at("status") == "done");
  CHECK(summary.at("end_time") == 21);
  CHECK(summary.at("statistics").at("rhs_evaluations") > 0);
  CHECK(contains(summary.dump(), "\"theta_rate\""));
}

TEST_CASE("an error bound in meters is met, or refused with the attainable one") {
  const Folder folder;
  expect(0, "run @fig2a.yaml --error '1 um' --summary s.json", folder, {"error about "});
  CHECK(summary_of(folder, "s.json").at("error_bound") == 1e-6);
  CHECK(summary_of(folder, "s.json").at("error_estimate") <= 1e-6);

  const Result beyond =
      expect(1, "run @fig2a.yaml --error 1e-20", folder, {"an error of 1e-20 m is out of reach"});
  CHECK(lines(folder.read("fig2a.csv")).size() == 1002);
  // The bound that it says is attainable is met.
  const std::string before = "gives about ";
  const std::size_t at = beyond.err.find(before) + before.size();
  const std::string had = beyond.err.substr(at, beyond.err.find(' ', at) - at);
  expect(0, "run @fig2a.yaml --error " + had, folder);
  expect(2, "run @fig2a.yaml --error 1e-6 --set solver.rtol=1e-5", folder,
         {"solver.rtol: given together with error"});
}

TEST_CASE("mistakes in --error are reported as --error's") {
  const Folder folder;
  const std::string allowed = "; allowed: a length greater than 0 and at most 1";
  const auto [line, told] = GENERATE_COPY(table<std::string, std::string>({
      {"run @fig2a.yaml --error '5 deg'", "--error 5 deg: found 5 deg, an angle" + allowed},
      {"sweep @fig2a.yaml --error 0 --vary ball.radius=list:0.01,0.02",
       "--error 0: found 0" + allowed},
      {"sweep @fig2a.yaml --error 1e-6 --vary solver.error=list:1e-5,1e-6",
       "--error 1e-6: found, but the sweep varies solver.error"},
      // A key given with --set is reported under that option.
      {"run @fig2a.yaml --set solver.error=0", "--set solver.error=0: solver.error: found 0"},
  }));
  CHECK(expect(2, line, folder).err.starts_with(told));
}

TEST_CASE("the printed law blows up: exit 1, rows kept, and the reason with the poles") {
  const Folder folder;
  const Result result =
      expect(1, "run @fig2b-literal.yaml --summary s.json", folder,
             {"the run ended early, at t = 0.74", "grew without bound",
              "the closed loop is unstable about home", "poles have a positive real part"});
  CHECK(result.seconds < 20);  // below a second in release, slower with sanitizers
  CHECK(summary_of(folder, "s.json").at("status") == "failed");
  const auto rows = lines(folder.read("fig2b-literal.csv"));
  REQUIRE(rows.size() >= 76);
  CHECK(rows.back().substr(0, 5) == "0.74,");
}

TEST_CASE("Ctrl-C and SIGTERM end a run with 130 and keep its rows so far") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const Folder folder;
  folder.write("long.yaml", long_scene);
  expect(130,
         bbsim(Launch{words_of("run long.yaml --summary s.json"), folder.path(), signal,
                      std::chrono::milliseconds(1000)}),
         {"interrupted at t = "});
  CHECK(folder.files() == Names{"long.csv", "long.yaml", "s.json"});
  CHECK(summary_of(folder, "s.json").at("status") == "interrupted");
  const auto rows = lines(folder.read("long.csv"));
  CHECK(rows.size() > 2);
  CHECK(contains(rows.back(), ","));
}

TEST_CASE("output that cannot be written gives exit code 3 and leaves nothing behind") {
  const Folder folder;
  expect(3, "run @fig2a.yaml -o /dev/full", folder, {"/dev/full", "no space left on device"});
  expect(3, "run @fig2a.yaml -o missing/fig2a.csv", folder, {"missing"});
  expect(3, "run @incline.yaml -o a.csv --summary /dev/full", folder);
  CHECK(folder.files() == Names{"a.csv"});
}

TEST_CASE("the scenario may stand before, between or after the options") {
  const Result before = expect(0, call("run @fig2a.yaml -q --set gravity=2 -o -"));
  for (const std::string line : {"run --set gravity=2 @fig2a.yaml -q -o -",
                                 "run -q -o - --set gravity=3 --set gravity=2 @fig2a.yaml"}) {
    CHECK(call(line).out == before.out);
  }
}

TEST_CASE("a non-finite column has its reason, and the exit code reports it") {
  const Folder folder;
  expect(1, "run @incline.yaml --set ball.mass=1e308 -o a.csv --summary a.json", folder,
         {"normal_force is not a finite number in 201 rows, the first at t = 0 s"});
  CHECK(lines(folder.read("a.csv")).size() == 202);
  CHECK(summary_of(folder, "a.json").at("status") == "done");
  CHECK(contains(folder.read("a.json"), "normal_force is not a finite number"));
}

TEST_CASE("a loop that diverges to the range of rounding errors ends soon") {
  const Folder folder;
  folder.write("runs.yaml",
               "ball: {radius: 0.02, position: [0.5, 0]}\n"
               "gimbal: {servo: {natural_frequency: 13.8273, damping: 0.8}, start: {phi: -0.02}}\n"
               "controller:\n"
               "  pd: {kv: [[0.1, 0], [0, -0.09]], "
               "kp: [[-0.9084745762711864, 0], [0, -0.9084745762711864]]}\n"
               "  drives: angle\n"
               "  reference: {point: [0.007, 0]}\n"
               "time: {end: 7, step: 0.08}\n"
               "output: {columns: [t, x]}\n");
  // Because of rounding, radau may also get there, or pass it in some dozens of steps.
  const std::string method = GENERATE("bdf", "adams");
  const Result result = expect(
      1,
      "run runs.yaml --set solver.rtol=1e-6 --set solver.atol=1e-8 --set solver.method=" + method,
      folder, {"the loop has run away"});
  CHECK(result.seconds < 30);
}

TEST_CASE("a run that takes a million steps per second says so, and how to end it") {
  const Folder folder;
  folder.write("fast.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: {sinusoid: {amplitude: 1e-7, frequency: 1e8}}}}\n"
               "time: {end: 100, step: 10}\n");
  expect(130,
         bbsim(Launch{words_of("run fast.yaml -o r.csv"), folder.path(), SIGINT,
                      std::chrono::milliseconds(2000)}),
         {"steps per second of motion", "Ctrl-C ends it and keeps its rows"});
}

}  // namespace bbsim_test::test_run
