// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// CSV, written and read back bit for bit; bad input is refused with its place.
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/atomic_file.hpp"
#include "file/table.hpp"
#include "file/table_writer.hpp"
#include "support/folder.hpp"
#include "support/tables.hpp"

namespace bbsim_test::test_csv {

using bbsim::InputError;
using bbsim::OutputError;
using bbsim::file::open_table;
using bbsim::file::read_table;
using bbsim::file::Table;
using Catch::Matchers::Contains;

namespace {

// The message for a file with the given content, without its folder.
std::string refusal(const std::string& content) {
  const Folder folder;
  const std::string file = folder.put("a.csv", content);
  std::string message = message_of<InputError>([&] {
    for (const bbsim::file::Column& column : read_table(file).columns) {
      if (column.is_text()) bbsim::file::refuse_text(file, column);
    }
  });
  const std::size_t at = message.find(folder.name());
  if (at != std::string::npos) message.erase(at, folder.name().size() + 1);
  return message;
}

Table parsed(const std::string& content) {
  const Folder folder;
  return read_table(folder.put("a.csv", content));
}

}  // namespace

TEST_CASE("CSV has a header of plain names, then the shortest numbers, also those not finite") {
  const Folder folder;
  const std::string file = folder / "a.csv";
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const auto text_of = [&](const Table& table) {
    write_table(file, table);
    return content_of(file);
  };
  CHECK(text_of({{"t", "x"}, {{0, 0.1, 1e300, -0.0}, {1.0 / 3, -1e-5, 5e-324, 123456789}}}) ==
        "t,x\n0,0.3333333333333333\n0.1,-1e-05\n1e+300,5e-324\n-0,123456789\n");
  CHECK(text_of({{"x"}, {{nan, -nan, inf, -inf}}}) == "x\nnan\nnan\ninf\n-inf\n");
  CHECK(text_of({{"t", "x"}, {{}, {}}}) == "t,x\n");
  CHECK(read_table(file).names().size() == 2);
  CHECK(read_table(file).columns[1].numbers.empty());
}

TEST_CASE("CSV round-trips bit for bit") {
  const Folder folder;
  const std::string file = folder / "a.csv";
  const Table table = random_table(5, 3000);
  write_table(file, table);
  const Table back = read_table(file);
  CHECK(back.names() == table.names());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    CHECK(same_bits(back.columns[c].numbers, table.columns[c].numbers));
  }
}

TEST_CASE("the extension selects the format") {
  const Folder folder;
  const std::string message = message_of<InputError>([&] {
    (void)open_table(folder / "a.txt", {{"x", "m", ""}});
  });
  CHECK_THAT(message, Contains("a.txt") && Contains(".csv, .h5 and .hdf5"));
  CHECK_THROWS_AS(open_table(folder / "csv", {{"x", "m", ""}}), InputError);
  CHECK_THROWS_AS(open_table("", {{"x", "m", ""}}), InputError);
  CHECK(folder.entries() == 0);
  write_table(folder / "A.CSV", {{"x"}, {{1}}});
  CHECK(content_of(folder / "A.CSV") == "x\n1\n");
}

TEST_CASE("a device gets CSV whatever its name") {
  const Folder folder;
  std::filesystem::create_symlink("/dev/null", folder / "a.h5");
  write_table(folder / "a.h5", {{"x"}, {{1}}});
  CHECK(std::filesystem::is_symlink(folder / "a.h5"));
  CHECK_THROWS_AS(write_table("/dev/full", {{"x"}, {{1}}}), OutputError);
}

TEST_CASE("CSV from other programs is read") {
  CHECK(parsed("\xEF\xBB\xBFt,x\r\n1,2\r\n").names() == std::vector<std::string>{"t", "x"});
  CHECK(parsed("t\n1\n2").columns[0].numbers == std::vector<double>{1, 2});
  const Table spaced = parsed(" t ,\tx\n 1 , +2.5e0\t\n");
  CHECK(spaced.columns[1].numbers == std::vector<double>{2.5});
  CHECK(spaced.names()[1] == "x");
  const Table special = parsed("a,b\nNaN,-Infinity\nnan,INF\n");
  CHECK(std::isnan(special.columns[0].numbers[0]));
  CHECK(special.columns[1].numbers[0] == -std::numeric_limits<double>::infinity());
  CHECK(special.columns[1].numbers[1] == std::numeric_limits<double>::infinity());
}

TEST_CASE("long decimals are read to the nearest double") {
  // strtod of the C library rounds correctly; from_chars must agree, ties included.
  std::vector<std::string> decimals = {"0.000350562590206655033482",
                                       "4.3359050650618905124e-37",
                                       "-0.0999883468382828927404",
                                       "9007199254740993",
                                       "9007199254740992.99999999999",
                                       "2.2250738585072011e-308",
                                       "4.9406564584124654e-324",
                                       "2.4703282292062327e-324",
                                       "2.4703282292062328e-324",
                                       "1e-400",
                                       "-1e-400",
                                       "1.7976931348623158e308"};
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    decimals.push_back("0." + std::to_string(random() | (1ULL << 63)) +
                       std::to_string(random() % 90 + 10) + "e" +
                       std::to_string(static_cast<int>(random() % 600) - 300));
  }
  std::string content = "x\n";
  std::vector<double> expected;
  for (const std::string& decimal : decimals) {
    content += decimal + "\n";
    expected.push_back(std::strtod(decimal.c_str(), nullptr));
  }
  CHECK(same_bits(parsed(content).columns[0].numbers, expected));
}

TEST_CASE("words that a board prints between rows are left out, with a warning") {
  const Folder folder;
  folder.put("a.csv", "t,x\n0,1\nBall balancer ready\nt,x\n1,2\nbye\n");
  const bbsim::file::Table table = bbsim::file::read_table(folder / "a.csv");
  REQUIRE(table.rows == 2);
  CHECK(table.columns[1].numbers == std::vector<double>{1, 2});
  CHECK(table.columns[0].texts.empty());
  REQUIRE(table.notes.size() == 2);
  CHECK(table.notes[0].find("a.csv:3") != std::string::npos);
}

TEST_CASE("rows and fields that are no numbers are refused at their place, safe for a terminal") {
  const auto [content, said] = GENERATE(table<std::string, std::string>({
      {"t,x\n1,2\n3\n4,5\n", "a.csv:3:1: found 1 number; the header names 2 columns"},
      {"t,x\n1,2,3,4\n", "a.csv:2:1: found 4 numbers; the header names 2 columns"},
      {"t,x\n1,2\n1, abc\n", "a.csv:3:4: column x: found \"abc\"; allowed: a number"},
      {"t\n1e400\n", "a.csv:2:1: column t: found \"1e400\", too large for a double"},
      {"t\n\x1b[31mred\n", "found \"\\x1b[31mred\""},
      // A header may not contain control characters; other special characters are possible.
      {"t,\u009b31mx\n1,y\n", "a.csv:2:3: column \\u009b31mx: found \"y\"; allowed: a number"},
      {"t\n" + std::string(100000, 'z') + "\n", "found \"" + std::string(40, 'z') + "...\""},
  }));
  CHECK_THAT(refusal(content), Contains(said));
  for (const char* text : {"0x10", "1.5.2", "1 2", "+-1", "--1", "+", "-", ".", "e5", "1e", "1;2",
                           "1_000", "one", "\x01", "0x", "1f", "nanx", "inf2"}) {
    CAPTURE(text);
    CHECK_THAT(refusal(std::string("t\n") + text + "\n"),
               Contains("a.csv:2:1: column t: found ") && Contains("allowed: a number"));
  }
}

TEST_CASE("blank lines and comments are not rows") {
  CHECK(parsed("t,x\n1,2\n\n3,4\n").columns[0].numbers == std::vector<double>{1, 3});
  CHECK(parsed("\n# by hand\nt\n1\n \r\n#2\n").columns[0].numbers == std::vector<double>{1});
}

TEST_CASE("a header has distinct names, which are no numbers") {
  const auto [content, said] = GENERATE(table<std::string, std::string>({
      {"", "a.csv:1:1: found no header"},
      {"\xEF\xBB\xBF", "a.csv:1:1: found no header"},
      {"t,,x\n", "a.csv:1:3: a column's name is empty"},
      {"t,x,\n", "a.csv:1:5: a column's name is empty"},
      {"t,x,t\n", "a.csv:1:5: column \"t\" appears twice"},
      {"0,0.1\n1,2\n", "a.csv:1:1: found the number \"0\""},
      {"t,\"x\n", "a.csv:1:1: found a quotation mark without"},
      {{"t\0x\n", 4}, "a control character"},
      {"t,x\r1,2\r", "a control character"},  // line ends of old
  }));
  CHECK_THAT(refusal(content), Contains(said));
}

TEST_CASE("a file that cannot be read is an InputError") {
  const Folder folder;
  CHECK(message_of<InputError>([&] { (void)read_table(folder / "none.csv"); }) ==
        "cannot read " + (folder / "none.csv") + ": no such file or directory");
  CHECK_THAT(message_of<InputError>([&] { (void)read_table(folder.name()); }),
             Contains("is a directory"));
}

TEST_CASE("an endless line is refused, from devices and files") {
  const std::string limit = ":1:1: found a line of more than 1048576 bytes";
  CHECK_THAT(message_of<InputError>([] { (void)read_table("/dev/zero"); }),
             Contains("/dev/zero" + limit));
  CHECK_THAT(refusal(std::string(3000000, 'x')), Contains("a.csv" + limit));
  CHECK_THAT(refusal("t\n" + std::string(1048577, '1') + "\n"),
             Contains("a.csv:2:1: found a line of more than"));
  // One byte less is read as a number, though too large.
  CHECK_THAT(refusal("t\n" + std::string(1048576, '1') + "\n"), Contains("too large for a double"));
  // Input is read as long as it is valid.
  CHECK_FALSE(message_of<InputError>([] { (void)read_table("/dev/urandom"); }).empty());
  CHECK_THAT(message_of<InputError>([] { (void)read_table("/dev/null"); }),
             Contains("/dev/null:1:1: found no header"));
}

TEST_CASE("a long row is read, and so are rows across read boundaries") {
  std::string header = "c0", row = "0";
  for (int c = 1; c < 50000; ++c) {
    header.append(",c").append(std::to_string(c));
    row.append(",").append(std::to_string(c));
  }
  const Table wide = parsed(header + "\n" + row + "\r\n" + row + "\n");
  REQUIRE(wide.columns.size() == 50000);
  CHECK(wide.columns[49999].numbers == std::vector<double>{49999, 49999});

  std::string content = "t,x\n";
  for (int i = 0; i < 100000; ++i)
    content.append(std::to_string(i)).append(",").append(std::to_string(2 * i)).append("\n");
  const Table rows = parsed(content);
  REQUIRE(rows.columns[1].numbers.size() == 100000);
  bool right = true;
  for (std::size_t i = 0; i < 100000; ++i) {
    right = right && rows.columns[1].numbers[i] == 2 * static_cast<double>(i);
  }
  CHECK(right);
}

TEST_CASE("a pipe is read as data arrive") {
  const Folder folder;
  const std::string pipe = folder / "pipe.csv";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::thread writer([&pipe] {
    std::ofstream stream(pipe);
    for (const char* part : {"t,", "x\n1", ",2\n", "3,4\r", "\n5,6"}) {
      stream << part << std::flush;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  const Table table = read_table(pipe);
  writer.join();
  CHECK(numbers_of(table) == std::vector<std::vector<double>>{{1, 3, 5}, {2, 4, 6}});
}

}  // namespace bbsim_test::test_csv
