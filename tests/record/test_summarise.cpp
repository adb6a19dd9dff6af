// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Groups of a sweep's cases.
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "catch.hpp"
#include "record/summarise.hpp"

namespace bbsim_test::test_summarise {

using namespace bbsim;
using namespace bbsim::record;

namespace {

file::Table table() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  file::Table table({"case", "k", "seed", "status", "end_time", "x.Peak", "max_y"},
                    {{0, 1, 2, 3, 4, 5},
                     {2, 1, 1, 1, 1, 2},
                     {1, 1, 2, 3, 4, 2},
                     {},
                     {9, 9, 1, 9, 9, 9},
                     {5, 1, 100, 2, 4, 7},
                     {1, nan, 1, nan, nan, 1}});
  for (const char* word : {"done", "done", "failed", "done", "done", "done"}) {
    table.columns[3].add_text(word);
  }
  return table;
}

}  // namespace

TEST_CASE("a sweep's cases by group") {
  const auto groups = summarise(table(), "sweep.csv", {"k"}, {}, {0.5, 0.25});
  REQUIRE(groups.size() == 2);
  CHECK(groups[0].values == std::vector<std::string>{"2"});  // as they first appear
  CHECK(groups[1].cases == 4);
  REQUIRE(groups[1].figures.size() == 2);
  const GroupFigures& peak = groups[1].figures[0];
  CHECK(peak.measure == "x.Peak");
  CHECK(peak.count == 3);  // the failed case has no value
  CHECK(peak.mean == Approx(7.0 / 3));
  CHECK(peak.deviation == Approx(std::sqrt(7.0 / 3)));
  CHECK(peak.least == 1);
  CHECK(peak.greatest == 4);
  CHECK(peak.quantiles[0] == 2);
  CHECK(peak.quantiles[1] == Approx(1.5));
  CHECK(groups[1].figures[1].count == 0);
  CHECK(std::isnan(groups[1].figures[1].mean));
  CHECK(groups[0].figures[1].deviation == 0);
  CHECK(to_csv({groups[0]}, {"k"}, {0.5, 0.25}) ==
        "k,measure,cases,count,mean,deviation,min,q50,q25,max\n"
        "2,x.Peak,2,2,6,1.4142135623730951,5,6,5.5,7\n"
        "2,max_y,2,2,1,0,1,1,1,1\n");
}

TEST_CASE("all cases form one group, and columns may be named") {
  const auto groups = summarise(table(), "sweep.csv", {}, {"max_y"}, {});
  REQUIRE(groups.size() == 1);
  CHECK(groups[0].cases == 6);
  CHECK(groups[0].figures[0].count == 2);
  CHECK_THROWS_AS(summarise(table(), "sweep.csv", {"z"}, {}, {}), InputError);
  CHECK_THROWS_AS(summarise(table(), "sweep.csv", {}, {"status"}, {}), InputError);
}

TEST_CASE("large values that are nearly equal keep their deviation") {
  const file::Table large({"v"}, {{1e9 + 1, 1e9 + 2, 1e9 + 3}});
  const auto groups = summarise(large, "large.csv", {}, {}, {});
  CHECK(groups[0].figures[0].mean == 1e9 + 2);
  CHECK(groups[0].figures[0].deviation == 1);
}

}  // namespace bbsim_test::test_summarise
