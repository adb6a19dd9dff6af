// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Limits of the system, rights, and signals; transcripts/files.txt has more of files.
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_files {

using Names = std::vector<std::string>;
namespace fs = std::filesystem;

namespace {

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

}  // namespace

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

TEST_CASE("a merge that cannot open its parts reports it and writes nothing") {
  if (under_sanitizers) return;
  const Folder folder;
  folder.write("in.yaml", short_scene);
  const std::string sweep = "sweep in.yaml -q --vary gravity=linear:1:2:40 --shard ";
  for (const std::string part : {"1", "2"}) {
    expect(0, sweep + part + "/2 -o " + part + ".csv", folder);
  }
  const Result result = call("merge 1.csv 2.csv -o m.csv", folder, [] { limit(RLIMIT_NOFILE, 4); });
  CHECK((result.exit_code == 2 || result.exit_code == 3));
  CHECK(contains(result.err, "too many open files"));
  CHECK_FALSE(fs::exists(folder / "m.csv"));
}

TEST_CASE("merges end at a signal with 130 and leave no incomplete file") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  CAPTURE(signal);
  const Folder folder;
  std::string rows = "case,gravity,status,reason,end_time\n";
  for (int i = 0; i < 400000; ++i) rows += std::to_string(i) + ",9.81,done,,10\n";
  folder.write("p.csv", rows);
  int interrupted = 0;
  for (int after = 0; after < 60 && interrupted < 3; after += 3) {
    const Result result = bbsim(Launch{words_of("merge p.csv -o m.csv"), folder.path(), signal,
                                       std::chrono::milliseconds(after)});
    const bool by_signal_before_main = result.exit_code == 128 + signal;
    CHECK((result.exit_code == 0 || result.exit_code == 130 || by_signal_before_main));
    CHECK(folder.files() == (result.exit_code == 0 ? Names{"m.csv", "p.csv"} : Names{"p.csv"}));
    if (result.exit_code == 130) ++interrupted;
    fs::remove(folder / "m.csv");
  }
}

}  // namespace bbsim_test::test_files
