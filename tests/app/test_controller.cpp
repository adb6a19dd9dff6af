// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// External controllers as a user runs them, both well-behaved and faulty.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_controller {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++times;
  }
  return times;
}

// A scene of 10 samples and 11 rows. Its controller is tests/app/child, which does what `mode`
// says.
struct Scene {
  Folder folder;
  std::string file;

  explicit Scene(const std::string& mode, const std::string& more = "timeout: 1",
                 const std::string& columns = "t, x, y, phi_command, u") {
    file = folder.write("scene.yaml",
                        "ball: {radius: 0.02, position: [0.01, 0.02]}\n"
                        "gimbal: {servo: {natural_frequency: 20, damping: 0.8}}\n"
                        "controller:\n"
                        "  program: {command: [\"" BBSIM_TEST_CHILD "\", " +
                            mode + ", pids], start_timeout: 5, " + more +
                            "}\n"
                            "  drives: angle\n"
                            "  reference: {point: [0, 0]}\n"
                            "  sampling: {period: 0.02}\n"
                            "time: {end: 0.2, step: 0.02}\n"
                            "output: {columns: [" +
                            columns + "]}\n");
  }

  [[nodiscard]] Result run(std::vector<std::string> words = {}) const {
    words.insert(words.begin(), {"run", file, "-o", folder / "out.csv"});
    return bbsim(std::move(words));
  }

  // Number of processes that it started, and how many still run.
  [[nodiscard]] std::pair<int, int> processes() const {
    std::ifstream ids(folder / "pids");
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
  const Result result = scene.run();
  CHECK(result.err == "controller: started\n" + (scene.folder / "out.csv") +
                          ": 11 of 11 rows, radau, 10 steps\n");
  REQUIRE(result.exit_code == 0);
  std::istringstream lines(scene.folder.read("out.csv"));
  std::string line;
  std::getline(lines, line);
  CHECK(line == "t,x,y,phi_command,u");
  while (std::getline(lines, line)) CHECK(line.ends_with(",0.01,0.5"));
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("any misbehavior of a controller is reported, and the rows before it are kept") {
  struct Misdeed {
    std::string mode, told;
  };
  const auto [mode, told] = GENERATE(values<Misdeed>({
      {"sleeps",
       "it did not answer within 1 s (flush buffered output after each answer: print(..., "
       "flush=True) in Python); it was still running, and has been ended"},
      {"joins", "it did not answer within 1 s"},
      {"dies", "failed at sample 5 (t = 0.1 s): it ended with exit code 3."},
      {"crashes", "it was ended by signal 9 (Killed)"},
      {"garbage", "its answer was \"hello \\x1b[31mworld\": standard output is only for answers"},
      {"floods", "its answer does not end within 65536 bytes: \"xxx"},
      {"closes", "it closed its standard output; it was still running, and has been ended"},
      {"breaks off", "its answer breaks off: \"{\"comma\"; it ended with exit code 0"},
      {"leaves another", "it ended with exit code 0"},
      {"late", "it did not answer within 1 s"},
      {"nan",
       "its answer was \"{\"command\": [NaN, 0]}\": found a command that is not a finite number"},
      {"infinite", "found a command that is not a finite number"},
      {"one", "found a command that is not two numbers"},
      {"three", "found a command that is not two numbers"},
      {"none", "found no command"},
      {"trails", "and more\": allowed"},
      {"empty", "its answer was nothing: standard output"},
      {"gives up", "it gave up: \"the plate is gone\""},
  }));
  CAPTURE(mode);
  const Scene scene("\"" + mode + "\"");
  const Result result = scene.run({"--summary", scene.folder / "summary.json"});
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err, "the run ended early, at t = 0.1 s of 0.2 s: the controller ("));
  CHECK(contains(result.err, "failed at sample 5 (t = 0.1 s): "));
  CHECK(contains(result.err, told));
  CHECK(result.seconds < 10);
  // The header and rows 0 to 4.
  CHECK(count(scene.folder.read("out.csv"), "\n") == 6);
  const auto [processes, running] = scene.processes_in_the_end();
  CHECK(processes == (mode == "leaves another" ? 2 : 1));
  CHECK(running == 0);
  const auto summary = nlohmann::json::parse(scene.folder.read("summary.json"));
  CHECK(summary.at("status") == "failed");
  CHECK(contains(summary.at("reason"), "failed at sample 5"));
}

TEST_CASE("two lines for one sample are detected before the next sample") {
  const Scene scene("twice");
  const Result result = scene.run();
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err,
                 "failed at sample 6 (t = 0.12 s): it said \"{\"command\": [0.01, "
                 "-0.02], \"u\": 0.5}\" before it was asked"));
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a controller that does not start fails the run before its first row") {
  struct Misdeed {
    std::string mode, told;
  };
  const auto [mode, told] = GENERATE(values<Misdeed>({
      {"mute", "it did not answer within 0.5 s"},
      {"dies at once", "it ended with exit code 4"},
      {"leaves", "it ended with exit code 0"},
      {"another version", "found a protocol of another version; allowed: 1"},
      {"chatters", "its answer was \"Welcome!\": standard output is only for answers"},
  }));
  CAPTURE(mode);
  const Scene scene("\"" + mode + "\"", "timeout: 1", "t, x");
  scene.folder.write("out.csv", "an earlier run's rows");
  // A busy machine may take long to start a controller that does answer.
  const std::string patience =
      std::string("controller.program.start_timeout=") + (mode == "mute" ? "0.5" : "30");
  const Result result = scene.run({"--set", patience});
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err, "failed to start: "));
  CHECK(contains(result.err, told));
  CHECK(result.seconds < 10);
  CHECK(contains(result.err, "out.csv: not written; there are no rows"));
  CHECK(scene.folder.read("out.csv") == "an earlier run's rows");
  CHECK(scene.processes_in_the_end().second == 0);
  const Result check = bbsim({"check", scene.file, "--set", patience});
  CHECK(check.exit_code == 1);
  CHECK(contains(check.err, told));
}

TEST_CASE("no process remains of a controller that leaves children or keeps running at the end") {
  const std::string mode = GENERATE("forks", "goes on");
  CAPTURE(mode);
  const Scene scene("\"" + mode + "\"");
  const Result result = scene.run();
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  CHECK(count(scene.folder.read("out.csv"), "\n") == 12);
  CHECK(contains(result.err, "it kept running after the end of its input, and has been ended") ==
        (mode == "goes on"));
  const auto [processes, running] = scene.processes_in_the_end();
  CHECK(processes == (mode == "goes on" ? 1 : 2));
  CHECK(running == 0);
}

TEST_CASE("a controller's standard error is passed on line by line, however long") {
  const Scene scene("complains", "timeout: 20");
  const Result result = scene.run();
  CHECK(result.exit_code == 0);
  CHECK(count(result.err, "controller: this is line ") == 40000);
  CHECK(contains(result.err, "controller: this is line 39999\n"));
}

TEST_CASE("a run that waits for its controller ends at SIGINT and keeps its rows") {
  const Scene scene(GENERATE("sleeps", "joins"), "timeout: 1000");
  Launch launch{{"run", scene.file, "-o", scene.folder / "out.csv"},
                {},
                SIGINT,
                {},
                [&] { return std::filesystem::exists(scene.folder / "pids.asleep"); },
                {}};
  const Result result = bbsim(launch);
  CAPTURE(result.err);
  CHECK(result.exit_code == 130);
  CHECK(result.seconds < 10);
  CHECK(contains(result.err, "interrupted at t = 0.1 s of 0.2 s."));
  CHECK(count(scene.folder.read("out.csv"), "\n") == 6);
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a controller gets time to end at SIGINT, and is not mentioned if it does") {
  const Scene scene("says goodbye", "timeout: 1000", "t, x");
  Launch launch{{"run", scene.file, "-o", scene.folder / "out.csv", "--set", "time.end=20000"},
                {},
                SIGINT,
                {},
                [&] { return std::filesystem::exists(scene.folder / "pids.begun"); },
                {}};
  const Result result = bbsim(launch);
  CAPTURE(result.err);
  CHECK(result.exit_code == 130);
  CHECK(std::filesystem::exists(scene.folder / "pids.ended"));
  CHECK_FALSE(contains(result.err, "went on"));
}

TEST_CASE("a signal that ends a command immediately ends its controller too") {
  const Scene scene("mute", "timeout: 1000");
  Launch launch{{"check", scene.file, "--set", "controller.program.start_timeout=1000"},
                {},
                SIGTERM,
                {},
                [&] { return scene.processes().first > 0; },
                {}};
  CHECK(bbsim(launch).exit_code == 130);
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a command that cannot be started is reported as the scenario's fault, with its place") {
  const Scene scene("good");
  const std::string set = "controller.program.command=[no-such-program]";
  for (const char* command : {"run", "check", "sweep"}) {
    std::vector<std::string> words{command, scene.file, "--set", set};
    if (command != std::string("check")) words.insert(words.end(), {"-o", scene.folder / "o.csv"});
    if (command == std::string("sweep")) words.insert(words.end(), {"--vary", "gravity=list:9,10"});
    const Result result = bbsim(words);
    CAPTURE(command, result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err == "--set " + set +
                            ": controller.program.command: found \"no-such-program\", which cannot "
                            "be started: no such file or directory; allowed: a program, by its "
                            "name or its path\n");
  }
  CHECK_FALSE(std::filesystem::exists(scene.folder / "o.csv"));
}

TEST_CASE("an output name of unknown format is refused before the controller starts") {
  const Scene scene("good");
  for (const char* command : {"run", "sweep"}) {
    std::vector<std::string> words{command, scene.file, "-o", scene.folder / "o.foo"};
    if (command == std::string("sweep")) words.insert(words.end(), {"--vary", "gravity=list:9,10"});
    const Result result = bbsim(words);
    CAPTURE(command, result.err);
    CHECK(result.exit_code == 2);
    CHECK(contains(result.err, ".csv, .h5"));
  }
  CHECK(scene.processes().first == 0);
}

TEST_CASE("check reports what is known of a loop with an unknown control law") {
  const Scene scene("resets");
  const Result result = bbsim({"check", scene.file});
  CAPTURE(result.out, result.err);
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "plant        8 poles about home under a held command (1/s): 0, 0"));
  CHECK(contains(result.out, "-16 +- 12i"));  // servo poles: -zeta omega +- omega sqrt(1 - zeta^2)
  CHECK(contains(result.out, "closed loop  no poles: only the controller knows its law"));
  CHECK(contains(result.out, "controller   the program starts, and answers\n"));
  CHECK(contains(result.out, "besides its commands it gives u (rad)"));
  CHECK(scene.processes_in_the_end() == std::pair(1, 0));
}

TEST_CASE("a number that the controller lacks is found before the run or in its answer") {
  const Scene declared("resets", "timeout: 1", "t, phi_comand");
  const Result typo = declared.run();
  CHECK(typo.exit_code == 2);
  CHECK(contains(typo.err,
                 "scene.yaml:9:10: output.columns: found phi_comand, which neither bbsim "
                 "nor the controller gives (did you mean phi_command?); allowed: those "
                 "of bbsim columns, and the controller's u"));
  const Scene silent("good", "timeout: 1", "t, v");
  const Result missing = silent.run();
  CHECK(missing.exit_code == 2);
  CHECK(contains(missing.err, "found no \"v\", which output.columns asks for"));
}

TEST_CASE("a sweep starts one controller per thread if it can reset, else one per case") {
  struct Way {
    std::string mode;
    std::size_t starts;
  };
  const auto [mode, starts] = GENERATE(values<Way>({{"resets", 2}, {"good", 1 + 6}}));
  CAPTURE(mode);
  const Scene scene(mode, "timeout: 5, parameters: {kp: 1}");
  const Result result =
      bbsim({"sweep", scene.file, "--vary", "controller.program.parameters.kp=linear:1:6:6", "-j",
             "1", "--measure", "max_u,end_phi_command", "-o", "-"});
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(result.out ==
        "case,controller.program.parameters.kp,status,reason,end_time,max_u,end_phi_command\n"
        "0,1,done,,0.2,0.5,0.01\n1,2,done,,0.2,0.5,0.01\n2,3,done,,0.2,0.5,0.01\n"
        "3,4,done,,0.2,0.5,0.01\n4,5,done,,0.2,0.5,0.01\n5,6,done,,0.2,0.5,0.01\n");
  CHECK(count(result.err, "controller: started") == starts);  // one extra tries the first case
  CHECK(scene.processes_in_the_end() == std::pair(static_cast<int>(starts), 0));
}

TEST_CASE("a case whose controller dies fails, and the next case starts a new one") {
  const Scene scene("dies");
  const Result result =
      bbsim({"sweep", scene.file, "--vary", "gravity=list:9,10", "--measure", "end_u", "-o", "-"});
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  CHECK(count(result.out, ",failed,") == 2);
  CHECK(count(result.out, "failed at sample 5 (t = 0.1 s): it ended with exit code 3") == 2);
  CHECK(count(result.out, ",0.1,0.5\n") == 2);
}

TEST_CASE("a controller's own files are not overwritten") {
  const Scene scene("good");
  const std::string kept = scene.folder.write("law.py", "a law");
  const Result result =
      bbsim({"run", scene.file, "--set", "controller.program.command=[python3, law.py]", "-o",
             scene.folder / "law.py"});
  CHECK(result.exit_code == 2);
  CHECK(scene.folder.read("law.py") == "a law");
}

TEST_CASE("an error bound holds with your own controller, which restarts for each run") {
  const Scene scene("good", "timeout: 5");
  const Result result = scene.run({"--error", "1e-6"});
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  CHECK(count(result.err, "controller: started") > 1);
  CHECK(scene.processes_in_the_end().second == 0);
}

}  // namespace bbsim_test::test_controller
