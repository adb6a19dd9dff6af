// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// External controllers as a user runs them, both well-behaved and faulty.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_controller {

namespace {

// A scene of 10 samples and 11 rows. Its controller is tests/app/child, which does what `mode`
// says.
struct Scene : Folder {
  explicit Scene(const std::string& mode, const std::string& more = "timeout: 1",
                 const std::string& columns = "t, x, y, phi_command, u") {
    write("scene.yaml",
          "ball: {radius: 0.02, position: [0.01, 0.02]}\n"
          "gimbal: {servo: {natural_frequency: 20, damping: 0.8}}\n"
          "controller:\n"
          "  program: {command: [\"" BBSIM_TEST_CHILD "\", \"" +
              mode + "\", pids], start_timeout: 5, " + more +
              "}\n"
              "  drives: angle\n"
              "  reference: {point: [0, 0]}\n"
              "  sampling: {period: 0.02}\n"
              "time: {end: 0.2, step: 0.02}\n"
              "output: {columns: [" +
              columns + "]}\n");
  }

  [[nodiscard]] Result run(const std::string& more = "") const {
    return call("run scene.yaml -o out.csv " + more, *this);
  }

  // Number of processes that it started, and how many still run.
  [[nodiscard]] std::pair<int, int> processes() const {
    std::ifstream ids(*this / "pids");
    std::pair<int, int> found{0, 0};
    for (int id = 0; ids >> id; ++found.first) {
      std::ifstream stat("/proc/" + std::to_string(id) + "/stat");
      std::string text;
      std::getline(stat, text);
      // State Z is a zombie: dead, but not yet waited for.
      if (!text.empty() && !contains(text, ") Z ")) ++found.second;
    }
    return found;
  }

  // The same, once none of them runs any more; killed processes take time to end, longer on a busy
  // machine.
  [[nodiscard]] std::pair<int, int> processes_in_the_end() const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    std::pair<int, int> found = processes();
    while (found.second > 0 && std::chrono::steady_clock::now() < until) found = processes();
    return found;
  }
};

}  // namespace

TEST_CASE("a well-behaved program runs to the end, with its numbers as columns") {
  const Scene scene("good");
  expect(0, scene.run(), {"controller: started\n", "out.csv: 11 of 11 rows, radau, 10 steps\n"});
  const std::vector<std::string> rows = lines(scene.read("out.csv"));
  CHECK(rows[0] == "t,x,y,phi_command,u");
  REQUIRE(rows.size() == 12);
  for (std::size_t i = 1; i < rows.size(); ++i) CHECK(rows[i].ends_with(",0.01,0.5"));
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("any misbehavior of a controller is reported, and the rows before it are kept") {
  const std::string ended = "it was still running, and has been ended";
  const std::string late = "it did not answer within 1 s";
  const std::string infinite = "found a command that is not a finite number";
  const std::string number = "found a command that is not two numbers";
  const auto [mode, told] = GENERATE_COPY(table<std::string, std::vector<std::string>>({
      {"sleeps", {late, "flush=True", ended}},
      {"joins", {late}},
      {"dies", {"failed at sample 5 (t = 0.1 s): it ended with exit code 3."}},
      {"crashes", {"it was ended by signal 9 (Killed)"}},
      {"garbage", {"its answer was \"hello \\x1b[31mworld\": standard output is only for answers"}},
      {"floods", {"its answer does not end within 65536 bytes: \"xxx"}},
      {"closes", {"it closed its standard output", ended}},
      {"breaks off", {"its answer breaks off: \"{\"comma\"; it ended with exit code 0"}},
      {"leaves another", {"it ended with exit code 0"}},
      {"late", {late}},
      {"nan", {"its answer was \"{\"command\": [NaN, 0]}\"", infinite}},
      {"infinite", {"[0, 1e999]", "allowed: {"}},
      {"one", {number}},
      {"three", {number}},
      {"none", {"found no command"}},
      {"trails", {"and more\": allowed"}},
      {"empty", {"its answer was nothing: standard output"}},
      {"gives up", {"it gave up: \"the plate is gone\""}},
  }));
  const Scene scene(mode);
  const Result result = expect(1, scene.run("--summary summary.json"),
                               {"the run ended early, at t = 0.1 s of 0.2 s: the controller (",
                                "failed at sample 5 (t = 0.1 s): "});
  expect(1, result, told);
  CHECK(result.seconds < 10);
  // The header and rows 0 to 4.
  CHECK(count(scene.read("out.csv"), "\n") == 6);
  CHECK(scene.processes_in_the_end() == std::pair(mode == "leaves another" ? 2 : 1, 0));
  const auto summary = summary_of(scene, "summary.json");
  CHECK(summary.at("status") == "failed");
  CHECK(contains(summary.at("reason"), "failed at sample 5"));
}

TEST_CASE("two lines for one sample are detected before the next sample") {
  const Scene scene("twice");
  expect(1, scene.run(),
         {"failed at sample 6 (t = 0.12 s): it said \"{\"command\": [0.01, -0.02], \"u\": 0.5}\" "
          "before it was asked"});
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a controller that does not start fails the run before its first row") {
  const auto [mode, told] = GENERATE(table<std::string, std::string>({
      {"mute", "it did not answer within 0.5 s"},
      {"dies at once", "it ended with exit code 4"},
      {"leaves", "it ended with exit code 0"},
      {"another version", "found a protocol of another version; allowed: 1"},
      {"chatters", "its answer was \"Welcome!\": standard output is only for answers"},
  }));
  const Scene scene(mode, "timeout: 1", "t, x");
  scene.write("out.csv", "an earlier run's rows");
  // A busy machine may take long to start a controller that does answer.
  const std::string patience =
      "--set controller.program.start_timeout=" + std::string(mode == "mute" ? "0.5" : "30");
  const Result result =
      expect(1, scene.run(patience),
             {"failed to start: ", told, "out.csv: not written; there are no rows"});
  CHECK(result.seconds < 10);
  CHECK(scene.read("out.csv") == "an earlier run's rows");
  CHECK(scene.processes_in_the_end().second == 0);
  expect(1, "check scene.yaml " + patience, scene, {told});
}

TEST_CASE("no process remains of a controller that leaves children or keeps running at the end") {
  const std::string mode = GENERATE("forks", "goes on");
  const Scene scene(mode);
  const Result result = expect(0, scene.run());
  CHECK(count(scene.read("out.csv"), "\n") == 12);
  CHECK(contains(result.err, "it kept running after the end of its input, and has been ended") ==
        (mode == "goes on"));
  CHECK(scene.processes_in_the_end() == std::pair(mode == "goes on" ? 1 : 2, 0));
}

TEST_CASE("a controller's standard error is passed on line by line, however long") {
  const Scene scene("complains", "timeout: 20");
  const Result result = expect(0, scene.run(), {"controller: this is line 39999\n"});
  CHECK(count(result.err, "controller: this is line ") == 40000);
}

TEST_CASE("a run that waits for its controller ends at SIGINT and keeps its rows") {
  const Scene scene(GENERATE("sleeps", "joins"), "timeout: 1000");
  const Result result =
      expect(130, signal_once(scene, "pids.asleep", 0, SIGINT, "run scene.yaml -o out.csv"),
             {"interrupted at t = 0.1 s of 0.2 s."});
  CHECK(result.seconds < 10);
  CHECK(count(scene.read("out.csv"), "\n") == 6);
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a controller gets time to end at SIGINT, and is not mentioned if it does") {
  const Scene scene("says goodbye", "timeout: 1000", "t, x");
  expect(
      130,
      signal_once(scene, "pids.begun", 0, SIGINT, "run scene.yaml -o out.csv --set time.end=20000"),
      {"!went on"});
  CHECK(std::filesystem::exists(scene / "pids.ended"));
}

TEST_CASE("a signal that ends a command immediately ends its controller too") {
  const Scene scene("mute", "timeout: 1000");
  expect(130, signal_once(scene, "pids", 1, SIGTERM,
                          "check scene.yaml --set controller.program.start_timeout=1000"));
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a command that cannot be started, and an output of no format, are refused first") {
  const Scene scene("good");
  const std::string line = GENERATE("run scene.yaml -o o.", "check scene.yaml",
                                    "sweep scene.yaml --vary gravity=list:9,10 -o o.");
  const bool writes = line.ends_with("o.");
  expect(2, line + (writes ? "csv" : "") + " --set controller.program.command=[no-such-program]",
         scene,
         {"--set controller.program.command=[no-such-program]: controller.program.command: found "
          "\"no-such-program\", which cannot be started: no such file or directory; allowed: "});
  CHECK_FALSE(std::filesystem::exists(scene / "o.csv"));
  if (writes) expect(2, line + "foo", scene, {".csv, .h5"});
  CHECK(scene.processes().first == 0);
}

TEST_CASE("check reports what is known of a loop with an unknown control law") {
  const Scene scene("resets");
  expect(
      0, "check scene.yaml", scene, {},
      {"plant        8 poles about home under a held command (1/s): 0, 0",
       "-16 +- 12i",  // servo poles: -zeta omega +- omega sqrt(1 - zeta^2)
       "closed loop  no poles: only the controller knows its law",
       "controller   the program starts, and answers\n", "besides its commands it gives u (rad)"});
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a number that the controller lacks is found before the run or in its answer") {
  const Scene declared("resets", "timeout: 1", "t, phi_comand");
  expect(2, declared.run(),
         {"scene.yaml:9:10: output.columns: found phi_comand, ", "did you mean phi_command?",
          "allowed: those of bbsim columns, and the controller's u"});
  const Scene silent("good", "timeout: 1", "t, v");
  expect(2, silent.run(), {"found no \"v\", which output.columns asks for"});
}

TEST_CASE("a sweep starts one controller per thread if it can reset, else one per case") {
  const auto [mode, starts] = GENERATE(table<std::string, int>({{"resets", 2}, {"good", 1 + 6}}));
  const Scene scene(mode, "timeout: 5, parameters: {kp: 1}");
  const Result result = expect(0,
                               "sweep scene.yaml --vary controller.program.parameters.kp=linear:1:"
                               "6:6 -j 1 --measure max_u,end_phi_command -o -",
                               scene);
  CHECK(result.out ==
        "case,controller.program.parameters.kp,status,reason,end_time,max_u,end_phi_command\n"
        "0,1,done,,0.2,0.5,0.01\n1,2,done,,0.2,0.5,0.01\n2,3,done,,0.2,0.5,0.01\n"
        "3,4,done,,0.2,0.5,0.01\n4,5,done,,0.2,0.5,0.01\n5,6,done,,0.2,0.5,0.01\n");
  // One extra tries the first case.
  CHECK(count(result.err, "controller: started") == static_cast<std::size_t>(starts));
  CHECK(scene.processes_in_the_end() == std::pair(starts, 0));
}

TEST_CASE("a case whose controller dies fails, and the next case starts a new one") {
  const Scene scene("dies");
  const Result result =
      expect(0, "sweep scene.yaml --vary gravity=list:9,10 --measure end_u -o -", scene);
  CHECK(count(result.out, ",failed,") == 2);
  CHECK(count(result.out, "failed at sample 5 (t = 0.1 s): it ended with exit code 3") == 2);
  CHECK(count(result.out, ",0.1,0.5\n") == 2);
}

TEST_CASE("a controller's own files are not overwritten") {
  const Scene scene("good");
  scene.write("law.py", "a law");
  expect(2, "run scene.yaml --set 'controller.program.command=[python3, law.py]' -o law.py", scene);
  CHECK(scene.read("law.py") == "a law");
}

TEST_CASE("an error bound holds with your own controller, which restarts for each run") {
  const Scene scene("good", "timeout: 5");
  const Result result = expect(0, scene.run("--error 1e-6"));
  CHECK(count(result.err, "controller: started") > 1);
  CHECK(scene.processes_in_the_end().second == 0);
}

}  // namespace bbsim_test::test_controller
