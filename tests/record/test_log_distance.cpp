// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <cstdint>
#include <limits>

#include "base/error.hpp"
#include "base/noise.hpp"
#include "catch.hpp"
#include "record/log_distance.hpp"

namespace bbsim_test::test_log_distance {

using bbsim::InputError;
using bbsim::file::Table;
using bbsim::record::log_distance;
using bbsim::record::LogDistance;
using bbsim::record::time_offset;
using Catch::Matchers::Contains;

namespace {

double motion(double t) {
  return std::sin(t) * std::exp(-0.2 * t);
}

// Rows `step` apart of the motion from `start` on, with a clock that is `early`.
Table rows(double start, double end, double step, double early, double wrong) {
  Table table{{"t", "x"}, {{}, {}}};
  for (double t = start; t <= end; t += step) {
    table.columns[0].numbers.push_back(t + early);
    table.columns[1].numbers.push_back(motion(t) + wrong);
  }
  return table;
}

}  // namespace

TEST_CASE("the distance of a log is measured at its rows within the run") {
  const Table run = rows(0, 10, 0.01, 0, 0);
  const LogDistance made = log_distance(rows(-1, 12, 0.3, 0, 0.25), run);
  REQUIRE(made.columns.size() == 1);
  CHECK(made.columns[0].name == "x");
  CHECK(made.columns[0].rms == Approx(0.25).epsilon(1e-4));
  CHECK(made.columns[0].greatest == Approx(0.25).epsilon(1e-4));
  CHECK(made.from >= 0);
  CHECK(made.to <= 10);
  CHECK(made.rows < made.rows_of_log);
  CHECK(made.columns[0].rows == made.rows);
  CHECK_THAT(to_text(made, "log", "run"), Contains("column") && Contains("log from run: "));
}

TEST_CASE("rates of the run curve the interpolation between its rows") {
  const Table line{{"t", "x"}, {{0, 1}, {0, 1}}};
  const Table curve{{"t", "x", "vx"}, {{0, 1}, {0, 1}, {0, 2}}};  // t^2
  const Table log{{"t", "x"}, {{0.5}, {0.25}}};
  CHECK(log_distance(log, line).columns[0].greatest == Approx(0.25));
  CHECK(log_distance(log, curve).columns[0].greatest == Approx(0).margin(1e-15));
}

TEST_CASE("cross-correlation finds the offset of a log's clock") {
  const Table run = rows(0, 10, 0.01, 0, 0);
  for (const double early : {-3.5, 0.0, 0.123, 1700.0}) {
    CAPTURE(early);
    const double offset = time_offset(rows(1, 9, 0.05, early, 0.1), run);
    CHECK(offset == Approx(-early).margin(1e-3));
  }
}

TEST_CASE("a column of noise alone does not move the offset") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    bbsim::Noise noise(seed);
    const auto with_noise_as_y = [&noise](Table table, double of_x) {
      std::vector<double>& y = table.columns.emplace_back(bbsim::file::Column{"y", {}}).numbers;
      for (double& x : table.find("x")->numbers) {
        x += of_x * noise.normal();
        y.push_back(1e-3 * noise.normal());
      }
      return table;
    };
    const double offset = time_offset(with_noise_as_y(rows(1, 9, 0.05, 5.3, 0), 1e-3),
                                      with_noise_as_y(rows(0, 10, 0.01, 0, 0), 0));
    CHECK(offset == Approx(-5.3).margin(1e-3));  // 5 standard deviations
  }
}

TEST_CASE("logs that cannot be compared are refused with the remedy") {
  const Table run = rows(0, 1, 0.1, 0, 0);
  CHECK_THROWS_WITH(log_distance(rows(0, 1, 0.1, 100, 0), run),
                    Contains("no time in common") && Contains("--time-offset"));
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(log_distance(run, {{"t", "x"}, {{none}, {none}}}), Contains(" s and nothing"));
  CHECK_THROWS_WITH(log_distance({{"ms", "x"}, {{0}, {0}}}, run), Contains("--map t=NAME:UNIT"));
  CHECK_THROWS_WITH(log_distance({{"t", "px"}, {{0}, {0}}}, run), Contains("no column in common"));
  CHECK_THROWS_AS(time_offset({{"t", "x"}, {{0, 1, 2}, {1, 1, 1}}}, run), InputError);
}

}  // namespace bbsim_test::test_log_distance
