// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the reader of HDF5 refuses: data in other files, and sizes that the file cannot hold.
// Threads may read at once, and no file content reaches a terminal raw.
#include <atomic>
#include <filesystem>
#include <thread>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "support/folder.hpp"
#include "support/hdf5.hpp"
#include "support/tables.hpp"

namespace bbsim_test::test_hdf5_reader {

using bbsim::InputError;
using bbsim::file::Hdf5Block;
using bbsim::file::Hdf5TableReader;
using bbsim::file::read_table;
using bbsim::file::Table;
using Catch::Matchers::Contains;

namespace {

// Why both readers refuse a file.
std::string refusal(const std::string& file) {
  const std::string why = message_of<InputError>([&] { (void)read_table(file); });
  CHECK(message_of<InputError>([&] { Hdf5TableReader{file}; }) == why);
  return why;
}

// A file that `make` fills.
template <class Make>
std::string foreign(const Folder& folder, const std::string& name, Make make) {
  const Handle file = created(folder / name);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  make(file, creation);
  return folder / name;
}

}  // namespace

TEST_CASE("many files may be open together") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const Table table = random_table(3, 2000);
  write_table(file, table);
  std::vector<Hdf5TableReader> readers;
  for (int i = 0; i < 20; ++i) readers.emplace_back(file, 500);
  Hdf5Block block;
  for (Hdf5TableReader& reader : readers) reader.read(block);
  readers[17].read(block);
  const std::vector<double>& column = table.columns[2].numbers;
  CHECK(same_bits(block.values[2], {column.begin() + 500, column.begin() + 1000}));
}

TEST_CASE("concurrent threads each read their own rows") {
  const Folder folder;
  constexpr std::size_t threads = 6;
  std::vector<Table> tables;
  for (std::size_t i = 0; i < threads; ++i) {
    tables.push_back(random_table(2, 5000));
    std::fill(tables[i].columns[1].numbers.begin(), tables[i].columns[1].numbers.end(),
              static_cast<double>(i));
    write_table(folder / (std::to_string(i) + ".h5"), tables[i]);
  }
  std::atomic<int> wrong{0};
  std::vector<std::thread> all;
  for (std::size_t i = 0; i < threads; ++i) {
    all.emplace_back([&, i] {
      for (int again = 0; again < 10; ++again) {
        const Table back = read_table(folder / (std::to_string(i) + ".h5"));
        if (!same_bits(back.columns[1].numbers, tables[i].columns[1].numbers)) ++wrong;
      }
    });
  }
  for (std::thread& one : all) one.join();
  CHECK(wrong == 0);
}

TEST_CASE("files that are no tables are refused, and the next one is read") {
  const Folder folder;
  const std::string none = folder / "none.h5";
  CHECK(refusal(none) == "cannot read " + none + ": no such file or directory");
  CHECK_THAT(refusal(folder.put("text.h5", "t,x\n1,2\n")), Contains("it is not an HDF5 file"));
  CHECK_THAT(refusal(folder.put("empty.h5", "")), Contains("it is not an HDF5 file"));
  std::filesystem::create_directory(folder / "folder.h5");
  CHECK_THAT(refusal(folder / "folder.h5"), Contains("it is not a regular file"));
  CHECK_THAT(message_of<InputError>([] { Hdf5TableReader{"/dev/null"}; }),
             Contains("it is not a regular file"));

  write_table(folder / "a.h5", random_table(3, 3000));
  const std::string whole = content_of(folder / "a.h5");
  for (const std::size_t bytes : {whole.size() / 2, whole.size() - 1}) {
    CHECK_THAT(refusal(folder.put("cut.h5", whole.substr(0, bytes))),
               Contains("cannot read " + (folder / "cut.h5") + ": opening the file failed"));
  }
  CHECK(refusal(folder / "a.h5").empty());
  const std::string bare = foreign(folder, "bare.h5", [](hid_t, hid_t) {});
  CHECK_THAT(refusal(bare), Contains("it holds no column at its root"));
  const std::string uneven = foreign(folder, "uneven.h5", [](hid_t id, hid_t) {
    put_dataset(id, "t", H5T_IEEE_F64LE, {2});
    put_dataset(id, "x", H5T_IEEE_F64LE, {5});
  });
  CHECK_THAT(refusal(uneven), Contains("dataset x has 5 rows, t has 2"));

  const auto of = [&](const std::string& name, hid_t type, const Sizes& sizes) {
    const std::string file =
        foreign(folder, name, [&](hid_t id, hid_t) { put_dataset(id, "it", type, sizes); });
    return message_of<InputError>([&] { (void)read_table(file); });
  };
  CHECK(of("image.h5", H5T_NATIVE_DOUBLE, {4, 4}).empty());
  CHECK(read_table(folder / "image.h5").columns[0].width == 4);
  CHECK(of("text-1.h5", H5T_C_S1, {4}).empty());
  CHECK(of("int.h5", H5T_STD_I32BE, {4}).empty());
  CHECK(numbers_of(read_table(folder / "int.h5")) ==
        std::vector<std::vector<double>>{{0, 0, 0, 0}});
}

TEST_CASE("a dataset that declares more than the file can contain is refused with its sizes") {
  const Folder folder;
  const std::string file = foreign(folder, "a.h5", [](hid_t id, hid_t creation) {
    const hsize_t chunk = 1024;
    H5Pset_chunk(creation, 1, &chunk);
    for (const char* name : {"t", "x", "y"})
      put_dataset(id, name, H5T_IEEE_F64LE, {40000000}, nullptr, creation);
  });
  const std::uintmax_t size = std::filesystem::file_size(file);
  CHECK(size < 5000);
  CHECK(refusal(file) == "cannot read " + file +
                             ": dataset t declares 40000000 rows, 320000000 bytes; the file has " +
                             std::to_string(size) +
                             ": it is damaged, or the dataset was never filled");

  // The largest possible numbers.
  const std::string most = foreign(folder, "most.h5", [](hid_t id, hid_t creation) {
    const hsize_t chunk = 1024;
    H5Pset_chunk(creation, 1, &chunk);
    put_dataset(id, "x", H5T_IEEE_F64LE, {~hsize_t{0} / 2}, nullptr, creation);
  });
  CHECK_THAT(refusal(most), Contains("declares 9223372036854775807 rows, 18446744073709551615 "));
}

TEST_CASE("a compressed dataset may be larger than the file, but only by a bounded factor") {
  const Folder folder;
  constexpr hsize_t rows = 2000000;
  const auto packed = [&](const std::string& name, hsize_t declared) {
    return foreign(folder, name, [&](hid_t id, hid_t creation) {
      const hsize_t chunk = 500000;
      H5Pset_chunk(creation, 1, &chunk);
      H5Pset_deflate(creation, 6);
      const Handle dataset = put_dataset(id, "x", H5T_IEEE_F64LE, {declared}, nullptr, creation);
      const std::vector<double> numbers(rows, 1.5);
      const Handle space(H5Dget_space(dataset), H5Sclose);
      const hsize_t first = 0;
      H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &rows, nullptr);
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, space_of({rows}), space, H5P_DEFAULT, numbers.data());
    });
  };
  const std::string sound = packed("sound.h5", rows);
  CHECK(std::filesystem::file_size(sound) < 200000);  // 16 MB of numbers
  CHECK(numbers_of(read_table(sound)) ==
        std::vector<std::vector<double>>{std::vector<double>(rows, 1.5)});
  CHECK_THAT(refusal(packed("false.h5", 1000 * rows)), Contains("declares 2000000000 rows"));
}

TEST_CASE("external data in other files are not read") {
  const Folder folder;
  folder.put("secret", std::string(800, 's'));
  write_table(folder / "other.h5", {{"x"}, {{1, 2}}});
  const std::string raw = foreign(folder, "raw.h5", [&](hid_t id, hid_t creation) {
    H5Pset_external(creation, (folder / "secret").c_str(), 0, 800);
    put_dataset(id, "x", H5T_IEEE_F64LE, {100}, nullptr, creation);
  });
  CHECK_THAT(refusal(raw), Contains("dataset x is not a column: its numbers are in other files"));

  const std::string mapped = foreign(folder, "mapped.h5", [&](hid_t id, hid_t creation) {
    const Handle space = space_of({2});
    H5Pset_virtual(creation, space, (folder / "other.h5").c_str(), "x", space);
    put_dataset(id, "x", H5T_IEEE_F64LE, {2}, nullptr, creation);
  });
  CHECK_THAT(refusal(mapped), Contains("its numbers are in other files"));

  const std::string linked = foreign(folder, "linked.h5", [&](hid_t id, hid_t) {
    H5Lcreate_external((folder / "other.h5").c_str(), "x", id, "x", H5P_DEFAULT, H5P_DEFAULT);
  });
  CHECK_THAT(refusal(linked), Contains("x is a link to another file"));

  const std::string way_round = foreign(folder, "way-round.h5", [&](hid_t id, hid_t) {
    const hid_t group = H5Gcreate2(id, "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external((folder / "other.h5").c_str(), "x", group, "x", H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(group);
    H5Lcreate_soft("/g/x", id, "x", H5P_DEFAULT, H5P_DEFAULT);
  });
  CHECK_THAT(refusal(way_round), Contains("opening x failed"));

  const std::string within = foreign(folder, "within.h5", [&](hid_t id, hid_t creation) {
    put_dataset(id, "x", H5T_IEEE_F64LE, {2}, nullptr, creation);
    H5Lcreate_soft("/x", id, "y", H5P_DEFAULT, H5P_DEFAULT);
  });
  CHECK(read_table(within).names() == std::vector<std::string>{"x", "y"});
}

TEST_CASE("dataset names are shown safe for a terminal") {
  const Folder folder;
  const std::string file = foreign(folder, "a\x1b[2J.h5", [](hid_t id, hid_t) {
    put_dataset(id, "x\x1b]0;title\x07\n", H5T_IEEE_F64LE, {2, 2, 2});
  });
  CHECK(refusal(file) == "cannot read " + (folder / "a\\x1b[2J.h5") +
                             ": dataset x\\x1b]0;title\\x07\\n is not a column: it has 3 "
                             "dimensions; numbers may have 1 or 2, text 1");
}

}  // namespace bbsim_test::test_hdf5_reader
