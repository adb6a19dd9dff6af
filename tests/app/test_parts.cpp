// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Parts of sweeps that are merged, and commands that end at a signal.
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_parts {

using Names = std::vector<std::string>;
namespace fs = std::filesystem;

namespace {

// A folder with a scenario, and with a sweep of it in two parts.
struct Parts : Folder {
  explicit Parts(const std::string& format = "csv", const std::string& first_set = "",
                 const std::string& second_set = "")
      : ending('.' + format) {
    write("in.yaml", short_scene);
    make("1", "", first_set);
    make("2", "", second_set);
  }
  void make(const std::string& part, const std::string& more = "",
            const std::string& set = "") const {
    const std::string line = "sweep in.yaml -q --vary gravity=linear:1:2:40 --shard " + part +
                             "/2 -o p-" + part + "of2" + ending + more;
    expect(0, set.empty() ? call(line, *this) : call_with("BBSIM_SIMD", set, line, *this));
  }
  [[nodiscard]] std::string merge() const {
    return "merge p-1of2" + ending + " p-2of2" + ending + " -o m" + ending;
  }
  std::string ending;
};

// Whether the machine has two instruction sets to compare.
bool has_two() {
  const Folder folder;
  return call_with("BBSIM_SIMD", "sse2", "--version", folder).exit_code == 0 &&
         call_with("BBSIM_SIMD", "avx2", "--version", folder).exit_code == 0;
}

}  // namespace

TEST_CASE("a merge does not overwrite its parts") {
  const Parts folder;
  const std::string first = folder.read("p-1of2.csv");
  expect(2, "merge p-1of2.csv p-2of2.csv -o p-1of2.csv", folder,
         {"p-1of2.csv (a part), which is read here"});
  CHECK(folder.read("p-1of2.csv") == first);
}

TEST_CASE("a merge that cannot read its parts reports it and writes nothing") {
  const Parts folder;
  if (!under_sanitizers) {
    const Result result = call(folder.merge(), folder, [] {
      const rlimit four{4, 4};
      setrlimit(RLIMIT_NOFILE, &four);
    });
    CHECK((result.exit_code == 2 || result.exit_code == 3));
    CHECK(contains(result.err, "too many open files"));
    CHECK_FALSE(fs::exists(folder / "m.csv"));
  }
  REQUIRE(mkfifo((folder / "p-3of3.csv").c_str(), 0600) == 0);
  CHECK(expect(2, "merge p-3of3.csv -o m.csv", folder).seconds < 20);
}

TEST_CASE("parts of a different sweep are refused by plan, other instruction sets are noted") {
  const Parts folder;
  CHECK(folder.files() ==
        Names{"in.yaml", "p-1of2.csv", "p-1of2.csv.plan", "p-2of2.csv", "p-2of2.csv.plan"});
  expect(0, folder.merge(), folder, {"m.csv: 40 cases from 2 parts"});
  CHECK_FALSE(fs::exists(folder / "m.csv.plan"));

  SECTION("another scenario") {
    folder.make("2", " --set ball.radius=0.02");
    expect(2, folder.merge(), folder,
           {"of another sweep than p-1of2.csv: their plans differ in overrides"});
    fs::remove(folder / "p-2of2.csv.plan");  // an older version wrote no plans
    expect(0, folder.merge(), folder);
  }
  SECTION("the last part is missing, whatever the file names") {
    fs::rename(folder / "p-1of2.csv", folder / "first.csv");
    fs::rename(folder / "p-1of2.csv.plan", folder / "first.csv.plan");
    expect(2, "merge first.csv -o m.csv", folder, {"found 16 cases of 40"});
  }
  SECTION("an invalid plan") {
    folder.write("p-2of2.csv.plan", "nonsense");
    expect(2, folder.merge(), folder, {"found no plan of bbsim sweep"});
  }
  SECTION("an incomplete row") {
    const std::string text = folder.read("p-2of2.csv");
    folder.write("p-2of2.csv", text.substr(0, text.size() - 30) + "\n");
    expect(2, folder.merge(), folder, {"in row 24 below the header"});
  }
}

TEST_CASE("parts of several instruction sets are merged and noted, and an HDF5 file names them") {
  if (!has_two()) return;
  const std::string format = GENERATE("csv", "h5");
  const Parts folder(format, "sse2", "avx2");
  expect(0, folder.merge(), folder,
         {"the parts are of avx2 and sse2: alike within the tolerance, not bit for bit"});
  if (format == "h5") CHECK(contains(folder.read("m.h5"), "avx2 and sse2"));
}

TEST_CASE("a sweep's summary has its plan, its engine and how its cases ended") {
  const Folder folder;
  expect(0,
         "sweep @fig2b-literal.yaml -q --vary controller.pd.kv=list:0.001,100 --set time.end=1 -o "
         "s.csv --summary s.json",
         folder);
  CHECK(folder.files() == Names{"s.csv", "s.json"});
  const auto summary = summary_of(folder, "s.json");
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
  const auto interrupt = [&](const std::string& line, int after) {
    return bbsim(Launch{words_of(line), folder.path(), signal, std::chrono::milliseconds(after)});
  };
  SECTION("run") {
    expect(130, interrupt("run long.yaml", 1500), {"interrupted at t = "});
    CHECK(folder.files() == Names{"long.csv", "long.yaml"});
  }
  SECTION("merge") {
    std::string rows = "case,gravity,status,reason,end_time\n";
    for (int i = 0; i < 400000; ++i) rows += std::to_string(i) + ",9.81,done,,10\n";
    folder.write("p.csv", rows);
    int interrupted = 0;
    for (int after = 0; after < 60 && interrupted < 3; after += 3) {
      const Result result = interrupt("merge p.csv -o m.csv", after);
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
  folder.write("in.yaml", short_scene);
  Launch launch{words_of("sweep in.yaml -q --vary time.step=uniform:1e-5:2e-5 --samples 100 -j 1 "
                         "-o s.csv"),
                folder.path(), SIGHUP, std::chrono::milliseconds(50)};
  launch.prepare = [] { static_cast<void>(std::signal(SIGHUP, SIG_IGN)); };  // nohup
  expect(0, bbsim(launch));
}

TEST_CASE("an interrupted sweep to standard output has printed its finished cases") {
  const Folder folder;
  folder.write("slow.yaml", long_scene);
  const Result result =
      expect(130, bbsim(Launch{words_of("sweep slow.yaml --set time.end=300 --vary "
                                        "gravity=linear:1:2:100000 --measure end_vx -j 1 -o -"),
                               folder.path(), SIGINT, std::chrono::milliseconds(2500)}));
  std::size_t finished = 0;
  REQUIRE(std::sscanf(result.err.c_str(), "interrupted after %zu of", &finished) == 1);
  CHECK(finished > 0);
  CHECK(count(result.out, "\n") == finished + 1);
}

TEST_CASE("a resumed sweep counts the earlier cases too") {
  const Folder folder;
  const std::string sweep = "sweep @falls.yaml --vary ball.mass=linear:0.1:0.2:900 -j 1 -o s.csv";
  expect(137, signal_once(folder, "s.csv.part", 10000, SIGKILL, sweep));
  expect(0, sweep + " --resume --summary s.json", folder,
         {" of them from the earlier run, 900 ended early (see status)"});
  CHECK(summary_of(folder, "s.json").at("statuses") == nlohmann::json{{"stopped", 900}});
}

TEST_CASE("a damaged part is truncated at the damage, and this is reported") {
  const Folder folder;
  folder.write("in.yaml", short_scene);
  const std::string sweep =
      "sweep in.yaml -q --vary time.step=uniform:1e-4:2e-4 --samples 3000 -j 1 -o ";
  expect(0, sweep + "whole.csv", folder);
  signal_once(folder, "s.csv.part", 10000, SIGKILL, sweep + "s.csv");
  std::string part = folder.read("s.csv.part");
  REQUIRE(part.size() > 5000);
  part.replace(4096, 200, 200, '\0');
  folder.write("s.csv.part", part);
  expect(0, sweep + "s.csv --resume", folder, {"is not as it was written; continuing from case "});
  const bool alike = folder.read("s.csv") == folder.read("whole.csv");
  CHECK(alike);
}

}  // namespace bbsim_test::test_parts
