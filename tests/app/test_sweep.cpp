// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps as a user runs them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_sweep {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::vector<std::string>> rows(const std::string& csv) {
  std::vector<std::vector<std::string>> table;
  std::istringstream lines(csv);
  for (std::string line, cell; std::getline(lines, line);) {
    std::istringstream cells(line);
    table.emplace_back();
    while (std::getline(cells, cell, ',')) table.back().push_back(cell);
  }
  return table;
}

std::vector<std::string> sweep(const std::string& scenario, std::vector<std::string> more) {
  std::vector<std::string> arguments{"sweep", scenario, "-q"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

// Slow enough to be interrupted, with varied rows.
const std::vector<std::string> long_sweep{
    "--vary",    "gimbal.motion.phi.sinusoid.phase=uniform:0:3",
    "--samples", "100000",
    "--vary",    "ball.position.0=list:0,0.1"};

std::vector<std::string> with(std::vector<std::string> one, const std::vector<std::string>& more) {
  one.insert(one.end(), more.begin(), more.end());
  return one;
}

// Runs a sweep to s.csv that a signal interrupts once it has some rows.
Result cut_off(const std::vector<std::string>& arguments, const Folder& folder, int signal) {
  Launch launch{arguments, folder.path(), signal};
  launch.signal_when = [&folder] {
    std::error_code none;
    const auto size = std::filesystem::file_size(folder / "s.csv.part", none);
    return !none && size > 10000;
  };
  return bbsim(launch);
}

}  // namespace

TEST_CASE("a sweep writes one row per case, in order, for any number of threads") {
  const Folder folder;
  const std::vector<std::string> keys{"--vary", "ball.position.0=linear:-10 cm:10 cm:7", "--vary",
                                      "gimbal.motion.phi.sinusoid.amplitude=list:0.5 deg,0.02"};
  const Result one =
      bbsim(sweep(config("fig2a.yaml"), with(keys, {"-j", "1", "-o", "-"})), folder.path());
  REQUIRE(one.exit_code == 0);
  const auto table = rows(one.out);
  REQUIRE(table.size() == 15);
  CHECK(table[0] == std::vector<std::string>{"case", "ball.position.0",
                                             "gimbal.motion.phi.sinusoid.amplitude", "status",
                                             "reason", "end_time", "end_x", "end_y", "max_tilt",
                                             "max_tilt_rate", "max_distance"});
  for (std::size_t i = 1; i < table.size(); ++i) {
    CHECK(table[i][0] == std::to_string(i - 1));
    CHECK(table[i][3] == "done");
    CHECK(table[i][4].empty());
    CHECK(table[i][5] == "10");
  }
  const Result two =
      bbsim(sweep(config("fig2a.yaml"), with(keys, {"-j", "3", "-o", "-"})), folder.path());
  CHECK(two.out == one.out);

  // Bit for bit the result of a run with the same values.
  const Result run = bbsim(
      {"run", config("fig2a.yaml"), "-q", "-o", "-", "--set", "ball.position.0=" + table[6][1],
       "--set", "gimbal.motion.phi.sinusoid.amplitude=" + table[6][2]},
      folder.path());
  const auto last = rows(run.out).back();
  CHECK(table[6][6] == last[1]);
  CHECK(table[6][7] == last[2]);
}

TEST_CASE("merged shards equal the sweep of one process byte for byte") {
  const Folder folder;
  const std::string ending = GENERATE(std::string(".csv"), std::string(".h5"));
  std::vector<std::string> keys{"--vary", "ball.radius=uniform:0.005:0.02", "--samples", "100"};
  if (ending == ".h5") keys.push_back("--keep-trajectories");
  REQUIRE(bbsim(sweep(config("fig2b.yaml"), with(keys, {"-o", "all" + ending})), folder.path())
              .exit_code == 0);
  std::vector<std::string> parts;
  for (const char* shard : {"3", "1", "2"}) {
    parts.push_back(std::string("part-") + shard + "of3" + ending);
    REQUIRE(bbsim(sweep(config("fig2b.yaml"),
                        with(keys, {"--shard", std::string(shard) + "/3", "-o", parts.back()})),
                  folder.path())
                .exit_code == 0);
  }
  const Result merged = bbsim(with({"merge", "-o", "merged" + ending}, parts), folder.path());
  CHECK(merged.exit_code == 0);
  CHECK(contains(merged.err, "100 cases from 3 parts"));
  CHECK(folder.read("merged" + ending) == folder.read("all" + ending));

  SECTION("a missing part is reported") {
    const Result less = bbsim({"merge", "-o", "less" + ending, parts[0], parts[1]}, folder.path());
    CHECK(less.exit_code == 2);
    CHECK(contains(less.err, "not part 2"));
  }
  SECTION("a part of a different sweep is refused") {
    REQUIRE(bbsim(sweep(config("fig2b.yaml"),
                        {"--vary", "ball.mass=linear:1:2:5", "-o", "other" + ending}),
                  folder.path())
                .exit_code == 0);
    const Result mixed =
        bbsim({"merge", "-o", "mixed" + ending, parts[0], parts[1], parts[2], "other" + ending},
              folder.path());
    CHECK(mixed.exit_code == 2);
    CHECK(contains(mixed.err, "parts of one sweep"));
  }
}

TEST_CASE("an interrupted sweep keeps its cases and resumes to the same bytes") {
  const Folder folder;
  const auto arguments =
      with({"sweep", config("fig2a.yaml")}, with(long_sweep, {"-j", "1", "-o", "s.csv"}));
  const int signal = GENERATE(2, 9);
  const Result cut = cut_off(arguments, folder, signal);
  REQUIRE(cut.exit_code != 0);
  if (signal == 2) {
    CHECK(cut.exit_code == 130);
    CHECK(contains(cut.err, "--resume continues"));
  }
  REQUIRE(folder.files() == std::vector<std::string>{"s.csv.part"});

  const Result again = bbsim(arguments, folder.path());
  CHECK(again.exit_code == 2);
  CHECK(contains(again.err, "add --resume"));
  const Result other = bbsim(with(arguments, {"--resume", "--seed", "9"}), folder.path());
  CHECK(other.exit_code == 2);
  CHECK(contains(other.err, "of another sweep"));

  const Result rest = bbsim(with(arguments, {"--resume"}), folder.path());
  CHECK(rest.exit_code == 0);
  CHECK(folder.files() == std::vector<std::string>{"s.csv"});
  REQUIRE(bbsim(with({"sweep", config("fig2a.yaml"), "-q"}, with(long_sweep, {"-o", "t.csv"})),
                folder.path())
              .exit_code == 0);
  CHECK(folder.read("s.csv") == folder.read("t.csv"));
}

TEST_CASE("parts with many cases are merged, through links and folders") {
  const Folder folder;
  const std::vector<std::string> keys{"--vary", "ball.position.0=linear:0:1:100002"};
  REQUIRE(bbsim(sweep(config("fig2a.yaml"), with(keys, {"-o", "part-1of1.csv"})), folder.path())
              .exit_code == 0);
  CHECK(bbsim({"merge", "-q", "part-1of1.csv", "-o", "all.csv"}, folder.path()).exit_code == 0);
  CHECK(folder.read("all.csv") == folder.read("part-1of1.csv"));

  std::filesystem::create_directory(folder / "sub");
  std::filesystem::create_symlink("sub/real.csv", folder / "link.csv");
  const std::vector<std::string> few{"--vary", "gravity=list:1,2"};
  CHECK(
      bbsim(sweep(config("fig2a.yaml"), with(few, {"-o", "link.csv"})), folder.path()).exit_code ==
      0);
  CHECK(std::filesystem::is_symlink(folder / "link.csv"));
  CHECK(std::filesystem::exists(folder / "sub/real.csv"));
  std::filesystem::create_directory(folder / "dir.csv");
  const Result directory =
      bbsim(sweep(config("fig2a.yaml"), with(few, {"-o", "dir.csv"})), folder.path());
  CHECK(directory.exit_code == 3);
  CHECK(contains(directory.err, "is a directory"));
}

TEST_CASE("a slow sweep keeps each finished case when interrupted") {
  const Folder folder;
  Launch launch{{"sweep", config("rig.yaml"), "--vary", "controller.sensor.seed=linear:1:2000:2000",
                 "-j", "1", "-o", "s.csv"},
                folder.path(),
                2};
  launch.signal_when = [&] {
    std::error_code none;
    const auto size = std::filesystem::file_size(folder / "s.csv.part", none);
    return !none && size > 6000;  // the plan, and some cases
  };
  const Result cut = bbsim(launch);
  CHECK(cut.exit_code == 130);
  std::size_t finished = 0;
  REQUIRE(std::sscanf(cut.err.c_str(), "interrupted after %zu of", &finished) == 1);
  CHECK(finished > 2);
  REQUIRE(folder.files() == std::vector<std::string>{"s.csv.part"});
}

TEST_CASE("expectations are columns of 1 and 0, and decide the exit code") {
  const Folder folder;
  const auto expecting = [&](const std::string& bound, std::vector<std::string> more) {
    return sweep(config("fig2a.yaml"), with({"--vary", "ball.position.0=list:0,0.1,0.2",
                                             "--measure", "end_x", "--expect", "max_x < " + bound},
                                            std::move(more)));
  };
  const Result some = bbsim(expecting("30 cm", {"-o", "-", "--summary", "s.json"}), folder.path());
  CHECK(some.exit_code == 1);
  CHECK(some.err == "not as expected: max_x < 30 cm: does not hold in 1 of 3 cases\n");
  const auto table = rows(some.out);
  REQUIRE(table.size() == 4);
  CHECK(table[0] == std::vector<std::string>{"case", "ball.position.0", "status", "reason",
                                             "end_time", "end_x", "max_x",
                                             "expect: max_x < 30 cm"});
  for (std::size_t i = 1; i < table.size(); ++i) {
    CHECK(table[i][7] == (std::stod(table[i][6]) < 0.3 ? "1" : "0"));
  }
  CHECK(contains(folder.read("s.json"), "\"cases_unmet\": 1"));
  CHECK(bbsim(expecting("1 m", {"-o", "-"}), folder.path()).exit_code == 0);

  // A case that has no value does not meet it.
  const Result none = bbsim(
      expecting("1 m", {"--expect", "find x when x=0.15 < 1 m", "-o", "x.h5"}), folder.path());
  CHECK(none.exit_code == 1);
  CHECK(none.err == "not as expected: find x when x=0.15 < 1 m: does not hold in 2 of 3 cases\n");

  const Result twice =
      bbsim(expecting("1 m", {"--expect", "max_x < 1 m", "-o", "-"}), folder.path());
  CHECK(twice.exit_code == 2);
  CHECK(contains(twice.err, "--expect: found \"max_x < 1 m\" twice"));
  const Result other = bbsim(expecting("1 deg", {"-o", "-"}), folder.path());
  CHECK(other.exit_code == 2);
  CHECK(contains(other.err, "but max_x is in m"));
}

TEST_CASE("a resumed sweep knows which cases of the first run missed an expectation") {
  const Folder folder;
  const auto arguments =
      with({"sweep", config("fig2a.yaml")},
           with(long_sweep, {"--expect", "end_x < 0.2", "-j", "1", "-o", "s.csv"}));
  REQUIRE(cut_off(arguments, folder, 2).exit_code == 130);
  const Result rest = bbsim(with(arguments, {"--resume"}), folder.path());
  CHECK(rest.exit_code == 1);
  const std::string table = folder.read("s.csv");
  std::size_t unmet = 0;
  for (auto at = table.find(",0\n"); at != std::string::npos; at = table.find(",0\n", at + 1))
    ++unmet;
  CHECK(unmet > 0);
  CHECK(contains(rest.err, "does not hold in " + std::to_string(unmet) + " of 200000 cases"));
}

TEST_CASE("a script for Slurm runs a sweep in shards whose merger is the sweep") {
  const Folder folder;
  const std::vector<std::string> keys{"--vary", "ball.position.0=linear:-0.1:0.1:41", "--set",
                                      "title=it's a ball"};
  const std::string scenario = config("fig2a.yaml");
  REQUIRE(bbsim(sweep(scenario, with(keys, {"-o", "all.csv"})), folder.path()).exit_code == 0);
  const Result written =
      bbsim(with({"sweep", scenario}, with(keys, {"-o", "my part.csv", "--summary", "sum.json",
                                                  "--slurm", "job.sh", "--slurm-tasks", "3"})),
            folder.path());
  CAPTURE(written.err);
  REQUIRE(written.exit_code == 0);
  CHECK(contains(written.err, "job.sh: 41 cases in 3 tasks; submit it with sbatch"));
  CHECK_FALSE(std::filesystem::exists(folder / "my part.csv"));
  const std::string script = folder.read("job.sh");
  CHECK(contains(script, "\n#SBATCH --array=1-3\n"));
  for (const char* task : {"1", "2", "3"}) {
    const std::string command =
        "BBSIM='" BBSIM_PROGRAM "' SLURM_ARRAY_TASK_ID=" + std::string(task) + " sh ./job.sh";
    REQUIRE(shell(command, folder.path()).exit_code == 0);
  }
  CHECK(std::filesystem::exists(folder / "sum-3of3.json"));
  const std::size_t merge = script.find("bbsim merge ");
  REQUIRE(merge != std::string::npos);
  const std::string command = script.substr(merge + 6, script.find('\n', merge) - merge - 6);
  REQUIRE(shell("'" BBSIM_PROGRAM "' " + command, folder.path()).exit_code == 0);
  CHECK(folder.read("my part.csv") == folder.read("all.csv"));
}

TEST_CASE("no script for Slurm has more tasks than groups of cases, or replaces an input") {
  const Folder folder;
  folder.write("s.yaml", "ball: {radius: 0.01}\ngimbal: {motion: {}}\ntime: {end: 1, step: 0.1}\n");
  const auto slurm = [&](const std::vector<std::string>& more) {
    return bbsim(with({"sweep", "s.yaml", "--vary", "ball.radius=linear:0.01:0.02:9"}, more),
                 folder.path());
  };
  CHECK(contains(slurm({"--slurm", "a.sh"}).err, "a.sh: 9 cases in 9 tasks; submit it"));
  CHECK(contains(slurm({"--slurm", "a.sh", "--slurm-tasks", "4"}).err, "a.sh: 9 cases in 4 tasks"));
  const Result replaced = slurm({"--slurm", "s.yaml"});
  CHECK(replaced.exit_code == 2);
  CHECK(contains(replaced.err, "--slurm"));
  CHECK(slurm({"--slurm", "b.csv", "-o", "b.csv"}).exit_code == 2);
  CHECK(slurm({"--slurm", "c.sh", "-o", "-"}).exit_code == 2);
  CHECK(slurm({"--slurm", "c.sh", "--slurm-tasks", "0"}).exit_code == 2);
  CHECK(slurm({"--slurm", "c.sh", "--shard", "1/2"}).exit_code == 2);
  CHECK(slurm({"--slurm", "c.sh", "--vary", "ball.mass=list:-1"}).exit_code == 2);
  CHECK_FALSE(std::filesystem::exists(folder / "c.sh"));
}

TEST_CASE("a sweep names the cases that failed, and the command that repeats one") {
  const Folder folder;
  const std::vector<std::string> arguments{"sweep",     config("fig2a.yaml"),
                                           "--vary",    "ball.position.0=list:1 mm,9 cm",
                                           "--set",     "title=it's a ball",
                                           "--expect",  "max_x < 5 cm",
                                           "--vary",    "ball.radius=list:1cm,2cm",
                                           "--summary", "s.json",
                                           "-o",        "s.csv"};
  const Result made = bbsim(arguments, folder.path());
  CAPTURE(made.err);
  CHECK(made.exit_code == 1);
  const std::size_t command = made.err.find("  bbsim run ");
  REQUIRE(command != std::string::npos);
  CHECK(contains(made.err, " is done (not as expected); repeat it with\n"));
  const std::string line = made.err.substr(command + 8, made.err.find('\n', command) - command - 8);
  const Result again =
      shell("'" BBSIM_PROGRAM "' " + line + " --expect 'max_x < 5 cm' -q -o -", folder.path());
  CAPTURE(line);
  CHECK(again.exit_code == 1);
  const std::string summary = folder.read("s.json");
  CHECK(contains(summary, "\"failed\": [\n"));
  CHECK(contains(summary, "\"reason\": \"not as expected\""));
  CHECK(contains(bbsim(sweep(config("falls.yaml"),
                             {"--vary", "ball.mass=list:0.1,0.2", "-o", "f.csv", "--summary", "-"}),
                       folder.path())
                     .out,
                 "\"status\": \"stopped\""));
}

TEST_CASE("a failed or stopped case is a row with its reason") {
  const Folder folder;
  // The loop of Fig. 2(b) as printed diverges; with small gains it does not within a second.
  const Result blows =
      bbsim(sweep(config("fig2b-literal.yaml"),
                  {"--vary", "controller.pd.kv=list:0.001,100", "--set", "time.end=1", "-o", "-"}),
            folder.path());
  REQUIRE(blows.exit_code == 0);
  const auto table = rows(blows.out);
  REQUIRE(table.size() == 3);
  CHECK(table[1][2] == "done");
  CHECK(table[1][3].empty());
  CHECK(table[2][2] == "failed");
  CHECK(contains(table[2][3], "grows without bound"));
  CHECK(std::stod(table[2][4]) == Approx(0.7488).epsilon(1e-3));

  const Result falls = bbsim(
      sweep(config("falls.yaml"), {"--vary", "ball.mass=list:0.1,0.2", "-o", "-"}), folder.path());
  REQUIRE(falls.exit_code == 0);
  for (const auto& row : {rows(falls.out)[1], rows(falls.out)[2]}) {
    CHECK(row[2] == "stopped");
    CHECK(row[3] == "edge");
  }
}

TEST_CASE("a scenario may contain its sweep and choose its measures") {
  const Folder folder;
  const std::string file = folder.write("scene.yaml",
                                        "ball: {radius: 0.01}\n"
                                        "time: {end: 1, step: 0.1}\n"
                                        "gimbal: {motion: {phi: 0.1}}\n"
                                        "sweep:\n"
                                        "  vary: {gravity: 'list:1,2'}\n"
                                        "  measure: [max_vx, end_normal_force, min_x, rms_x]\n");
  const Result result = bbsim(sweep(file, {}), folder.path());
  REQUIRE(result.exit_code == 0);
  const auto table = rows(folder.read("scene-sweep.csv"));
  REQUIRE(table.size() == 3);
  CHECK(table[0] == std::vector<std::string>{"case", "gravity", "status", "reason", "end_time",
                                             "max_vx", "end_normal_force", "min_x", "rms_x"});
  for (std::size_t i = 1; i <= 2; ++i) {
    const double g = static_cast<double>(i), a = 5.0 / 7 * g * std::sin(0.1);
    CHECK(std::stod(table[i][5]) == Approx(a));
    CHECK(std::stod(table[i][6]) == Approx(g * std::cos(0.1)));
    CHECK(std::abs(std::stod(table[i][7])) < 1e-15);
    double sum = 0;
    for (int row = 0; row <= 10; ++row) sum += std::pow(a / 2 * row * row / 100.0, 2);
    CHECK(std::stod(table[i][8]) == Approx(std::sqrt(sum / 11)));
  }
  CHECK(bbsim({"run", file, "-q"}, folder.path()).exit_code == 0);
  CHECK(
      contains(bbsim({"check", file}, folder.path()).out, "2 cases of bbsim sweep, over gravity"));

  const Result wrong = bbsim(sweep(file, {"--measure", "max_speed"}), folder.path());
  CHECK(wrong.exit_code == 2);
  CHECK(contains(wrong.err, "max_speed"));
  CHECK(contains(wrong.err, "such as max_tilt"));
  const Result none = bbsim(sweep(file, {"--measure", "max_tracking_error"}), folder.path());
  CHECK(none.exit_code == 2);
  CHECK(contains(none.err, "no controller"));
}

TEST_CASE("the cases of a rig equal its runs bit for bit") {
  const Folder folder;
  const std::vector<std::string> short_run{"--set", "time.end=4"};
  const Result result =
      bbsim(sweep(config("rig.yaml"),
                  with(short_run, {"--vary", "controller.gravity_compensation.kp=list:8,12",
                                   "--vary", "controller.sensor.seed=linear:1:3:3", "--measure",
                                   "end_x,end_y,end_theta", "-o", "-"})),
            folder.path());
  REQUIRE(result.exit_code == 0);
  const auto table = rows(result.out);
  REQUIRE(table.size() == 7);
  for (std::size_t i = 1; i < table.size(); ++i) {
    const Result run = bbsim(
        with({"run", config("rig.yaml"), "-q", "-o", "-", "--set",
              "controller.gravity_compensation.kp=" + table[i][1], "--set",
              "controller.sensor.seed=" + table[i][2], "--set", "output.columns=[x, y, theta]"},
             short_run),
        folder.path());
    const auto last = rows(run.out).back();
    CHECK(std::vector<std::string>(table[i].begin() + 6, table[i].end()) == last);
  }
}

TEST_CASE("a bound on the error holds for each case") {
  const Folder folder;
  const Result result = bbsim(sweep(config("fig2a.yaml"), {"--vary", "ball.position.0=list:0,0.05",
                                                           "--error", "1e-7", "-o", "-"}),
                              folder.path());
  REQUIRE(result.exit_code == 0);
  const Result exact = bbsim(sweep(config("fig2a.yaml"), {"--vary", "ball.position.0=list:0,0.05",
                                                          "--set", "solver.rtol=1e-12", "-o", "-"}),
                             folder.path());
  for (std::size_t i = 1; i <= 2; ++i) {
    for (std::size_t c = 5; c <= 6; ++c) {
      CHECK(std::abs(std::stod(rows(result.out)[i][c]) - std::stod(rows(exact.out)[i][c])) < 1e-7);
    }
  }
}

TEST_CASE("an impossible sweep is refused in one line before it begins") {
  const Folder folder;
  const auto fault = [&](std::vector<std::string> more) {
    const Result result = bbsim(sweep(config("fig2a.yaml"), std::move(more)), folder.path());
    CHECK(result.exit_code == 2);
    return result.err;
  };
  const std::vector<std::string> key{"--vary", "gravity=list:1,2"};
  CHECK(contains(fault({}), "no key to vary"));
  CHECK(contains(fault(with(key, {"--shard", "4/3"})), "K from 1 to N"));
  CHECK(contains(fault({"--vary", "gravity=uniform:1:2", "--samples", "1.5"}), "a whole number"));
  CHECK(contains(fault(with(key, {"--measure", "max_x,max_x"})), "twice"));
  CHECK(contains(fault(with(key, {"--shard", "x"})), "K/N"));
  CHECK(contains(fault(with(key, {"-o", "a.txt"})), ".csv, .h5 and .hdf5"));
  CHECK(contains(fault(with(key, {"-o", "-", "--resume"})), "cannot resume"));
  CHECK(contains(fault(with(key, {"--keep-trajectories"})), ".h5"));
  CHECK(contains(fault({"--vary", "time.end=list:1,2", "--keep-trajectories", "-o", "a.h5"}),
                 "time.end among the keys that vary"));
  CHECK(folder.files().empty());
  const Result full =
      bbsim(sweep(config("fig2a.yaml"), with(key, {"-o", "/dev/full"})), folder.path());
  CHECK(full.exit_code == 3);
}

TEST_CASE("tied keys: one axis, a column for each, on the command line and in the scenario") {
  const Folder folder;
  const std::string tied = "controller.pd.kp.0.0,-controller.pd.kp.1.1";
  const std::vector<std::string> vary{"--vary", tied + "=linear:0.001:0.003:3"};
  const Result result =
      bbsim(sweep(config("fig2b.yaml"), with(vary, {"-o", "a.csv"})), folder.path());
  REQUIRE(result.exit_code == 0);
  const auto table = rows(folder.read("a.csv"));
  REQUIRE(table.size() == 4);
  CHECK(std::vector<std::string>(table[0].begin(), table[0].begin() + 4) ==
        std::vector<std::string>{"case", "controller.pd.kp.0.0", "controller.pd.kp.1.1", "status"});
  CHECK(table[2][1] == "0.002");
  CHECK(table[2][2] == "-0.002");

  // Equal to a run with the same values.
  const Result run = bbsim({"run", config("fig2b.yaml"), "-q", "-o", "-", "--set",
                            "controller.pd.kp=[[0.002, 0], [0, -0.002]]"},
                           folder.path());
  const auto last = rows(run.out).back();
  CHECK(std::stod(table[2][6]) == Approx(std::stod(last[1])).margin(1e-10));
  CHECK(std::stod(table[2][7]) == Approx(std::stod(last[2])).margin(1e-10));

  std::string text;
  std::istringstream lines(folder.read(config("fig2b.yaml")));
  for (std::string line; std::getline(lines, line);) text += line + '\n';
  const std::string scene = folder.write(
      "scene.yaml", text + "sweep:\n  vary:\n    " + tied + ": linear:0.001:0.003:3\n");
  REQUIRE(bbsim(sweep(scene, {"-o", "b.csv"}), folder.path()).exit_code == 0);
  CHECK(folder.read("b.csv") == folder.read("a.csv"));
  CHECK(contains(bbsim({"check", scene}, folder.path()).out,
                 "3 cases of bbsim sweep, over controller.pd.kp.0.0, controller.pd.kp.1.1"));

  // Shards and HDF5 have the same columns.
  for (const char* shard : {"1", "2"}) {
    REQUIRE(
        bbsim(sweep(config("fig2b.yaml"), with(vary, {"--shard", std::string(shard) + "/2", "-o",
                                                      std::string("p-") + shard + "of2.csv"})),
              folder.path())
            .exit_code == 0);
  }
  REQUIRE(
      bbsim({"merge", "-q", "p-1of2.csv", "p-2of2.csv", "-o", "m.csv"}, folder.path()).exit_code ==
      0);
  CHECK(folder.read("m.csv") == folder.read("a.csv"));
  CHECK(bbsim(sweep(config("fig2b.yaml"), with(vary, {"-o", "a.h5"})), folder.path()).exit_code ==
        0);

  const Result wrong =
      bbsim(sweep(config("fig2b.yaml"), {"--vary", "gravity,=list:1"}), folder.path());
  CHECK(wrong.exit_code == 2);
  CHECK(contains(wrong.err, "-KEY or NUMBER*KEY"));
}

TEST_CASE("an interrupted sweep of tied keys resumes to the same bytes") {
  const Folder folder;
  const std::vector<std::string> arguments{
      "sweep",
      config("fig2a.yaml"),
      "--vary",
      "gimbal.motion.phi.sinusoid.phase,-gimbal.motion.theta.sinusoid.phase=uniform:0:3",
      "--samples",
      "200000",
      "-j",
      "1"};
  const Result cut = cut_off(with(arguments, {"-o", "s.csv"}), folder, 2);
  REQUIRE(cut.exit_code == 130);
  CHECK(bbsim(with(arguments, {"-o", "s.csv", "--resume"}), folder.path()).exit_code == 0);
  CHECK(bbsim(with(arguments, {"-o", "t.csv"}), folder.path()).exit_code == 0);
  CHECK(folder.read("s.csv") == folder.read("t.csv"));
}

TEST_CASE("a varying key cannot be set with --set") {
  const Folder folder;
  const Result result =
      bbsim(sweep(config("fig2a.yaml"), {"--vary", "gravity=list:1,2", "--set", "gravity=3"}),
            folder.path());
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err, "--set gravity=3: found, but the sweep varies gravity"));
  CHECK(folder.files().empty());
}

TEST_CASE(
    "a measure that is no finite number is said at the end, and is no case that ended early") {
  const Folder folder;
  const Result result = bbsim({"sweep", config("fig2a.yaml"), "--vary", "ball.mass=list:1,1e308",
                               "--measure", "max_normal_force", "-o", "a.csv"},
                              folder.path());
  CHECK(result.exit_code == 0);
  CHECK(contains(result.err, "2 of 2 cases, 1 with no finite number (see reason)"));
  CHECK_FALSE(contains(result.err, "ended early"));
  CHECK(rows(folder.read("a.csv"))[2][3] == "max_normal_force is infinite");
}

TEST_CASE("measures of the loop give the same bytes in any parts, alone and with others") {
  const Folder folder;
  const std::string names =
      GENERATE("stable,spectral_radius,phi_delay_margin", "max_tilt,phi_delay_margin,stable");
  CAPTURE(names);
  const std::vector<std::string> maps{
      "--vary",    "controller.gravity_compensation.kp=linear:1:40:7",
      "--vary",    "controller.gravity_compensation.kv=linear:1:14:7",
      "--set",     "time.end=2",
      "--measure", names};
  const auto make = [&](std::vector<std::string> more) {
    const Result made =
        bbsim(sweep(config("rig.yaml"), with(maps, std::move(more))), folder.path());
    CAPTURE(made.err);
    CHECK(made.exit_code == 0);
  };
  make({"-o", "whole.csv"});
  const std::string whole = folder.read("whole.csv");
  CHECK(contains(whole, "the loop is not stable"));
  make({"-o", "one.csv", "-j", "1"});
  CHECK(folder.read("one.csv") == whole);
  for (const std::string ending : {".csv", ".h5"}) {
    make({"-o", "a" + ending, "--shard", "1/2"});
    make({"-o", "b" + ending, "--shard", "2/2"});
    CHECK(bbsim({"merge", "-q", "a" + ending, "b" + ending, "-o", "all" + ending}, folder.path())
              .exit_code == 0);
    CHECK(
        bbsim({"compare", "all" + ending, "whole.csv", "--rtol", "0", "--atol", "0"}, folder.path())
            .exit_code == 0);
  }
  CHECK(folder.read("all.csv") == whole);
  CHECK(bbsim({"summarize", "whole.csv", "--measure", "stable"}, folder.path()).exit_code == 0);
}

TEST_CASE("an interrupted stability map resumes to the same bytes") {
  const Folder folder;
  const std::vector<std::string> map{
      "--vary",    "controller.gravity_compensation.kp=linear:1:40:20",
      "--vary",    "controller.gravity_compensation.kv=linear:1:9:20",
      "--measure", "phi_delay_margin,stable"};
  const auto arguments = with({"sweep", config("rig.yaml")}, with(map, {"-j", "1", "-o", "s.csv"}));
  const Result cut = cut_off(arguments, folder, 9);
  REQUIRE(cut.exit_code != 0);
  CHECK(bbsim(with(arguments, {"--resume"}), folder.path()).exit_code == 0);
  REQUIRE(bbsim(sweep(config("rig.yaml"), with(map, {"-o", "t.csv"})), folder.path()).exit_code ==
          0);
  CHECK(folder.read("s.csv") == folder.read("t.csv"));
}

}  // namespace bbsim_test::test_sweep
