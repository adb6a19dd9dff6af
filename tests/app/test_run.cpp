// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim run: its output, its messages and its exit codes.
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_run {

using Names = std::vector<std::string>;
using Catch::Matchers::Contains;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> list;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) list.push_back(line);
  return list;
}

// Takes minutes: a million seconds of a fast oscillation.
const char* const long_scene =
    "ball: {radius: 0.01}\n"
    "gimbal: {motion: {phi: {sinusoid: {amplitude: 1e-5, frequency: 300}}}}\n"
    "time: {end: 1e6, step: 1}\n";

}  // namespace

TEST_CASE("run writes the scenario's name with .csv into the current folder") {
  const Folder folder;
  const Result result = bbsim({"run", config("fig2a.yaml")}, folder.path());
  CHECK(result.exit_code == 0);
  CHECK(result.out.empty());
  CHECK(contains(result.err, "fig2a.csv: 1001 of 1001 rows"));
  CHECK(folder.files() == Names{"fig2a.csv"});
  const auto rows = lines(folder.read("fig2a.csv"));
  REQUIRE(rows.size() == 1002);
  CHECK(rows[0] == "t,x,y,gamma,phi,theta");
  CHECK(rows[1] == "0,0,-0.1,0,0.01,0");
  CHECK(contains(rows[1001], "10,0.1289970"));  // the reference says 0.128997060042
}

TEST_CASE("option -o - writes the CSV to standard output, and -q silences everything else") {
  const Folder folder;
  const Result result = bbsim({"run", config("incline.yaml"), "-o", "-", "-q"}, folder.path());
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK(lines(result.out).size() == 202);
  CHECK(folder.files().empty());
  CHECK(bbsim({"-q", "run", config("incline.yaml"), "-o", "-"}).out == result.out);
}

TEST_CASE("the same scene gives the same bytes") {
  const Result first = bbsim({"run", config("hold.yaml"), "-o", "-"});
  CHECK(first.exit_code == 0);
  CHECK(bbsim({"run", config("hold.yaml"), "-o", "-"}).out == first.out);
}

TEST_CASE("option --set changes a key with the same checks") {
  const Result fewer = bbsim({"run", config("fig2a.yaml"), "--set", "time.step=1", "--set",
                              "ball.position.1=5 cm", "-o", "-"});
  CHECK(fewer.exit_code == 0);
  const auto rows = lines(fewer.out);
  REQUIRE(rows.size() == 12);
  CHECK(rows[1] == "0,0,0.05,0,0.01,0");

  const Folder folder;
  const Result refused =
      bbsim({"run", config("fig2a.yaml"), "--set", "ball.radius=-1"}, folder.path());
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "--set ball.radius=-1: ball.radius: found -1; allowed:"));
  CHECK(folder.files().empty());
}

TEST_CASE("HDF5 is written, and compares equal to the CSV") {
  const Folder folder;
  CHECK(bbsim({"run", config("fig2a.yaml"), "-o", "a.h5"}, folder.path()).exit_code == 0);
  CHECK(bbsim({"run", config("fig2a.yaml"), "-o", "a.csv"}, folder.path()).exit_code == 0);
  CHECK(folder.files() == Names{"a.csv", "a.h5"});
  const Result compared =
      bbsim({"compare", "a.csv", "a.h5", "--rtol", "0", "--atol", "0"}, folder.path());
  CHECK(compared.exit_code == 0);
}

TEST_CASE("the summary tells how the run went") {
  const Folder folder;
  const Result result =
      bbsim({"run", config("fig2b.yaml"), "-o", "b.csv", "--summary", "b.json"}, folder.path());
  CHECK(result.exit_code == 0);
  const std::string json = folder.read("b.json");
  CHECK(contains(json, "\"status\": \"done\""));
  CHECK(contains(json, "\"end_time\": 21"));
  CHECK(contains(json, "\"rhs_evaluations\""));
  CHECK(contains(json, "\"theta_rate\""));
}

TEST_CASE("an error bound in meters is met, or refused with the attainable one") {
  const Folder folder;
  const Result met =
      bbsim({"run", config("fig2a.yaml"), "--error", "1 um", "--summary", "s.json"}, folder.path());
  CHECK(met.exit_code == 0);
  CHECK(contains(met.err, "error about "));
  CHECK(contains(folder.read("s.json"), "\"error_bound\": 1e-06"));
  CHECK(contains(folder.read("s.json"), "\"error_estimate\""));

  const Result beyond = bbsim({"run", config("fig2a.yaml"), "--error", "1e-20"}, folder.path());
  CHECK(beyond.exit_code == 1);
  CHECK(contains(beyond.err, "an error of 1e-20 m is out of reach"));
  CHECK(lines(folder.read("fig2a.csv")).size() == 1002);
  // The bound that it says is attainable is met.
  const std::string before = "gives about ";
  const std::size_t at = beyond.err.find(before) + before.size();
  const std::string had = beyond.err.substr(at, beyond.err.find(' ', at) - at);
  CAPTURE(had);
  CHECK(bbsim({"run", config("fig2a.yaml"), "--error", had}, folder.path()).exit_code == 0);

  const Result both = bbsim(
      {"run", config("fig2a.yaml"), "--error", "1e-6", "--set", "solver.rtol=1e-5"}, folder.path());
  CHECK(both.exit_code == 2);
  CHECK(contains(both.err, "solver.rtol: given together with error"));
}

TEST_CASE("mistakes in --error are reported as --error's") {
  const Folder folder;
  const std::string allowed = "; allowed: a length greater than 0 and at most 1, such as 1e-9\n";
  const Result run = bbsim({"run", config("fig2a.yaml"), "--error", "5 deg"}, folder.path());
  CHECK(run.exit_code == 2);
  CHECK(run.err == "--error 5 deg: found 5 deg, an angle" + allowed);
  const Result sweep =
      bbsim({"sweep", config("fig2a.yaml"), "--error", "0", "--vary", "ball.radius=list:0.01,0.02"},
            folder.path());
  CHECK(sweep.exit_code == 2);
  CHECK(sweep.err == "--error 0: found 0" + allowed);
  const Result varied = bbsim(
      {"sweep", config("fig2a.yaml"), "--error", "1e-6", "--vary", "solver.error=list:1e-5,1e-6"},
      folder.path());
  CHECK(varied.exit_code == 2);
  CHECK(varied.err.starts_with("--error 1e-6: found, but the sweep varies solver.error"));
  // A key given with --set is reported under that option.
  const Result set = bbsim({"run", config("fig2a.yaml"), "--set", "solver.error=0"}, folder.path());
  CHECK(set.err.starts_with("--set solver.error=0: solver.error: found 0"));
}

TEST_CASE("the printed law blows up: exit 1, rows kept, and the reason with the poles") {
  const Folder folder;
  const Result result =
      bbsim({"run", config("fig2b-literal.yaml"), "--summary", "s.json"}, folder.path());
  CHECK(result.exit_code == 1);
  CHECK(result.seconds < 20);  // below a second in release, slower with sanitizers
  CHECK(contains(result.err, "the run ended early, at t = 0.74"));
  CHECK(contains(result.err, "grew without bound"));
  CHECK(contains(result.err, "the closed loop is unstable about home"));
  CHECK(contains(result.err, "poles have a positive real part"));
  CHECK(contains(folder.read("s.json"), "\"status\": \"failed\""));
  const auto rows = lines(folder.read("fig2b-literal.csv"));
  REQUIRE(rows.size() >= 76);
  CHECK(rows.back().substr(0, 5) == "0.74,");
}

TEST_CASE("Ctrl-C and SIGTERM end a run with 130 and keep its rows so far") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const Folder folder;
  folder.write("long.yaml", long_scene);
  Launch launch{{"run", "long.yaml", "--summary", "s.json"}, folder.path(), signal, {}};
  launch.signal_after = std::chrono::milliseconds(1000);
  const Result result = bbsim(launch);
  CHECK(result.exit_code == 130);
  CHECK(contains(result.err, "interrupted at t = "));
  CHECK(folder.files() == Names{"long.csv", "long.yaml", "s.json"});
  CHECK(contains(folder.read("s.json"), "\"status\": \"interrupted\""));
  const auto rows = lines(folder.read("long.csv"));
  CHECK(rows.size() > 2);
  CHECK(rows.back().find(',') != std::string::npos);
}

TEST_CASE("output that cannot be written gives exit code 3 and leaves nothing behind") {
  const Folder folder;
  const Result full = bbsim({"run", config("fig2a.yaml"), "-o", "/dev/full"}, folder.path());
  CHECK(full.exit_code == 3);
  CHECK_THAT(full.err, Contains("/dev/full") && Contains("no space left on device"));

  const Result nowhere =
      bbsim({"run", config("fig2a.yaml"), "-o", "missing/fig2a.csv"}, folder.path());
  CHECK(nowhere.exit_code == 3);
  CHECK(contains(nowhere.err, "missing"));

  const Result summary = bbsim(
      {"run", config("incline.yaml"), "-o", "a.csv", "--summary", "/dev/full"}, folder.path());
  CHECK(summary.exit_code == 3);
  CHECK(folder.files() == Names{"a.csv"});
}

TEST_CASE("the scenario may stand before, between or after the options") {
  const std::string scenario = config("fig2a.yaml");
  const Result before = bbsim({"run", scenario, "-q", "--set", "gravity=2", "-o", "-"});
  REQUIRE(before.exit_code == 0);
  CHECK(bbsim({"run", "--set", "gravity=2", scenario, "-q", "-o", "-"}).out == before.out);
  CHECK(bbsim({"run", "-q", "-o", "-", "--set", "gravity=3", "--set", "gravity=2", scenario}).out ==
        before.out);
}

TEST_CASE("a faulty command line gives exit code 2 with a hint to help") {
  for (const auto& arguments :
       {Names{}, Names{"fly"}, Names{"run"}, Names{"run", "a", "--wings"}}) {
    const Result result = bbsim(arguments);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(contains(result.err, "--help"));
  }
  CHECK(contains(bbsim({"fly"}).err, "unknown command fly; known: run check"));
  const Result ending = bbsim({"run", config("fig2a.yaml"), "-o", "fig2a.txt"});
  CHECK(ending.exit_code == 2);
  CHECK(contains(ending.err, ".csv"));
  const Result missing = bbsim({"run", "missing.yaml"});
  CHECK(missing.exit_code == 2);
  CHECK(contains(missing.err, "missing.yaml"));
}

TEST_CASE("help and version") {
  const Result help = bbsim({"--help"});
  CHECK(help.exit_code == 0);
  for (const char* word : {"run", "check", "compare", "columns", "Exit codes"}) {
    CHECK(contains(help.out, word));
  }
  for (const char* command : {"run", "check", "compare", "columns"}) {
    CHECK(bbsim({command, "--help"}).exit_code == 0);
  }
  const Result version = bbsim({"--version"});
  CHECK(version.exit_code == 0);
  CHECK(version.out.substr(0, 6) == "bbsim ");
}

TEST_CASE("a non-finite column has its reason, and the exit code reports it") {
  const Folder folder;
  const Result result = bbsim({"run", config("incline.yaml"), "--set", "ball.mass=1e308", "-o",
                               "a.csv", "--summary", "a.json"},
                              folder.path());
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err,
                 "normal_force is not a finite number in 201 rows, the first at t = 0 s"));
  CHECK(lines(folder.read("a.csv")).size() == 202);
  CHECK(contains(folder.read("a.json"), "\"status\": \"done\""));
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
  const Result result = bbsim({"run", "runs.yaml", "--set", "solver.rtol=1e-6", "--set",
                               "solver.atol=1e-8", "--set", "solver.method=" + method},
                              folder.path());
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.err, Catch::Matchers::Contains("the loop has run away"));
  CHECK(result.seconds < 30);
}

TEST_CASE("a summary states in one word why a run is incomplete") {
  const Folder folder;
  const auto code = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "run");
    words.insert(words.end(), {"-q", "-o", "r.csv", "--summary", "s.json"});
    CHECK(bbsim(words, folder.path()).exit_code < 2);
    return nlohmann::json::parse(folder.read("s.json")).at("reason_code").get<std::string>();
  };
  CHECK(code({config("incline.yaml")}) == "none");
  CHECK(code({config("falls.yaml")}) == "event");
  CHECK(code({config("fig2b-literal.yaml")}) == "unbounded");
  CHECK(code({BBSIM_SOURCE_DIR "/tests/data/scenarios/fast.yaml", "--error", "1e-13"}) ==
        "error_out_of_reach");
}

TEST_CASE("a run that takes a million steps per second says so, and how to end it") {
  const Folder folder;
  folder.write("fast.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: {sinusoid: {amplitude: 1e-7, frequency: 1e8}}}}\n"
               "time: {end: 100, step: 10}\n");
  Launch launch{{"run", "fast.yaml", "-o", "r.csv"}, folder.path(), SIGINT, {}};
  launch.signal_after = std::chrono::milliseconds(2000);
  const Result result = bbsim(launch);
  CHECK(result.exit_code == 130);
  CHECK(contains(result.err, "steps per second of motion"));
  CHECK(contains(result.err, "Ctrl-C ends it and keeps its rows"));
}

}  // namespace bbsim_test::test_run
