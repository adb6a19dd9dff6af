// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An HDF5 result has everything needed to repeat its run; transcripts/hdf5.txt has more.
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

}  // namespace bbsim_test::test_hdf5
