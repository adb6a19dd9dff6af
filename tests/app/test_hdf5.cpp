// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5 results: equal runs give equal bytes, with everything needed to repeat them.
#include <algorithm>
#include <string>
#include <vector>

#include "base/number_text.hpp"
#include "catch.hpp"
#include "file/hdf5_table.hpp"
#include "process.hpp"

namespace bbsim_test::test_hdf5 {

// Inside, `bbsim` is the function that runs the program; `bbsim::` remains the namespace.
namespace bbsim_test {

using bbsim::file::AttributeValue;
using bbsim::file::Hdf5TableReader;
using bbsim::file::InputTable;
using Catch::Matchers::Contains;

namespace {

AttributeValue attribute_of(const Hdf5TableReader& file, const std::string& name) {
  for (const auto& [known, value] : file.head().attributes) {
    if (known == name) return value;
  }
  return "absent";
}

std::string as_csv(const bbsim::file::TableData& table) {
  std::string text;
  for (const std::string& name : table.names) text += (text.empty() ? "" : ",") + name;
  for (std::size_t row = 0; row < table.columns[0].size(); ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      text += c == 0 ? '\n' : ',';
      text += bbsim::number_text(table.columns[c][row]);
    }
  }
  return text + '\n';
}

void run(const std::vector<std::string>& arguments, const Folder& folder) {
  const Result result = bbsim(arguments, folder.path());
  CAPTURE(arguments, result.err);
  REQUIRE(result.exit_code == 0);
}

}  // namespace

TEST_CASE("equal runs give the same HDF5 file byte for byte, whatever its name") {
  const Folder folder;
  for (const std::string name : {"a.h5", "b.h5"}) {
    run({"run", config("rig.yaml"), "-q", "--set", "time.end=1", "-o", name}, folder);
    run({"run", config("hold.yaml"), "-q", "--error", "1e-6", "-o", "error-" + name}, folder);
    run({"sweep", config("fig2a.yaml"), "-q", "--vary", "ball.radius=linear:0.01:0.02:40", "-j",
         name == "a.h5" ? "1" : "2", "-o", "sweep-" + name},
        folder);
  }
  for (const std::string kind : {"", "error-", "sweep-"}) {
    CAPTURE(kind);
    const std::string a = folder.read(kind + "a.h5");
    CHECK_FALSE(a.empty());
    const bool same = a == folder.read(kind + "b.h5");
    CHECK(same);
  }
}

TEST_CASE("a run can be repeated byte for byte from its HDF5 file alone") {
  const Folder folder, other;
  run({"run", config("recorded.yaml"), "-q", "--set", "time.step=0.05", "-o", folder / "a.h5"},
      folder);
  Hdf5TableReader file(folder / "a.h5");
  other.write("recorded.yaml", attribute_of(file, "scenario_text").text());
  const std::vector<InputTable> inputs = file.read_inputs();
  REQUIRE(inputs.size() == 1);
  for (const auto& [name, data] : inputs) other.write(name, as_csv(*data));
  CHECK(attribute_of(file, "overrides") == AttributeValue("time.step=0.05"));
  run({"run", "recorded.yaml", "-q", "--set", "time.step=0.05", "-o", "a.h5"}, other);

  run({"run", config("recorded.yaml"), "-q", "--set", "time.step=0.05", "-o", "a.csv"}, folder);
  run({"run", "recorded.yaml", "-q", "--set", "time.step=0.05", "-o", "a.csv"}, other);
  CHECK(folder.read("a.csv") == other.read("a.csv"));
  const Hdf5TableReader again(other / "a.h5");
  CHECK(again.rows() == file.rows());
  CHECK(again.columns() == file.columns());
}

TEST_CASE("with a bound on the error, each row has its error estimate") {
  const Folder folder;
  run({"run", config("fig2b.yaml"), "-q", "--error", "1 um", "-o", "a.h5"}, folder);
  run({"run", config("fig2b.yaml"), "-q", "-o", "b.h5"}, folder);
  Hdf5TableReader file(folder / "a.h5");
  const auto column = std::find_if(file.columns().begin(), file.columns().end(),
                                   [](const auto& one) { return one.name == "position_error"; });
  REQUIRE(column != file.columns().end());
  CHECK(column->unit == "m");
  bbsim::file::Hdf5Block block;
  CHECK(file.read(block));
  const auto& errors = block.values[static_cast<std::size_t>(column - file.columns().begin())];
  REQUIRE(errors.size() == file.rows());
  const double greatest = *std::max_element(errors.begin(), errors.end());
  CHECK(attribute_of(file, "error_estimate") == AttributeValue(greatest));
  CHECK(greatest < 1e-6);
  CHECK(attribute_of(file, "error_bound") == AttributeValue(1e-6));
  const Hdf5TableReader without(folder / "b.h5");
  CHECK(without.columns().size() == file.columns().size() - 1);
}

TEST_CASE("a sweep's HDF5 file has numbers as numbers, units of the keys, and input tables") {
  const Folder folder;
  run({"sweep", config("recorded.yaml"), "-q", "--vary", "ball.position.0=linear:0:0.1:5", "--vary",
       "ball.spin=normal:0:1", "--vary", "ball.inertia_factor=list:0.4,0.5", "--samples", "2",
       "--seed", "9", "-o", "a.h5"},
      folder);
  Hdf5TableReader file(folder / "a.h5");
  CHECK(attribute_of(file, "cases") == AttributeValue(20));
  CHECK(attribute_of(file, "samples") == AttributeValue(2));
  CHECK(attribute_of(file, "seed") == AttributeValue(9));
  CHECK(file.columns()[1].unit == "m");
  CHECK(file.columns()[2].unit == "rad/s");
  CHECK(file.columns()[3].unit.empty());
  CHECK(file.read_inputs().size() == 1);
}

TEST_CASE("parts of a sweep are merged with their tables, and refused if these differ") {
  const Folder folder;
  const std::string rows = "\n0,0\n1,0.01\n2,0\n3,0.01\n";
  folder.write("table.csv", "t,phi" + rows);
  folder.write("scene.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: {table: {file: table.csv, time: t, value: phi}}}}\n"
               "time: {end: 3, step: 1}\n");
  const auto sweep = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"sweep",
                                       "scene.yaml",
                                       "-q",
                                       "--vary",
                                       "ball.position.0=linear:0:0.1:8",
                                       "--keep-trajectories"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run(arguments, folder);
  };
  sweep({"-o", "whole.h5"});
  sweep({"--shard", "1/2", "-o", "part-1of2.h5"});
  sweep({"--shard", "2/2", "-o", "part-2of2.h5"});
  run({"merge", "part-1of2.h5", "part-2of2.h5", "-q", "-o", "merged.h5"}, folder);
  const bool same = folder.read("merged.h5") == folder.read("whole.h5");
  CHECK(same);

  folder.write("table.csv", "t,phi" + rows + "4,0\n");
  sweep({"--shard", "2/2", "-o", "part-2of2.h5"});
  const Result result =
      bbsim({"merge", "part-1of2.h5", "part-2of2.h5", "-o", "other.h5"}, folder.path());
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Contains("part-2of2.h5: found other columns or another scenario"));
}

TEST_CASE("an endless device is refused before it fills the memory") {
  const Result result = bbsim({"compare", "/dev/zero", "/dev/zero"});
  CHECK(result.exit_code == 2);
  CHECK(result.err ==
        "/dev/zero:1:1: found a line of more than 1048576 bytes; allowed: rows of a table, one a "
        "line\n");
}

// tests/data/hdf5-0.3.0 is of bbsim 0.3.0: recorded.yaml, and falls.yaml with trajectories.
TEST_CASE("files of version 0.3.0 are read") {
  const std::string then = BBSIM_SOURCE_DIR "/tests/data/hdf5-0.3.0/";
  const auto same = [](const std::string& a, const std::string& b) {
    const Result result = bbsim({"compare", a, b, "--rtol", "0", "--atol", "0"});
    INFO(result.out << result.err);
    CHECK(result.exit_code == 0);
  };
  same(then + "run.csv", then + "run.h5");
  Hdf5TableReader file(then + "run.h5");
  CHECK(attribute_of(file, "status") == AttributeValue("done"));
  CHECK(file.read_inputs().at(0).data->names.at(0) == "t");
  const Folder folder;
  run({"merge", then + "sweep.h5", "-q", "-o", "merged.h5"}, folder);
  same(folder / "merged.h5", then + "sweep.h5");
  const Result cases = bbsim({"compare", then + "sweep.csv", then + "sweep.h5"});
  // The CSV has no trajectories.
  CHECK_THAT(cases.out, Catch::Contains("\nmax_distance                      0       0"));
}

}  // namespace bbsim_test

}  // namespace bbsim_test::test_hdf5
