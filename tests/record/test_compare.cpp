// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which values count as equal, and how differences are reported.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "record/compare.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_compare {

using bbsim::InputError;
using bbsim::file::read_table;
using bbsim::file::Table;
using bbsim::record::Allowance;
using bbsim::record::compare;
using bbsim::record::Comparison;
using Catch::Matchers::Contains;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();

bool alike(double a, double b, const Allowance& allowance = {}) {
  return compare({{"x"}, {{a}}}, {{"x"}, {{b}}}, allowance).alike();
}

// Reads the cells of a CSV from its text.
Table cells(const std::string& text, const std::vector<std::string>& wanted = {}) {
  const Folder folder;
  return read_table(folder.put("a.csv", text), {wanted, {}});
}

const Table three_rows{{"t", "x"}, {{0, 0.5, 1}, {1, 2, 4}}};

}  // namespace

TEST_CASE("two values are alike within atol + rtol max(|a|, |b|)") {
  // Powers of two, so that sums and products are exact and the limit is met exactly.
  struct Pair {
    double a, b;
    Allowance allowance;
    bool alike;
  };
  const Allowance standard, none{0, 0}, quarter{0.25, 0}, half{0, 0.5};
  const Pair pairs[] = {
      {4, 5.5, {0.25, 0.5}, true},  // 1.5 <= 0.5 + 0.25 * 5.5 = 1.875
      {0, 0.5, half, true},
      {0, std::nextafter(0.5, 1), half, false},
      {3, 4, quarter, true},
      {4, 3, quarter, true},
      {std::nextafter(3, 0), 4, quarter, false},
      {-4, -3, quarter, true},
      {-4, 4, quarter, false},
      {1, 1 + 1e-10, standard, true},  // tolerates only rounding
      {1, 1 + 1e-8, standard, false},
      {0, 1e-13, standard, true},
      {0, 1e-11, standard, false},
      {1, 1, none, true},
      {0.0, -0.0, none, true},
      {0, 5e-324, none, false},
      {largest, -largest, {1, 0}, false},  // the difference overflows
  };
  for (const Pair& one : pairs) {
    CAPTURE(one.a, one.b);
    CHECK(alike(one.a, one.b, one.allowance) == one.alike);
  }
}

TEST_CASE("NaN equals NaN, and an infinity itself, for any allowance") {
  const double special[] = {not_a_number, infinity, -infinity, 0, 1};
  for (const Allowance& allowance : {Allowance{0, 0}, Allowance{1e308, 1e308}}) {
    for (const double a : special) {
      for (const double b : special) {
        if (std::isfinite(a) && std::isfinite(b)) continue;
        CAPTURE(a, b);
        CHECK(alike(a, b, allowance) == (a == b || (std::isnan(a) && std::isnan(b))));
      }
    }
  }
}

TEST_CASE("columns match by name, in any order") {
  const Table swapped({three_rows.columns[1], three_rows.columns[0]});
  const Comparison result = compare(three_rows, swapped);
  CHECK(result.alike());
  REQUIRE(result.columns.size() == 2);
  CHECK(result.columns[0].name == "t");
  CHECK(result.columns[1].different_rows == 0);
  CHECK(result.columns[1].worst.excess == 0);
}

TEST_CASE("the worst value exceeds its allowance by most") {
  // The allowance is half the larger value. y differs most; small z exceeds its allowance most.
  const Table a{{"t", "y", "z"}, {{0, 0.5, 1}, {100, 100, 100}, {1, 1, 0.125}}};
  const Table b{{"t", "y", "z"}, {{0, 0.5, 1}, {100, 400, 100}, {1, 1.5, 0.5}}};
  const Comparison result = compare(a, b, {0.5, 0});
  CHECK_FALSE(result.alike());
  CHECK(result.columns[0].different_rows == 0);
  const auto& y = result.columns[1];
  CHECK(y.worst.row == 1);
  CHECK(y.worst.a == 100);
  CHECK(y.worst.b == 400);
  CHECK(y.worst.difference == 300);
  CHECK(y.worst.allowance == 200);
  CHECK(y.worst.excess == 1.5);
  CHECK(y.different_rows == 1);
  const auto& z = result.columns[2];
  CHECK(z.largest.row == 1);  // 0.5, within its allowance of 0.75
  CHECK(z.largest.difference == 0.5);
  CHECK(z.worst.row == 2);
  CHECK(z.worst.excess == 0.375 / 0.25);
  // y and z tie at 1.5: the larger difference wins.
  REQUIRE(result.worst.has_value());
  CHECK(*result.worst == 1);
  REQUIRE(result.worst_time.has_value());
  CHECK(*result.worst_time == 0.5);
}

TEST_CASE("a nonfinite value is worse than any number") {
  const Comparison result =
      compare({{"x"}, {{0, not_a_number, 0}}}, {{"x"}, {{1e300, 1, 1e300}}}, {0, 1e-300});
  CHECK(result.columns[0].worst.row == 1);
  CHECK(result.columns[0].worst.difference == infinity);
  CHECK(result.columns[0].different_rows == 3);
  CHECK_FALSE(result.worst_time.has_value());  // no column t
}

TEST_CASE("a column on one side only is a difference, unless others are requested") {
  const Table more{{"t", "x", "y"}, {{0, 0.5, 1}, {1, 2, 4}, {0, 0, 0}}};
  const Comparison right = compare(three_rows, more);
  CHECK_FALSE(right.alike());
  CHECK(right.only_in_b == std::vector<std::string>{"y"});
  CHECK(right.only_in_a.empty());
  const Comparison left = compare(more, three_rows);
  CHECK_FALSE(left.alike());
  CHECK(left.only_in_a == std::vector<std::string>{"y"});
  CHECK(compare(more, three_rows, {}, {"x", "t"}).alike());

  const Table other{{"t", "x"}, {{0, 0.5, 1}, {9, 9, 9}}};
  CHECK(compare(three_rows, other, {}, {"t"}).alike());
  CHECK_FALSE(compare(three_rows, other, {}, {"t", "x"}).alike());
  // Without a common column there is no worst one.
  const Comparison none = compare({{"x"}, {{1}}}, {{"y"}, {{1}}});
  CHECK_FALSE(none.alike());
  CHECK_FALSE(none.worst.has_value());
}

TEST_CASE("different numbers of rows are a difference; the common rows are compared") {
  const Table shorter{{"t", "x"}, {{0, 0.5}, {1, 3}}};
  const Comparison result = compare(three_rows, shorter);
  CHECK_FALSE(result.alike());
  CHECK(result.rows_a == 3);
  CHECK(result.rows_b == 2);
  CHECK(result.columns[1].worst.row == 1);
  const Table prefix{{"t", "x"}, {{0, 0.5}, {1, 2}}};
  CHECK_FALSE(compare(prefix, three_rows).alike());
  const Table empty{{"t", "x"}, {{}, {}}};
  CHECK_FALSE(compare(empty, three_rows).alike());
  CHECK(compare(empty, empty).alike());
}

TEST_CASE("columns that are missing and invalid tolerances are refused by name") {
  const auto refusal = [](const Allowance& allowance, const std::vector<std::string>& names) {
    const Table other{{"t"}, {{0, 0.5, 1}}};
    return message_of<InputError>([&] { (void)compare(three_rows, other, allowance, names); });
  };
  CHECK(refusal({}, {"t", "vz"}) == "--columns: the first file has no column \"vz\"; it has t, x");
  CHECK(refusal({}, {"x"}) == "--columns: the second file has no column \"x\"; it has t");
  for (const double bad : {-1e-300, not_a_number, infinity}) {
    CHECK_THAT(refusal({bad, 0}, {"t"}), Contains("--rtol: found "));
    CHECK_THAT(refusal({0, bad}, {"t"}), Contains("--atol: found "));
  }
}

TEST_CASE("the report names files, columns, rows, times, values and what is missing") {
  const auto report = [](const Table& other, const Allowance& allowance) {
    return to_text(compare(three_rows, other, allowance), "a.csv", "b.csv", allowance);
  };
  CHECK_THAT(report({{"t", "x"}, {{0, 0.5, 1}, {1, 2.5, 4}}}, {0.125, 0}),
             Contains("different: worst in column x, row 1 (t = 0.5): 2 in a.csv, 2.5 in b.csv; "
                      "the difference is 0.5, the tolerance 0.312\n"));
  CHECK_THAT(report(three_rows, {}),
             Contains("\nalike: a.csv and b.csv, 2 columns, 3 rows, within rtol 1e-09 and atol "
                      "1e-12\n") &&
                 !Contains("different"));
  CHECK_THAT(report({{"t", "y"}, {{0}, {1}}}, {}),
             Contains("different: column x is in a.csv but not in b.csv\n") &&
                 Contains("different: column y is in b.csv but not in a.csv\n") &&
                 Contains("different: a.csv has 3 rows, b.csv has 1 row\n") && !Contains("alike:"));
}

TEST_CASE("texts must be equal, numbers within the tolerance") {
  const Table a = cells("case,status,x\n0,done,1\n1,\"failed at 1 s: no, \"\"never\"\"\",2\n");
  CHECK(a.columns[1].texts == std::vector<std::string>{"done", "failed at 1 s: no, \"never\""});
  CHECK(compare(a, a).alike());
  const Table b = cells("case,status,x\n0,done,1.0000000001\n1,failed,2\n");
  const Comparison result = compare(a, b);
  CHECK_FALSE(result.alike());
  CHECK(result.columns[1].different_rows == 1);
  CHECK(result.columns[2].different_rows == 0);
  CHECK_THAT(to_text(result, "a.csv", "b.csv", {}),
             Contains("different: worst in column status, row 1: \"failed at 1 s: no, \"never\"\" "
                      "in a.csv, \"failed\" in b.csv\n"));
  CHECK(compare(a, b, {}, {"case", "x"}).alike());
}

TEST_CASE("a number in place of a text is a difference") {
  const Table a = cells("kp,x\n2,0\nnone,0\n,0\n"), b = cells("kp,x\n2,0\n3,0\n,0\n");
  CHECK(compare(a, a).alike());
  const Comparison result = compare(a, b);
  CHECK(result.columns[0].different_rows == 1);
  CHECK_THAT(to_text(result, "a", "b", {}), Contains("\"none\" in a, 3 in b\n"));
}

TEST_CASE("only the named columns are parsed") {
  const std::string huge = "when,x,y\nMonday,1,1e999\nTuesday,2,1e999\n";
  CHECK_THAT(message_of<InputError>([&] { (void)cells(huge); }), Contains("too large"));
  const Table a = cells(huge, {"x"});
  CHECK(a.names() == std::vector<std::string>{"when", "x", "y"});
  CHECK(a.rows == 2);
  CHECK(a.columns[0].numbers.empty());
  CHECK(a.columns[1].numbers == std::vector<double>{1, 2});
  CHECK(compare(a, a, {}, {"x"}).alike());
}

TEST_CASE("several numbers per row are compared one by one, with their times") {
  Table a({{"case", {0, 1}}, {"x", {1, 2, 3, 4, 5, 6}, {}, "", 3}, {"t", {0, 0.5, 1}, {}, "", 3}});
  Table b = a;
  CHECK(compare(a, b).alike());
  b.columns[1].numbers[4] = 7;
  b.columns[1].numbers[5] = 6.5;
  const Comparison result = compare(a, b);
  CHECK(result.columns[1].different_rows == 1);
  CHECK(result.columns[1].worst.row == 1);
  CHECK(result.columns[1].worst.position == 1);
  CHECK(result.worst_time == 0.5);
  const Table narrow(
      {{"case", {0, 1}}, {"x", {1, 2, 4, 5}, {}, "", 2}, {"t", {0, 0.5}, {}, "", 2}});
  CHECK_FALSE(compare(a, narrow).alike());
  CHECK_THAT(to_text(compare(a, narrow), "a", "b", {}),
             Contains("different: column x has 3 numbers a row in a, 2 in b\n"));
}

}  // namespace bbsim_test::test_compare
