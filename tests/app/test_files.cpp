// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Input and output files: no file is lost, whatever its name and however the program ends.
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"
#include "rights.hpp"

namespace bbsim_test::test_files {

using Names = std::vector<std::string>;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const char* const scene =
    "ball: {radius: 0.01}\n"
    "gimbal: {motion: {phi: {sinusoid: {amplitude: 0.01, frequency: 1}}}}\n"
    "time: {end: 1, step: 0.1}\n";

// Takes minutes and writes a hundred thousand rows.
const char* const long_scene =
    "ball: {radius: 0.01}\n"
    "gimbal: {motion: {phi: {sinusoid: {amplitude: 1e-5, frequency: 300}}}}\n"
    "time: {end: 1e6, step: 1}\n";

const char* const table = "t,a\n0,0\n1,0.01\n2,0\n3,0.01\n";
const char* const scene_with_table =
    "ball: {radius: 0.01}\n"
    "gimbal: {motion: {phi: {table: {file: t.csv, time: t, value: a}}}}\n"
    "time: {end: 3, step: 0.1}\n";

Names with(Names one, const Names& more) {
  one.insert(one.end(), more.begin(), more.end());
  return one;
}

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

// Runs a part of a sweep over gravity with the given instruction set.
Result shard(const Folder& folder, const std::string& file, const std::string& part,
             const Names& more = {}, const std::string& simd = "") {
  Launch launch{with({"sweep", "in.yaml", "-q", "--vary", "gravity=linear:1:2:40", "--shard", part,
                      "-o", file},
                     more),
                folder.path()};
  if (!simd.empty()) launch.prepare = [simd] { setenv("BBSIM_SIMD", simd.c_str(), 1); };
  return bbsim(launch);
}

// Kills a sweep once its partial file has the given number of bytes.
Result kill_once_there_are(std::uintmax_t bytes, const std::string& part, const Names& arguments,
                           const Folder& folder) {
  Launch launch{arguments, folder.path(), SIGKILL};
  launch.signal_when = [&] {
    std::error_code none;
    const std::uintmax_t size = fs::file_size(folder / part, none);
    return !none && size >= bytes;
  };
  return bbsim(launch);
}

// Whether the machine has two instruction sets to compare.
bool has_two() {
  const auto has = [](const char* name) {
    Launch launch{{"--version"}};
    launch.prepare = [name] { setenv("BBSIM_SIMD", name, 1); };
    return bbsim(launch).exit_code == 0;
  };
  return has("sse2") && has("avx2");
}

}  // namespace

TEST_CASE("no command overwrites its input or writes two outputs to one file") {
  const Folder folder;
  folder.write("in.yaml", scene);
  folder.write("d.csv", scene);  // the default output of this name is the file itself
  folder.write("table.yaml", scene_with_table);
  folder.write("t.csv", table);
  fs::create_symlink("in.yaml", folder / "link.json");
  const Names sweep{"sweep", "in.yaml", "--vary", "gravity=list:1,2"};
  const std::vector<Names> refused{
      {"run", "d.csv"},
      {"run", "in.yaml", "--summary", "in.yaml"},
      {"run", "in.yaml", "--summary", "link.json"},
      {"run", "in.yaml", "-o", "x.csv", "--summary", "x.csv"},
      {"run", "table.yaml", "-o", "t.csv"},
      {"run", "table.yaml", "-o", "new.csv", "--summary", "t.csv"},
      {"accuracy", "in.yaml", "--csv", "in.yaml"},
      {"sweep", "d.csv", "--vary", "gravity=list:1,2", "-o", "d.csv"},
      {"sweep", "table.yaml", "--vary", "gravity=list:1,2", "-o", "t.csv"},
      with(sweep, {"-o", "x.csv", "--summary", "x.csv"}),
      with(sweep, {"-o", "x.csv", "--summary", "x.csv.plan"}),
  };
  for (const Names& words : refused) {
    std::string line;
    for (const std::string& word : words) line += word + ' ';
    CAPTURE(line);
    const Result result = bbsim(words, folder.path());
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("the same file as"));
  }
  folder.write("y.csv.part", scene);
  const Result part =
      bbsim({"sweep", "y.csv.part", "--vary", "gravity=list:1,2", "-o", "y.csv"}, folder.path());
  CHECK(part.exit_code == 2);
  CHECK_THAT(part.err, Contains("y.csv.part (the scenario), which is read here"));
  CHECK(folder.read("in.yaml") == scene);
  CHECK(folder.read("d.csv") == scene);
  CHECK(folder.read("t.csv") == table);
  CHECK(folder.read("y.csv.part") == scene);
  CHECK(folder.files() ==
        Names{"d.csv", "in.yaml", "link.json", "t.csv", "table.yaml", "y.csv.part"});
}

TEST_CASE("no command overwrites a table that it displays") {
  const Folder folder;
  folder.write("recorded.yaml", scene_with_table);
  folder.write("t.csv", table);
  const auto run = [&](const Names& words) { return bbsim(words, folder.path()); };

  std::string shown = scene_with_table;
  folder.write("shown.yaml", shown.replace(shown.find("t.csv"), 5, "t.html"));
  folder.write("t.html", table);
  REQUIRE(run({"run", "shown.yaml", "-q", "-o", "r.csv", "--summary", "r.json"}).exit_code == 0);
  for (const Names& more : {Names{}, Names{"--scenario", "shown.yaml"}}) {
    const Result result = run(with({"replay", "r.csv", "-o", "t.html"}, more));
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("(a table of the scenario), which is read here"));
    CHECK(folder.read("t.html") == table);
  }
}

TEST_CASE("linearize, measure and replay overwrite no input, with or without -o") {
  const Folder folder;
  folder.write("own.yaml",
               "ball: {radius: 0.02}\n"
               "gimbal: {servo: {natural_frequency: 20, damping: 0.8}}\n"
               "controller:\n"
               "  program: {command: [python3, pid.py, gains.csv]}\n"
               "  drives: angle\n"
               "  reference: {point: [0, 0]}\n"
               "  sampling: {period: 0.02}\n"
               "time: {end: 0.2, step: 0.02}\n");
  const std::string law = "a law";
  for (const char* const name : {"pid.py", "gains.csv"}) folder.write(name, law);
  fs::create_symlink("pid.py", folder / "link.py");
  for (const std::string name : {"pid.py", "gains.csv", "link.py", "./pid.py"}) {
    CAPTURE(name);
    const Result result = bbsim({"linearize", "own.yaml", "-o", name}, folder.path());
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("(the scenario's controller), which is read here"));
  }
  CHECK(folder.read("pid.py") == law);
  CHECK(folder.read("gains.csv") == law);

  folder.write("in.yaml", scene);
  REQUIRE(bbsim({"run", "in.yaml", "-q", "-o", "r.csv", "--summary", "r.json"}, folder.path())
              .exit_code == 0);
  const std::string summary = folder.read("r.json");
  fs::create_symlink("r.json", folder / "t.html");
  const Result replay = bbsim({"replay", "r.csv", "-o", "t.html"}, folder.path());
  CHECK(replay.exit_code == 2);
  CHECK_THAT(replay.err, Contains("r.json (the summary of r.csv), which is read here"));
  Launch launch{{"measure", "r.csv", "--measure", "max_x"}, folder.path()};
  launch.prepare = [] { static_cast<void>(std::freopen("r.json", "a", stdout)); };
  CHECK(bbsim(launch).exit_code == 2);
  CHECK(folder.read("r.json") == summary);
}

TEST_CASE("no page may overwrite the page template") {
  const Folder folder;
  folder.write("in.yaml", scene);
  const std::string page =
      "<!-- A replay made by bbsim. --><title>@BBSIM_TITLE@</title>@BBSIM_DATA@";
  folder.write("replay.html", page);
  for (const Names& words : {Names{"replay", "in.yaml", "-o", "replay.html"},
                             Names{"run", "in.yaml", "-q", "--replay", "replay.html"}}) {
    Launch launch{words, folder.path()};
    launch.prepare = [] { setenv("BBSIM_SHARE_PATH", ".", 1); };
    const Result result = bbsim(launch);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("replay.html (the template of pages), which is read here"));
    CHECK(folder.read("replay.html") == page);
  }
}

TEST_CASE("without -o only a command's own earlier output is replaced") {
  struct Kept {
    std::string content, told;
  };
  const auto [content, told] = GENERATE(values<Kept>({
      {"t,x_mm,y_mm\n0,1,2\n", "begins with \"t,x_mm,y_mm\""},
      {"", "is empty"},
      {"t,x,y,gamma,phi,theta", "begins with \"t,x,y,gamma,phi,theta\""},
      {"t,x,y,gamma,phi,theta\r\n0,0,0,0,0,0\r\n", "begins with"},
      {"t,x,y,gamma,phi,theta,spin\n0,0,0,0,0,0,0\n", "begins with"},
      {"t,x,y,gamma,phi,theta\n0,0,0,0,0,0\n0.1,0,0", "breaks off within its last row"},
      {std::string("\x89HDF\r\n\x1a\n\0\0", 10), "begins with \"\\x89HDF"},
  }));
  CAPTURE(content);
  const Folder folder;
  folder.write("trial1.yaml", scene);
  folder.write("trial1.csv", content);
  const Result result = bbsim({"run", "trial1.yaml"}, folder.path());
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Contains("trial1.csv: already exists, and ") && Contains(told) &&
                             Contains("-o") && Contains("--force"));
  CHECK(folder.read("trial1.csv") == content);
  CHECK(folder.files() == Names{"trial1.csv", "trial1.yaml"});

  CHECK(bbsim({"run", "trial1.yaml", "-q", "--force"}, folder.path()).exit_code == 0);
  const std::string rows = folder.read("trial1.csv");
  CHECK_THAT(rows, Catch::Matchers::StartsWith("t,x,y,gamma,phi,theta\n0,"));
  CHECK(bbsim({"run", "trial1.yaml", "-q"}, folder.path()).exit_code == 0);
  CHECK(folder.read("trial1.csv") == rows);
  CHECK(bbsim({"run", "trial1.yaml", "-q", "--set", "output.columns=[t, x]"}, folder.path())
            .exit_code == 2);
  CHECK(folder.read("trial1.csv") == rows);
  // An explicit name may replace any file.
  CHECK(bbsim({"run", "trial1.yaml", "-q", "--set", "output.columns=[t, x]", "-o", "trial1.csv"},
              folder.path())
            .exit_code == 0);
}

TEST_CASE("without -o sweeps and pages also replace only their own earlier output") {
  const Folder folder;
  folder.write("a.yaml", scene);
  REQUIRE(bbsim({"run", "a.yaml", "-q", "-o", "a.csv"}, folder.path()).exit_code == 0);
  struct Way {
    Names words;
    std::string file;
  };
  const auto [words, file] = GENERATE(values<Way>({
      {{"sweep", "a.yaml", "--vary", "gravity=list:9,10"}, "a-sweep.csv"},
      {{"replay", "a.csv"}, "a.html"},
      {{"replay", "a.yaml"}, "a.html"},
  }));
  CAPTURE(words, file);
  const std::string content = "notes of mine, on case,gravity\n";
  folder.write(file, content);
  const Result result = bbsim(words, folder.path());
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Contains(file + ": already exists, and begins with \"notes of mine") &&
                             Contains("--force"));
  CHECK(folder.read(file) == content);
  CHECK(bbsim(with(words, {"--force", "-q"}), folder.path()).exit_code == 0);
  CHECK(folder.read(file) != content);
  CHECK(bbsim(with(words, {"-q"}), folder.path()).exit_code == 0);
}

TEST_CASE("a summary that nests without end is refused") {
  const Folder folder;
  folder.write("in.yaml", scene);
  REQUIRE(bbsim({"run", "in.yaml", "-q", "-o", "r.csv", "--summary", "r.json"}, folder.path())
              .exit_code == 0);
  std::string summary = folder.read("r.json");
  const std::size_t nesting = 100'000;
  summary.insert(1, "\"deep\": " + std::string(nesting, '[') + std::string(nesting, ']') + ",");
  folder.write("r.json", summary);
  for (const Names& words :
       {Names{"replay", "r.csv", "-q"}, Names{"measure", "r.csv", "--measure", "max_x"}}) {
    CAPTURE(words);
    CHECK(bbsim(words, folder.path()).exit_code == 0);  // no summary was requested
  }
  const Result result = bbsim({"replay", "r.csv", "--summary", "r.json"}, folder.path());
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Contains("r.json: is not a summary"));
}

TEST_CASE("a folder, unreadable file or device in place of a summary gives exit code 2") {
  const Folder folder;
  folder.write("in.yaml", scene);
  REQUIRE(bbsim({"run", "in.yaml", "-q", "-o", "r.csv"}, folder.path()).exit_code == 0);
  fs::create_directory(folder / "folder");
  folder.write("closed", "{}");
  REQUIRE(chmod((folder / "closed").c_str(), 0) == 0);
  struct Way {
    std::string file, why;
  };
  for (const auto& [file, why] :
       {Way{"folder", "is a directory"}, Way{"closed", "permission denied"},
        Way{"nowhere", "no such file"}, Way{"/dev/null", "/dev/null: "}}) {
    CAPTURE(file);
    Launch launch{{"replay", "r.csv", "--summary", file}, folder.path()};
    launch.prepare = drop_rights_over_files;
    const Result result = bbsim(launch);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains(why));
  }
  CHECK(folder.files() == Names{"closed", "folder", "in.yaml", "r.csv"});
}

TEST_CASE("an option with an empty value is refused, as from an unset variable") {
  const Folder folder;
  folder.write("in.yaml", scene);
  for (const char* const option : {"-o", "--error", "--summary", "--replay", "--set"}) {
    CAPTURE(option);
    const Result result = bbsim({"run", "in.yaml", option, ""}, folder.path());
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("found nothing"));
    CHECK_THAT(result.err, Contains(option));
  }
  CHECK(folder.files() == Names{"in.yaml"});
}

TEST_CASE("the shipped scenarios run in their own folder, with the same result twice") {
  const Folder folder;
  for (const char* name :
       {"recorded.yaml", "recorded-angles.csv", "traced.yaml", "traced-path.csv"}) {
    fs::copy(config(name), folder / name);
  }
  for (const std::string name : {"recorded", "traced"}) {
    CHECK(bbsim({"run", name + ".yaml", "-q"}, folder.path()).exit_code == 0);
    const std::string first = folder.read(name + ".csv");
    CHECK(bbsim({"run", name + ".yaml", "-q"}, folder.path()).exit_code == 0);
    CHECK(folder.read(name + ".csv") == first);
  }
}

TEST_CASE("standard output redirected to an input is detected, and devices never conflict") {
  const Folder folder;
  folder.write("in.yaml", scene);
  Launch launch{{"run", "in.yaml", "-q", "-o", "-"}, folder.path()};
  launch.prepare = [] { static_cast<void>(std::freopen("in.yaml", "a", stdout)); };
  CHECK(bbsim(launch).exit_code == 2);
  for (const Names& words :
       {Names{"check", "in.yaml"}, Names{"verify", "in.yaml"},
        Names{"compare", "in.yaml", "in.yaml"}, Names{"accuracy", "in.yaml"}}) {
    launch.arguments = words;
    CHECK(bbsim(launch).exit_code == 2);
  }
  CHECK(folder.read("in.yaml") == scene);
  CHECK(bbsim({"run", "in.yaml", "-q", "-o", "/dev/null", "--summary", "/dev/null"}, folder.path())
            .exit_code == 0);
}

TEST_CASE("a merge does not overwrite its parts") {
  const Folder folder;
  folder.write("in.yaml", scene);
  REQUIRE(shard(folder, "p-1of2.csv", "1/2").exit_code == 0);
  REQUIRE(shard(folder, "p-2of2.csv", "2/2").exit_code == 0);
  const std::string first = folder.read("p-1of2.csv");
  const Result over =
      bbsim({"merge", "p-1of2.csv", "p-2of2.csv", "-o", "p-1of2.csv"}, folder.path());
  CHECK(over.exit_code == 2);
  CHECK_THAT(over.err, Contains("p-1of2.csv (a part), which is read here"));
  CHECK(folder.read("p-1of2.csv") == first);
}

TEST_CASE("a merge that cannot read its parts reports it and writes nothing") {
  const Folder folder;
  folder.write("in.yaml", scene);
  REQUIRE(shard(folder, "p-1of2.csv", "1/2").exit_code == 0);
  REQUIRE(shard(folder, "p-2of2.csv", "2/2").exit_code == 0);
  for (const rlim_t descriptors : {4}) {
    if (under_sanitizers) break;
    Launch launch{{"merge", "p-1of2.csv", "p-2of2.csv", "-o", "m.csv"}, folder.path()};
    launch.prepare = [descriptors] { limit(RLIMIT_NOFILE, descriptors); };
    const Result result = bbsim(launch);
    CHECK((result.exit_code == 2 || result.exit_code == 3));
    CHECK_THAT(result.err, Contains("too many open files"));
    CHECK_FALSE(fs::exists(folder / "m.csv"));
  }
  REQUIRE(mkfifo((folder / "p-3of3.csv").c_str(), 0600) == 0);
  const Result fifo = bbsim({"merge", "p-3of3.csv", "-o", "m.csv"}, folder.path());
  CHECK(fifo.exit_code == 2);
  CHECK(fifo.seconds < 20);
}

TEST_CASE("parts of a different sweep are refused by plan, other instruction sets are noted") {
  const Folder folder;
  folder.write("in.yaml", scene);
  REQUIRE(shard(folder, "p-1of2.csv", "1/2").exit_code == 0);
  REQUIRE(shard(folder, "p-2of2.csv", "2/2").exit_code == 0);
  CHECK(folder.files() ==
        Names{"in.yaml", "p-1of2.csv", "p-1of2.csv.plan", "p-2of2.csv", "p-2of2.csv.plan"});
  const auto merged = [&](const Names& more = {}) {
    return bbsim(with({"merge", "p-1of2.csv", "p-2of2.csv", "-o", "m.csv"}, more), folder.path());
  };
  const Result good = merged();
  CHECK(good.exit_code == 0);
  CHECK(good.err == "m.csv: 40 cases from 2 parts\n");
  CHECK_FALSE(fs::exists(folder / "m.csv.plan"));

  SECTION("another scenario") {
    REQUIRE(shard(folder, "p-2of2.csv", "2/2", {"--set", "ball.radius=0.02"}).exit_code == 0);
    const Result result = merged();
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err,
               Contains("of another sweep than p-1of2.csv: their plans differ in overrides"));
    fs::remove(folder / "p-2of2.csv.plan");  // an older version wrote no plans
    CHECK(merged().exit_code == 0);
  }
  SECTION("an instruction set") {
    if (!has_two()) return;
    REQUIRE(shard(folder, "p-1of2.csv", "1/2", {}, "sse2").exit_code == 0);
    REQUIRE(shard(folder, "p-2of2.csv", "2/2", {}, "avx2").exit_code == 0);
    const Result result = merged();
    CHECK(result.exit_code == 0);
    CHECK_THAT(
        result.err,
        Contains("the parts are of avx2 and sse2: alike within the tolerance, not bit for bit"));
  }
  SECTION("the last part is missing, whatever the file names") {
    fs::rename(folder / "p-1of2.csv", folder / "first.csv");
    fs::rename(folder / "p-1of2.csv.plan", folder / "first.csv.plan");
    const Result result = bbsim({"merge", "first.csv", "-o", "m.csv"}, folder.path());
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("found 16 cases of 40"));
  }
  SECTION("an invalid plan") {
    folder.write("p-2of2.csv.plan", "nonsense");
    const Result result = merged();
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("found no plan of bbsim sweep"));
  }
  SECTION("an incomplete row") {
    const std::string text = folder.read("p-2of2.csv");
    folder.write("p-2of2.csv", text.substr(0, text.size() - 30) + "\n");
    const Result result = merged();
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains("in row 24 below the header"));
  }
}

TEST_CASE("HDF5 parts of several instruction sets are merged, and the file names them") {
  if (!has_two()) return;
  const Folder folder;
  folder.write("in.yaml", scene);
  REQUIRE(shard(folder, "p-1of2.h5", "1/2", {}, "sse2").exit_code == 0);
  REQUIRE(shard(folder, "p-2of2.h5", "2/2", {}, "avx2").exit_code == 0);
  const Result result = bbsim({"merge", "p-1of2.h5", "p-2of2.h5", "-o", "m.h5"}, folder.path());
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.err, Contains("the parts are of avx2 and sse2"));
  CHECK_THAT(folder.read("m.h5"), Contains("avx2 and sse2"));
}

TEST_CASE("the instruction set is named") {
  const Result version = bbsim({"--version"});
  CHECK(version.exit_code == 0);
  CHECK_THAT(version.out,
             Catch::Matchers::StartsWith("bbsim " BBSIM_VERSION "\ninstruction set: "));
  const Folder folder;
  folder.write("in.yaml", scene);
  const std::size_t at = version.out.find("set: ") + 5;
  const std::string name = version.out.substr(at, version.out.find('\n', at) - at);
  CHECK_THAT(version.out, Catch::Matchers::Matches(
                              "bbsim [0-9.]+\n"
                              "instruction set: [a-z0-9]+\n"
                              "commit: ([0-9a-f]{7,}(, with changes)?|unknown: .*)\n"
                              "libraries: SUNDIALS [0-9.]+, Eigen [0-9.]+, yaml-cpp [0-9.]+, CLI11 "
                              "[0-9.]+, nlohmann-json [0-9.]+, HDF5 [0-9.]+\n"));
  CHECK(bbsim({"run", "in.yaml", "-q", "--summary", "s.json"}, folder.path()).exit_code == 0);
  CHECK(nlohmann::json::parse(folder.read("s.json")).at("instruction_set") == name);
  Launch wrong{{"--version"}};
  wrong.prepare = [] { setenv("BBSIM_SIMD", "none", 1); };
  CHECK(bbsim(wrong).exit_code == 2);
}

TEST_CASE("files name the commit beside the version") {
  const std::string told = bbsim({"--version"}).out;
  const std::size_t at = told.find("commit: ") + 8;
  std::string commit = told.substr(at, told.find('\n', at) - at);
  std::string version = BBSIM_VERSION;
  if (!commit.starts_with("unknown")) {
    const std::size_t end = commit.find(',');
    version += "+g" + commit.substr(0, end) + (end == std::string::npos ? "" : ".changed");
  }
  const Folder folder;
  folder.write("in.yaml", scene);
  CHECK(bbsim({"run", "in.yaml", "-q", "-o", "r.h5", "--summary", "r.json"}, folder.path())
            .exit_code == 0);
  CHECK(bbsim({"sweep", "in.yaml", "-q", "--vary", "gravity=list:9,10", "-o", "s.h5", "--summary",
               "s.json"},
              folder.path())
            .exit_code == 0);
  for (const std::string name : {"r", "s"}) {
    CHECK(nlohmann::json::parse(folder.read(name + ".json")).at("version") == version);
    CHECK_THAT(folder.read(name + ".h5"), Contains(version));
  }
}

TEST_CASE("a sweep's summary has its plan, its engine and how its cases ended") {
  const Folder folder;
  const Result result = bbsim(
      {"sweep", config("fig2b-literal.yaml"), "-q", "--vary", "controller.pd.kv=list:0.001,100",
       "--set", "time.end=1", "-o", "s.csv", "--summary", "s.json"},
      folder.path());
  CHECK(result.exit_code == 0);
  CHECK(folder.files() == Names{"s.csv", "s.json"});
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  CHECK(summary.at("status") == "done");
  CHECK(summary.at("statuses") == nlohmann::json{{"done", 1}, {"failed", 1}});
  CHECK(summary.at("engine") == "lanes");
  CHECK(summary.at("rows") == 2);
  CHECK(summary.at("cases") == 2);
  CHECK(summary.at("vary") == nlohmann::json{"controller.pd.kv=list:0.001,100"});
  CHECK(summary.at("overrides") == nlohmann::json{"time.end=1"});
  CHECK(summary.contains("instruction_set"));
}

TEST_CASE("runs and merges end at a signal with 130 and leave no incomplete file") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  CAPTURE(signal);
  const Folder folder;
  folder.write("long.yaml", long_scene);
  SECTION("run") {
    const Result result =
        bbsim(Launch{{"run", "long.yaml"}, folder.path(), signal, std::chrono::milliseconds(1500)});
    CHECK(result.exit_code == 130);
    CHECK_THAT(result.err, Contains("interrupted at t = "));
    CHECK(folder.files() == Names{"long.csv", "long.yaml"});
  }
  SECTION("merge") {
    std::string rows = "case,gravity,status,reason,end_time\n";
    for (int i = 0; i < 400000; ++i) rows += std::to_string(i) + ",9.81,done,,10\n";
    folder.write("p.csv", rows);
    int interrupted = 0;
    for (int after = 0; after < 60 && interrupted < 3; after += 3) {
      const Result result = bbsim(Launch{{"merge", "p.csv", "-o", "m.csv"},
                                         folder.path(),
                                         signal,
                                         std::chrono::milliseconds(after)});
      const bool by_signal_before_main = result.exit_code == 128 + signal;
      CHECK((result.exit_code == 0 || result.exit_code == 130 || by_signal_before_main));
      CHECK(folder.files() == (result.exit_code == 0 ? Names{"long.yaml", "m.csv", "p.csv"}
                                                     : Names{"long.yaml", "p.csv"}));
      if (result.exit_code == 130) ++interrupted;
      fs::remove(folder / "m.csv");
    }
  }
}

TEST_CASE("a program started with nohup outlives its terminal") {
  const Folder folder;
  folder.write("in.yaml", scene);
  Launch launch{{"sweep", "in.yaml", "-q", "--vary", "time.step=uniform:1e-5:2e-5", "--samples",
                 "100", "-j", "1", "-o", "s.csv"},
                folder.path(),
                SIGHUP,
                std::chrono::milliseconds(50)};
  launch.prepare = [] { static_cast<void>(std::signal(SIGHUP, SIG_IGN)); };  // nohup
  CHECK(bbsim(launch).exit_code == 0);
}

TEST_CASE("an interrupted sweep to standard output has printed its finished cases") {
  const Folder folder;
  folder.write("slow.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: {sinusoid: {amplitude: 1e-5, frequency: 300}}}}\n"
               "time: {end: 300, step: 1}\n");
  const Result result = bbsim(Launch{{"sweep", "slow.yaml", "--vary", "gravity=linear:1:2:100000",
                                      "--measure", "end_vx", "-j", "1", "-o", "-"},
                                     folder.path(),
                                     SIGINT,
                                     std::chrono::milliseconds(2500)});
  CHECK(result.exit_code == 130);
  std::size_t finished = 0;
  REQUIRE(std::sscanf(result.err.c_str(), "interrupted after %zu of", &finished) == 1);
  CHECK(finished > 0);
  const auto lines =
      static_cast<std::size_t>(std::count(result.out.begin(), result.out.end(), '\n'));
  CHECK(lines == finished + 1);
}

TEST_CASE("a resumed sweep counts the earlier cases too") {
  const Folder folder;
  const Names arguments{
      "sweep", config("falls.yaml"), "--vary", "ball.mass=linear:0.1:0.2:900", "-j", "1", "-o",
      "s.csv"};
  REQUIRE(kill_once_there_are(10000, "s.csv.part", arguments, folder).exit_code == 137);
  const Result rest = bbsim(with(arguments, {"--resume", "--summary", "s.json"}), folder.path());
  CHECK(rest.exit_code == 0);
  CHECK_THAT(rest.err, Contains(" of them from the earlier run, 900 ended early (see status)"));
  CHECK(nlohmann::json::parse(folder.read("s.json")).at("statuses") ==
        nlohmann::json{{"stopped", 900}});
}

TEST_CASE("a damaged part is truncated at the damage, and this is reported") {
  const Folder folder;
  folder.write("in.yaml", scene);
  const Names arguments{"sweep",     "in.yaml", "-q", "--vary", "time.step=uniform:1e-4:2e-4",
                        "--samples", "3000",    "-j", "1"};
  REQUIRE(bbsim(with(arguments, {"-o", "whole.csv"}), folder.path()).exit_code == 0);
  kill_once_there_are(10000, "s.csv.part", with(arguments, {"-o", "s.csv"}), folder);
  std::string part = folder.read("s.csv.part");
  REQUIRE(part.size() > 5000);
  part.replace(4096, 200, 200, '\0');
  folder.write("s.csv.part", part);
  const Result rest = bbsim(with(arguments, {"-o", "s.csv", "--resume"}), folder.path());
  CHECK(rest.exit_code == 0);
  CHECK_THAT(rest.err, Contains("is not as it was written; continuing from case "));
  const bool alike = folder.read("s.csv") == folder.read("whole.csv");
  CHECK(alike);
}

TEST_CASE("an extension in capitals means the same format in every command") {
  const Folder folder;
  folder.write("in.yaml", scene);
  CHECK(bbsim({"run", "in.yaml", "-q", "-o", "A.H5"}, folder.path()).exit_code == 0);
  CHECK(bbsim({"run", "in.yaml", "-q", "-o", "A.CSV"}, folder.path()).exit_code == 0);
  CHECK(bbsim({"compare", "A.H5", "A.CSV"}, folder.path()).exit_code == 0);
  for (const std::string ending : {".H5", ".HDF5", ".CSV"}) {
    CAPTURE(ending);
    REQUIRE(shard(folder, "p-1of2" + ending, "1/2").exit_code == 0);
    REQUIRE(shard(folder, "p-2of2" + ending, "2/2").exit_code == 0);
    const Result merged =
        bbsim({"merge", "p-1of2" + ending, "p-2of2" + ending, "-o", "m" + ending}, folder.path());
    CHECK(merged.exit_code == 0);
  }
  const Result other = bbsim({"merge", "p-1of2.CSV", "p-2of2.CSV", "-o", "m.txt"}, folder.path());
  CHECK(other.exit_code == 2);
  CHECK_THAT(other.err, Contains(".csv, .h5 and .hdf5"));
}

TEST_CASE("a folder name that is not UTF-8 does not stop a sweep with a table") {
  const Folder folder;
  fs::create_directory(folder / "s\xff");
  folder.write("s\xff/in.yaml", scene_with_table);
  folder.write("s\xff/t.csv", table);
  const Result result =
      bbsim({"sweep", "s\xff/in.yaml", "--vary", "gravity=list:1,2", "-o", "s.csv"}, folder.path());
  CHECK(result.exit_code == 0);
}

TEST_CASE("if fewer threads are available, fewer are used") {
  if (under_sanitizers) return;
  const Folder folder;
  folder.write("in.yaml", scene);
  const Names arguments{"sweep",     "in.yaml", "--vary", "gravity=linear:1:2:5000",
                        "--measure", "end_vx"};
  Launch launch{with(arguments, {"-j", "64", "-o", "few.csv"}), folder.path()};
  launch.prepare = [] {
    limit(RLIMIT_STACK, rlim_t{1} << 30U);  // the size of each thread's stack
    limit(RLIMIT_AS, rlim_t{3} << 30U);
  };
  const Result few = bbsim(launch);
  CHECK(few.exit_code == 0);
  CHECK_THAT(few.err, Contains("no more than ") && Contains(" of 64 threads"));
  CHECK(bbsim(with(arguments, {"-j", "1", "-o", "one.csv"}), folder.path()).exit_code == 0);
  CHECK(folder.read("few.csv") == folder.read("one.csv"));
}

TEST_CASE("memory that runs out ends the program with a message, not a signal") {
  const Folder folder;
  folder.write("in.yaml", scene);
  for (rlim_t kilobytes = 4000; kilobytes <= 16000; kilobytes += 100) {
    Launch launch{{"run", "in.yaml", "-q", "-o", "a.csv"}, folder.path()};
    launch.prepare = [kilobytes] { limit(RLIMIT_AS, kilobytes * 1024); };
    const Result result = bbsim(launch);
    CAPTURE(kilobytes, result.exit_code, result.err);
    // 127: the loader ran out of memory. SIGKILL, SIGSEGV: the kernel could not start the program.
    const bool before_main = result.err.find("bbsim") == 0 || result.err.empty();
    CHECK((result.exit_code < 128 || before_main));
    CHECK(result.exit_code != 128 + SIGABRT);
  }
}

TEST_CASE("without the HDF5 module a sweep to HDF5 ends before its first case") {
  const Folder folder;
  folder.write("in.yaml", scene);
  Launch launch{{"sweep", "in.yaml", "--vary", "gravity=list:1,2", "-o", "s.h5"}, folder.path()};
  launch.prepare = [&] { setenv("BBSIM_MODULE_PATH", folder.path().c_str(), 1); };
  const Result result = bbsim(launch);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("the HDF5 module"));
  CHECK(folder.files() == Names{"in.yaml"});
}

TEST_CASE(
    "a write-protected target and a folder that cannot be searched are refused by all alike") {
  const Folder folder;
  folder.write("in.yaml", scene);
  folder.write("s.csv", "old");
  REQUIRE(chmod((folder / "s.csv").c_str(), 0444) == 0);
  fs::create_directory(folder / "closed");
  REQUIRE(chmod((folder / "closed").c_str(), 0) == 0);
  for (const char* file : {"s.csv", "closed/s.csv"}) {
    for (const Names& words :
         {Names{"run", "in.yaml", "-o", file},
          Names{"sweep", "in.yaml", "--vary", "gravity=list:1,2", "-o", file}}) {
      Launch launch{words, folder.path()};
      launch.prepare = drop_rights_over_files;
      const Result result = bbsim(launch);
      CHECK(result.exit_code == 3);
      CHECK_THAT(result.err, Contains("permission denied"));
    }
  }
  CHECK(folder.read("s.csv") == "old");
  CHECK(folder.files() == Names{"closed", "in.yaml", "s.csv"});
}

TEST_CASE("sweep outputs that cannot be written give exit code 3") {
  const Folder folder;
  folder.write("in.yaml", scene);
  fs::create_symlink("loop.csv", folder / "loop.csv");
  REQUIRE(mkfifo((folder / "f.csv.part").c_str(), 0600) == 0);
  for (const std::string& file :
       {std::string("loop.csv"), std::string(300, 'n') + ".csv", std::string("f.csv")}) {
    const Result result =
        bbsim({"sweep", "in.yaml", "--vary", "gravity=list:1,2", "-o", file}, folder.path());
    CHECK(result.exit_code == 3);
    CHECK_THAT(result.err, Contains("cannot write "));
    CHECK(result.seconds < 20);
  }
}

}  // namespace bbsim_test::test_files
