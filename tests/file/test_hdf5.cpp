// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5: written and read back bit for bit, with units, description and scale where other programs
// look for them. A full disk is an error and not a crash.
#include <hdf5.h>
#include <hdf5_hl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <memory>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/hdf5_module.hpp"
#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "support/folder.hpp"
#include "support/limits.hpp"
#include "support/tables.hpp"

namespace bbsim_test::test_hdf5 {

using bbsim::InputError;
using bbsim::OutputError;
using bbsim::file::hdf5_module_folders;
using bbsim::file::Hdf5Block;
using bbsim::file::Hdf5TableReader;
using bbsim::file::InputTable;
using bbsim::file::open_hdf5_module;
using bbsim::file::open_table;
using bbsim::file::read_table;
using bbsim::file::TableData;
using Catch::Matchers::Contains;

namespace {

// A string attribute of an object, read with HDF5 itself; "" if it is not a UTF-8 string of exactly
// fitting fixed length.
std::string attribute_of(hid_t file, const char* object, const char* name) {
  const hid_t attribute = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  std::string text;
  if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
      H5Tget_cset(type) == H5T_CSET_UTF8) {
    text.resize(H5Tget_size(type));
    H5Aread(attribute, type, text.data());
    text.resize(text.size() - 1);  // without the terminator
  }
  H5Tclose(type);
  H5Aclose(attribute);
  return text;
}

// Type of an attribute of the root, and its value as a double.
struct Number {
  H5T_class_t kind;
  std::size_t bytes;
  double value;
};
Number number_of(hid_t file, const char* name) {
  const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  Number number{H5Tget_class(type), H5Tget_size(type), 0};
  H5Aread(attribute, H5T_NATIVE_DOUBLE, &number.value);
  H5Tclose(type);
  H5Aclose(attribute);
  return number;
}

bool is_attached(hid_t file, const char* dataset, const char* scale, unsigned dimension) {
  const hid_t one = H5Dopen2(file, dataset, H5P_DEFAULT);
  const hid_t other = H5Dopen2(file, scale, H5P_DEFAULT);
  const bool attached = H5DSis_attached(one, other, dimension) > 0;
  H5Dclose(other);
  H5Dclose(one);
  return attached;
}

// Writes a file of doubles or strings as another program might do.
void write_foreign(const std::string& file, const std::string& name, std::vector<hsize_t> sizes,
                   hid_t type) {
  const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr);
  H5Dclose(H5Dcreate2(id, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Fclose(id);
}

std::string refusal(const std::string& file) {
  return message_of<InputError>([&] { (void)read_table(file); });
}

}  // namespace

TEST_CASE("HDF5 round-trips bit for bit, in order") {
  const Folder folder;
  for (const std::string name : {"a.h5", "a.hdf5", "A.H5"}) {
    TableData table = random_table(12, 3000);  // c10 comes before c2 by name
    table.names[3] = "t";
    write_table(folder / name, table);
    const TableData back = read_table(folder / name);
    REQUIRE(back.names == table.names);
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      CHECK(same_bits(back.columns[c], table.columns[c]));
    }
  }
  CHECK(folder.entries() == 3);
}

TEST_CASE("HDF5 without rows, without t, and with one row") {
  const Folder folder;
  write_table(folder / "none.h5", {{"t", "x"}, {{}, {}}});
  CHECK(read_table(folder / "none.h5").columns == std::vector<std::vector<double>>{{}, {}});
  write_table(folder / "x.h5", {{"x"}, {{1.5}}});
  CHECK(read_table(folder / "x.h5").columns == std::vector<std::vector<double>>{{1.5}});
  write_table(folder / "t.h5", {{"t"}, {{1.5}}});
  CHECK(read_table(folder / "t.h5").columns == std::vector<std::vector<double>>{{1.5}});
}

TEST_CASE("HDF5 carries units, descriptions, the scale t and the run's attributes") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const std::string long_text(200000, 'y');  // more than a compact attribute holds
  write_table(file, {{"x", "t"}, {{1, 2, 3}, {0, 0.1, 0.2}}},
              {{"title", "ψ, über"}, {"scenario_text", long_text}, {"empty", ""}});

  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(id >= 0);
  CHECK(attribute_of(id, "x", "unit") == "m");
  CHECK(attribute_of(id, "x", "units") == "m");
  CHECK(attribute_of(id, "x", "description") == "one value a row");
  CHECK(attribute_of(id, "t", "unit") == "m");
  CHECK(attribute_of(id, "/", "title") == "ψ, über");
  CHECK(attribute_of(id, "/", "scenario_text") == long_text);
  CHECK(H5Aexists(id, "empty") > 0);

  const hid_t x = H5Dopen2(id, "x", H5P_DEFAULT);
  const hid_t t = H5Dopen2(id, "t", H5P_DEFAULT);
  CHECK(H5DSis_scale(t) > 0);
  CHECK(H5DSis_scale(x) == 0);
  CHECK(H5DSis_attached(x, t, 0) > 0);
  const hid_t space = H5Dget_space(x);
  hsize_t size = 0;
  hsize_t most = 0;
  REQUIRE(H5Sget_simple_extent_ndims(space) == 1);
  H5Sget_simple_extent_dims(space, &size, &most);
  CHECK(size == 3);
  CHECK(most == H5S_UNLIMITED);
  const hid_t type = H5Dget_type(x);
  CHECK(H5Tequal(type, H5T_IEEE_F64LE) > 0);
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(t);
  H5Dclose(x);
  H5Fclose(id);
}

TEST_CASE("numeric attributes are numbers") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  write_table(file, {{"t"}, {{0}}},
              {{"rtol", 1e-8}, {"rows", std::size_t{1} << 40U}, {"below", -1}, {"text", "1e-8"}});
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(id >= 0);
  const Number rtol = number_of(id, "rtol"), rows = number_of(id, "rows");
  CHECK((rtol.kind == H5T_FLOAT && rtol.bytes == 8 && rtol.value == 1e-8));
  CHECK((rows.kind == H5T_INTEGER && rows.bytes == 8 && rows.value == 0x1p40));
  CHECK(number_of(id, "below").value == -1);
  CHECK(attribute_of(id, "/", "text") == "1e-8");
  H5Fclose(id);
}

TEST_CASE("an unknown unit is not written as one of UDUNITS") {
  const Folder folder;
  const auto writer = open_table(folder / "a.h5", {{"x", "", "a gain"}, {"n", "1", "a count"}});
  writer->finish({});
  const hid_t id = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  CHECK(H5Aexists_by_name(id, "x", "unit", H5P_DEFAULT) > 0);
  CHECK(H5Aexists_by_name(id, "x", "units", H5P_DEFAULT) == 0);
  CHECK(attribute_of(id, "n", "units") == "1");
  H5Fclose(id);
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
  const TableData back = read_table(file);
  CHECK(back.names == std::vector<std::string>{"t", "position_error"});
  CHECK(back.columns[1] == std::vector<double>{1e-9, 2e-9, 3e-9});
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  CHECK(attribute_of(id, "position_error", "units") == "m");
  CHECK(attribute_of(id, "position_error", "description") == "estimate");
  CHECK(is_attached(id, "position_error", "t", 0));
  H5Fclose(id);

  const auto writer = open_table(file, {{"t", "s", "time"}});
  writer->append({&column, 1}, 3);
  CHECK_THROWS_AS(writer->add_column({"e", "m", ""}, {1}), OutputError);
}

TEST_CASE("the tables of a scenario are stored with its results, under any name") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const TableData motion = random_table(3, 5000);
  TableData odd;
  odd.names = {"x (m/s)", "x (m_s)", ".", "a/b/c"};
  odd.columns.assign(4, {1, 2});
  const auto shared = [](const TableData& table) {
    return std::make_shared<const TableData>(table);
  };
  const std::vector<InputTable> inputs{{"motion.csv", shared(motion)},
                                       {"../b/odd.csv", shared(odd)},
                                       {"c/odd.csv", shared(odd)},
                                       {"none.csv", shared({{"t"}, {{}}})}};
  {
    const auto writer = open_table(file, {{"t", "s", "time"}});
    writer->keep(inputs);
    writer->finish({});
  }
  CHECK(read_table(file).names == std::vector<std::string>{"t"});  // they are not columns

  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  CHECK(attribute_of(id, "inputs/motion.csv", "file") == "motion.csv");
  CHECK(attribute_of(id, "inputs/odd.csv", "file") == "../b/odd.csv");
  CHECK(attribute_of(id, "inputs/odd.csv (2)", "file") == "c/odd.csv");
  CHECK(attribute_of(id, "inputs/odd.csv/x (m_s)", "column") == "x (m/s)");
  CHECK(attribute_of(id, "inputs/odd.csv/x (m_s) (2)", "column") == "x (m_s)");
  CHECK(attribute_of(id, "inputs/odd.csv/._", "column") == ".");
  std::vector<double> numbers(5000);
  const hid_t column = H5Dopen2(id, "inputs/motion.csv/c2", H5P_DEFAULT);
  REQUIRE(column >= 0);
  H5Dread(column, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
  CHECK(same_bits(numbers, motion.columns[2]));
  H5Dclose(column);
  H5Fclose(id);

  const std::vector<InputTable> back = Hdf5TableReader(file).read_inputs();
  const std::vector<InputTable> after_rows = [&] {
    Hdf5TableReader reader(file, 7);
    Hdf5Block block;
    reader.read(block);
    return reader.read_inputs();
  }();
  REQUIRE(after_rows.size() == 4);
  CHECK(same_bits(after_rows[0].data->columns[0], back[0].data->columns[0]));
  REQUIRE(back.size() == 4);
  for (std::size_t i = 0; i < back.size(); ++i) {
    CHECK(back[i].file == inputs[i].file);
    CHECK(back[i].data->names == inputs[i].data->names);
    REQUIRE(back[i].data->columns.size() == inputs[i].data->columns.size());
    for (std::size_t c = 0; c < back[i].data->columns.size(); ++c) {
      CHECK(same_bits(back[i].data->columns[c], inputs[i].data->columns[c]));
    }
  }
}

TEST_CASE("the same table gives the same bytes") {
  const Folder folder;
  for (const std::string name : {"a.h5", "b.h5"}) {
    const auto writer = open_table(folder / name, {{"t", "s", ""}, {"x", "m", ""}});
    writer->keep({{"in.csv", std::make_shared<const TableData>(random_table(2, 50))}});
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

TEST_CASE("h5dump reads the file") {
  if (std::system("command -v h5dump >/dev/null 2>&1") != 0) {
    WARN("skipped: h5dump is not installed");
    return;
  }
  const Folder folder;
  write_table(folder / "a.h5", {{"t", "x"}, {{0, 0.5}, {1.25, 2}}}, {{"title", "dumped"}});
  const std::string command =
      "h5dump " + (folder / "a.h5") + " >" + (folder / "text") + " 2>" + (folder / "errors");
  REQUIRE(std::system(command.c_str()) == 0);
  const std::string text = content_of(folder / "text");
  CHECK_THAT(text, Contains("\"dumped\"") && Contains("1.25, 2") && Contains("DIMENSION_SCALE") &&
                       Contains("\"one value a row\"") && Contains("H5T_CSET_UTF8"));
  CHECK(content_of(folder / "errors").empty());
}

TEST_CASE("an unfinished HDF5 file leaves nothing behind") {
  const Folder folder;
  folder.put("a.h5", "old");
  {
    auto writer = open_table(folder / "a.h5", {{"x", "m", "position"}});
    const double value = 1;
    const double* column = &value;
    writer->append({&column, 1}, 1);
  }
  CHECK(content_of(folder / "a.h5") == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("HDF5 replaces a file, keeps its permissions and follows a link") {
  const Folder folder;
  const std::string real = folder.put("real.h5", "old");
  REQUIRE(chmod(real.c_str(), 0604) == 0);
  std::filesystem::create_symlink("real.h5", folder / "link.h5");
  write_table(folder / "link.h5", {{"x"}, {{1, 2}}});
  CHECK(std::filesystem::is_symlink(folder / "link.h5"));
  CHECK(permissions_of(real) == 0604);
  CHECK(read_table(real).columns[0] == std::vector<double>{1, 2});
  CHECK_THROWS_AS(open_table(folder / "none/a.h5", {{"x", "m", ""}}), OutputError);
}

// The disk gets full in the header, the rows, the attributes or at closing.
// For the leak sanitizer: HDF5 loses some memory of a file that it cannot write.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libhdf5";
}

TEST_CASE("a disk that fills up while HDF5 is written is an error and keeps the old file") {
  const Folder folder;
  const TableData table = random_table(3, 5000);
  write_table(folder / "whole.h5", table, {{"title", "x"}});
  const std::uintmax_t size = std::filesystem::file_size(folder / "whole.h5");
  const std::string file = folder.put("a.h5", "old");
  // An odd number of unaligned limits, from nothing to one byte too few.
  constexpr std::uintmax_t steps = 61;
  for (std::uintmax_t i = 0; i <= steps; ++i) {
    const FileSizeLimit limit((size - 1) * i / steps);
    CAPTURE(i);
    CHECK_THAT(message_of<OutputError>([&] {
                 write_table(file, table, {{"title", "x"}});
               }),
               Contains("cannot write " + file + ": file too large"));
  }
  CHECK(content_of(file) == "old");
  CHECK(folder.entries() == 2);
  write_table(file, table, {{"title", "x"}});  // HDF5 still works afterwards
  const bool same = content_of(file) == content_of(folder / "whole.h5");
  CHECK(same);
}

TEST_CASE("a process that met a full disk ends normally") {
  const Folder folder;
  const TableData table = random_table(3, 5000);
  const pid_t child = fork();
  if (child == 0) {
    const FileSizeLimit limit(20000);
    const std::string message =
        message_of<OutputError>([&] { write_table(folder / "a.h5", table); });
    std::exit(message.empty() ? 1 : 0);  // runs HDF5's exit handlers
  }
  int status = -1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  CHECK(folder.entries() == 0);
}

TEST_CASE("HDF5 files of other programs are read") {
  const Folder folder;
  write_foreign(folder / "int.h5", "n", {4}, H5T_STD_I32BE);
  CHECK(read_table(folder / "int.h5").columns == std::vector<std::vector<double>>{{0, 0, 0, 0}});
}

TEST_CASE("HDF5 that contains no table is refused") {
  const Folder folder;
  const std::string none = folder / "none.h5";
  CHECK(refusal(none) == "cannot read " + none + ": no such file or directory");
  CHECK_THAT(refusal(folder.put("text.h5", "t,x\n1,2\n")), Contains("it is not an HDF5 file"));
  CHECK_THAT(refusal(folder.put("empty.h5", "")), Contains("it is not an HDF5 file"));
  std::filesystem::create_directory(folder / "folder.h5");
  CHECK_THAT(refusal(folder / "folder.h5"), Contains("it is not a regular file"));

  write_foreign(folder / "two.h5", "image", {4, 4}, H5T_NATIVE_DOUBLE);
  CHECK_THAT(refusal(folder / "two.h5"), Contains("dataset image is not a column"));
  write_foreign(folder / "string.h5", "names", {4}, H5T_C_S1);
  CHECK_THAT(refusal(folder / "string.h5"), Contains("dataset names is not a column"));

  write_table(folder / "a.h5", {{"t", "x"}, {{0, 1}, {2, 3}}});
  const std::string whole = content_of(folder / "a.h5");
  CHECK_THAT(refusal(folder.put("cut.h5", whole.substr(0, whole.size() / 2))),
             Contains("cannot read " + (folder / "cut.h5") + ": opening the file failed"));

  const hid_t id = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Gclose(H5Gcreate2(id, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  hsize_t size = 5;
  const hid_t x = H5Dopen2(id, "x", H5P_DEFAULT);
  H5Dset_extent(x, &size);
  H5Dclose(x);
  H5Fclose(id);
  CHECK_THAT(refusal(folder / "a.h5"), Contains("dataset x has 5 rows, t has 2"));

  H5Fclose(H5Fcreate((folder / "bare.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT));
  CHECK_THAT(refusal(folder / "bare.h5"), Contains("it holds no column at its root"));
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
