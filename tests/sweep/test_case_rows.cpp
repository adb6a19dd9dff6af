// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reading back the rows of a sweep: every damage is found.
#include <fcntl.h>
#include <unistd.h>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/descriptor.hpp"
#include "support/folder.hpp"
#include "sweep/case_rows.hpp"

namespace bbsim_test::test_case_rows {

using namespace bbsim::file;
using namespace bbsim::sweep;
using bbsim::InputError;
using bbsim::OutputError;
using Catch::Matchers::Contains;

namespace {

std::vector<std::string> lines_of(const std::string& file, bool& whole, off_t& end) {
  const Descriptor descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  PartLines reader(descriptor.get(), file, Blame::input);
  std::vector<std::string> lines;
  std::string_view line;
  while (reader.next(line)) {
    lines.emplace_back(line);
    whole = reader.whole();
    end = reader.end();
  }
  return lines;
}

const std::string header = "case,ball.radius,solver.method,status,reason,end_time,end_x";

}  // namespace

TEST_CASE("lines of any length are read, and an unterminated last line is reported") {
  const Folder folder;
  const std::string longest(1000000, 'y');
  bool whole = false;
  off_t end = 0;
  CHECK(lines_of(folder.put("a", "one\n\n" + longest + "\nlast\n"), whole, end) ==
        std::vector<std::string>{"one", "", longest, "last"});
  CHECK(whole);
  CHECK(end == 1000011);
  CHECK(lines_of(folder.put("b", "one\ncut"), whole, end) ==
        std::vector<std::string>{"one", "cut"});
  CHECK_FALSE(whole);
  CHECK(end == 7);
  CHECK(lines_of(folder.put("c", ""), whole, end).empty());
}

TEST_CASE("a read error is an error, never the end of the file") {
  const Folder folder;
  std::string_view line;
  for (const int descriptor : {-1, open(folder.name().c_str(), O_RDONLY | O_CLOEXEC)}) {
    const Descriptor owned(descriptor);
    PartLines input(descriptor, "a.csv", Blame::input), output(descriptor, "a.csv", Blame::output);
    CHECK_THAT(message_of<InputError>([&] { static_cast<void>(input.next(line)); }),
               Contains("cannot read a.csv: "));
    CHECK_THAT(message_of<OutputError>([&] { static_cast<void>(output.next(line)); }),
               Contains("cannot read a.csv: "));
  }
}

TEST_CASE("a row is split into its fields") {
  RowReader reader(header);
  REQUIRE(reader.read("12,0.01,radau,failed,\"it grew, \"\"fast\"\", and out\",0.744,nan").empty());
  CHECK(reader.case_number() == 12);
  CHECK(reader.text(3) == "failed");
  CHECK(reader.text(4) == "it grew, \"fast\", and out");
  CHECK(reader.number(5) == 0.744);
  CHECK(std::isnan(reader.number(6)));
  REQUIRE(reader.read("13,0.01,radau,done,,10,-inf").empty());
  CHECK(reader.text(4).empty());
  CHECK(std::isinf(reader.number(6)));
}

TEST_CASE("a row that no sweep would write is reported") {
  RowReader reader(header);
  const std::vector<std::pair<std::string, std::string>> rows{
      {"", "does not begin with the number of a case"},
      {"x,0.01,radau,done,,10,1", "does not begin with the number of a case"},
      {"-1,0.01,radau,done,,10,1", "does not begin with the number of a case"},
      {"1.5,0.01,radau,done,,10,1", "does not begin with the number of a case"},
      {"12", "1 field where 7 belong"},
      {"12,0.01,radau,done,,10", "6 fields where 7 belong"},
      {"12,0.01,radau,done,,10,1,2", "8 fields where 7 belong"},
      {"12,0.01,radau,done,,10,", "something other than a number in field 7"},
      {"12,0.01,radau,done,,1O,1", "something other than a number in field 6"},
      {"12,0.01,radau,done,,10 ,1", "something other than a number in field 6"},
      {"12,0.01,radau,done,\"open,10,1", "a quote that is not closed"},
      {"12,0.01,radau,done,\"shut\"x,10,1", "a quote that is not closed"},
      {std::string("12,0.01,radau,done,\0\0,10,1", 26), "zero bytes"},
      {std::string(4096, '\0'), "zero bytes"}};
  for (const auto& [row, found] : rows) {
    CAPTURE(row);
    CHECK_THAT(reader.read(row), Contains(found));
  }
}

TEST_CASE("the columns determine which fields are numbers and which are texts") {
  RowReader reader(std::vector<Hdf5Column>{{"case", "", ""},
                                           {"gravity", "", ""},
                                           {"status", "", "", Hdf5Kind::text},
                                           {"x", "", "", Hdf5Kind::series, 3}});
  CHECK(reader.read("1,9.81,done").empty());
  CHECK_FALSE(reader.read("1,heavy,done").empty());
  CHECK_FALSE(reader.read("1,9.81,done,3").empty());
}

}  // namespace bbsim_test::test_case_rows
