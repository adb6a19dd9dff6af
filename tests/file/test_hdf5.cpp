// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5: written and read back bit for bit, with units, description and scale where other programs
// look for them.
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <memory>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "support/folder.hpp"
#include "support/hdf5.hpp"
#include "support/tables.hpp"

namespace bbsim_test::test_hdf5 {

using bbsim::OutputError;
using bbsim::file::hdf5_module_folders;
using bbsim::file::Hdf5Block;
using bbsim::file::Hdf5TableReader;
using bbsim::file::InputTable;
using bbsim::file::open_hdf5_module;
using bbsim::file::open_table;
using bbsim::file::read_table;
using bbsim::file::Table;
using Catch::Matchers::Contains;

namespace {

// A string attribute of an object, read with HDF5 itself; "" if it is not a UTF-8 string of exactly
// fitting fixed length.
std::string attribute_of(hid_t file, const char* object, const char* name) {
  const Handle attribute(H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose);
  std::string text;
  if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
      H5Tget_cset(type) == H5T_CSET_UTF8) {
    text.resize(H5Tget_size(type));
    H5Aread(attribute, type, text.data());
    text.resize(text.size() - 1);  // without the terminator
  }
  return text;
}

// Type of an attribute of the root, and its value as a double.
struct Number {
  H5T_class_t kind;
  std::size_t bytes;
  double value;
};
Number number_of(hid_t file, const char* name) {
  const Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose);
  Number number{H5Tget_class(type), H5Tget_size(type), 0};
  H5Aread(attribute, H5T_NATIVE_DOUBLE, &number.value);
  return number;
}

}  // namespace

TEST_CASE("HDF5 round-trips bit for bit, in order") {
  const Folder folder;
  for (const std::string name : {"a.h5", "a.hdf5", "A.H5"}) {
    Table table = random_table(12, 3000);  // c10 comes before c2 by name
    table.columns[3].name = "t";
    write_table(folder / name, table);
    const Table back = read_table(folder / name);
    REQUIRE(back.names() == table.names());
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      CHECK(same_bits(back.columns[c].numbers, table.columns[c].numbers));
    }
  }
  CHECK(folder.entries() == 3);
}

TEST_CASE("HDF5 without rows, without t, and with one row") {
  const Folder folder;
  write_table(folder / "none.h5", {{"t", "x"}, {{}, {}}});
  CHECK(numbers_of(read_table(folder / "none.h5")) == std::vector<std::vector<double>>{{}, {}});
  write_table(folder / "x.h5", {{"x"}, {{1.5}}});
  CHECK(numbers_of(read_table(folder / "x.h5")) == std::vector<std::vector<double>>{{1.5}});
  write_table(folder / "t.h5", {{"t"}, {{1.5}}});
  CHECK(numbers_of(read_table(folder / "t.h5")) == std::vector<std::vector<double>>{{1.5}});
}

TEST_CASE("HDF5 carries units, descriptions, the scale t and the run's attributes") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const std::string long_text(200000, 'y');  // more than a compact attribute holds
  write_table(file, {{"x", "t"}, {{1, 2, 3}, {0, 0.1, 0.2}}},
              {{"title", "ψ, über"}, {"scenario_text", long_text}, {"empty", ""}});

  const Handle id = opened(file);
  REQUIRE(id >= 0);
  CHECK(attribute_of(id, "x", "unit") == "m");
  CHECK(attribute_of(id, "x", "units") == "m");
  CHECK(attribute_of(id, "x", "description") == "one value a row");
  CHECK(attribute_of(id, "t", "unit") == "m");
  CHECK(attribute_of(id, "/", "title") == "ψ, über");
  CHECK(attribute_of(id, "/", "scenario_text") == long_text);
  CHECK(H5Aexists(id, "empty") > 0);

  const Handle x = dataset_of(id, "x"), t = dataset_of(id, "t");
  CHECK(H5DSis_scale(t) > 0);
  CHECK(H5DSis_scale(x) == 0);
  CHECK(H5DSis_attached(x, t, 0) > 0);
  const Handle space(H5Dget_space(x), H5Sclose);
  hsize_t size = 0, most = 0;
  REQUIRE(H5Sget_simple_extent_ndims(space) == 1);
  H5Sget_simple_extent_dims(space, &size, &most);
  CHECK(size == 3);
  CHECK(most == H5S_UNLIMITED);
  CHECK(H5Tequal(type_of(x), H5T_IEEE_F64LE) > 0);
}

TEST_CASE("numeric attributes are numbers") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  write_table(file, {{"t"}, {{0}}},
              {{"rtol", 1e-8}, {"rows", std::size_t{1} << 40U}, {"below", -1}, {"text", "1e-8"}});
  const Handle id = opened(file);
  REQUIRE(id >= 0);
  const Number rtol = number_of(id, "rtol"), rows = number_of(id, "rows");
  CHECK((rtol.kind == H5T_FLOAT && rtol.bytes == 8 && rtol.value == 1e-8));
  CHECK((rows.kind == H5T_INTEGER && rows.bytes == 8 && rows.value == 0x1p40));
  CHECK(number_of(id, "below").value == -1);
  CHECK(attribute_of(id, "/", "text") == "1e-8");
}

TEST_CASE("an unknown unit is not written as one of UDUNITS") {
  const Folder folder;
  const auto writer = open_table(folder / "a.h5", {{"x", "", "a gain"}, {"n", "1", "a count"}});
  writer->finish({});
  const Handle id = opened(folder / "a.h5");
  CHECK(H5Aexists_by_name(id, "x", "unit", H5P_DEFAULT) > 0);
  CHECK(H5Aexists_by_name(id, "x", "units", H5P_DEFAULT) == 0);
  CHECK(attribute_of(id, "n", "units") == "1");
}

TEST_CASE("a column known only at the end is stored with the others") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const std::vector<double> values{1, 2, 3};
  const double* column = values.data();
  {
    const auto writer = open_table(file, {{"t", "s", "time"}});
    writer->append({&column, 1}, 3);
    writer->add_column({"position_error", "m", "estimate"}, {1e-9, 2e-9, 3e-9});
    writer->finish({});
  }
  const Table back = read_table(file);
  CHECK(back.names() == std::vector<std::string>{"t", "position_error"});
  CHECK(back.columns[1].numbers == std::vector<double>{1e-9, 2e-9, 3e-9});
  const Handle id = opened(file);
  CHECK(attribute_of(id, "position_error", "units") == "m");
  CHECK(attribute_of(id, "position_error", "description") == "estimate");
  CHECK(H5DSis_attached(dataset_of(id, "position_error"), dataset_of(id, "t"), 0) > 0);

  const auto writer = open_table(file, {{"t", "s", "time"}});
  writer->append({&column, 1}, 3);
  CHECK_THROWS_AS(writer->add_column({"e", "m", ""}, {1}), OutputError);
}

TEST_CASE("the tables of a scenario are stored with its results, under any name") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const Table motion = random_table(3, 5000);
  const std::vector<double> pair{1, 2};
  const Table odd({"x (m/s)", "x (m_s)", ".", "a/b/c"}, {pair, pair, pair, pair});
  const auto shared = [](const Table& table) { return std::make_shared<const Table>(table); };
  const std::vector<InputTable> inputs{{"motion.csv", shared(motion)},
                                       {"../b/odd.csv", shared(odd)},
                                       {"c/odd.csv", shared(odd)},
                                       {"none.csv", shared({{"t"}, {{}}})}};
  {
    const auto writer = open_table(file, {{"t", "s", "time"}});
    writer->keep(inputs);
    writer->finish({});
  }
  CHECK(read_table(file).names() == std::vector<std::string>{"t"});  // they are not columns

  {
    const Handle id = opened(file);
    CHECK(attribute_of(id, "inputs/motion.csv", "file") == "motion.csv");
    CHECK(attribute_of(id, "inputs/odd.csv", "file") == "../b/odd.csv");
    CHECK(attribute_of(id, "inputs/odd.csv (2)", "file") == "c/odd.csv");
    CHECK(attribute_of(id, "inputs/odd.csv/x (m_s)", "column") == "x (m/s)");
    CHECK(attribute_of(id, "inputs/odd.csv/x (m_s) (2)", "column") == "x (m_s)");
    CHECK(attribute_of(id, "inputs/odd.csv/._", "column") == ".");
    std::vector<double> numbers(5000);
    const Handle stored = dataset_of(id, "inputs/motion.csv/c2");
    REQUIRE(stored >= 0);
    H5Dread(stored, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    CHECK(same_bits(numbers, motion.columns[2].numbers));
  }
  const std::vector<InputTable> back = Hdf5TableReader(file).read_inputs();
  Hdf5TableReader reader(file, 7);
  Hdf5Block block;
  reader.read(block);
  const std::vector<InputTable> after_rows = reader.read_inputs();
  REQUIRE(after_rows.size() == 4);
  CHECK(same_bits(after_rows[0].data->columns[0].numbers, back[0].data->columns[0].numbers));
  REQUIRE(back.size() == 4);
  for (std::size_t i = 0; i < back.size(); ++i) {
    CHECK(back[i].file == inputs[i].file);
    CHECK(back[i].data->names() == inputs[i].data->names());
    REQUIRE(back[i].data->columns.size() == inputs[i].data->columns.size());
    for (std::size_t c = 0; c < back[i].data->columns.size(); ++c) {
      CHECK(same_bits(back[i].data->columns[c].numbers, inputs[i].data->columns[c].numbers));
    }
  }
}

TEST_CASE("the same table gives the same bytes") {
  const Folder folder;
  for (const std::string name : {"a.h5", "b.h5"}) {
    const auto writer = open_table(folder / name, {{"t", "s", ""}, {"x", "m", ""}});
    writer->keep({{"in.csv", std::make_shared<const Table>(random_table(2, 50))}});
    const std::vector<double> t{0, 1}, x{2, 3};
    const std::array<const double*, 2> columns{t.data(), x.data()};
    writer->append(columns, 2);
    writer->add_column({"e", "m", ""}, {5, 6});
    writer->finish({{"status", "done"}, {"rtol", 1e-8}, {"rows", 2}});
    sleep(name == "a.h5" ? 1 : 0);  // HDF5 timestamps objects in whole seconds
  }
  CHECK_FALSE(content_of(folder / "a.h5").empty());
  const bool same = content_of(folder / "a.h5") == content_of(folder / "b.h5");
  CHECK(same);
}

TEST_CASE("HDF5 replaces a file, keeps its permissions and follows a link") {
  const Folder folder;
  const std::string real = folder.put("real.h5", "old");
  REQUIRE(chmod(real.c_str(), 0604) == 0);
  std::filesystem::create_symlink("real.h5", folder / "link.h5");
  write_table(folder / "link.h5", {{"x"}, {{1, 2}}});
  CHECK(std::filesystem::is_symlink(folder / "link.h5"));
  CHECK(permissions_of(real) == 0604);
  CHECK(read_table(real).columns[0].numbers == std::vector<double>{1, 2});
  CHECK_THROWS_AS(open_table(folder / "none/a.h5", {{"x", "m", ""}}), OutputError);
}

TEST_CASE("a missing module is reported with the remedy") {
  const Folder folder;
  const auto none = open_hdf5_module({folder / "a", folder / "b"});
  CHECK(none.functions == nullptr);
  CHECK(none.trouble == "the HDF5 module libbbsim_hdf5.so is not in " + (folder / "a") + " and " +
                            (folder / "b") +
                            "; write or read .csv instead, or install all of bbsim, or set "
                            "BBSIM_MODULE_PATH to the module's folder");

  folder.put("libbbsim_hdf5.so", "no library");
  const auto broken = open_hdf5_module({folder.name()});
  CHECK(broken.functions == nullptr);
  CHECK_THAT(broken.trouble, Contains("the HDF5 module cannot be loaded: ") &&
                                 Contains("write or read .csv instead"));
}

TEST_CASE("the module is found through the environment or beside the program") {
  const char* before = std::getenv("BBSIM_MODULE_PATH");
  const std::string kept = before == nullptr ? "" : before;
  setenv("BBSIM_MODULE_PATH", "/some/folder", 1);
  CHECK(hdf5_module_folders() == std::vector<std::string>{"/some/folder"});
  unsetenv("BBSIM_MODULE_PATH");
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  CHECK(hdf5_module_folders().at(0) == program.parent_path().parent_path() / "lib/bbsim");
  if (before != nullptr) setenv("BBSIM_MODULE_PATH", kept.c_str(), 1);
}

}  // namespace bbsim_test::test_hdf5
