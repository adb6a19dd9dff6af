// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Polynomials through Chebyshev points, and the greatest values of functions found with them.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/maxima.hpp"
#include "catch.hpp"

namespace bbsim_test::test_maxima {

using namespace bbsim;

namespace {

template <class Function>
std::vector<double> values_at(const ChebyshevPoints& points, Function function) {
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); ++i) values.push_back(function(points[i]));
  return values;
}

// Greatest value of a function, from the given number of intervals.
template <class Function>
double greatest_of(Function function, std::size_t intervals, Between between) {
  const ChebyshevPoints points(intervals);
  const std::vector<double> values = values_at(points, function);
  double greatest = -std::numeric_limits<double>::infinity();
  for (const double value : values) greatest = value > greatest ? value : greatest;
  for_each_bracket(points, values.data(), greatest, between, [&](const Bracket& bracket) {
    const Peak peak = climb(bracket, 1e-7 * (bracket.to.at - bracket.from.at), function);
    CHECK(peak.at >= bracket.from.at);
    CHECK(peak.at <= bracket.to.at);
    CHECK(peak.value == function(peak.at));
    if (peak.value > greatest) greatest = peak.value;
  });
  return greatest;
}

}  // namespace

TEST_CASE("interpolating a polynomial returns that polynomial") {
  const auto cubic = [](double s) { return 2 - 3 * s + 5 * s * s - 7 * s * s * s; };
  for (const std::size_t intervals : {3, 4, 7, 16, 64}) {
    const ChebyshevPoints points(intervals);
    REQUIRE(points.size() == intervals + 1);
    CHECK(points[0] == 0);
    CHECK(points[intervals] == 1);
    const std::vector<double> values = values_at(points, cubic);
    for (double s = 0; s <= 1; s += 1.0 / 32) {
      CHECK(points.at(values.data(), s) == Approx(cubic(s)).margin(1e-14));
    }
    // Sums of one product per point, each up to 2 intervals^2.
    const double rounding = 1e-15 * static_cast<double>(intervals * intervals);
    CHECK(points.slope_at_start(values.data()) == Approx(-3).margin(rounding));
    CHECK(points.slope_at_end(values.data()) == Approx(-3 + 10 - 21).margin(rounding));
    const ChebyshevPoints more(2 * intervals);
    for (std::size_t i = 0; i < intervals; ++i) {
      CHECK(points.between(values.data(), i) == Approx(cubic(more[2 * i + 1])).margin(1e-14));
    }
  }
}

TEST_CASE("the tail of a polynomial is the size of its last two coefficients") {
  const ChebyshevPoints points(8);
  const auto chebyshev = [&](double degree) {
    return values_at(points, [=](double s) { return std::cos(degree * std::acos(1 - 2 * s)); });
  };
  CHECK(points.tail(chebyshev(8).data()) == Approx(1));
  CHECK(points.tail(chebyshev(7).data()) == Approx(1));
  CHECK(points.tail(chebyshev(6).data()) < 1e-15);
  CHECK(points.tail(chebyshev(0).data()) < 1e-15);
}

TEST_CASE("the greatest value of a wave is found wherever it is") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 2000; ++i) {
    // Up to one and a half half-waves, with the maximum sometimes next to or at an end.
    const double rate = 1 + 4 * uniform(random), phase = 2 * M_PI * uniform(random);
    const auto wave = [=](double s) { return std::cos(rate * s + phase); };
    const bool turns = rate + phase >= 2 * M_PI;
    const double expected = turns ? 1.0 : std::max(wave(0), wave(1));
    CAPTURE(rate, phase);
    CHECK(std::abs(greatest_of(wave, 8, Between::smooth) - expected) < 1e-13);
  }
}

TEST_CASE("corners are found as well") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 500; ++i) {
    const double corner = uniform(random), steepness = 1 + uniform(random);
    const auto tent = [=](double s) {
      return 3 - std::abs(s - corner) * (s < corner ? 1 : steepness);
    };
    CAPTURE(corner, steepness);
    // The place is found to 1e-7 of the distance between points.
    CHECK(std::abs(greatest_of(tent, 16, Between::kinks) - 3) < 1e-7);
  }
}

TEST_CASE("nothing is searched if nothing rises above the points") {
  const ChebyshevPoints points(8);
  int looks = 0;
  const auto count = [&](const Bracket&) { ++looks; };
  const auto look = [&](const auto& function, double best, Between between) {
    const std::vector<double> values = values_at(points, function);
    for_each_bracket(points, values.data(), best, between, count);
  };
  const auto level = [](double) { return 0.3; };
  const auto rises = [](double s) { return 2 * s; };
  const auto hill = [](double s) { return s * (1 - s); };
  const auto none = [](double) { return std::numeric_limits<double>::quiet_NaN(); };
  look(level, 0.3, Between::smooth);
  look(level, 0.3, Between::kinks);
  look(rises, 2, Between::smooth);
  look(hill, 1, Between::smooth);  // 1 exceeds the hill
  look(none, 0, Between::smooth);
  look(none, 0, Between::kinks);
  CHECK(looks == 0);
  look(hill, 0.2, Between::smooth);
  CHECK(looks == 1);
}

TEST_CASE("a NaN at a point hides no maximum elsewhere") {
  const ChebyshevPoints points(16);
  const auto hill = [](double s) { return std::sin(M_PI * s); };
  std::vector<double> values = values_at(points, hill);
  values[1] = std::numeric_limits<double>::quiet_NaN();
  // The slopes at the ends are then NaN, the inner brackets are not.
  double greatest = 0.99;
  for_each_bracket(points, values.data(), greatest, Between::smooth, [&](const Bracket& bracket) {
    greatest = std::max(greatest, climb(bracket, 1e-9, hill).value);
  });
  CHECK(greatest == Approx(1).epsilon(1e-13));
}

TEST_CASE("a maximum next to an end is found through refined values") {
  // Like a servo's rate just before its command changes: 1e-6 above the end.
  const double place = GENERATE(0.999, 0.001);
  const auto function = [place](double s) { return -(s - place) * (s - place); };
  const ChebyshevPoints points(8), twice(16);
  std::vector<double> values(points.size()), finer;
  for (std::size_t i = 0; i < points.size(); ++i) values[i] = function(points[i]);
  double greatest = *std::max_element(values.begin(), values.end());
  REQUIRE(greatest == Approx(-1e-6));
  refine(points, values.data(), greatest, finer);
  for_each_bracket(twice, finer.data(), greatest, Between::smooth, [&](const Bracket& bracket) {
    greatest = std::max(greatest, climb(bracket, 1e-9, function).value);
  });
  CHECK(std::abs(greatest) < 1e-16);
}

}  // namespace bbsim_test::test_maxima
