// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables of cases: numbers, text and series, read back bit for bit and block by block. The same
// rows give the same bytes for any block size, also when parts are merged.
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/hdf5_table.hpp"
#include "support/folder.hpp"
#include "support/hdf5.hpp"
#include "support/limits.hpp"
#include "support/tables.hpp"

namespace bbsim_test::test_hdf5_table {

using bbsim::InputError;
using bbsim::OutputError;
using bbsim::file::Attributes;
using bbsim::file::Hdf5Axis;
using bbsim::file::Hdf5Block;
using bbsim::file::Hdf5Column;
using bbsim::file::Hdf5Kind;
using bbsim::file::Hdf5TableReader;
using bbsim::file::Hdf5TableWriter;
using bbsim::file::read_table;
using Catch::Matchers::Contains;

namespace {

using Columns = std::vector<Hdf5Column>;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Columns three_kinds(std::size_t width) {
  return {{"gain", "1/s", "of the loop"},
          {"ending", "1", "why the case ended", Hdf5Kind::text},
          {"x", "m", "the ball's way", Hdf5Kind::series, width}};
}

// The same cases for any division into blocks.
Hdf5Block cases(std::size_t first, std::size_t rows, std::size_t width) {
  static const std::vector<std::string> endings = {"done", "", "Kugel fällt: ψ > 90°", "nan"};
  Hdf5Block block{rows, {{}, {}, {}}, {{}, {}, {}}};
  for (std::size_t row = first; row < first + rows; ++row) {
    block.values[0].push_back(row % 7 == 3 ? nan : 0.1 * static_cast<double>(row));
    block.texts[1].push_back(endings[row % endings.size()]);
    if (row % 100 == 99) block.texts[1].back().append(row, 'y');
    for (std::size_t i = 0; i < width; ++i) {
      block.values[2].push_back(i == 1 ? -inf : static_cast<double>(row * 1000 + i) / 3);
    }
  }
  return block;
}

bool same(const Hdf5Block& a, const Hdf5Block& b) {
  bool result = a.rows == b.rows && a.texts == b.texts && a.values.size() == b.values.size();
  for (std::size_t c = 0; result && c < a.values.size(); ++c) {
    result = same_bits(a.values[c], b.values[c]);
  }
  return result;
}

const Attributes some_attributes = {
    {"title", "über"}, {"empty", ""}, {"a", "after z"}, {"rtol", 1e-8}, {"cases", 3000}};
const std::vector<Hdf5Axis> some_axes = {{{"t", "s", "output times"}, {0, 0.5, 1}}};

// Writes `rows` cases in blocks of `at_once`.
void write_cases(const std::string& file, std::size_t rows, std::size_t width,
                 std::size_t at_once) {
  Hdf5TableWriter writer(file, three_kinds(width), some_axes);
  for (std::size_t first = 0; first < rows; first += at_once) {
    writer.append(cases(first, std::min(at_once, rows - first), width));
  }
  writer.finish(some_attributes);
}

// Faster than content_of() on large files.
std::string bytes_of(const std::string& file) {
  std::string bytes(std::filesystem::file_size(file), '\0');
  std::ifstream(file, std::ios::binary).read(bytes.data(), std::ssize(bytes));
  return bytes;
}

bool same_files(const std::string& a, const std::string& b) {
  return bytes_of(a) == bytes_of(b);
}

// Properties of a dataset, from HDF5 itself.
struct Facts {
  Sizes size, most, chunk;
  bool text, utf8, number, axis;
};

Facts facts_of(hid_t file, const char* name) {
  const Handle dataset = dataset_of(file, name), type = type_of(dataset);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const auto rank = static_cast<std::size_t>(H5Sget_simple_extent_ndims(space));
  Facts facts{Sizes(rank), Sizes(rank), {}, false, false, false, false};
  H5Sget_simple_extent_dims(space, facts.size.data(), facts.most.data());
  if (H5Pget_layout(creation) == H5D_CHUNKED) {
    facts.chunk.resize(rank);
    H5Pget_chunk(creation, static_cast<int>(rank), facts.chunk.data());
  }
  facts.text = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) > 0;
  facts.utf8 = facts.text && H5Tget_cset(type) == H5T_CSET_UTF8;
  facts.number = H5Tequal(type, H5T_IEEE_F64LE) > 0;
  facts.axis = H5Aexists(dataset, "axis") > 0;
  return facts;
}

}  // namespace

TEST_CASE("a table of cases as HDF5 sees it") {
  const Folder folder;
  write_cases(folder / "a.h5", 5, 3, 5);
  const Handle file = opened(folder / "a.h5");
  REQUIRE(file >= 0);
  for (const char* name : {"gain", "ending"}) {
    CAPTURE(name);
    const bool text = std::string(name) == "ending";
    const Facts facts = facts_of(file, name);
    CHECK((facts.text == text && facts.utf8 == text && facts.number == !text && !facts.axis));
    CHECK(facts.size == Sizes{5});
    CHECK(facts.most == Sizes{H5S_UNLIMITED});
    CHECK(facts.chunk == Sizes{1024});
  }
  const Facts x = facts_of(file, "x");
  CHECK((x.number && !x.axis));
  CHECK(x.size == Sizes{5, 3});
  CHECK(x.most == Sizes{H5S_UNLIMITED, 3});
  CHECK(x.chunk == Sizes{4096, 3});  // 96 KiB
  const Facts t = facts_of(file, "t");
  CHECK((t.number && t.axis));
  CHECK(t.size == Sizes{3});
  CHECK(t.most == Sizes{3});
  CHECK(t.chunk.empty());

  // Stored as strings, and none of zero length.
  const Handle dataset = dataset_of(file, "ending"), type = type_of(dataset);
  std::vector<char*> texts(5, nullptr);
  REQUIRE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(texts.data())) >=
          0);
  CHECK(std::string(texts[0]) == "done");
  CHECK((texts[1] == nullptr || *texts[1] == '\0'));
  CHECK(std::string(texts[2]) == "Kugel fällt: ψ > 90°");
  for (char* text : texts) H5free_memory(text);
}

TEST_CASE("case numbers are integers and the scale of all rows; times are that of trajectories") {
  const Folder folder;
  Columns columns = three_kinds(3);
  columns.insert(columns.begin(), {"case", "1", "number of the case, from 0"});
  Hdf5Block block = cases(0, 5, 3);
  block.values.insert(block.values.begin(), {7, 8, 9, 10, 0x1p53});
  block.texts.insert(block.texts.begin(), std::vector<std::string>());
  {
    Hdf5TableWriter writer(folder / "a.h5", columns, some_axes);
    writer.append(block);
    writer.finish({});
  }
  {
    const Handle file = opened(folder / "a.h5");
    REQUIRE(file >= 0);
    const Handle number = dataset_of(file, "case"), t = dataset_of(file, "t");
    CHECK(H5Tequal(type_of(number), H5T_STD_I64LE) > 0);
    std::vector<std::int64_t> numbers(5);
    H5Dread(number, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    CHECK(numbers == std::vector<std::int64_t>{7, 8, 9, 10, 9007199254740992});
    CHECK(H5DSis_scale(number) > 0);
    CHECK(H5DSis_scale(t) > 0);
    for (const char* name : {"gain", "ending", "x"}) {
      const Handle dataset = dataset_of(file, name);
      CHECK(H5DSis_scale(dataset) == 0);
      CHECK(H5DSis_attached(dataset, number, 0) > 0);
      if (std::string(name) == "x") CHECK(H5DSis_attached(dataset, t, 1) > 0);
    }
  }
  Hdf5TableReader reader(folder / "a.h5");
  CHECK(reader.columns() == columns);
  Hdf5Block back;
  CHECK(reader.read(back));
  CHECK(same(back, block));
}

TEST_CASE("tables of cases are compressed, and texts of equal length stored contiguously") {
  const Folder folder;
  constexpr std::size_t rows = 20000;
  const Columns columns{{"case", "1", ""},
                        {"gain", "m", ""},
                        {"status", "", "", Hdf5Kind::text, 16},
                        {"reason", "", "", Hdf5Kind::text},
                        {"x", "m", "", Hdf5Kind::series, 2}};
  Hdf5Block block{rows, std::vector<std::vector<double>>(5),
                  std::vector<std::vector<std::string>>(5)};
  for (std::size_t i = 0; i < rows; ++i) {
    block.values[0].push_back(static_cast<double>(i));
    block.values[1].push_back(0.25 * static_cast<double>(i / 100));
    block.texts[2].emplace_back(i % 7 == 0 ? "0123456789abcdef" : "done");
    block.texts[3].emplace_back(i == 5 ? "a reason that is longer than sixteen bytes" : "");
    block.values[4].insert(block.values[4].end(), {1, 2});
  }
  {
    Hdf5TableWriter writer(folder / "a.h5", columns, {});
    writer.append(block);
    writer.finish({});
  }
  for (const Hdf5Column& column : columns) {
    CAPTURE(column.name);
    const Handle file = opened(folder / "a.h5");
    const Handle dataset = dataset_of(file, column.name), type = type_of(dataset);
    const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
    unsigned flags = 0, level = 0;
    std::size_t count = 1;
    CHECK(H5Pget_filter_by_id2(creation, H5Z_FILTER_DEFLATE, &flags, &count, &level, 0, nullptr,
                               nullptr) >= 0);
    // The numbers repeat; string references contain file positions.
    const std::size_t part = column.name == "reason" ? 3 : 20;
    const std::size_t width = column.kind == Hdf5Kind::series ? column.width : 1;
    CHECK(H5Dget_storage_size(dataset) < rows * H5Tget_size(type) * width / part);
    if (column.name == "status") CHECK(H5Tis_variable_str(type) == 0);
    if (column.name == "reason") CHECK(H5Tis_variable_str(type) > 0);
  }
  Hdf5TableReader reader(folder / "a.h5");
  CHECK(reader.columns() == columns);
  Hdf5Block back;
  CHECK(reader.read(back));
  CHECK(same(back, block));

  // Text is never truncated.
  CHECK(message_of<OutputError>([&] {
          Hdf5TableWriter writer(folder / "b.h5", {{"status", "", "", Hdf5Kind::text, 4}}, {});
          writer.append({1, {{}}, {{"refused"}}});
          writer.finish({});
        }) ==
        "cannot write " + (folder / "b.h5") + ": writing rows: a text is longer than its column");
}

TEST_CASE("chunks of series are whole rows of about 100 KiB") {
  const Folder folder;
  Hdf5TableWriter writer(folder / "a.h5", {{"a", "1", "", Hdf5Kind::series, 1},
                                           {"b", "1", "", Hdf5Kind::series, 5000},
                                           {"c", "1", "", Hdf5Kind::series, 100000}});
  writer.finish({});
  const Handle file = opened(folder / "a.h5");
  CHECK(facts_of(file, "a").chunk == Sizes{16384, 1});
  CHECK(facts_of(file, "b").chunk == Sizes{2, 5000});
  CHECK(facts_of(file, "c").chunk == Sizes{1, 100000});
}

TEST_CASE("a table of cases reads back, whole and in blocks, also if its series are wide") {
  const Folder folder;
  using Table = std::pair<std::size_t, std::size_t>;
  const auto [rows, width] = GENERATE(Table{2500, 3}, Table{700, 5000});
  write_cases(folder / "a.h5", rows, width, 300);
  Hdf5TableReader reader(folder / "a.h5");
  CHECK(reader.columns() == three_kinds(width));
  REQUIRE(reader.head().axes.size() == 1);
  CHECK(reader.head().axes[0].first == some_axes[0].first);
  CHECK(reader.head().axes[0].second == some_axes[0].second);
  CHECK(reader.head().attributes == some_attributes);

  Hdf5Block block;
  for (const std::size_t a_block :
       {std::size_t{0}, std::size_t{341}, std::size_t{1024}, rows - 1, rows, rows + 1}) {
    CAPTURE(rows, a_block);
    Hdf5TableReader in_blocks =
        a_block == 0 ? Hdf5TableReader(folder / "a.h5") : Hdf5TableReader(folder / "a.h5", a_block);
    CHECK(in_blocks.rows() == rows);
    const std::size_t most = a_block == 0 ? rows : a_block;
    std::size_t first = 0;
    bool equal = true;
    for (; in_blocks.read(block); first += block.rows) {
      equal = equal && same(block, cases(first, std::min(most, rows - first), width));
    }
    CHECK(equal);
    CHECK(first == rows);
    CHECK(same(block, cases(0, 0, width)));
  }
  CHECK(folder.entries() == 1);
}

TEST_CASE("any number round-trips bit for bit in a table of cases") {
  const Folder folder;
  const auto table = random_table(2, 3000);
  Hdf5TableWriter writer(folder / "a.h5", {{"n", "1", ""}, {"s", "1", "", Hdf5Kind::series, 1500}});
  std::vector<double> series = table.columns[1].numbers;
  while (series.size() < 3000 * 1500) series.insert(series.end(), series.begin(), series.end());
  series.resize(3000 * 1500);
  const Hdf5Block block{3000, {table.columns[0].numbers, series}, {{}, {}}};
  writer.append(block);
  writer.finish({});
  Hdf5Block back;
  Hdf5TableReader(folder / "a.h5").read(back);
  CHECK(same(back, block));
}

TEST_CASE("a table without cases, with one case, and with a single column") {
  const Folder folder;
  write_cases(folder / "none.h5", 0, 3, 1);
  Hdf5TableReader none(folder / "none.h5");
  CHECK(none.rows() == 0);
  CHECK(none.columns() == three_kinds(3));
  Hdf5Block block = cases(0, 2, 3);
  CHECK_FALSE(none.read(block));
  CHECK(same(block, cases(0, 0, 3)));

  for (const Hdf5Column& column : three_kinds(3)) {
    Hdf5TableWriter writer(folder / "one.h5", {column});
    const bool text = column.kind == Hdf5Kind::text;
    const std::vector<double> values(text ? 0 : column.width, 1.5);
    const Hdf5Block one{1, {values}, {std::vector<std::string>(text ? 1 : 0, "ψ")}};
    writer.append(one);
    writer.finish({});
    Hdf5TableReader reader(folder / "one.h5");
    CHECK(reader.head().axes.empty());
    CHECK(reader.head().attributes.empty());
    CHECK(reader.read(block));
    CHECK(same(block, one));
  }
}

TEST_CASE("the same cases give the same bytes for any division into blocks") {
  const Folder folder;
  using Sizes = std::pair<std::size_t, std::size_t>;
  for (const auto& [rows, width] : {Sizes{2500, 3}, Sizes{150, 8000}}) {  // 1024 or 128 a block
    write_cases(folder / "whole.h5", rows, width, rows);
    sleep(1);  // HDF5 timestamps objects in whole seconds
    for (const std::size_t at_once : {1, 7, 128, 1000}) {
      CAPTURE(width, at_once);
      write_cases(folder / "cut.h5", rows, width, at_once);
      const bool equal = same_files(folder / "whole.h5", folder / "cut.h5");
      CHECK(equal);
    }
  }
}

TEST_CASE("merged parts give the bytes of the whole") {
  const Folder folder;
  const std::size_t width = 40;
  write_cases(folder / "whole.h5", 3000, width, 3000);
  for (const auto& [name, first, rows] :
       std::vector<std::tuple<std::string, std::size_t, std::size_t>>{
           {"1.h5", 0, 1100}, {"2.h5", 1100, 0}, {"3.h5", 1100, 1900}}) {
    Hdf5TableWriter part(folder / name, three_kinds(width), some_axes);
    part.append(cases(first, rows, width));
    part.finish(some_attributes);
  }
  const Hdf5TableReader first(folder / "1.h5");
  Hdf5TableWriter merged(folder / "merged.h5", first.columns(), first.head().axes);
  for (const char* name : {"1.h5", "2.h5", "3.h5"}) {
    Hdf5TableReader part(folder / name, 333);
    REQUIRE(part.columns() == first.columns());
    Hdf5Block block;
    while (part.read(block)) merged.append(block);
  }
  merged.finish(first.head().attributes);
  const bool equal = same_files(folder / "whole.h5", folder / "merged.h5");
  CHECK(equal);
}

TEST_CASE("after a failure a table of cases cannot be completed") {
  const Folder folder;
  Hdf5TableWriter writer(folder / "a.h5", three_kinds(50));
  {
    const FileSizeLimit limit(10000);
    CHECK_THROWS_AS(writer.append(cases(0, 3000, 50)), OutputError);
  }
  CHECK_THROWS_AS(writer.append(cases(0, 3000, 50)), OutputError);
  CHECK_THROWS_AS(writer.finish({}), OutputError);
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5"));
}

TEST_CASE("outputs that cannot contain a table of cases are refused") {
  const Folder folder;
  const auto message = [](const std::string& target) {
    return message_of<OutputError>([&] { Hdf5TableWriter(target, three_kinds(3)); });
  };
  for (const char* target : {"/dev/full", "/dev/null", "-", "/dev/stdout"}) {
    CHECK_THAT(message(target),
               Contains("cannot write " + std::string(target) + ": it is a device"));
  }
  REQUIRE(mkfifo((folder / "pipe.h5").c_str(), 0600) == 0);
  CHECK_THAT(message(folder / "pipe.h5"), Contains("HDF5 needs a regular file"));
  CHECK_THAT(message(folder / "none/a.h5"), Contains("there is no folder"));
  CHECK_THAT(message(folder.name()), Contains("is a directory"));
}

TEST_CASE("columns and blocks that do not form a table are refused") {
  const Folder folder;
  const std::string file = folder / "a.h5";
  const auto message = [&](const Columns& columns, const std::vector<Hdf5Axis>& axes) {
    return message_of<OutputError>([&] { Hdf5TableWriter(file, columns, axes); });
  };
  CHECK_THAT(message({}, {}), Contains("at least one column"));
  CHECK_THAT(message({{"a", "", ""}, {"a", "", ""}}, {}), Contains("two columns are called a"));
  CHECK_THAT(message({{"t", "", ""}}, some_axes), Contains("the axis t has the name of"));
  CHECK_THAT(message({{"x", "", "", Hdf5Kind::series, 0}}, {}), Contains("has no values"));
  CHECK_THAT(message({{"", "", ""}}, {}), Contains("cannot write " + file));

  Hdf5TableWriter writer(file, three_kinds(3));
  Hdf5Block block = cases(0, 2, 3);
  block.values[2].pop_back();
  CHECK_THROWS_AS(writer.append(block), OutputError);
  CHECK_THROWS_AS(writer.append({1, {{1}}, {{}}}), OutputError);
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("a run's HDF5 file is also a table of cases") {
  const Folder folder;
  const auto table = random_table(3, 2000);
  write_table(folder / "a.h5", {{"t", "x", "y"}, numbers_of(table)}, {{"title", "run"}});
  Hdf5TableReader reader(folder / "a.h5");
  CHECK(reader.columns() == Columns{{"t", "m", "one value a row"},
                                    {"x", "m", "one value a row"},
                                    {"y", "m", "one value a row"}});
  CHECK(reader.head().axes.empty());
  CHECK(reader.head().attributes == Attributes{{"title", "run"}});
  Hdf5Block block;
  CHECK(reader.read(block));
  CHECK(same(block, {2000, numbers_of(table), {{}, {}, {}}}));
}

TEST_CASE("a table of cases is read whole, with texts, series and axes") {
  const Folder folder;
  Hdf5TableWriter writer(
      folder / "a.h5",
      {{"a", "1", ""}, {"why", "1", "", Hdf5Kind::text}, {"t_of", "m", "", Hdf5Kind::series, 2}},
      {{{"t", "s", ""}, {0, 1}}});
  const std::vector<double> none, pair{1, 2}, four{1, 2, 3, 4};
  writer.append(Hdf5Block{2, {pair, none, four}, {{}, {"", "late"}, {}}});
  writer.finish({});
  const bbsim::file::Table table = read_table(folder / "a.h5");
  CHECK(table.rows == 2);
  CHECK(table.names() == std::vector<std::string>{"a", "why", "t_of", "t"});
  CHECK(table.columns[1].texts == std::vector<std::string>{"", "late"});
  CHECK(table.columns[2].width == 2);
  CHECK(table.columns[3].numbers == std::vector<double>{0, 1});
  CHECK_THROWS_WITH(bbsim::file::refuse_text("a.h5", table.columns[1]),
                    "a.h5: column why, row 2: found \"late\"; allowed: a number");
}
}  // namespace bbsim_test::test_hdf5_table
