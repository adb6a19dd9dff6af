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

using bbsim::file::AttributeValue;
using bbsim::file::Hdf5TableReader;
using bbsim::file::InputTable;

namespace {

AttributeValue attribute_of(const Hdf5TableReader& file, const std::string& name) {
  for (const auto& [known, value] : file.head().attributes) {
    if (known == name) return value;
  }
  return "absent";
}

std::string as_csv(const bbsim::file::Table& table) {
  std::string text;
  for (const std::string& name : table.names()) text += (text.empty() ? "" : ",") + name;
  for (std::size_t row = 0; row < table.columns[0].numbers.size(); ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      text += c == 0 ? '\n' : ',';
      text += bbsim::number_text(table.columns[c].numbers[row]);
    }
  }
  return text + '\n';
}

}  // namespace

TEST_CASE("equal runs give the same HDF5 file byte for byte, whatever its name") {
  const Folder folder;
  const std::string line =
      GENERATE("run @rig.yaml -q --set time.end=1 -o ", "run @hold.yaml -q --error 1e-6 -o ",
               "sweep @fig2a.yaml -q --vary ball.radius=linear:0.01:0.02:40 -o ");
  const bool sweeps = line.starts_with("sweep");
  expect(0, line + "a.h5" + (sweeps ? " -j 1" : ""), folder);
  expect(0, line + "b.h5" + (sweeps ? " -j 2" : ""), folder);
  const std::string a = folder.read("a.h5");
  CHECK_FALSE(a.empty());
  const bool same = a == folder.read("b.h5");
  CHECK(same);
}

TEST_CASE("a run can be repeated byte for byte from its HDF5 file alone") {
  const Folder folder, other;
  const std::string run = "recorded.yaml -q --set time.step=0.05 -o a.";
  expect(0, "run @" + run + "h5", folder);
  Hdf5TableReader file(folder / "a.h5");
  other.write("recorded.yaml", attribute_of(file, "scenario_text").text());
  const std::vector<InputTable> inputs = file.read_inputs();
  REQUIRE(inputs.size() == 1);
  for (const auto& [name, data] : inputs) other.write(name, as_csv(*data));
  CHECK(attribute_of(file, "overrides") == AttributeValue("time.step=0.05"));
  expect(0, "run " + run + "h5", other);

  expect(0, "run @" + run + "csv", folder);
  expect(0, "run " + run + "csv", other);
  CHECK(folder.read("a.csv") == other.read("a.csv"));
  const Hdf5TableReader again(other / "a.h5");
  CHECK(again.rows() == file.rows());
  CHECK(again.columns() == file.columns());
}

TEST_CASE("with a bound on the error, each row has its error estimate") {
  const Folder folder;
  expect(0, "run @fig2b.yaml -q --error '1 um' -o a.h5", folder);
  expect(0, "run @fig2b.yaml -q -o b.h5", folder);
  Hdf5TableReader file(folder / "a.h5");
  const auto column = std::ranges::find_if(
      file.columns(), [](const auto& one) { return one.name == "position_error"; });
  REQUIRE(column != file.columns().end());
  CHECK(column->unit == "m");
  bbsim::file::Hdf5Block block;
  CHECK(file.read(block));
  const auto& errors = block.values[static_cast<std::size_t>(column - file.columns().begin())];
  REQUIRE(errors.size() == file.rows());
  const double greatest = *std::ranges::max_element(errors);
  CHECK(attribute_of(file, "error_estimate") == AttributeValue(greatest));
  CHECK(greatest < 1e-6);
  CHECK(attribute_of(file, "error_bound") == AttributeValue(1e-6));
  CHECK(Hdf5TableReader(folder / "b.h5").columns().size() == file.columns().size() - 1);
}

TEST_CASE("a sweep's HDF5 file has numbers as numbers, units of the keys, and input tables") {
  const Folder folder;
  expect(0,
         "sweep @recorded.yaml -q --vary ball.position.0=linear:0:0.1:5 --vary "
         "ball.spin=normal:0:1 --vary ball.inertia_factor=list:0.4,0.5 --samples 2 --seed 9 -o "
         "a.h5",
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
  const std::string rows = "t,phi\n0,0\n1,0.01\n2,0\n3,0.01\n";
  folder.write("table.csv", rows);
  folder.write("scene.yaml",
               "ball: {radius: 0.01}\n"
               "gimbal: {motion: {phi: {table: {file: table.csv, time: t, value: phi}}}}\n"
               "time: {end: 3, step: 1}\n");
  const std::string sweep =
      "sweep scene.yaml -q --vary ball.position.0=linear:0:0.1:8 --keep-trajectories -o ";
  expect(0, sweep + "whole.h5", folder);
  expect(0, sweep + "part-1of2.h5 --shard 1/2", folder);
  expect(0, sweep + "part-2of2.h5 --shard 2/2", folder);
  expect(0, "merge part-1of2.h5 part-2of2.h5 -q -o merged.h5", folder);
  const bool same = folder.read("merged.h5") == folder.read("whole.h5");
  CHECK(same);

  folder.write("table.csv", rows + "4,0\n");
  expect(0, sweep + "part-2of2.h5 --shard 2/2", folder);
  expect(2, "merge part-1of2.h5 part-2of2.h5 -o other.h5", folder,
         {"part-2of2.h5: found other columns or another scenario"});
}

TEST_CASE("an endless device is refused before it fills the memory") {
  expect(2, call("compare /dev/zero /dev/zero"),
         {"/dev/zero:1:1: found a line of more than 1048576 bytes; allowed: "});
}

// tests/data/hdf5-0.3.0 is of bbsim 0.3.0: recorded.yaml, and falls.yaml with trajectories.
TEST_CASE("files of version 0.3.0 are read") {
  const Folder folder;
  const std::string then = "%tests/data/hdf5-0.3.0/", exactly = " --rtol 0 --atol 0";
  expect(0, "compare " + then + "run.csv " + then + "run.h5" + exactly, folder);
  Hdf5TableReader file(BBSIM_SOURCE_DIR "/tests/data/hdf5-0.3.0/run.h5");
  CHECK(attribute_of(file, "status") == AttributeValue("done"));
  CHECK(file.read_inputs().at(0).data->columns.at(0).name == "t");
  expect(0, "merge " + then + "sweep.h5 -q -o merged.h5", folder);
  expect(0, "compare merged.h5 " + then + "sweep.h5" + exactly, folder);
  // The CSV has no trajectories.
  const Result cases = call("compare " + then + "sweep.csv " + then + "sweep.h5");
  CHECK(contains(cases.out, "\nmax_distance                      0       0"));
}

TEST_CASE("columns of numbers of any HDF5 file are a scenario's table") {
  const Folder folder;
  expect(0,
         "sweep @fig2a.yaml -q --vary ball.radius=linear:0.01:0.02:6 --keep-trajectories -o s.h5",
         folder);
  const auto scenario = [&](const std::string& column) {
    folder.write("table.yaml",
                 "ball: {radius: 1 cm}\ntime: {end: 5, step: 1}\n"
                 "gimbal: {motion: {phi: {table: {file: s.h5, time: case, unit: rad, value: " +
                     column + "}}}}\n");
  };
  scenario("ball.radius");
  expect(0, "run table.yaml -q -o run.h5", folder);
  CHECK(Hdf5TableReader(folder / "run.h5").read_inputs().at(0).data->find("case") != nullptr);
  scenario("status");
  expect(2, "check table.yaml", folder, {"column status, row 1: found \"done\""});
}

}  // namespace bbsim_test::test_hdf5
