// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The greatest tilt and rate of prescribed motions, against dense sampling.
#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"
#include "record/track/gimbal_extremes.hpp"
#include "support/greatest_of.hpp"

namespace bbsim_test::test_gimbal_extremes {

using namespace bbsim;
using namespace bbsim::record;
using bbsim_test::greatest_of;

namespace {

// The greatest tilt and rate at the sampled times.
GimbalExtremes::Greatest at_many_times(const model::SignalPair& motion, double end) {
  constexpr std::size_t times = 400000;
  std::vector<double> tilts, rates;
  for (std::size_t i = 0; i <= times; ++i) {
    const auto [phi, theta] = motion.at(end * static_cast<double>(i) / times);
    const double cos_phi = std::cos(phi.value), cos_theta = std::cos(theta.value);
    tilts.push_back(std::atan2(std::hypot(std::sin(phi.value), cos_phi * std::sin(theta.value)),
                               cos_phi * cos_theta));
    rates.push_back(std::hypot(phi.rate, theta.rate));
  }
  return {greatest_of(tilts), greatest_of(rates)};
}

void check_gimbal(const model::SignalPair& motion, double end) {
  const GimbalExtremes::Greatest found = GimbalExtremes().of(motion, end);
  const GimbalExtremes::Greatest expected = at_many_times(motion, end);
  CHECK(found.tilt == Approx(expected.tilt).epsilon(1e-10));
  CHECK(found.rate == Approx(expected.rate).epsilon(1e-10));
}

}  // namespace

TEST_CASE("a prescribed motion's greatest tilt and rate agree with dense sampling") {
  model::SignalPair motion;
  SECTION("at rest") {
    motion.add_constant(0, 0.2);
    const GimbalExtremes::Greatest found = GimbalExtremes().of(motion, 5);
    CHECK(found.tilt == Approx(0.2).epsilon(1e-14));
    CHECK(found.rate == 0);
  }
  SECTION("one frequency, part of a period or many") {
    const double end = GENERATE(0.1, 1.0, 2.5, 40.0);
    const double level = GENERATE(0.0, 0.1);
    const double size = GENERATE(0.01, 1.2);
    motion.add_constant(0, level);
    motion.add_sinusoid(0, size, 1.3, 0.4);
    motion.add_sinusoid(1, 0.7 * size, 1.3, 2);
    check_gimbal(motion, end);
  }
  SECTION("several frequencies and a ramp") {
    motion.add_sinusoid(0, 0.2, 1.3, 0.4);
    motion.add_sinusoid(0, 0.05, 17, 1);
    motion.add_sinusoid(1, 0.1, 3.1, 2);
    motion.add_ramp(1, 0.1, 0.02);
    check_gimbal(motion, 20);
  }
  SECTION("turning over and over") {
    motion.add_ramp(0, 0, 3);
    motion.add_constant(1, 0.3);
    const GimbalExtremes::Greatest found = GimbalExtremes().of(motion, 20);
    // The normal is furthest from the vertical at half a turn of phi.
    CHECK(found.tilt == Approx(M_PI - 0.3).epsilon(1e-10));
    CHECK(found.rate == Approx(3).epsilon(1e-14));
  }
  SECTION("tables") {
    std::vector<double> times, values;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    for (int i = 0; i < 40; ++i) {
      times.push_back(0.25 * i);
      values.push_back(uniform(random));
    }
    motion.add_table(0, model::Spline(times, values));
    motion.add_sinusoid(1, 0.2, 2, 0);
    check_gimbal(motion, 9.3);
  }
}

TEST_CASE("cached values of one motion are not used for another") {
  GimbalExtremes gimbal;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.1, 1);
  for (int i = 0; i < 20; ++i) {
    model::SignalPair motion;
    motion.add_sinusoid(0, uniform(random), i % 3 == 0 ? 2 * uniform(random) : 1, uniform(random));
    motion.add_sinusoid(1, uniform(random), i % 2 == 0 ? 1 : 3 * uniform(random), uniform(random));
    const GimbalExtremes::Greatest found = gimbal.of(motion, 10),
                                   fresh = GimbalExtremes().of(motion, 10);
    CHECK(found.tilt == fresh.tilt);
    CHECK(found.rate == fresh.rate);
  }
}

}  // namespace bbsim_test::test_gimbal_extremes
