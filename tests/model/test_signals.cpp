// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Profiles and splines: values, derivatives and common properties.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "model/random_states.hpp"
#include "model/signals/signal_pair.hpp"

namespace bbsim_test::test_signals {

using namespace bbsim;
using namespace bbsim::model;

namespace {

constexpr double epsilon = 2.3e-16;

}  // namespace

TEST_CASE("a profile is the sum of its terms, with two derivatives") {
  SignalPair pair;
  pair.add(0, {0.5, Ramp{0.1, 2}, Sinusoid{0.3, 5, 0.7, 0.01}, Sinusoid{0.2, 5, -1, 0}});
  pair.add(1, {Sinusoid{0.4, 3, 0, 0}});
  for (const double t : {0.0, 0.37, 12.5}) {
    const auto [phi, theta] = pair.at(t);
    const double a = 5 * t + 0.7, b = 5 * t - 1;
    // The argument 5 t has the rounding of t, the sum adds a few errors.
    const double bound = 8 * epsilon * (1 + 5 * t) * 25;
    CHECK(std::abs(phi.value - (0.61 + 2 * t + 0.3 * std::sin(a) + 0.2 * std::sin(b))) < bound);
    CHECK(std::abs(phi.rate - (2 + 1.5 * std::cos(a) + 1.0 * std::cos(b))) < bound);
    CHECK(std::abs(phi.acceleration - (-7.5 * std::sin(a) - 5.0 * std::sin(b))) < bound);
    CHECK(std::abs(theta.value - 0.4 * std::sin(3 * t)) < bound);
    CHECK(std::abs(theta.acceleration + 3.6 * std::sin(3 * t)) < bound);
  }
  CHECK(pair.highest_frequency() == 5);
}

TEST_CASE("a spline reproduces a cubic and its derivatives") {
  const std::vector<double> times{0, 0.5, 0.7, 2, 3.5, 4};
  const auto cubic = [](double t) { return 1 + t * (-2 + t * (0.5 + t * 0.25)); };
  std::vector<double> values;
  for (const double t : times) values.push_back(cubic(t));
  const Spline spline(times, values);
  bbsim_test::Random random(8);
  for (int i = 0; i < 100; ++i) {
    const double t = random.uniform(0, 4);
    const Jet<double> jet = spline.at(t);
    // Divided differences over the shortest interval, 0.2 s, magnify rounding 25 times for the
    // second derivative, on values up to 25.
    CHECK(std::abs(jet.value - cubic(t)) < 200 * epsilon * 25);
    CHECK(std::abs(jet.rate - (-2 + t * (1 + t * 0.75))) < 1000 * epsilon * 25);
    CHECK(std::abs(jet.acceleration - (1 + t * 1.5)) < 5000 * epsilon * 25);
  }
}

TEST_CASE("a spline passes through its table and is C2") {
  const std::vector<double> times{0, 1, 1.5, 4, 5}, values{0, 0.3, -0.2, 0.5, 0.1};
  const Spline spline(times, values);
  for (std::size_t i = 0; i < times.size(); ++i) {
    CHECK(std::abs(spline.at(times[i]).value - values[i]) < 20 * epsilon);
  }
  for (std::size_t i = 1; i + 1 < times.size(); ++i) {
    const double h = 1e-9;
    const Jet<double> left = spline.at(times[i] - h), right = spline.at(times[i] + h);
    // Across 2 h a derivative changes by 2 h times the next one, at most 100 here.
    CHECK(std::abs(left.rate - right.rate) < 2 * h * 100);
    CHECK(std::abs(left.acceleration - right.acceleration) < 2 * h * 100);
  }
}

TEST_CASE("a spline of a smooth function converges with fourth order") {
  const auto error = [](int n) {
    std::vector<double> times, values;
    for (int i = 0; i <= n; ++i) {
      times.push_back(3.0 * i / n);
      values.push_back(std::sin(times.back()));
    }
    const Spline spline(times, values);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
      const double t = 3.0 * i / 500;
      worst = std::max(worst, std::abs(spline.at(t).value - std::sin(t)));
    }
    return worst;
  };
  CHECK(std::log2(error(20) / error(40)) > 3.7);  // observed order, one-sided
}

}  // namespace bbsim_test::test_signals
