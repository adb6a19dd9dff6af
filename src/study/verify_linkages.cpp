// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/verify_linkages.hpp"

#include <algorithm>
#include <cmath>

#include "model/servo/linkages.hpp"

namespace bbsim::study {
namespace {

// Calls use(angle) for servo angles well within the curve, up to 50 degrees.
template <class Use>
void for_each_servo(const Use& use) {
  for (int i = -50; i <= 50; ++i) use(i * 0.0174);
}

// With the gimbal's axis at (a - b, l) and a rod of length l, (M54) is exactly
//
//     b sin(chi) - a sin(delta) = sqrt(l^2 - u^2) - l,  u = a (1 - cos(delta)) - b (1 - cos(chi)).
//
// Within 50 degrees |u| < a, so the sines differ by at most a^2 / (b l).
Check quanser() {
  const double horn = 0.0254, arm = 0.1375, rod = 1000;
  const model::Linkage linkage =
      make_linkage(RodLinkage{horn, arm, {}, {horn - arm, rod}}, model::Assumed::exact);
  double error = 0;
  for_each_servo([&](double servo) {
    error =
        std::max(error, std::abs(std::sin(linkage.angle(servo)) - horn / arm * std::sin(servo)));
  });
  return {"push rod: long and upright it is Quanser's, sin(plate) = a/b sin(servo)", error,
          horn * horn / (arm * rod), "1"};
}

// The bound is the rounding of angles of at most 1 rad, through a curve of slope 0.2 to 0.5.
Check push_rod_inverted() {
  const model::Linkage linkage = make_linkage(push_rod(), model::Assumed::exact);
  double error = 0;
  for_each_servo([&](double servo) {
    error = larger(error, std::abs(linkage.servo_for(linkage.angle(servo)) - servo));
  });
  return {"push rod: inverse of forward", error, 1e-13, "rad"};
}

// Fourth-order differences leave out h^4/30 times the fifth derivative, which is below 1e3. Their
// rounding error is that of an angle divided by h.
constexpr double h = 1e-3, of_differences = 1e3 * h * h * h * h / 30 + 1e-15 / h;

template <class Function>
double difference(const Function& of, double at) {
  return (8 * (of(at + h) - of(at - h)) - (of(at + 2 * h) - of(at - 2 * h))) / (12 * h);
}

Check push_rod_slope() {
  const model::LinkCurve curve = make_linkage(push_rod(), model::Assumed::exact).curve;
  const auto angle = [&](double servo) { return curve.angle(servo); };
  double error = 0;
  for_each_servo([&](double servo) {
    error = larger(error, std::abs(curve.plain_turn(servo).slope - difference(angle, servo)));
  });
  return {"push rod: slope against differences (M56)", error, of_differences, "1"};
}

model::ThreeServos three_legs() {
  return make_three_servos({0.06, 0.09, 0.04, 0.10, 0.11}, model::Assumed::exact);
}

// Calls use(tilts) over the workspace.
template <class Use>
void for_each_tilt(const model::ThreeServos& three, const Use& use) {
  const double most = 0.98 * greatest_tilt(three);
  for (int i = -8; i <= 8; ++i) {
    for (int j = -8; j <= 8; ++j) {
      const double wanted[2] = {most * i / 8, most * j / 8};
      if (std::cos(wanted[0]) * std::cos(wanted[1]) >= std::cos(most)) use(wanted);
    }
  }
}

// The bound is rounding, which a nearly stretched leg magnifies.
Check three_legs_inverted() {
  const model::ThreeServos three = three_legs();
  double error = 0;
  for_each_tilt(three, [&](const double(&wanted)[2]) {
    double servo[3], plane[2];
    three.told(wanted, servo);
    three.angles(servo, plane);
    for (int i = 0; i < 2; ++i) error = larger(error, std::abs(plane[i] - wanted[i]));
  });
  return {"three servos: forward of inverse over the workspace (M58) to (M61)", error, 1e-13,
          "rad"};
}

Check three_legs_rates() {
  const model::ThreeServos three = three_legs();
  const double rate[3] = {0.7, -0.4, 0.5}, none[3] = {0, 0, 0};
  double error = 0;
  for_each_tilt(three, [&](const double(&wanted)[2]) {
    double servo[3];
    for (int i = 0; i < 2; ++i) {
      // Halfway out, so that the differences stay within the workspace.
      const double half[2] = {wanted[0] / 2, wanted[1] / 2};
      three.told(half, servo);
      model::GimbalAngle<double> axis[2];
      three.planes(servo, rate, none, axis);
      const auto angle = [&](double t) {
        double moved[3], plane[2];
        for (int k = 0; k < 3; ++k) moved[k] = servo[k] + rate[k] * t;
        three.angles(moved, plane);
        return plane[i];
      };
      error = larger(error, std::abs(axis[i].rate - difference(angle, 0)));
    }
  });
  return {"three servos: rates of the plane against differences", error, of_differences, "rad/s"};
}

}  // namespace

RodLinkage push_rod() {
  return {0.024, 0.06, {}, {-0.016, 0.07}};
}

std::vector<std::function<Check()>> linkage_checks() {
  return {quanser, push_rod_inverted, push_rod_slope, three_legs_inverted, three_legs_rates};
}

}  // namespace bbsim::study
