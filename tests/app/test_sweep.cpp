// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps as a user runs them: their rows, measures and refusals.
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_sweep {

using Words = std::vector<std::string>;

TEST_CASE("a sweep writes one row per case, in order, for any number of threads") {
  const Folder folder;
  const std::string sweep =
      "sweep @fig2a.yaml -q --vary 'ball.position.0=linear:-10 cm:10 cm:7' --vary "
      "'gimbal.motion.phi.sinusoid.amplitude=list:0.5 deg,0.02' -o - -j ";
  const Result one = expect(0, sweep + "1", folder);
  const auto table = rows(one.out);
  REQUIRE(table.size() == 15);
  CHECK(table[0] == Words{"case", "ball.position.0", "gimbal.motion.phi.sinusoid.amplitude",
                          "status", "reason", "end_time", "end_x", "end_y", "max_tilt",
                          "max_tilt_rate", "max_distance"});
  for (std::size_t i = 1; i < table.size(); ++i) {
    CHECK(table[i][0] == std::to_string(i - 1));
    CHECK(table[i][3] == "done");
    CHECK(table[i][4].empty());
    CHECK(table[i][5] == "10");
  }
  CHECK(call(sweep + "3", folder).out == one.out);

  // Bit for bit the result of a run with the same values.
  const Result run = call("run @fig2a.yaml -q -o - --set ball.position.0=" + table[6][1] +
                          " --set gimbal.motion.phi.sinusoid.amplitude=" + table[6][2]);
  const auto last = rows(run.out).back();
  CHECK(table[6][6] == last[1]);
  CHECK(table[6][7] == last[2]);
}

TEST_CASE("merged shards equal the sweep of one process byte for byte") {
  const Folder folder;
  const std::string ending = GENERATE(".csv", ".h5");
  const std::string sweep =
      "sweep @fig2b.yaml -q --vary ball.radius=uniform:0.005:0.02 --samples 100 " +
      std::string(ending == ".h5" ? "--keep-trajectories " : "");
  expect(0, sweep + "-o all" + ending, folder);
  std::string parts;
  for (const std::string shard : {"3", "1", "2"}) {
    const std::string file = " part-" + shard + "of3" + ending;
    expect(0, sweep + "--shard " + shard + "/3 -o" + file, folder);
    parts += file;
  }
  expect(0, "merge -o merged" + ending + parts, folder, {"100 cases from 3 parts"});
  CHECK(folder.read("merged" + ending) == folder.read("all" + ending));

  SECTION("a missing part is reported") {
    expect(2, "merge -o less" + ending + parts.substr(0, parts.rfind(' ')), folder, {"not part 2"});
  }
  SECTION("a part of a different sweep is refused") {
    expect(0, "sweep @fig2b.yaml -q --vary ball.mass=linear:1:2:5 -o other" + ending, folder);
    expect(2, "merge -o mixed" + ending + parts + " other" + ending, folder,
           {"parts of one sweep"});
  }
}

TEST_CASE("parts with many cases are merged, through links and folders") {
  const Folder folder;
  expect(0, "sweep @fig2a.yaml -q --vary ball.position.0=linear:0:1:100002 -o part-1of1.csv",
         folder);
  expect(0, "merge -q part-1of1.csv -o all.csv", folder);
  CHECK(folder.read("all.csv") == folder.read("part-1of1.csv"));

  std::filesystem::create_directory(folder / "sub");
  std::filesystem::create_symlink("sub/real.csv", folder / "link.csv");
  std::filesystem::create_directory(folder / "dir.csv");
  const std::string few = "sweep @fig2a.yaml -q --vary gravity=list:1,2 -o ";
  expect(0, few + "link.csv", folder);
  CHECK(std::filesystem::is_symlink(folder / "link.csv"));
  CHECK(std::filesystem::exists(folder / "sub/real.csv"));
  expect(3, few + "dir.csv", folder, {"is a directory"});
}

TEST_CASE("expectations are columns of 1 and 0, and decide the exit code") {
  const Folder folder;
  const std::string sweep =
      "sweep @fig2a.yaml -q --vary ball.position.0=list:0,0.1,0.2 --measure end_x "
      "--expect 'max_x < ";
  const Result some = expect(1, sweep + "30 cm' -o - --summary s.json", folder,
                             {"max_x < 30 cm", "in 1 of 3 cases"});
  const auto table = rows(some.out);
  REQUIRE(table.size() == 4);
  CHECK(table[0] == Words{"case", "ball.position.0", "status", "reason", "end_time", "end_x",
                          "max_x", "expect: max_x < 30 cm"});
  for (std::size_t i = 1; i < table.size(); ++i) {
    CHECK(table[i][7] == (std::stod(table[i][6]) < 0.3 ? "1" : "0"));
  }
  CHECK(contains(folder.read("s.json"), "\"cases_unmet\": 1"));
  expect(0, sweep + "1 m' -o -", folder);
  // A case that has no value does not meet it.
  expect(1, sweep + "1 m' --expect 'find x when x=0.15 < 1 m' -o x.h5", folder,
         {"find x when x=0.15 < 1 m", "in 2 of 3 cases"});
  expect(2, sweep + "1 m' --expect 'max_x < 1 m' -o -", folder,
         {"--expect: found \"max_x < 1 m\" twice"});
  expect(2, sweep + "1 deg' -o -", folder, {"but max_x is in m"});
}

TEST_CASE("a script for Slurm runs a sweep in shards whose merger is the sweep") {
  const Folder folder;
  const std::string sweep = "sweep @fig2a.yaml --vary ball.position.0=linear:-0.1:0.1:41 --set ";
  const auto with_title = [&](const std::string& line) {
    std::vector<std::string> words = words_of(line);
    words.insert(words.end(), {"--set", "title=it's a ball"});
    return bbsim(words, folder.path());
  };
  expect(0, with_title(sweep + "gravity=9.8 -o all.csv"));
  expect(0,
         with_title(sweep + "gravity=9.8 -o 'my part.csv' --summary sum.json --slurm job.sh "
                            "--slurm-tasks 3"),
         {"job.sh: 41 cases in 3 tasks"});
  CHECK_FALSE(std::filesystem::exists(folder / "my part.csv"));
  const std::string script = folder.read("job.sh");
  CHECK(contains(script, "\n#SBATCH --array=1-3\n"));
  for (const std::string task : {"1", "2", "3"}) {
    expect(0, shell("SLURM_ARRAY_TASK_ID=" + task + " sh ./job.sh", folder));
  }
  CHECK(std::filesystem::exists(folder / "sum-3of3.json"));
  const std::size_t merge = script.find("bbsim merge ");
  REQUIRE(merge != std::string::npos);
  const std::string command = script.substr(merge + 6, script.find('\n', merge) - merge - 6);
  expect(0, shell("$BBSIM " + command, folder));
  CHECK(folder.read("my part.csv") == folder.read("all.csv"));
}

TEST_CASE("no script for Slurm has more tasks than groups of cases, or replaces an input") {
  const Folder folder;
  folder.write("s.yaml", short_scene);
  const std::string slurm = "sweep s.yaml --vary ball.radius=linear:0.01:0.02:9 --slurm ";
  expect(0, slurm + "a.sh", folder, {"a.sh: 9 cases in 9 tasks"});
  expect(0, slurm + "a.sh --slurm-tasks 4", folder, {"a.sh: 9 cases in 4 tasks"});
  for (const std::string wrong : {"s.yaml", "b.csv -o b.csv", "c.sh -o -", "c.sh --slurm-tasks 0",
                                  "c.sh --shard 1/2", "c.sh --vary ball.mass=list:-1"}) {
    expect(2, slurm + wrong, folder);
  }
  CHECK(folder.files() == Words{"a.sh", "s.yaml"});
}

TEST_CASE("a sweep names the cases that failed, and the command that repeats one") {
  const Folder folder;
  std::vector<std::string> words = words_of(
      "sweep @fig2a.yaml --vary 'ball.position.0=list:1 mm,9 cm' --expect 'max_x < 5 cm' --vary "
      "ball.radius=list:1cm,2cm --summary s.json -o s.csv");
  words.insert(words.end(), {"--set", "title=it's a ball"});
  const Result made = expect(1, bbsim(words, folder.path()), {" is done (not as expected)"});
  const std::size_t command = made.err.find("  bbsim run ");
  REQUIRE(command != std::string::npos);
  const std::string line = made.err.substr(command + 8, made.err.find('\n', command) - command - 8);
  expect(1, shell("$BBSIM " + line + " --expect 'max_x < 5 cm' -q -o -", folder));
  const std::string summary = folder.read("s.json");
  CHECK(contains(summary, "\"failed\": [\n"));
  CHECK(contains(summary, "\"reason\": \"not as expected\""));
  expect(0, "sweep @falls.yaml -q --vary ball.mass=list:0.1,0.2 -o f.csv --summary -", folder, {},
         {"\"status\": \"stopped\""});
}

TEST_CASE("a failed or stopped case is a row with its reason") {
  const Folder folder;
  // The loop of Fig. 2(b) as printed diverges; with small gains it does not within a second.
  const auto table =
      rows(expect(0,
                  "sweep @fig2b-literal.yaml -q --vary controller.pd.kv=list:0.001,100 --set "
                  "time.end=1 -o -",
                  folder)
               .out);
  REQUIRE(table.size() == 3);
  CHECK(table[1][2] == "done");
  CHECK(table[1][3].empty());
  CHECK(table[2][2] == "failed");
  CHECK(contains(table[2][3], "grows without bound"));
  CHECK(std::stod(table[2][4]) == Approx(0.7488).epsilon(1e-3));

  const auto falls =
      rows(expect(0, "sweep @falls.yaml -q --vary ball.mass=list:0.1,0.2 -o -", folder).out);
  for (const std::size_t row : {1U, 2U}) {
    CHECK(falls.at(row)[2] == "stopped");
    CHECK(falls[row][3] == "edge");
  }
}

TEST_CASE("a scenario may contain its sweep and choose its measures") {
  const Folder folder;
  folder.write("scene.yaml",
               "ball: {radius: 0.01}\n"
               "time: {end: 1, step: 0.1}\n"
               "gimbal: {motion: {phi: 0.1}}\n"
               "sweep:\n"
               "  vary: {gravity: 'list:1,2'}\n"
               "  measure: [max_vx, end_normal_force, min_x, rms_x]\n");
  expect(0, "sweep scene.yaml", folder);
  const auto table = rows(folder.read("scene-sweep.csv"));
  REQUIRE(table.size() == 3);
  CHECK(table[0] == Words{"case", "gravity", "status", "reason", "end_time", "max_vx",
                          "end_normal_force", "min_x", "rms_x"});
  for (std::size_t i = 1; i <= 2; ++i) {
    const double g = static_cast<double>(i), a = 5.0 / 7 * g * std::sin(0.1);
    CHECK(std::stod(table[i][5]) == Approx(a));
    CHECK(std::stod(table[i][6]) == Approx(g * std::cos(0.1)));
    CHECK(std::abs(std::stod(table[i][7])) < 1e-15);
    double sum = 0;
    for (int row = 0; row <= 10; ++row) sum += std::pow(a / 2 * row * row / 100.0, 2);
    CHECK(std::stod(table[i][8]) == Approx(std::sqrt(sum / 11)));
  }
  expect(0, "run scene.yaml -q", folder);
  expect(0, "check scene.yaml", folder, {}, {"2 cases of bbsim sweep, over gravity"});
  expect(2, "sweep scene.yaml --measure max_speed", folder, {"max_speed", "such as max_tilt"});
  expect(2, "sweep scene.yaml --measure max_tracking_error", folder, {"no controller"});
}

TEST_CASE("the cases of a rig equal its runs bit for bit") {
  const Folder folder;
  const auto table =
      rows(expect(0,
                  "sweep @rig.yaml -q --set time.end=4 --vary "
                  "controller.gravity_compensation.kp=list:8,12 --vary "
                  "controller.sensor.seed=linear:1:3:3 --measure end_x,end_y,end_theta -o -",
                  folder)
               .out);
  REQUIRE(table.size() == 7);
  for (std::size_t i = 1; i < table.size(); ++i) {
    const Result run =
        call("run @rig.yaml -q -o - --set time.end=4 --set controller.gravity_compensation.kp=" +
             table[i][1] + " --set controller.sensor.seed=" + table[i][2] +
             " --set 'output.columns=[x, y, theta]'");
    CHECK(Words(table[i].begin() + 6, table[i].end()) == rows(run.out).back());
  }
}

TEST_CASE("a bound on the error holds for each case") {
  const Folder folder;
  const std::string sweep = "sweep @fig2a.yaml -q --vary ball.position.0=list:0,0.05 -o - ";
  const auto bounded = rows(expect(0, sweep + "--error 1e-7", folder).out);
  const auto exact = rows(expect(0, sweep + "--set solver.rtol=1e-12", folder).out);
  for (std::size_t i = 1; i <= 2; ++i) {
    for (std::size_t c = 5; c <= 6; ++c) {
      CHECK(std::abs(std::stod(bounded.at(i)[c]) - std::stod(exact.at(i)[c])) < 1e-7);
    }
  }
}

TEST_CASE("an impossible sweep is refused in one line before it begins") {
  const Folder folder;
  const auto [more, told] = GENERATE(table<std::string, std::string>({
      {"", "no key to vary"},
      {"--vary gravity=list:1,2 --shard 4/3", "K from 1 to N"},
      {"--vary gravity=uniform:1:2 --samples 1.5", "a whole number"},
      {"--vary gravity=list:1,2 --measure max_x,max_x", "twice"},
      {"--vary gravity=list:1,2 --shard x", "K/N"},
      {"--vary gravity=list:1,2 -o a.txt", ".csv, .h5 and .hdf5"},
      {"--vary gravity=list:1,2 -o - --resume", "cannot resume"},
      {"--vary gravity=list:1,2 --keep-trajectories", ".h5"},
      {"--vary time.end=list:1,2 --keep-trajectories -o a.h5", "time.end among the keys that vary"},
      {"--vary gravity=list:1,2 --set gravity=3",
       "--set gravity=3: found, but the sweep varies gravity"},
      {"--vary gravity,=list:1", "-KEY or NUMBER*KEY"},
  }));
  expect(2, "sweep @fig2a.yaml -q " + more, folder, {told});
  CHECK(folder.files().empty());
  expect(3, "sweep @fig2a.yaml -q --vary gravity=list:1,2 -o /dev/full", folder);
}

TEST_CASE("tied keys: one axis, a column for each, on the command line and in the scenario") {
  const Folder folder;
  const std::string tied = "controller.pd.kp.0.0,-controller.pd.kp.1.1";
  const std::string sweep = "sweep @fig2b.yaml -q --vary " + tied + "=linear:0.001:0.003:3 ";
  expect(0, sweep + "-o a.csv", folder);
  const auto table = rows(folder.read("a.csv"));
  REQUIRE(table.size() == 4);
  CHECK(Words(table[0].begin(), table[0].begin() + 4) ==
        Words{"case", "controller.pd.kp.0.0", "controller.pd.kp.1.1", "status"});
  CHECK(table[2][1] == "0.002");
  CHECK(table[2][2] == "-0.002");

  // Equal to a run with the same values.
  const auto last =
      rows(call("run @fig2b.yaml -q -o - --set 'controller.pd.kp=[[0.002, 0], [0, -0.002]]'").out)
          .back();
  CHECK(std::stod(table[2][6]) == Approx(std::stod(last[1])).margin(1e-10));
  CHECK(std::stod(table[2][7]) == Approx(std::stod(last[2])).margin(1e-10));

  const std::string text = folder.read(config("fig2b.yaml"));
  folder.write("scene.yaml", text + "sweep:\n  vary:\n    " + tied + ": linear:0.001:0.003:3\n");
  expect(0, "sweep scene.yaml -q -o b.csv", folder);
  CHECK(folder.read("b.csv") == folder.read("a.csv"));
  expect(0, "check scene.yaml", folder, {},
         {"3 cases of bbsim sweep, over controller.pd.kp.0.0, controller.pd.kp.1.1"});

  // Shards and HDF5 have the same columns.
  expect(0, sweep + "--shard 1/2 -o p-1of2.csv", folder);
  expect(0, sweep + "--shard 2/2 -o p-2of2.csv", folder);
  expect(0, "merge -q p-1of2.csv p-2of2.csv -o m.csv", folder);
  CHECK(folder.read("m.csv") == folder.read("a.csv"));
  expect(0, sweep + "-o a.h5", folder);
}

TEST_CASE(
    "a measure that is no finite number is said at the end, and is no case that ended early") {
  const Folder folder;
  expect(0, "sweep @fig2a.yaml --vary ball.mass=list:1,1e308 --measure max_normal_force -o a.csv",
         folder, {"2 of 2 cases, 1 with no finite number (see reason)", "!ended early"});
  CHECK(rows(folder.read("a.csv"))[2][3] == "max_normal_force is infinite");
}

TEST_CASE("measures of the loop give the same bytes in any parts, alone and with others") {
  const Folder folder;
  const std::string names =
      GENERATE("stable,spectral_radius,phi_delay_margin", "max_tilt,phi_delay_margin,stable");
  const std::string map =
      "sweep @rig.yaml -q --vary controller.gravity_compensation.kp=linear:1:40:7 --vary "
      "controller.gravity_compensation.kv=linear:1:14:7 --set time.end=2 --measure " +
      names + " -o ";
  expect(0, map + "whole.csv", folder);
  const std::string whole = folder.read("whole.csv");
  CHECK(contains(whole, "the loop is not stable"));
  expect(0, map + "one.csv -j 1", folder);
  CHECK(folder.read("one.csv") == whole);
  for (const std::string ending : {".csv", ".h5"}) {
    expect(0, map + "a" + ending + " --shard 1/2", folder);
    expect(0, map + "b" + ending + " --shard 2/2", folder);
    expect(0, "merge -q a" + ending + " b" + ending + " -o all" + ending, folder);
    expect(0, "compare all" + ending + " whole.csv --rtol 0 --atol 0", folder);
  }
  CHECK(folder.read("all.csv") == whole);
  expect(0, "summarize whole.csv --measure stable", folder);
}

// Each is slow enough to be interrupted, and has varied rows.
TEST_CASE("interrupted sweeps of several kinds resume to the same bytes") {
  const Folder folder;
  const auto [sweep, signal] = GENERATE(table<std::string, int>({
      {"@fig2a.yaml --vary gimbal.motion.phi.sinusoid.phase=uniform:0:3 --samples 100000 --vary "
       "ball.position.0=list:0,0.1",
       SIGINT},
      {"@fig2a.yaml --vary gimbal.motion.phi.sinusoid.phase=uniform:0:3 --samples 100000 --vary "
       "ball.position.0=list:0,0.1 --expect 'end_x < 0.2'",
       SIGKILL},
      {"@fig2a.yaml --vary gimbal.motion.phi.sinusoid.phase,-gimbal.motion.theta.sinusoid.phase="
       "uniform:0:3 --samples 200000",
       SIGINT},
      {"@rig.yaml --vary controller.gravity_compensation.kp=linear:1:40:20 --vary "
       "controller.gravity_compensation.kv=linear:1:9:20 --measure phi_delay_margin,stable",
       SIGKILL},
  }));
  const int missed = contains(sweep, "--expect") ? 1 : 0;
  const std::string line = "sweep " + sweep + " -j 1 -o s.csv";
  const Result cut = signal_once(folder, "s.csv.part", 10000, signal, line);
  if (signal == SIGINT) {
    expect(130, cut, {"--resume continues"});
  } else {
    REQUIRE(cut.exit_code == 128 + SIGKILL);
  }
  REQUIRE(folder.files() == Words{"s.csv.part"});
  expect(2, line, folder, {"add --resume"});
  expect(2, line + " --resume " + (contains(sweep, "uniform") ? "--seed 9" : "--set gravity=9"),
         folder, {"of another sweep"});

  const Result rest = expect(missed, line + " --resume", folder);
  CHECK(folder.files() == Words{"s.csv"});
  expect(missed, "sweep " + sweep + " -q -o t.csv", folder);
  const std::string resumed = folder.read("s.csv");
  const bool alike = resumed == folder.read("t.csv");
  CHECK(alike);
  if (missed == 0) return;
  const std::size_t unmet = count(resumed, ",0\n");  // the first run's too
  CHECK(unmet > 0);
  CHECK(contains(rest.err, "in " + std::to_string(unmet) + " of 200000 cases"));
}

TEST_CASE("a slow sweep keeps each finished case when interrupted") {
  const Folder folder;
  // The plan, and some cases.
  const Result cut = expect(
      130, signal_once(
               folder, "s.csv.part", 6000, SIGINT,
               "sweep @rig.yaml --vary controller.sensor.seed=linear:1:2000:2000 -j 1 -o s.csv"));
  std::size_t finished = 0;
  REQUIRE(std::sscanf(cut.err.c_str(), "interrupted after %zu of", &finished) == 1);
  CHECK(finished > 2);
  REQUIRE(folder.files() == Words{"s.csv.part"});
}

}  // namespace bbsim_test::test_sweep
