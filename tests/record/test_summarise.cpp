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
  // Groups come as they first appear; the failed case has no value.
  CHECK(summarise(table(), "sweep.csv", {"k"}, {}, {0.5, 0.25}) ==
        "k,measure,cases,count,mean,deviation,min,q50,q25,max\n"
        "2,x.Peak,2,2,6,1.4142135623730951,5,6,5.5,7\n"
        "2,max_y,2,2,1,0,1,1,1,1\n"
        "1,x.Peak,4,3,2.333333333333333,1.5275252316519465,1,2,1.5,4\n"
        "1,max_y,4,0,nan,nan,nan,nan,nan,nan\n");
}

TEST_CASE("all cases form one group, and columns may be named") {
  CHECK(summarise(table(), "sweep.csv", {}, {"max_y"}, {}) ==
        "measure,cases,count,mean,deviation,min,max\nmax_y,6,2,1,0,1,1\n");
  CHECK_THROWS_AS(summarise(table(), "sweep.csv", {"z"}, {}, {}), InputError);
  CHECK_THROWS_AS(summarise(table(), "sweep.csv", {}, {"status"}, {}), InputError);
}

TEST_CASE("large values that are nearly equal keep their deviation") {
  const file::Table large({"v"}, {{1e9 + 1, 1e9 + 2, 1e9 + 3}});
  CHECK(summarise(large, "large.csv", {}, {}, {}) ==
        "measure,cases,count,mean,deviation,min,max\n"
        "v,3,3,1000000002,1,1000000001,1000000003\n");
}

}  // namespace bbsim_test::test_summarise
