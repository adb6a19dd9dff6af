// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The pose of random three-legged plates, followed up to poses that are nearly singular.
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "base/error.hpp"
#include "catch.hpp"
#include "model/servo/linkages.hpp"

namespace bbsim_test::test_random_legs {

using namespace bbsim;
using model::ThreeServos;

namespace {

using Pose = ThreeServos::Pose<double>;

// The servos' angles on a straight way from home, rad, and their horns' directions.
struct Servos {
  double angle[3], sine[3], cosine[3];

  Servos(const ThreeServos& legs, const double (&direction)[3], double way) {
    static_cast<void>(legs.home(angle));
    for (int i = 0; i < 3; ++i) angle[i] += way * direction[i];
    legs.directions(angle, sine, cosine);
  }
};

// The ratio of the singular values of the leg equations, with z relative to the plate's radius.
double singular_ratio(const ThreeServos& legs, const Pose& at, const Servos& servos) {
  const auto there = legs.jacobian(at, servos.sine, servos.cosine);
  Eigen::Matrix3d by;
  for (int i = 0; i < 3; ++i) {
    by.row(i) << there.of[i].of[0], there.of[i].of[1], there.of[i].of[2] * legs.leg[0].plate;
  }
  const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(by).singularValues();
  return values[0] / values[2];
}

double distance(const ThreeServos& legs, const Pose& a, const Pose& b) {
  return std::abs(a.p - b.p) + std::abs(a.q - b.q) + std::abs(a.z - b.z) / legs.leg[0].plate;
}

// The pose a short way further, in steps so short that no other pose is as near. Empty at the edge.
std::optional<Pose> continued(const ThreeServos& legs, const double (&direction)[3],
                              const Pose& from, double& way) {
  for (double step = 2e-3; step > 1e-12; step /= 2) {
    const Servos servos(legs, direction, way + step);
    ThreeServos::Jacobian<double> there;
    const Pose to = legs.pose_near(from, servos.sine, servos.cosine, there);
    Pose next;
    const bool solves = legs.newton_step(servos.sine, servos.cosine, to, next, there) < 1e-24;
    if (!solves || !(distance(legs, from, to) < 1e-3)) continue;
    way += step;
    return to;
  }
  return {};
}

ThreeServos random_legs(std::mt19937_64& draw) {
  std::uniform_real_distribution<double> unit(0, 1);
  for (;;) {
    const double base = 0.04 + 0.06 * unit(draw), plate = 0.04 + 0.08 * unit(draw);
    const double horn = 0.02 + 0.04 * unit(draw), rod = 0.08 + 0.08 * unit(draw);
    const double height = 0.06 + 0.1 * unit(draw);
    try {
      return model::make_three_servos({{base, plate, horn, rod, height}}, model::Assumed::exact);
    } catch (const InputError&) {  // they do not close at home
    }
  }
}

}  // namespace

TEST_CASE("in long steps, legs of any size keep their assembly up to singular values of 1 : 500") {
  std::mt19937_64 draw(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  int almost_singular = 0;
  for (int path = 0; path < 200; ++path) {
    CAPTURE(path);
    const ThreeServos legs = random_legs(draw);
    double direction[3], from[3];
    for (double& one : direction) one = normal(draw);
    const double most =
        std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])});
    for (double& one : direction) one /= most;
    const double step = 0.05 + 0.19 * unit(draw);  // rad
    Pose fine = legs.home(from), coarse = fine;
    double way = 0;
    for (double next = step; way < 1.6;) {
      const double before = way;
      const auto further = continued(legs, direction, fine, way);
      const bool at_end = !further || singular_ratio(legs, *further, {legs, direction, way}) > 500;
      if (at_end) way = before;
      almost_singular += at_end;
      if (!at_end) fine = *further;
      if (!at_end && way < next) continue;
      const Servos servos(legs, direction, way);
      ThreeServos::Jacobian<double> there;
      coarse = legs.pose_from(coarse, from, servos.angle, servos.sine, servos.cosine, there);
      // Rounding, 500 times; poses of another assembly differ by more than 1e-3.
      REQUIRE(distance(legs, coarse, fine) < 1e-11);
      const Pose from_home = legs.pose(servos.angle, servos.sine, servos.cosine, there);
      REQUIRE(distance(legs, from_home, fine) < 1e-11);
      if (at_end) break;
      std::copy_n(servos.angle, 3, from);
      next = way + step;
    }
  }
  CHECK(almost_singular > 20);
}

}  // namespace bbsim_test::test_random_legs
