// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Linkages between servos and plane: push rods, measured curves, three servos.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

#include "base/error.hpp"
#include "base/noise.hpp"
#include "base/quad.hpp"
#include "catch.hpp"
#include "model/servo/linkages.hpp"
#include "scenario/calibration.hpp"
#include "simd/gradient.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_linkage {

using namespace bbsim;
using namespace bbsim::model;
using Catch::Matchers::Contains;

namespace {

// phi and theta of a plate on three servos at these angles, rad, from its normal: (M61).
void angles_of(const model::ThreeServos& three, const double (&servo)[3], double (&plane)[2]) {
  double sine[3], cosine[3];
  three.directions(servo, sine, cosine);
  model::ThreeServos::Jacobian<double> there;
  const auto at = three.pose(servo, sine, cosine, there);
  const double theta = std::asin(-at.q);
  plane[0] = std::asin(at.p / std::cos(theta)) + three.offset[0];
  plane[1] = theta + three.offset[1];
}

// Horn, arm and rod of a desktop rig, all different.
RodLinkage desk() {
  return {0.025, 0.08, {}, {0.06, 0.09}};
}

// Linkages that close at home, well away from a dead point.
std::vector<RodLinkage> some_linkages() {
  std::mt19937_64 draw(12);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<RodLinkage> found;
  while (found.size() < 200) {
    RodLinkage one{0.01 + 0.05 * unit(draw),
                   0.02 + 0.1 * unit(draw),
                   {},
                   {0.2 * unit(draw) - 0.1, 0.3 * unit(draw) - 0.15}};
    if (std::abs(one.offset[1]) < 0.02) continue;
    found.push_back(one);
  }
  return found;
}

double rod_between(const Rods& rods, double servo, double arm) {
  return std::hypot(rods.x + rods.arm * std::cos(arm) - rods.horn * std::cos(servo),
                    rods.z + rods.arm * std::sin(arm) - rods.horn * std::sin(servo));
}

// Some angles within the curve, none near its ends.
std::vector<double> angles_within(const LinkCurve& curve) {
  std::vector<double> angles;
  const double low = std::max(curve.low, -1.5), high = std::min(curve.high, 1.5);
  for (int i = 1; i < 20; ++i) angles.push_back(low + (high - low) * i / 20);
  return angles;
}

}  // namespace

TEST_CASE("a push rod keeps its length, and has an exact inverse and its derivatives") {
  using Number = simd::WithGradient<1>;
  int beyond = 0;
  for (const RodLinkage& one : some_linkages()) {
    const Linkage linkage = make_linkage(one, Assumed::exact);
    const LinkCurve& curve = linkage.curve;
    CAPTURE(one.horn, one.arm, one.offset[0], one.offset[1]);
    const auto check_inverse = [&](double servo) {
      CAPTURE(servo);
      const double slope = curve.plain_turn(servo).slope;
      // The inverse's slope magnifies rounding of the plane's angle.
      const double bound = 1e-13 * std::max(1.0, 0.05 / std::abs(slope));
      CHECK(std::abs(linkage.servo_for(linkage.angle(servo)) - servo) < bound);
      // The same for every number type.
      const auto command = curve.command_for(Number::variable(linkage.angle(servo), 0));
      CHECK(std::abs(command.value - servo) < bound);
      return command.gradient[0] * slope;
    };
    CHECK(std::abs(linkage.angle(0)) < 1e-14);  // home; rounding, magnified near a dead point
    for (const double servo : angles_within(curve)) {
      // Rounding of sums of lengths up to 0.4 m.
      CHECK(std::abs(rod_between(curve.rods, servo, linkage.angle(servo)) - curve.rods.rod) <
            2e-15);
      CHECK(check_inverse(servo) == Approx(1).epsilon(1e-9));
      const Turn<Number> turn = curve.turn(Number::variable(servo, 0));
      const double slope = turn.slope.value;
      // d sin(beta) = cos(beta) beta', and so on: exact up to rounding.
      const double size = 1 + std::abs(slope) + std::abs(turn.bend.value);
      CHECK(std::abs(turn.sin.gradient[0] - turn.cos.value * slope) < 1e-11 * size);
      CHECK(std::abs(turn.slope.gradient[0] - turn.bend.value) < 1e-10 * size * size);
      // Fourth-order differences of the angle: h^4 times the fifth derivative, which is large near
      // a dead point, and rounding divided by h.
      if (servo < curve.low + 0.3 || servo > curve.high - 0.3) continue;
      const double h = 1e-3;
      const auto angle = [&](double at) { return curve.angle(at); };
      const double difference = (8 * (angle(servo + h) - angle(servo - h)) -
                                 (angle(servo + 2 * h) - angle(servo - 2 * h))) /
                                (12 * h);
      CHECK(std::abs(difference - slope) < 1e-7 * size);
    }
    // Some servos may turn by more than half a turn.
    if (!std::isfinite(curve.low) || !std::isfinite(curve.high)) continue;
    for (int i = 1; i < 50; ++i) {
      const double servo = curve.low + (curve.high - curve.low) * i / 50;
      beyond += std::abs(servo) > std::numbers::pi;
      check_inverse(servo);
    }
  }
  CHECK(beyond > 100);
}

TEST_CASE("with opposite bars of equal length the plane turns as the servo does") {
  std::mt19937_64 draw(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 200; ++i) {
    const double length = 0.01 + 0.05 * unit(draw), direction = 0.1 + 2.9 * unit(draw),
                 distance = 0.01 + 0.2 * unit(draw);
    const double x = distance * std::cos(direction), z = distance * std::sin(direction);
    const Linkage linkage = make_linkage(RodLinkage{length, length, {}, {x, z}}, Assumed::exact);
    CHECK(linkage.curve.slope == 1);
    for (double servo = -3; servo <= 3; servo += 0.25) {
      CHECK(linkage.angle(servo) == servo);
      if (servo < linkage.reach.low || servo > linkage.reach.high) continue;
      CHECK(linkage.servo_for(servo) == servo);
    }
    // All bars lie along the line through both axes.
    CHECK(linkage.curve.high == Approx(direction).epsilon(1e-14));
    CHECK(linkage.curve.low == Approx(direction - std::numbers::pi).epsilon(1e-14));
    CHECK(linkage.reach.high == linkage.curve.high);
    CHECK(linkage.reach.low == linkage.curve.low);
    CHECK(linkage.high_end == "horn, rod and arm are in line");
    // The same with an explicit rod.
    const Linkage given =
        make_linkage(RodLinkage{length, length, std::hypot(x, z), {x, z}}, Assumed::exact);
    CHECK(given.curve.high == linkage.curve.high);
  }
}

TEST_CASE("a curve ends before all three bars are in line, for any lengths") {
  std::mt19937_64 draw(6);
  std::uniform_real_distribution<double> unit(0, 1);
  int ends = 0;
  for (int i = 0; i < 400; ++i) {
    const double horn = 0.01 + 0.05 * unit(draw), arm = 0.01 + 0.08 * unit(draw);
    const double x = 0.2 * unit(draw) - 0.1, z = 0.02 + 0.1 * unit(draw);
    // The longest plus the shortest bar equals the sum of the other two.
    const double distance = std::hypot(x, z), sign = i % 2 == 0 ? 1 : -1;
    const double rod = std::abs(distance + sign * (horn - arm));
    Linkage linkage;
    try {
      linkage = make_linkage(RodLinkage{horn, arm, rod, {x, z}}, Assumed::exact);
    } catch (const InputError&) {
      continue;  // it does not close at home
    }
    const Rods& rods = linkage.curve.rods;
    for (const auto& [why, end, inside] :
         {std::tuple(linkage.low_end, linkage.curve.low, 1e-9),
          std::tuple(linkage.high_end, linkage.curve.high, -1e-9)}) {
      if (why != "horn, rod and arm are in line") continue;
      ++ends;
      const Turn<double> turn = rods.arm_at(end + inside);
      const double angle = std::atan2(turn.sin, turn.cos);
      CHECK(std::abs(rod_between(rods, end, angle) - rod) < 1e-12);
      // The bend agrees with differences of the slope, up to rounding there.
      const double h = 1e-4;
      const double before = end + (inside > 0 ? h : -h);
      const double difference =
          (rods.arm_at(before + h).slope - rods.arm_at(before - h).slope) / (2 * h);
      CHECK(std::abs(difference - rods.arm_at(before).bend) <
            1e-2 * (1 + std::abs(difference) + turn.slope * turn.slope));
    }
  }
  CHECK(ends > 100);
}

TEST_CASE("with a long upright rod it approaches Quanser's: sin(plate) = (horn / arm) sin(servo)") {
  // The difference is inversely proportional to the rod's length.
  const double horn = 0.0254, arm = 0.1375;
  double last = 0;
  for (const double rod : {1.0, 10.0, 100.0, 1000.0}) {
    const Linkage linkage =
        make_linkage(RodLinkage{horn, arm, {}, {horn - arm, rod}}, Assumed::exact);
    double worst = 0;
    for (double servo = -1.4; servo <= 1.4; servo += 0.1) {
      worst =
          std::max(worst, std::abs(std::sin(linkage.angle(servo)) - horn / arm * std::sin(servo)));
    }
    if (last > 0) CHECK(worst == Approx(last / 10).epsilon(0.05));
    last = worst;
  }
  CHECK(last < 1e-5);
}

TEST_CASE("a curve ends where two of the three bars are in line, up to rounding") {
  int ends = 0;
  for (const RodLinkage& one : some_linkages()) {
    const Linkage linkage = make_linkage(one, Assumed::exact);
    const Rods& rods = linkage.curve.rods;
    for (const bool up : {true, false}) {
      const double end = up ? linkage.curve.high : linkage.curve.low;
      if (!std::isfinite(end)) continue;
      ++ends;
      // Slightly before the end the angle in question is small: proportional to the root of the
      // distance for rod and arm, to the distance for horn and rod.
      const double near = end + (up ? -1e-8 : 1e-8);
      const Turn<double> turn = rods.arm_at(near);
      const double px = rods.x + rods.arm * turn.cos - rods.horn * std::cos(near),
                   pz = rods.z + rods.arm * turn.sin - rods.horn * std::sin(near);
      const bool of_arm = (up ? linkage.high_end : linkage.low_end) == "rod and arm are in line";
      const double across =
          of_arm ? px * turn.sin - pz * turn.cos : px * std::sin(near) - pz * std::cos(near);
      CHECK(std::abs(across) / rods.rod < 3e-3);
      CHECK(linkage.curve.low < 0);
      CHECK(linkage.curve.high > 0);
    }
  }
  CHECK(ends > 300);
}

TEST_CASE("linkages that cannot close, are in line at home or turn back are refused") {
  const auto rods = [](const RodLinkage& one) {
    return message_of<InputError>([&] { static_cast<void>(make_linkage(one, Assumed::exact)); });
  };
  RodLinkage desk_with = desk();
  CHECK(rods(desk_with).empty());
  for (const double rod : {0.5, 0.001}) {
    desk_with.rod = rod;
    CHECK_THAT(rods(desk_with), Contains("gimbal.linkage") && Contains("does not close at home"));
  }
  CHECK_THAT(rods({0.02, 0.05, {}, {0.06, 0}}), Contains("in line at home"));
  CHECK_THAT(rods({0.02, 0.02, {}, {0, 0}}), Contains("zero length"));
  const auto curve = [](std::vector<double> servo, std::vector<double> plate) {
    const CurveLinkage one{"", std::move(servo), std::move(plate)};
    return message_of<InputError>([&] { static_cast<void>(make_linkage(one, Assumed::exact)); });
  };
  CHECK_THAT(curve({-1, -0.5, 0.5, 1}, {0, -0.2, 0.1, 0.3}), Contains("turns back"));
  CHECK_THAT(curve({0.1, 0.2, 0.3, 0.4}, {0, 0.1, 0.2, 0.3}), Contains("home"));
  CHECK_THROWS_WITH(make_three_servos({{0.06, 0.09, 0.04, 0.02, 0.11}}, Assumed::exact),
                    Contains("do not close at home"));
}

TEST_CASE("a rod that does not fit home tilts the plate there") {
  RodLinkage one = desk();
  const double needed = make_linkage(one, Assumed::exact).curve.rods.rod;
  one.rod = needed + 0.002;
  const Linkage linkage = make_linkage(one, Assumed::exact);
  const double home = linkage.angle(0);
  CHECK(std::abs(home) > 0.01);
  CHECK(std::abs(home) < 0.1);
  CHECK(std::abs(rod_between(linkage.curve.rods, 0, home) - *one.rod) < 1e-15);
  CHECK(std::abs(linkage.servo_for(home)) < 1e-14);
}

namespace {

CurveLinkage measured(const RodLinkage& of, int rows, double from, double to) {
  const Linkage exact = make_linkage(of, Assumed::exact);
  CurveLinkage curve;
  for (int i = 0; i < rows; ++i) {
    curve.servo.push_back(from + (to - from) * i / (rows - 1));
    curve.plate.push_back(exact.angle(curve.servo.back()));
  }
  return curve;
}

}  // namespace

TEST_CASE("a measured curve is smooth, has an exact inverse and approaches the measured relation") {
  const Linkage exact = make_linkage(desk(), Assumed::exact);
  double last = 0;
  for (const int rows : {11, 21, 41}) {
    const Linkage curve = make_linkage(measured(desk(), rows, -0.9, 0.55), Assumed::exact);
    double worst = 0;
    for (double servo = -0.85; servo < 0.51; servo += 0.0371) {
      worst = std::max(worst, std::abs(curve.angle(servo) - exact.angle(servo)));
      CHECK(std::abs(curve.servo_for(curve.angle(servo)) - servo) < 1e-13);
      // The piece that a mode holds agrees.
      LinkCurve at = curve.curve;
      const std::size_t piece = curve.piece_at(0, servo, 1);
      at.piece = at.command_piece = curve.table->view().pieces[piece];
      CHECK(at.angle(servo) == curve.angle(servo));
      CHECK(std::abs(at.command_for(curve.angle(servo)) - servo) < 1e-13);
      CHECK(std::abs(at.plain_turn(servo).slope - curve.table->at(servo).rate) < 1e-15);
    }
    if (last > 0) CHECK(worst < last / 8);  // fourth order, except half of it near the ends
    last = worst;
  }
  CHECK(last < 1e-7);
}

TEST_CASE("a calibration with noise, flat ends and repetitions approaches the measured curve") {
  const Linkage exact = make_linkage(desk(), Assumed::exact);
  CurveLinkage curve;
  unsigned state = 1;
  const double noise = 5e-3;
  // Downward, each angle twice; above 0.5 and below -0.8 the plate rests on its stops.
  for (int i = 140; i >= 0; --i) {
    const double servo = -0.9 + 1.5 * (i / 2) / 70;
    state = state * 1664525U + 1013904223U;
    const double one = noise * (2 * (state / 4294967296.0) - 1);
    curve.servo.push_back(servo);
    curve.plate.push_back(exact.angle(std::clamp(servo, -0.8, 0.5)) + one);
  }
  const scenario::Calibration made = scenario::calibrate(curve);
  CHECK_THAT(made.done, Contains("rows sorted") && Contains("averaged") && Contains("smoothed") &&
                            Contains("flat up to") && Contains("flat from"));
  const Linkage found = make_linkage(curve, Assumed::exact);
  CHECK(std::abs(found.curve.low + 0.8) < 0.04);
  CHECK(std::abs(found.curve.high - 0.5) < 0.04);
  for (double servo = -0.75; servo < 0.46; servo += 0.0371) {
    CHECK(std::abs(found.angle(servo) - exact.angle(servo)) < 2 * noise);
    CHECK(std::abs(found.servo_for(found.angle(servo)) - servo) < 1e-12);
  }
}

TEST_CASE("at a knot the servo's direction selects the piece") {
  const Linkage curve = make_linkage(measured(desk(), 19, -0.9, 0.55), Assumed::exact);
  const double knot = curve.table->knots()[5];
  CHECK(curve.piece_at(4, knot, 1) == 5);
  CHECK(curve.piece_at(5, knot, -1) == 4);
  CHECK(curve.piece_at(4, knot, 0) == 4);
  CHECK(curve.piece_at(5, knot, 0) == 5);
  CHECK(curve.piece_at(9, -2, -1) == 0);
  CHECK(curve.piece_at(9, 2, 1) == 17);
}

namespace {

ThreeServoPlate hobby_plate() {
  return {{0.06, 0.09, 0.04, 0.1, 0.11}, {}};
}

// Three different legs.
ThreeServoPlate unequal_plate() {
  ThreeServoPlate plate = hobby_plate();
  auto& legs = plate.legs.emplace();
  legs[0] = {{0.06, 0.09, 0.04, 0.1, 0.11}, 0.1, 0.003, 0.05, 1, {}};
  legs[1] = {{0.07, 0.085, 0.045, 0.105, 0.115}, 2.0, -0.004, 0, -1, {}};
  legs[2] = {{0.055, 0.1, 0.038, 0.11, 0.1}, 4.3, 0.001, -0.03, 1, {}};
  return plate;
}

// The plate's pose from leg lengths alone: phi, theta, the rotation about the normal, and the
// center. Newton's iteration in quad precision on the distances in space, with derivatives by
// differences.
std::array<Quad, 6> pose_in_space(const ThreeServoPlate& plate, const std::array<Quad, 3>& horn) {
  const auto residuals = [&](const std::array<Quad, 6>& x, std::array<Quad, 6>& out) {
    const auto phi = sin_cos(x[0]), theta = sin_cos(x[1]), turn = sin_cos(x[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const ServoLeg leg = plate.leg(i);
      const auto azimuth = sin_cos(Quad(leg.angle)), elevation = sin_cos(horn[i]);
      // R_y(phi) R_x(theta) R_z(turn) of the joint.
      const Quad px = Quad(leg.radius_plate) * azimuth.cos;
      const Quad py = Quad(leg.radius_plate) * azimuth.sin;
      const Quad ax = turn.cos * px - turn.sin * py, ay = turn.sin * px + turn.cos * py;
      const Quad az = leg.joint_height;
      const Quad bx = ax, by = theta.cos * ay - theta.sin * az;
      const Quad bz = theta.sin * ay + theta.cos * az;
      const Quad cx = x[3] + phi.cos * bx + phi.sin * bz, cy = x[4] + by;
      const Quad cz = x[5] + phi.cos * bz - phi.sin * bx;
      const Quad out_of_axis = cx * azimuth.cos + cy * azimuth.sin - Quad(leg.radius_base);
      const Quad above = cz - Quad(leg.joint_height) + Quad(leg.height);
      const Quad dx = out_of_axis - Quad(leg.horn) * elevation.cos;
      const Quad dz = above - Quad(leg.horn) * elevation.sin;
      out[i] = cy * azimuth.cos - cx * azimuth.sin;
      out[3 + i] = dx * dx + dz * dz - Quad(leg.rod) * Quad(leg.rod);
    }
  };
  std::array<Quad, 6> x;
  x.fill(Quad(0.0));
  for (int pass = 0; pass < 14; ++pass) {
    std::array<Quad, 6> at, moved;
    Quad a[6][7];
    residuals(x, at);
    constexpr double h = 1e-14;
    for (std::size_t j = 0; j < 6; ++j) {
      std::array<Quad, 6> beside = x;
      beside[j] += Quad(h);
      residuals(beside, moved);
      for (std::size_t i = 0; i < 6; ++i) a[i][j] = (moved[i] - at[i]) / Quad(h);
    }
    for (std::size_t i = 0; i < 6; ++i) a[i][6] = -at[i];
    for (int k = 0; k < 6; ++k) {  // Gauss-Jordan with pivoting
      int best = k;
      for (int i = k + 1; i < 6; ++i) {
        if (abs(a[i][k]) > abs(a[best][k])) best = i;
      }
      std::swap(a[k], a[best]);
      for (int i = 0; i < 6; ++i) {
        if (i == k) continue;
        const Quad factor = a[i][k] / a[k][k];
        for (int j = k; j < 7; ++j) a[i][j] -= factor * a[k][j];
      }
    }
    for (std::size_t j = 0; j < 6; ++j) x[j] += a[j][6] / a[j][j];
  }
  return x;
}

}  // namespace

TEST_CASE(
    "three servos: the closed chain returns what the inverse assumed, over the whole workspace") {
  const ThreeServos three =
      make_three_servos(GENERATE(hobby_plate(), unequal_plate()), Assumed::exact);
  const double most = greatest_tilt(three);
  CHECK(most > 0.2);
  int poses = 0;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      const double wanted[2] = {0.099 * i * most, 0.099 * j * most};
      if (std::cos(wanted[0]) * std::cos(wanted[1]) < std::cos(0.98 * most)) continue;
      double servo[3], plane[2];
      three.commands_for(wanted, servo);
      angles_of(three, servo, plane);
      ++poses;
      // Rounding, magnified by 1/sine of the knee angle if a leg is nearly stretched.
      CHECK(std::abs(plane[0] - wanted[0]) < 1e-13);
      CHECK(std::abs(plane[1] - wanted[1]) < 1e-13);
      CHECK(three.margin(servo) > 0);
    }
  }
  CHECK(poses > 200);
  if (!three.equal) return;
  const double level[2] = {0, 0};
  double servo[3];
  three.commands_for(level, servo);
  for (const double one : servo) CHECK(std::abs(one) < 1e-15);
}

TEST_CASE("three servos: rates and accelerations of the plane are derivatives of its angles") {
  const ThreeServos three =
      make_three_servos(GENERATE(hobby_plate(), unequal_plate()), Assumed::exact);
  const auto servo_at = [](double t, double(&servo)[3]) {
    servo[0] = 0.2 + 0.3 * t + 0.5 * t * t;
    servo[1] = -0.1 + 0.7 * t - 0.2 * t * t;
    servo[2] = 0.05 - 0.4 * t + 0.9 * t * t;
  };
  const double rate[3] = {0.3, 0.7, -0.4}, acceleration[3] = {1.0, -0.4, 1.8};
  double servo[3];
  servo_at(0, servo);
  GimbalAngle<double> axis[2];
  three.planes(servo, rate, acceleration, axis);
  const double h = 1e-3;
  double plane[5][2];
  for (int k = -2; k <= 2; ++k) {
    double at[3];
    servo_at(k * h, at);
    angles_of(three, at, plane[k + 2]);
  }
  for (int i = 0; i < 2; ++i) {
    CHECK(std::abs(std::atan2(axis[i].sin, axis[i].cos) - plane[2][i]) < 1e-15);
    const double first = (8 * (plane[3][i] - plane[1][i]) - (plane[4][i] - plane[0][i])) / (12 * h);
    const double second =
        (16 * (plane[3][i] + plane[1][i]) - (plane[4][i] + plane[0][i]) - 30 * plane[2][i]) /
        (12 * h * h);
    CHECK(axis[i].rate == Approx(first).epsilon(1e-9));
    CHECK(axis[i].acceleration == Approx(second).epsilon(1e-6));
  }
}

TEST_CASE("three servos: the closed chain agrees with the pose in quad precision") {
  const ThreeServoPlate plate = GENERATE(hobby_plate(), unequal_plate());
  const ThreeServos three = make_three_servos(plate, Assumed::none);
  CHECK(three.equal == !plate.legs);
  Noise noise(11);
  double largest = 0, twist = 0;
  for (int k = 0; k < 60; ++k) {
    double servo[3], plane[2];
    std::array<Quad, 3> horn;
    for (std::size_t i = 0; i < 3; ++i) {
      servo[i] = k == 0 ? 0 : 0.5 * (2 * noise.uniform() - 1);
      const ServoLeg leg = plate.leg(i);
      horn[i] = Quad(three.leg[i].home) + Quad(leg.offset) + Quad(leg.direction * servo[i]);
    }
    angles_of(three, servo, plane);
    if (!(three.margin(servo) > 0.1)) continue;
    const std::array<Quad, 6> exact = pose_in_space(plate, horn);
    CHECK(std::abs(plain(exact[0] - Quad(plane[0]))) < 1e-12);
    CHECK(std::abs(plain(exact[1] - Quad(plane[1]))) < 1e-12);
    largest = std::max(largest, std::abs(plane[0]));
    twist = std::max(twist, std::abs(plain(exact[2])));
  }
  CHECK(largest > 0.2);
  CHECK(twist > 1e-3);
  // Level at home, where the offsets of legs are compensated.
  const double level[2] = {0, 0};
  double servo[3], plane[2];
  three.commands_for(level, servo);
  for (std::size_t i = 0; i < 3; ++i) {
    const ServoLeg leg = plate.leg(i);
    CHECK(servo[i] == Approx(-leg.direction * leg.offset).margin(1e-15));
  }
  angles_of(three, servo, plane);
  CHECK(std::abs(plane[0]) < 1e-15);
  CHECK(std::abs(plane[1]) < 1e-15);
}

TEST_CASE("equal legs that are written out are equal, and slightly unequal ones hardly differ") {
  ThreeServoPlate plate = hobby_plate();
  auto& legs = plate.legs.emplace();
  for (std::size_t i = 0; i < 3; ++i) legs[i] = hobby_plate().leg(i);
  const ThreeServos equal = make_three_servos(plate, Assumed::exact);
  CHECK(equal.equal);
  legs[1].angle += 2e-12;
  const ThreeServos general = make_three_servos(plate, Assumed::exact);
  REQUIRE_FALSE(general.equal);
  CHECK(greatest_tilt(equal) == Approx(greatest_tilt(general)).epsilon(1e-9));
  CHECK(greatest_twist(general, 0.1) < 1e-12);
}

TEST_CASE("firmware with wrong leg dimensions has a table that is not level") {
  Scenario scene;
  scene.gimbal.three_servos = hobby_plate();
  auto& legs = scene.gimbal.three_servos->legs.emplace();
  for (std::size_t i = 0; i < 3; ++i) legs[i] = hobby_plate().leg(i);
  legs[0].rod += 0.003;
  scene.controller.emplace().assumes = Assumes::exact;
  scene.controller->assumed_legs = hobby_plate();
  const Mechanism mechanism = mechanism_of(scene);
  const std::array<double, 3> servo = mechanism.commands_for({0, 0});
  // The horns are set for a level plate with the assumed legs.
  const ThreeServos taken = make_three_servos(hobby_plate(), Assumed::exact);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(mechanism.three->leg[i].home + servo[i] == Approx(taken.leg[i].home).epsilon(1e-14));
  }
  const Pair tilt = mechanism.tilt(servo);
  CHECK(std::abs(tilt[0]) > 0.01);  // a longer rod lifts its side
  CHECK(std::abs(tilt[1]) < 1e-12);
  // The firmware believes the plate to be level.
  const double resting[3] = {0, 0, 0};
  double into[4];
  mechanism.believed(servo.data(), resting, into);
  CHECK(std::abs(into[0]) < 1e-14);
  CHECK(std::abs(into[1]) < 1e-14);
  scene.controller->assumed_legs.reset();
  CHECK(std::abs(mechanism_of(scene).tilt(mechanism_of(scene).commands_for({0, 0}))[0]) < 1e-14);
}

TEST_CASE("three servos: a ratio is the inverse's slope at home") {
  const ThreeServoPlate plate = GENERATE(hobby_plate(), unequal_plate());
  const ThreeServos exact = make_three_servos(plate, Assumed::exact);
  const ThreeServos ratio = make_three_servos(plate, Assumed::ratio);
  const double h = 1e-5;
  for (const auto& direction : {std::pair{1.0, 0.0}, std::pair{0.0, 1.0}, std::pair{0.6, -0.8}}) {
    const double wanted[2] = {h * direction.first, h * direction.second};
    const double level[2] = {0, 0};
    double home[3], a[3], b[3], angle[2], rate[2];
    exact.commands_for(level, home);
    exact.commands_for(wanted, a);
    ratio.commands_for(wanted, b);
    for (int i = 0; i < 3; ++i) CHECK(std::abs(a[i] - home[i] - b[i]) < 100 * h * h);
    const double none[3] = {0, 0, 0};
    ratio.believed(b, none, angle, rate);
    CHECK(angle[0] == Approx(wanted[0]).margin(1e-18));
    CHECK(angle[1] == Approx(wanted[1]).margin(1e-18));
  }
}

}  // namespace bbsim_test::test_linkage
