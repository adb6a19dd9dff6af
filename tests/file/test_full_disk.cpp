// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables that cannot be completed: a full disk is an error and not a crash, and the old file stays.
#include <cstdlib>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/hdf5_table.hpp"
#include "support/child.hpp"
#include "support/folder.hpp"
#include "support/limits.hpp"
#include "support/tables.hpp"

namespace bbsim_test::test_full_disk {

using bbsim::OutputError;
using bbsim::file::Hdf5Block;
using bbsim::file::Hdf5Kind;
using bbsim::file::Hdf5TableWriter;
using Catch::Matchers::Contains;

// For the leak sanitizer: HDF5 loses some memory of a file that it cannot write.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libhdf5";
}

namespace {

// Cases with numbers, text and series, in blocks.
void write_cases(const std::string& file, bool whole) {
  constexpr std::size_t width = 50, at_once = 500;
  Hdf5TableWriter writer(file,
                         {{"gain", "1/s", ""},
                          {"ending", "1", "", Hdf5Kind::text},
                          {"x", "m", "", Hdf5Kind::series, width}},
                         {{{"t", "s", "output times"}, {0, 0.5, 1}}});
  for (std::size_t first = 0; first < 3000; first += at_once) {
    Hdf5Block block{at_once, {{}, {}, {}}, {{}, {}, {}}};
    for (std::size_t row = first; row < first + at_once; ++row) {
      block.values[0].push_back(0.1 * static_cast<double>(row));
      block.texts[1].emplace_back(row % 100 == 99 ? row : 4, 'y');
      for (std::size_t i = 0; i < width; ++i) {
        block.values[2].push_back(static_cast<double>(row * 1000 + i) / 3);
      }
    }
    writer.append(block);
  }
  if (whole) writer.finish({{"title", "x"}, {"rtol", 1e-8}});
}

void write_rows(const std::string& file, bool whole) {
  const auto table = random_table(3, 5000);
  if (whole) return write_table(file, table, {{"title", "x"}});
  const auto writer = bbsim::file::open_table(file, {{"x", "m", "position"}});
  const double* const column = table.columns[0].numbers.data();
  writer->append({&column, 1}, 5000);
}

struct Table {
  std::string name;
  void (*write)(const std::string& file, bool whole);
};
const auto every_table = [] {
  return GENERATE(
      values<Table>({{"a.csv", write_rows}, {"a.h5", write_rows}, {"a.hdf5", write_cases}}));
};

}  // namespace

TEST_CASE("a table that is not finished leaves the old file and no other") {
  const auto [name, write] = every_table();
  const Folder folder;
  folder.put(name, "old");
  write(folder / name, false);
  CHECK(content_of(folder / name) == "old");
  CHECK(folder.entries() == 1);
}

// The disk gets full in the header, the rows, the strings, the attributes or at closing.
TEST_CASE("a disk that fills up while a table is written is an error, and the old file stays") {
  const auto [name, write] = every_table();
  const Folder folder;
  write(folder / ("whole-" + name), true);
  const std::string whole = content_of(folder / ("whole-" + name)), file = folder.put(name, "old");
  // An odd number of unaligned limits, from nothing to one byte too few.
  constexpr std::size_t steps = 61;
  for (std::size_t i = 0; i <= steps; ++i) {
    const FileSizeLimit limit((whole.size() - 1) * i / steps);
    CAPTURE(i);
    CHECK_THAT(message_of<OutputError>([&, write = write] { write(file, true); }),
               Contains("cannot write " + file + ": file too large"));
  }
  CHECK(content_of(file) == "old");
  CHECK(folder.entries() == 2);
  write(file, true);  // HDF5 still works afterwards
  const bool same = content_of(file) == whole;
  CHECK(same);
}

TEST_CASE("a process that met a full disk ends as usual") {
  const auto [name, write] = every_table();
  const rlim_t bytes = GENERATE(1000, 20000, 100000);
  const Folder folder;
  CHECK(status_of_child([&, write = write, name = name] {
          const FileSizeLimit limit(bytes);
          const auto message = message_of<OutputError>([&] { write(folder / name, true); });
          std::exit(message.empty() ? 1 : 0);  // runs HDF5's exit handlers
          return 2;
        }) == 0);
  CHECK(folder.entries() == 0);
}

}  // namespace bbsim_test::test_full_disk
