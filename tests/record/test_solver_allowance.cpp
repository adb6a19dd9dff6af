// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How far two HDF5 files may differ, given their solvers' tolerances.
#include <string>

#include "catch.hpp"
#include "record/compare.hpp"

namespace bbsim_test::test_solver_allowance {

using bbsim::file::Attributes;
using bbsim::file::Table;
using bbsim::record::Allowances;
using bbsim::record::solver_allowances;
using Catch::Matchers::Contains;

namespace {

const std::string scenario =
    "ball: {radius: 1 cm}\n"
    "gimbal: {servo: {natural_frequency: 30, damping: 1}}\n"
    "time: {end: 20, step: 1}\n"
    "controller: {table: {file: none.csv}}\n";  // neither read nor searched for

Table table(const Attributes& attributes) {
  Table made{
      {"t", "x", "y", "vx", "spin", "gamma", "phi", "phi_acceleration", "x_reference", "end_x"},
      {{0, 20}, {0.5, 0}, {-2, 0}, {0, 3}, {8, 0}, {0, 5}, {0, 0.1}, {0, 7}, {9, 9}, {1, 1}}};
  made.attributes = attributes;
  return made;
}

const Attributes tolerances{
    {"rtol", "1e-08"}, {"atol", "1e-10"}, {"scenario_text", scenario}, {"overrides", ""}};

}  // namespace

TEST_CASE("files without solver information allow nothing") {
  CHECK_FALSE(solver_allowances(table({}), table({})).has_value());
  CHECK_FALSE(solver_allowances(table({{"rtol", "1e-8"}}), table({})).has_value());
  CHECK_FALSE(solver_allowances(table({{"rtol", "-1"}, {"atol", "nan"}}), table({})).has_value());
}

TEST_CASE("tolerances become an allowance for each column, by its kind and unit") {
  const auto both = solver_allowances(table(tolerances), table(tolerances));
  REQUIRE(both.has_value());
  const auto allowed = [&](const char* column) { return both->of(column).atol; };
  // 1e-12 for rounding; for each file 100 (rtol size + atol unit).
  CHECK(allowed("x") == Approx(1e-12 + 200 * (1e-8 * 2 + 1e-10)));  // y is of the same kind as x
  CHECK(allowed("y") == allowed("x"));
  CHECK(allowed("end_x") == allowed("x"));
  CHECK(allowed("vx") == Approx(1e-12 + 200 * (1e-8 * 3 + 1e-10)));
  CHECK(allowed("spin") == Approx(1e-12 + 200 * (1e-8 * 8 + 1e-10 / 0.01)));
  CHECK(allowed("gamma") == Approx(1e-12 + 200 * (1e-8 * 5 + 1e-10 * 20 / 0.01)));
  CHECK(allowed("phi") == Approx(1e-12 + 200 * (1e-8 * 0.1 + 1e-10)));
  CHECK(allowed("phi_acceleration") == Approx(1e-12 + 200 * (1e-8 * 7 + 1e-10 * 30 * 32)));
  CHECK(allowed("t") == 1e-12);
  CHECK(allowed("x_reference") == 1e-12);
  CHECK(both->of("x").rtol == 1e-9);
  CHECK_THAT(both->reason, Contains("rtol 1e-08, atol 1e-10"));

  // A file without tolerances, such as CSV, adds nothing.
  const auto one = solver_allowances(table(tolerances), table({}));
  REQUIRE(one.has_value());
  CHECK(one->of("x").atol == Approx(1e-12 + 100 * (1e-8 * 2 + 1e-10)));
}

TEST_CASE("an override of the radius is used") {
  Attributes set = tolerances;
  set[3].second = "ball.mass=2\nball.radius=2 cm";
  const auto allowances = solver_allowances(table(set), table({}));
  REQUIRE(allowances.has_value());
  CHECK(allowances->of("spin").atol == Approx(1e-12 + 100 * (1e-8 * 8 + 1e-10 / 0.02)));
}

TEST_CASE("an error bound is the allowance of positions; everything else uses the tolerances") {
  const Attributes bound{{"rtol", "1e-08"}, {"atol", "1e-10"}, {"error_bound", "1e-06"}};
  Attributes missed = bound;
  missed.emplace_back("error_estimate", "5e-06");
  const auto allowances = solver_allowances(table(bound), table(missed));
  REQUIRE(allowances.has_value());
  CHECK(allowances->of("x").atol == Approx(1e-12 + 1e-6 + 5e-6));
  CHECK(allowances->of("vx").atol == Approx(1e-12 + 200 * (1e-8 * 3 + 1e-10)));
  CHECK_THAT(allowances->reason, Contains("positions to 1e-06 m") && Contains("5e-06 m"));
}

}  // namespace bbsim_test::test_solver_allowance
