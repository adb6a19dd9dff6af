// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Merging CSV parts: rows of any length are copied, and every damage is found.
#include "base/error.hpp"
#include "catch.hpp"
#include "support/folder.hpp"
#include "sweep/merge.hpp"

namespace bbsim_test::test_merge {

using bbsim::InputError;
using Catch::Matchers::Contains;

namespace {

const std::string header = "case,ball.radius,solver.method,status,reason,end_time,end_x\n";
const std::atomic<bool> goes_on{false};

}  // namespace

TEST_CASE("parts are merged in the order of their cases, with texts of any kind") {
  const Folder folder;
  const std::string first = "0,0.01,radau,failed,\"it grew, \"\"fast\"\", and out\",0.744,nan\n",
                    second = "1,0.01," + std::string(1000000, 'y') + ",done,,10,-inf\n";
  const std::vector<std::string> parts{folder.put("b.csv", header + second),
                                       folder.put("a.csv", header + first),
                                       folder.put("none.csv", header)};
  const auto merged = bbsim::sweep::merge_cases(parts, folder / "m.csv", goes_on);
  CHECK(merged.cases == 2);
  const bool whole = content_of(folder / "m.csv") == header + first + second;
  CHECK(whole);
}

TEST_CASE("a row that no sweep would write is reported") {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> rows{
      {"\n", "does not begin with the number of a case"},
      {"x,0.01,radau,done,,10,1\n", "does not begin with the number of a case"},
      {"-1,0.01,radau,done,,10,1\n", "does not begin with the number of a case"},
      {"1.5,0.01,radau,done,,10,1\n", "does not begin with the number of a case"},
      {"1\n", "1 field where 7 belong"},
      {"1,0.01,radau,done,,10\n", "6 fields where 7 belong"},
      {"1,0.01,radau,done,,10,1,2\n", "8 fields where 7 belong"},
      {"1,0.01,radau,done,,10,\n", "something other than a number in field 7"},
      {"1,0.01,radau,done,,1O,1\n", "something other than a number in field 6"},
      {"1,0.01,radau,done,,10 ,1\n", "something other than a number in field 6"},
      {"1,0.01,radau,done,\"open,10,1\n", "quotes that no sweep writes"},
      {"1,0.01,radau,done,\"shut\"x,10,1\n", "quotes that no sweep writes"},
      {std::string("1,0.01,radau,done,\0\0,10,1\n", 26), "zero bytes"},
      {std::string(4096, '\0') + '\n', "zero bytes"},
      {"1,0.01,radau,done,,10,1", "an incomplete last row"},
      {"1,0.01,radau,done,,10,1\r\n", "an incomplete last row"},
      {"2,0.01,radau,done,,10,1\n", "case 2 where case 1 should come"}};
  for (const auto& [row, found] : rows) {
    CAPTURE(row);
    const std::string part = folder.put("a.csv", header + "0,0.01,radau,done,,10,1\n" + row);
    CHECK_THAT(message_of<InputError>([&] {
                 static_cast<void>(bbsim::sweep::merge_cases({part}, folder / "m.csv", goes_on));
               }),
               Contains("a.csv: found ") && Contains(found));
  }
  CHECK(folder.entries() == 1);
}

}  // namespace bbsim_test::test_merge
