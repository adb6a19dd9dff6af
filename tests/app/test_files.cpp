// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Input and output files: no file is lost, whatever its name and however the program ends.
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_files {

using Names = std::vector<std::string>;
namespace fs = std::filesystem;

namespace {

const std::string samples = "t,a\n0,0\n1,0.01\n2,0\n3,0.01\n";
const std::string scene_with_table =
    "ball: {radius: 0.01}\n"
    "gimbal: {motion: {phi: {table: {file: t.csv, time: t, value: a}}}}\n"
    "time: {end: 3, step: 0.1}\n";

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

// Runs a command whose standard output is appended to a file.
Result call_into(const char* file, const std::string& line, const Folder& folder) {
  return call(line, folder, [=] { static_cast<void>(std::freopen(file, "a", stdout)); });
}

}  // namespace

TEST_CASE("no command overwrites its input or writes two outputs to one file") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  folder.write("d.csv", short_scene);  // the default output of this name is the file itself
  folder.write("table.yaml", scene_with_table);
  folder.write("t.csv", samples);
  fs::create_symlink("in.yaml", folder / "link.json");
  for (const std::string line : {
           "run d.csv",
           "run in.yaml --summary in.yaml",
           "run in.yaml --summary link.json",
           "run in.yaml -o x.csv --summary x.csv",
           "run table.yaml -o t.csv",
           "run table.yaml -o new.csv --summary t.csv",
           "accuracy in.yaml --csv in.yaml",
           "sweep d.csv --vary gravity=list:1,2 -o d.csv",
           "sweep table.yaml --vary gravity=list:1,2 -o t.csv",
           "sweep in.yaml --vary gravity=list:1,2 -o x.csv --summary x.csv",
           "sweep in.yaml --vary gravity=list:1,2 -o x.csv --summary x.csv.plan",
       }) {
    expect(2, line, folder, {"the same file as"});
  }
  folder.write("y.csv.part", short_scene);
  expect(2, "sweep y.csv.part --vary gravity=list:1,2 -o y.csv", folder,
         {"y.csv.part (the scenario), which is read here"});
  for (const char* const name : {"in.yaml", "d.csv", "y.csv.part"}) {
    CHECK(folder.read(name) == short_scene);
  }
  CHECK(folder.read("t.csv") == samples);
  CHECK(folder.files() ==
        Names{"d.csv", "in.yaml", "link.json", "t.csv", "table.yaml", "y.csv.part"});
}

TEST_CASE("no command overwrites a table that it displays") {
  const Folder folder;
  std::string shown = scene_with_table;
  folder.write("shown.yaml", shown.replace(shown.find("t.csv"), 5, "t.html"));
  folder.write("t.html", samples);
  expect(0, "run shown.yaml -q -o r.csv --summary r.json", folder);
  for (const std::string more : {"", " --scenario shown.yaml"}) {
    expect(2, "replay r.csv -o t.html" + more, folder,
           {"(a table of the scenario), which is read here"});
    CHECK(folder.read("t.html") == samples);
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
    expect(2, "linearize own.yaml -o " + name, folder,
           {"(the scenario's controller), which is read here"});
  }
  CHECK(folder.read("pid.py") == law);
  CHECK(folder.read("gains.csv") == law);

  folder.write("in.yaml", short_scene);
  expect(0, "run in.yaml -q -o r.csv --summary r.json", folder);
  const std::string summary = folder.read("r.json");
  fs::create_symlink("r.json", folder / "t.html");
  expect(2, "replay r.csv -o t.html", folder,
         {"r.json (the summary of r.csv), which is read here"});
  expect(2, call_into("r.json", "measure r.csv --measure max_x", folder));
  CHECK(folder.read("r.json") == summary);
}

TEST_CASE("no page may overwrite the page template") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  const std::string page =
      "<!-- A replay made by bbsim. --><title>@BBSIM_TITLE@</title>@BBSIM_DATA@";
  folder.write("replay.html", page);
  for (const char* const line :
       {"replay in.yaml -o replay.html", "run in.yaml -q --replay replay.html"}) {
    expect(2, call_with("BBSIM_SHARE_PATH", ".", line, folder),
           {"replay.html (the template of pages), which is read here"});
    CHECK(folder.read("replay.html") == page);
  }
}

TEST_CASE("without -o only a command's own earlier output is replaced") {
  const auto [content, told] = GENERATE(table<std::string, std::string>({
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
  folder.write("trial1.yaml", short_scene);
  folder.write("trial1.csv", content);
  expect(2, "run trial1.yaml", folder, {"trial1.csv: already exists, and ", told, "-o", "--force"});
  CHECK(folder.read("trial1.csv") == content);
  CHECK(folder.files() == Names{"trial1.csv", "trial1.yaml"});

  expect(0, "run trial1.yaml -q --force", folder);
  const std::string rows = folder.read("trial1.csv");
  CHECK(rows.starts_with("t,x,y,gamma,phi,theta\n0,"));
  expect(0, "run trial1.yaml -q", folder);
  CHECK(folder.read("trial1.csv") == rows);
  expect(2, "run trial1.yaml -q --set 'output.columns=[t, x]'", folder);
  CHECK(folder.read("trial1.csv") == rows);
  // An explicit name may replace any file.
  expect(0, "run trial1.yaml -q --set 'output.columns=[t, x]' -o trial1.csv", folder);
}

TEST_CASE("without -o sweeps and pages also replace only their own earlier output") {
  const Folder folder;
  folder.write("a.yaml", short_scene);
  expect(0, "run a.yaml -q -o a.csv", folder);
  const auto [line, file] = GENERATE(
      table<std::string, std::string>({{"sweep a.yaml --vary gravity=list:9,10", "a-sweep.csv"},
                                       {"replay a.csv", "a.html"},
                                       {"replay a.yaml", "a.html"}}));
  const std::string content = "notes of mine, on case,gravity\n";
  folder.write(file, content);
  expect(2, line, folder, {file + ": already exists, and begins with \"notes of mine", "--force"});
  CHECK(folder.read(file) == content);
  expect(0, line + " --force -q", folder);
  CHECK(folder.read(file) != content);
  expect(0, line + " -q", folder);
}

TEST_CASE("a summary that nests without end is refused") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  expect(0, "run in.yaml -q -o r.csv --summary r.json", folder);
  std::string summary = folder.read("r.json");
  const std::size_t nesting = 100'000;
  summary.insert(1, "\"deep\": " + std::string(nesting, '[') + std::string(nesting, ']') + ",");
  folder.write("r.json", summary);
  expect(0, "replay r.csv -q", folder);  // no summary was requested
  expect(0, "measure r.csv --measure max_x", folder);
  expect(2, "replay r.csv --summary r.json", folder, {"r.json: is not a summary"});
}

TEST_CASE("a folder, unreadable file or device in place of a summary gives exit code 2") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  expect(0, "run in.yaml -q -o r.csv", folder);
  fs::create_directory(folder / "folder");
  folder.write("closed", "{}");
  REQUIRE(chmod((folder / "closed").c_str(), 0) == 0);
  for (const auto& [file, why] : {std::pair<std::string, std::string>{"folder", "is a directory"},
                                  {"closed", "permission denied"},
                                  {"nowhere", "no such file"},
                                  {"/dev/null", "/dev/null: "}}) {
    expect(2, call("replay r.csv --summary " + file, folder, drop_rights_before_exec), {why});
  }
  CHECK(folder.files() == Names{"closed", "folder", "in.yaml", "r.csv"});
}

TEST_CASE("an option with an empty value is refused, as from an unset variable") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  for (const std::string option : {"-o", "--error", "--summary", "--replay", "--set"}) {
    expect(2, "run in.yaml " + option + " ''", folder, {"found nothing", option});
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
    expect(0, "run " + name + ".yaml -q", folder);
    const std::string first = folder.read(name + ".csv");
    expect(0, "run " + name + ".yaml -q", folder);
    CHECK(folder.read(name + ".csv") == first);
  }
}

TEST_CASE("standard output redirected to an input is detected, and devices never conflict") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  for (const char* const line : {"run in.yaml -q -o -", "check in.yaml", "verify in.yaml",
                                 "compare in.yaml in.yaml", "accuracy in.yaml"}) {
    expect(2, call_into("in.yaml", line, folder));
  }
  CHECK(folder.read("in.yaml") == short_scene);
  expect(0, "run in.yaml -q -o /dev/null --summary /dev/null", folder);
}

TEST_CASE("the instruction set is named") {
  const Folder folder;
  const std::string version = expect(0, "--version", folder).out;
  CHECK_THAT(version, Catch::Matchers::Matches(
                          "bbsim " BBSIM_VERSION "\n"
                          "instruction set: [a-z0-9]+\n"
                          "commit: ([0-9a-f]{7,}(, with changes)?|unknown: .*)\n"
                          "libraries: SUNDIALS [0-9.]+, Eigen [0-9.]+, yaml-cpp [0-9.]+, CLI11 "
                          "[0-9.]+, nlohmann-json [0-9.]+, HDF5 [0-9.]+\n"));
  folder.write("in.yaml", short_scene);
  expect(0, "run in.yaml -q --summary s.json", folder);
  CHECK("instruction set: " + summary_of(folder, "s.json")["instruction_set"].get<std::string>() ==
        lines(version)[1]);
  expect(2, call_with("BBSIM_SIMD", "none", "--version", folder));
}

TEST_CASE("files name the commit beside the version") {
  const Folder folder;
  const std::string commit = lines(call("--version").out)[2].substr(8);
  std::string version = BBSIM_VERSION;
  if (!commit.starts_with("unknown")) {
    const std::size_t end = commit.find(',');
    version += "+g" + commit.substr(0, end) + (end == std::string::npos ? "" : ".changed");
  }
  folder.write("in.yaml", short_scene);
  expect(0, "run in.yaml -q -o r.h5 --summary r.json", folder);
  expect(0, "sweep in.yaml -q --vary gravity=list:9,10 -o s.h5 --summary s.json", folder);
  for (const std::string name : {"r", "s"}) {
    CHECK(summary_of(folder, name + ".json")["version"] == version);
    CHECK(contains(folder.read(name + ".h5"), version));
  }
}

TEST_CASE("an extension in capitals means the same format in every command") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  expect(0, "run in.yaml -q -o A.H5", folder);
  expect(0, "run in.yaml -q -o A.CSV", folder);
  expect(0, "compare A.H5 A.CSV", folder);
  for (const std::string ending : {".H5", ".HDF5", ".CSV"}) {
    for (const std::string part : {"1", "2"}) {
      expect(0,
             "sweep in.yaml -q --vary gravity=linear:1:2:40 --shard " + part + "/2 -o p" + part +
                 ending,
             folder);
    }
    expect(0, "merge p1" + ending + " p2" + ending + " -o m" + ending, folder);
  }
  expect(2, "merge p1.CSV p2.CSV -o m.txt", folder, {".csv, .h5 and .hdf5"});
}

TEST_CASE("a folder name that is not UTF-8 does not stop a sweep with a table") {
  const Folder folder;
  fs::create_directory(folder / "s\xff");
  folder.write("s\xff/in.yaml", scene_with_table);
  folder.write("s\xff/t.csv", samples);
  expect(0, "sweep s\xff/in.yaml --vary gravity=list:1,2 -o s.csv", folder);
}

TEST_CASE("if fewer threads are available, fewer are used") {
  if (under_sanitizers) return;
  const Folder folder;
  folder.write("in.yaml", short_scene);
  const std::string sweep = "sweep in.yaml --vary gravity=linear:1:2:5000 --measure end_vx ";
  const auto few_threads = [] {
    limit(RLIMIT_STACK, rlim_t{1} << 30U);  // the size of each thread's stack
    limit(RLIMIT_AS, rlim_t{3} << 30U);
  };
  expect(0, call(sweep + "-j 64 -o few.csv", folder, few_threads),
         {"no more than ", " of 64 threads"});
  expect(0, sweep + "-j 1 -o one.csv", folder);
  CHECK(folder.read("few.csv") == folder.read("one.csv"));
}

TEST_CASE("memory that runs out ends the program with a message, not a signal") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  for (rlim_t kilobytes = 4000; kilobytes <= 16000; kilobytes += 100) {
    const Result result =
        call("run in.yaml -q -o a.csv", folder, [=] { limit(RLIMIT_AS, kilobytes * 1024); });
    CAPTURE(kilobytes, result.exit_code, result.err);
    // 127: the loader ran out of memory. SIGKILL, SIGSEGV: the kernel could not start the program.
    const bool before_main = result.err.find("bbsim") == 0 || result.err.empty();
    CHECK((result.exit_code < 128 || before_main));
    CHECK(result.exit_code != 128 + SIGABRT);
  }
}

TEST_CASE("without the HDF5 module a sweep to HDF5 ends before its first case") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  expect(3,
         call_with("BBSIM_MODULE_PATH", folder.path(),
                   "sweep in.yaml --vary gravity=list:1,2 -o s.h5", folder),
         {"the HDF5 module"});
  CHECK(folder.files() == Names{"in.yaml"});
}

TEST_CASE(
    "a write-protected target and a folder that cannot be searched are refused by all alike") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  folder.write("s.csv", "old");
  REQUIRE(chmod((folder / "s.csv").c_str(), 0444) == 0);
  fs::create_directory(folder / "closed");
  REQUIRE(chmod((folder / "closed").c_str(), 0) == 0);
  for (const std::string file : {"s.csv", "closed/s.csv"}) {
    for (const std::string command : {"run in.yaml", "sweep in.yaml --vary gravity=list:1,2"}) {
      expect(3, call(command + " -o " + file, folder, drop_rights_before_exec),
             {"permission denied"});
    }
  }
  CHECK(folder.read("s.csv") == "old");
  CHECK(folder.files() == Names{"closed", "in.yaml", "s.csv"});
}

TEST_CASE("sweep outputs that cannot be written give exit code 3") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  fs::create_symlink("loop.csv", folder / "loop.csv");
  REQUIRE(mkfifo((folder / "f.csv.part").c_str(), 0600) == 0);
  for (const std::string& file : {std::string("loop"), std::string(300, 'n'), std::string("f")}) {
    const std::string line = "sweep in.yaml --vary gravity=list:1,2 -o " + file + ".csv";
    CHECK(expect(3, line, folder, {"cannot write "}).seconds < 20);
  }
}

}  // namespace bbsim_test::test_files
