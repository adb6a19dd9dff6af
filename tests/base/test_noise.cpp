// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Noise: normal and the same on every machine.
#include <cmath>

#include "catch.hpp"
#include "model/control/sampled_controller.hpp"

namespace bbsim_test::test_noise {

using namespace bbsim;
using namespace bbsim::model;

TEST_CASE("the normal quantile inverts the distribution") {
  for (double z = -8; z <= 8; z += 1.0 / 64) {
    const double p = std::erfc(-z / std::sqrt(2.0)) / 2;
    if (p <= 0 || p >= 1) continue;
    // The algorithm's own 2e-7 and, near 1, the rounding of p: eps / density.
    const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::acos(-1.0));
    const double rounding = z > 0 ? 2.3e-16 / density : 0;
    CHECK(std::abs(normal_quantile(p) - z) < 2e-7 * std::abs(z) + 1e-9 + rounding);
  }
}

TEST_CASE("noise has the requested mean and deviation, and repeats for a seed") {
  Noise noise(42), again(42), other(43);
  const int n = 100000;
  double sum = 0, squares = 0;
  bool differs = false;
  for (int i = 0; i < n; ++i) {
    const double value = noise.normal();
    CHECK_FALSE(value != again.normal());
    differs = differs || value != other.normal();
    sum += value;
    squares += value * value;
  }
  CHECK(differs);
  // Five standard deviations of the mean and of the variance of n values.
  CHECK(std::abs(sum / n) < 5 / std::sqrt(double(n)));
  CHECK(std::abs(squares / n - 1) < 5 * std::sqrt(2.0 / n));
}

TEST_CASE("uniform and normal numbers are drawn from one sequence, in turn") {
  Noise noise(7), uniform(7);
  for (int i = 0; i < 1000; ++i) {
    const double p = uniform.uniform();
    REQUIRE((i % 3 == 0 ? noise.uniform() == p : noise.normal() == normal_quantile(p)));
  }
}

TEST_CASE("the first noise of seed 1 is known: the same on every machine") {
  // std::mt19937_64's first output of seed 1 is 2469588189546311528 (the standard fixes it).
  Noise noise(1);
  CHECK(noise.uniform() == (2469588189546311528ULL >> 12U) * 0x1p-52 + 0x1p-53);
}

TEST_CASE("a sensor rounds, misses what it cannot see, reads then as told, and drops its share") {
  Sensor sensor;
  sensor.area = Pair{0.2, 0.1};
  sensor.dead_zones = {{0.02, -0.01, 0.04, 0.01}};
  sensor.resolution = 0.001;
  Pair seen{};
  BallSensor none(sensor);
  REQUIRE(none.read(0.01234, -0.0461, seen));
  CHECK(seen[0] == Approx(0.012).margin(1e-15));
  CHECK(seen[1] == Approx(-0.046).margin(1e-15));
  CHECK(none.read(0.03, 0.02, seen));
  CHECK_FALSE(none.read(0.03, 0, seen));         // in the dead zone
  CHECK_FALSE(none.read(0.01, 0, seen, false));  // with too little force
  CHECK_FALSE(none.read(0.0, 0.0501, seen));
  CHECK_FALSE(none.read(-0.1001, 0.0, seen));

  sensor.on_miss = OnMiss::last;
  BallSensor last(sensor);
  CHECK_FALSE(last.read(0.03, 0, seen));  // there is no last reading yet
  CHECK(last.read(-0.05, 0.02, seen));
  CHECK(last.read(0.03, 0, seen));
  CHECK(seen == Pair{-0.05, 0.02});
  sensor.on_miss = OnMiss::edge;
  sensor.offset = {0.01, 0};
  BallSensor edge(sensor);
  CHECK(edge.read(0.5, 0, seen));
  CHECK(std::abs(seen[0] + 0.09) < 1e-15);
  CHECK(seen[1] == -0.05);

  sensor.on_miss = OnMiss::none;
  sensor.dropout = 0.25;
  BallSensor drops(sensor);
  int missed = 0;
  const int n = 10000;
  for (int i = 0; i < n; ++i) missed += drops.read(0, 0, seen) ? 0 : 1;
  CHECK(std::abs(missed - 0.25 * n) < 5 * std::sqrt(n * 0.25 * 0.75));
}

}  // namespace bbsim_test::test_noise
