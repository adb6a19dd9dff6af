// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/servo/linkages.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "scenario/coupled.hpp"

namespace bbsim::model {
namespace {

// Commands stay this far from the ends of a curve, rad, where the inverse is infinitely steep.
constexpr double inside = 1e-9;
// A curve ends this far before rod and arm are in line, rad. There the plane's rate and
// acceleration are infinite.
constexpr double before_infinity = 1e-9;
// A curve ends this far before all three bars are in line, rad. There the arm may go either way.
// Near that point the second derivative is a quotient of numbers as small as the cube of the
// distance; here rounding is 1e-7 of it.
constexpr double before_change = 1e-3;

constexpr const char* all_in_line = "horn, rod and arm are in line";

// A servo and arm angle at which two bars, or all three, are in line.
struct DeadPoint {
  double servo, arm;
  const char* why;
  double before = 0;  // the curve ends this far before, rad
};

// The two angles with a given cosine relative to `from`.
struct Angles {
  std::vector<double> of;  // two; empty if there are none
  bool change = false;     // they coincide up to rounding: all bars are in line
};
Angles angles_with(double cosine, double from) {
  constexpr double rounding = 1e-12;
  if (!(std::abs(cosine) <= 1 + rounding)) return {};
  const double away = std::acos(std::clamp(cosine, -1.0, 1.0));
  return {{from + away, from - away}, std::abs(cosine) >= 1 - rounding};
}

// Whether horn and arm have the same length, and rod and distance of the axes too. The arm then
// stays parallel to the horn.
bool is_parallelogram(const Rods& of) {
  constexpr double rounding = 1e-15;
  const double scale = std::abs(of.x) + std::abs(of.z) + of.horn + of.arm;
  return std::abs(of.horn - of.arm) <= rounding * scale &&
         std::abs(of.rod - std::hypot(of.x, of.z)) <= rounding * scale;
}

// The dead points of both branches.
std::vector<DeadPoint> dead_points(const Rods& of) {
  std::vector<DeadPoint> found;
  const double distance = std::hypot(of.x, of.z), direction = std::atan2(of.z, of.x);
  if (distance == 0) return found;  // the whole linkage rotates without dead points
  if (is_parallelogram(of)) {
    for (const double bar : {direction, direction + std::numbers::pi}) {
      found.push_back({bar, bar, all_in_line});
    }
    return found;
  }
  const double d2 = distance * distance;
  for (const double sign : {1.0, -1.0}) {
    const double to_horn = of.rod + sign * of.arm;
    const double c = (of.horn * of.horn + d2 - to_horn * to_horn) / (2 * of.horn * distance);
    const Angles servos = angles_with(c, direction);
    for (const double servo : servos.of) {
      const double vx = of.horn * std::cos(servo) - of.x, vz = of.horn * std::sin(servo) - of.z;
      const double k = vx * vx + vz * vz + of.arm * of.arm - of.rod * of.rod;
      found.push_back({servo, std::atan2(std::copysign(vz, vz * k), std::copysign(vx, vx * k)),
                       servos.change ? all_in_line : "rod and arm are in line",
                       servos.change ? before_change : before_infinity});
    }
    const double to_arm = of.horn + sign * of.rod;
    if (to_arm == 0) continue;
    const double a = (to_arm * to_arm - d2 - of.arm * of.arm) / (2 * of.arm * distance);
    const Angles arms = angles_with(a, direction);
    for (const double arm : arms.of) {
      const double bx = of.x + of.arm * std::cos(arm), bz = of.z + of.arm * std::sin(arm);
      const double servo = std::atan2(bz / to_arm, bx / to_arm);
      // Keeps only points on this branch.
      const Turn<double> turn = of.arm_at(servo);
      if (std::hypot(turn.cos - std::cos(arm), turn.sin - std::sin(arm)) < 1e-6) {
        found.push_back({servo, std::atan2(std::sin(arm), std::cos(arm)),
                         arms.change ? all_in_line : "horn and rod are in line",
                         arms.change ? before_change : 0});
      }
    }
  }
  return found;
}

double turned_within(double angle, double from) {
  return angle - 2 * std::numbers::pi * std::floor((angle - from) / (2 * std::numbers::pi));
}

// The arm's angle with whole turns, after the servo has moved from home to `servo`. `arm` is this
// angle without whole turns.
double arm_followed(const Rods& rods, double servo, double arm) {
  const Turn<double> home = rods.arm_at(0.0);
  double angle = std::atan2(home.sin, home.cos);
  const auto go_to = [&angle](double next) {
    angle = turned_within(next, angle - std::numbers::pi);
  };
  constexpr int steps = 256;
  for (int i = 1; i < steps; ++i) {
    const Turn<double> turn = rods.arm_at(servo * i / steps);
    go_to(std::atan2(turn.sin, turn.cos));
  }
  go_to(arm);
  return angle;
}

[[noreturn]] void refuse(const std::string& message) {
  throw KeyError("gimbal.linkage", message);
}

std::string metres(double length) {
  return number_text(length) + " m";
}

}  // namespace

Linkage make_linkage(const RodLinkage& of, Assumed assumed) {
  Rods rods;
  rods.horn = of.horn;
  rods.arm = of.arm;
  rods.x = of.offset[0];
  rods.z = of.offset[1];
  rods.set_rod(of.rod.value_or(std::hypot(rods.x + rods.arm - rods.horn, rods.z)));
  const double vx = rods.horn - rods.x, vz = -rods.z, v = std::hypot(vx, vz);
  const double least = std::abs(v - rods.arm), most = v + rods.arm;
  if (!(rods.rod > 0)) {
    refuse(
        "found horn and arm whose ends meet at home, with a rod of zero length between; allowed: "
        "an offset that keeps them apart");
  }
  if (rods.rod < least || rods.rod > most) {
    refuse("found a rod of " + metres(rods.rod) +
           ", with which the linkage does not close at home; allowed: " + metres(least) + " to " +
           metres(most) + ", from the horn's end to where the arm's can be");
  }
  const double k = (v * v + rods.arm * rods.arm - rods.rod * rods.rod) / (2 * rods.arm);
  const double square = v * v - k * k;
  double home = 0;
  if (square > 1e-12 * v * v) {
    // The solution with the arm nearer to its home position.
    double least_angle = unlimited;
    for (const double side : {1.0, -1.0}) {
      rods.arm_side = side;
      const Turn<double> turn = rods.arm_at(0.0);
      const double angle = std::atan2(turn.sin, turn.cos);
      if (std::abs(angle) >= least_angle) continue;
      least_angle = std::abs(angle);
      home = angle;
    }
    rods.arm_side = -vz * std::cos(home) + vx * std::sin(home) > 0 ? 1 : -1;
  }
  const double bz = rods.z + rods.arm * std::sin(home);
  const double at_rod =
      (bz * std::cos(home) - (rods.x + rods.arm * std::cos(home) - rods.horn) * std::sin(home)) /
      rods.rod;
  if (!(square > 1e-12 * v * v) || std::abs(at_rod) < 1e-6) {
    refuse(
        "found rod and arm in line at home, where the servo cannot turn the plate; allowed: an "
        "offset that has the rod at an angle to both, such as [0, 0.05]");
  }
  if (std::abs(bz) < 1e-6 * rods.rod) {
    refuse(
        "found horn and rod in line at home, where the servo does not move the plate; allowed: "
        "an offset that has the rod at an angle to both, such as [0, 0.05]");
  }
  rods.horn_side = bz > 0 ? -1 : 1;

  Linkage linkage;
  LinkCurve& curve = linkage.curve;
  const bool parallel = is_parallelogram(rods);
  curve.kind = parallel ? LinkCurve::Kind::ideal : LinkCurve::Kind::rods;
  curve.assumed = assumed;
  curve.rods = rods;
  curve.slope = parallel ? 1 : rods.arm_at(0.0).slope;
  double at_low = -unlimited, at_high = unlimited;  // the arm's angles at the ends
  const auto arm_at = [&](const DeadPoint& point, double servo) {
    if (point.before != before_change) return point.arm;
    const Turn<double> turn = rods.arm_at(servo);
    return std::atan2(turn.sin, turn.cos);
  };
  for (const DeadPoint& point : dead_points(rods)) {
    const double there = turned_within(point.servo, 0);
    const double up = there - point.before, down = there - 2 * std::numbers::pi + point.before;
    if (up < curve.high) {
      curve.high = up;
      at_high = arm_at(point, up);
      linkage.high_end = point.why;
    }
    if (down > curve.low) {
      curve.low = down;
      at_low = arm_at(point, down);
      linkage.low_end = point.why;
    }
  }
  if (parallel) {
    linkage.reach = {curve.low, curve.high};
  } else if (curve.high < unlimited) {
    at_low = arm_followed(rods, curve.low, at_low);
    at_high = arm_followed(rods, curve.high, at_high);
    linkage.reach = {std::min(at_low, at_high), std::max(at_low, at_high)};
    curve.rods.horn_middle = RangeMiddle::of(curve.low, curve.high);
    curve.rods.arm_middle = RangeMiddle::of(linkage.reach.low, linkage.reach.high);
  }
  return linkage;
}

namespace {

// A point at which an interpolant of the curve turns back or stands still.
struct TurnsBack {
  std::size_t piece;
  double servo;  // rad
};
std::optional<TurnsBack> first_turn(const CurveLinkage& of, const SplineView& view,
                                    double slope_home) {
  for (std::size_t i = 0; i < view.count; ++i) {
    const SplineView::Piece& p = view.pieces[i];
    const double length = of.servo[i + 1] - of.servo[i];
    // The least and greatest slope of a piece are at its ends or at this point.
    const double turn = p.c3 != 0 ? std::clamp(-p.c2 / (3 * p.c3), 0.0, length) : 0.0;
    for (const double s : {0.0, turn, length}) {
      const double slope = p.c1 + s * (2 * p.c2 + s * 3 * p.c3);
      if (!(slope * slope_home > 0)) return TurnsBack{i, p.start + s};
    }
  }
  return {};
}

// Replaces the two rows next to a piece by their mean, or at an end by the end's row.
void merge_rows(CurveLinkage& of, std::size_t piece) {
  const auto at = static_cast<std::ptrdiff_t>(piece);
  const bool first = piece == 0, last = piece + 2 == of.servo.size();
  for (std::vector<double>* column : {&of.servo, &of.plate}) {
    double& low = (*column)[piece];
    double& high = (*column)[piece + 1];
    low = first ? low : last ? high : low + (high - low) / 2;
    column->erase(column->begin() + at + 1);
  }
}

}  // namespace

Linkage make_linkage(const CurveLinkage& given, Assumed assumed) {
  CurveLinkage of = given;
  if (!(of.servo.front() < 0 && of.servo.back() > 0)) {
    refuse("found a measured curve from " + number_text(of.servo.front()) + " to " +
           number_text(of.servo.back()) +
           " rad of the servo; allowed: one that has home, 0, between its ends");
  }
  Linkage linkage;
  LinkCurve& curve = linkage.curve;
  curve.kind = LinkCurve::Kind::table;
  curve.assumed = assumed;
  for (;;) {
    linkage.table.emplace(of.servo, of.plate);
    const SplineView view = linkage.table->view();
    const std::size_t home = linkage.piece_at(0, 0, 1);
    curve.piece = curve.command_piece = view.pieces[home];
    double value = 0;
    curve.slope = LinkCurve::along(curve.piece, 0.0, &value).slope;
    // Smoothed rows are monotonic, but an interpolant may overshoot by their remaining noise.
    const double rise = of.plate.back() - of.plate.front();
    const std::optional<TurnsBack> turn = first_turn(of, view, of.smoothed ? rise : curve.slope);
    if (!turn) break;
    constexpr std::size_t fewest = 4;
    if (!of.smoothed || of.servo.size() <= fewest) {
      refuse("found a measured curve that turns back, or stands still, at a servo's angle of " +
             number_text(turn->servo) +
             " rad; allowed: one that rises throughout, or falls throughout");
    }
    merge_rows(of, turn->piece);
  }
  curve.low = of.servo.front();
  curve.high = of.servo.back();
  linkage.low_end = linkage.high_end = "the measured curve ends";
  linkage.reach = {std::min(of.plate.front(), of.plate.back()),
                   std::max(of.plate.front(), of.plate.back())};
  return linkage;
}

double Linkage::angle(double servo) const {
  if (table) return table->at(servo).value - curve.shift;
  return curve.angle(servo);
}

double Linkage::servo_for(double angle) const {
  double within = angle + curve.shift;
  if (reach.binds()) {
    // A full turn more or less is the same direction.
    const double low = reach.low + inside, high = reach.high - inside;
    for (const double turn : {2 * std::numbers::pi, -2 * std::numbers::pi}) {
      if ((within < low || within > high) && within + turn >= low && within + turn <= high) {
        within += turn;
      }
    }
    within = std::clamp(within, low, high);
  }
  if (curve.kind == LinkCurve::Kind::ideal) return within;
  if (!table) return curve.rods.horn_at(within);
  // Newton's iteration, with bisection when it leaves the bracket.
  double low = curve.low, high = curve.high;
  const double sign = curve.slope > 0 ? 1 : -1;
  double servo = std::clamp(within / curve.slope, low, high);
  for (int i = 0; i < 200; ++i) {
    const Jet<double> at = table->at(servo);
    const double off = sign * (at.value - within);
    (off > 0 ? high : low) = servo;
    double next = servo - (at.value - within) / at.rate;
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    if (std::abs(next - servo) <= 1e-16 * (1 + std::abs(servo))) return next;
    servo = next;
  }
  return servo;
}

double Linkage::command_for(double wanted) const {
  return curve.assumed == Assumed::exact ? servo_for(wanted) : curve.command_for(wanted);
}

std::size_t Linkage::piece_at(std::size_t present, double servo, double direction) const {
  const std::vector<double>& knots = table->knots();
  const std::size_t last = knots.size() - 2;
  const double near = 1e-11 * (knots.back() - knots.front());
  const auto above = static_cast<std::size_t>(
      std::upper_bound(knots.begin() + 1, knots.end() - 1, servo) - knots.begin());
  const std::size_t piece = std::min(above - 1, last);
  // On a knot, the piece in the direction of motion.
  for (const std::size_t knot : {piece, piece + 1}) {
    if (knot == 0 || knot > last || std::abs(servo - knots[knot]) > near) continue;
    if (direction == 0) return present == knot || present + 1 == knot ? present : piece;
    return direction > 0 ? knot : knot - 1;
  }
  return piece;
}

std::size_t Linkage::command_piece_at(std::size_t present, double wanted) const {
  const CommandRange holds = command_piece_range(present);
  const std::size_t last = table->knots().size() - 2;
  const double near = 1e-11 * (reach.high - reach.low);
  // At the end of the present piece, the next piece.
  const bool rises = curve.slope > 0;
  const double angle = wanted + curve.shift;
  const bool at_high = std::abs(angle - holds.high) <= near;
  if (!at_high && !(std::abs(angle - holds.low) <= near)) {
    return piece_at(present, servo_for(wanted), 1);
  }
  return at_high == rises ? std::min(present + 1, last) : present - (present > 0 ? 1 : 0);
}

CommandRange Linkage::piece_range(std::size_t piece) const {
  const std::vector<double>& knots = table->knots();
  return {knots[piece], knots[piece + 1]};
}

CommandRange Linkage::command_piece_range(std::size_t piece) const {
  const CommandRange of = piece_range(piece);
  const double a = table->at(of.low).value, b = table->at(of.high).value;
  return {std::min(a, b), std::max(a, b)};
}

bool Mechanism::has_pieces() const {
  return std::any_of(linkages.begin(), linkages.end(),
                     [](const Linkage& linkage) { return linkage.table.has_value(); });
}

std::array<double, 3> Mechanism::commands_for(Pair wanted) const {
  if (three) {
    const double of[2] = {wanted[0], wanted[1]};
    double servo[3];
    as_assumed().commands_for(of, servo);
    if (!assumed) return {servo[0], servo[1], servo[2]};
    return {servo[0] + zero[0], servo[1] + zero[1], servo[2] + zero[2]};
  }
  if (linkages.empty()) return {wanted[0], wanted[1], 0};
  return {linkages[0].command_for(wanted[0]), linkages[1].command_for(wanted[1]), 0};
}

Pair Mechanism::tilt(const std::array<double, 3>& servo) const {
  const double at[3] = {servo[0], servo[1], servo[2]};
  if (!(three->margin(at) > 0)) return {no_number, no_number};
  const double none[3] = {};
  GimbalAngle<double> axis[2];
  three->planes(at, none, none, axis);
  return {std::atan2(axis[0].sin, axis[0].cos) - three->offset[0],
          std::atan2(axis[1].sin, axis[1].cos) - three->offset[1]};
}

void Mechanism::believed(const double* servo, const double* rate, double (&into)[4]) const {
  double angle[2] = {servo[0], servo[1]}, angle_rate[2] = {rate[0], rate[1]};
  if (three) {
    const double at[3] = {servo[0] - zero[0], servo[1] - zero[1], servo[2] - zero[2]};
    as_assumed().believed(at, rate, angle, angle_rate);
  }
  for (std::size_t i = 0; i < linkages.size(); ++i) {
    LinkCurve curve = linkages[i].curve;
    if (linkages[i].table) {
      curve.piece = linkages[i].table->view().pieces[linkages[i].piece_at(0, servo[i], 1)];
    }
    curve.believed(servo[i], rate[i], &angle[i], &angle_rate[i]);
  }
  for (int i = 0; i < 2; ++i) {
    into[i] = angle[i];
    into[2 + i] = angle_rate[i];
  }
}

CommandRange Mechanism::reach(int axis) const {
  if (three && three->assumed == Assumed::exact) {
    // With both angles at this value, the tilt is the greatest tilt.
    return CommandRange::within(std::acos(std::sqrt(std::cos(greatest_tilt(as_assumed())))));
  }
  if (linkages.empty()) return {};
  const Linkage& of = linkages[static_cast<std::size_t>(axis)];
  if (of.curve.assumed != Assumed::exact || !of.reach.binds()) return {};
  return {of.reach.low + inside - of.curve.shift, of.reach.high - inside - of.curve.shift};
}

Linkages Mechanism::at_home() const {
  Linkages both;
  for (std::size_t i = 0; i < linkages.size(); ++i) both.of[i] = linkages[i].curve;
  return both;
}

Assumes assumes_of(const Scenario& scene) {
  return scene.controller->assumes.value_or(scene.gimbal.three_servos ? Assumes::exact
                                                                      : Assumes::ratio);
}

Mechanism mechanism_of(const Scenario& scene) {
  Mechanism mechanism;
  if (!scenario::is_linked(scene) || !scene.controller) return mechanism;
  const Controller& controller = *scene.controller;
  // Your own controller commands linked servos itself; three servos only if it drives legs.
  const bool itself =
      controller.own && (!scene.gimbal.three_servos || controller.drives == Drives::legs);
  const Assumed assumed = itself                                ? Assumed::none
                          : assumes_of(scene) == Assumes::exact ? Assumed::exact
                                                                : Assumed::ratio;
  const Mounting& mounting = scene.gimbal.mounting;
  const double offset[2] = {mounting.phi_offset, mounting.theta_offset};
  if (scene.gimbal.three_servos) {
    ThreeServos three = make_three_servos(*scene.gimbal.three_servos, assumed);
    for (int i = 0; i < 2; ++i) three.set_offset(i, offset[i]);
    mechanism.three = three;
    if (controller.assumed_legs) {
      mechanism.assumed =
          make_three_servos(*controller.assumed_legs, assumed, "controller.assumes");
      // Both mean the same elevation of a horn, but each counts from its own home.
      for (std::size_t i = 0; i < 3; ++i) {
        const ThreeServos::Leg& leg = mechanism.assumed->leg[i];
        mechanism.zero[i] = leg.turns * (leg.home - three.leg[i].home);
      }
    }
    return mechanism;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    Linkage& linkage = mechanism.linkages.emplace_back();
    if (const auto& given = scene.gimbal.linkage[i]) {
      linkage = std::visit([&](const auto& of) { return make_linkage(of, assumed); }, *given);
    }
    linkage.curve.set_offsets(offset[i], 0);
  }
  return mechanism;
}

namespace {

bool are_equal(const ThreeServoPlate& plate) {
  if (!plate.legs) return true;
  const ServoLeg first = plate.leg(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const ServoLeg leg = plate.leg(i);
    const double azimuth = 2 * std::numbers::pi / 3 * static_cast<double>(i);
    if (leg.radius_base != first.radius_base || leg.radius_plate != first.radius_plate ||
        leg.horn != first.horn || leg.rod != first.rod || leg.height != first.height ||
        leg.joint_height != 0 || std::abs(leg.angle - azimuth) > 1e-12) {
      return false;
    }
  }
  return true;
}

ThreeServos::Leg make_leg(const ServoLeg& of, const std::string& key, const std::string& which) {
  ThreeServos::Leg leg;
  leg.base = of.radius_base;
  leg.plate = of.radius_plate;
  leg.horn = of.horn;
  leg.rod = of.rod;
  leg.height = of.height;
  leg.turns = of.direction;
  leg.ex = std::cos(of.angle);
  leg.ey = std::sin(of.angle);
  leg.joint = of.joint_height;
  const double x = of.radius_plate - of.radius_base, to_joint = std::hypot(x, of.height);
  const double least = std::abs(of.horn - of.rod), most = of.horn + of.rod;
  if (!(to_joint > least && to_joint < most)) {
    throw KeyError(key, "found " + which +
                            " at home: from a servo's axis to its joint under the plate it is " +
                            metres(to_joint) + "; allowed: more than " + metres(least) +
                            " and less than " + metres(most) +
                            ", horn and rod folded and stretched");
  }
  // Take the outer of the knee's two positions.
  leg.side = of.height > 0 ? -1 : 1;
  const double k = (to_joint * to_joint + of.horn * of.horn - of.rod * of.rod) / (2 * of.horn);
  const double root = leg.side * std::sqrt(to_joint * to_joint - k * k);
  leg.sin_zero = (k * of.height + root * x) / (to_joint * to_joint);
  leg.cos_zero = (k * x - root * of.height) / (to_joint * to_joint);
  return leg;
}

// Sets the twist and shift of the plate that the planes of unequal legs require.
void set_planes(ThreeServos::Leg (&leg)[3], const std::string& key) {
  // The planes' normals are (-ey, ex).
  double xx = 0, xy = 0, yy = 0, free = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const ThreeServos::Leg &next = leg[(i + 1) % 3], &last = leg[(i + 2) % 3];
    leg[i].twist = next.ex * last.ey - next.ey * last.ex;
    free += leg[i].twist * leg[i].plate;
    size += std::abs(leg[i].twist) * leg[i].plate;
    xx += leg[i].ey * leg[i].ey;
    xy -= leg[i].ey * leg[i].ex;
    yy += leg[i].ex * leg[i].ex;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-6) || !(std::abs(free) > 1e-6 * size)) {
    throw KeyError(key,
                   "found legs whose planes let the plate slide or twist; allowed: other "
                   "angles, such as 0, 120 and 240 deg");
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double nx = -leg[j].ey, ny = leg[j].ex;
      leg[i].shift[j] =
          (leg[i].ex * (yy * nx - xy * ny) + leg[i].ey * (xx * ny - xy * nx)) / determinant;
    }
  }
}

}  // namespace

ThreeServos make_three_servos(const ThreeServoPlate& of, Assumed assumed, const std::string& key) {
  ThreeServos three;
  three.equal = are_equal(of);
  double sine[3], cosine[3];
  for (int i = 0; i < 3; ++i) {
    const std::string which = of.legs ? "leg " + std::to_string(i + 1) + " that does not close"
                                      : "legs that do not close";
    three.leg[i] = make_leg(of.leg(static_cast<std::size_t>(i)), key, which);
    sine[i] = three.leg[i].sin_zero;
    cosine[i] = three.leg[i].cos_zero;
    three.leg[i].home = std::atan2(sine[i], cosine[i]);
  }
  set_planes(three.leg, key);
  three.assumed = assumed;
  const ThreeServos::Pose<double> home{0, 0, of.leg(0).height};
  const ThreeServos::Jacobian<double> at_home = three.jacobian(home, sine, cosine);
  double scale = 1;
  for (int i = 0; i < 3; ++i) {
    ThreeServos::Leg& leg = three.leg[i];
    // p corresponds to phi, and q to -theta.
    const ThreeServos::Slopes<double>& m = at_home.of[i];
    leg.slope[0] = leg.turns * (-m.of[0] / m.of_horn);
    leg.slope[1] = leg.turns * (m.of[1] / m.of_horn);
    if (const double offset = of.leg(static_cast<std::size_t>(i)).offset; offset != 0) {
      leg.level = -leg.turns * offset;
      leg.sin_zero = std::sin(leg.home + offset);
      leg.cos_zero = std::cos(leg.home + offset);
    }
    scale *= leg.rod;
  }
  scale *= three.leg[0].plate * three.leg[0].plate;
  three.determinant = at_home.inverse.determinant;
  if (!(std::abs(three.determinant) > 1e-9 * scale)) {
    throw KeyError(key,
                   "found rods that are level at home, and do not hold the plate up; allowed: "
                   "another height");
  }
  three.pose_slopes(at_home, three.home_slopes);
  // The pose's acceleration at rates of the servos is a quadratic form of them.
  const auto form = [&](int i, int j) {
    double rate[3] = {};
    const double none[3] = {};
    rate[i] = rate[j] = 1;
    const auto [p, q, z] = three.pose_acceleration(home, three.pose_rate(at_home, rate), at_home,
                                                   sine, cosine, rate, none);
    return std::array{p, q, z};
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto both = form(i, j), first = form(i, i), second = form(j, j);
      for (std::size_t k = 0; k < 3; ++k) {
        three.home_bends[k][i][j] = i == j ? both[k] : (both[k] - first[k] - second[k]) / 2;
      }
    }
  }
  const double length = three.leg[0].slope[0] * three.leg[0].slope[0] +
                        three.leg[1].slope[0] * three.leg[1].slope[0] +
                        three.leg[2].slope[0] * three.leg[2].slope[0];
  for (int i = 0; i < 3; ++i) {
    // For equal legs, the two columns of slopes are orthogonal and of equal length.
    for (int j = 0; j < 2; ++j) three.inferred[j][i] = three.leg[i].slope[j] / length;
    if (three.equal) continue;
    three.inferred[0][i] = three.home_slopes[0][i];
    three.inferred[1][i] = -three.home_slopes[1][i];
  }
  return three;
}

double greatest_twist(const ThreeServos& three, double tilt) {
  double most = 0;
  for (int degree = 0; degree < 360 && !three.equal; ++degree) {
    const double azimuth = std::numbers::pi / 180 * degree;
    const ThreeServos::Pose<double> at{std::sin(tilt) * std::cos(azimuth),
                                       std::sin(tilt) * std::sin(azimuth), three.leg[0].height};
    const auto twist = three.twist(at, [](double value) { return value; });
    most = std::max(most, std::abs(std::atan2(twist.sine, twist.cosine)));
  }
  return most;
}

double greatest_tilt(const ThreeServos& three) {
  // Whether all legs reach a tilt in the direction (east, north).
  const auto reached = [&](double tilt, double east, double north) {
    const double sine = std::sin(tilt);
    const ThreeServos::Pose<double> at{sine * east, sine * north, three.leg[0].height};
    ThreeServos::Joint<double> joint[3];
    three.joints(at, joint);
    for (int i = 0; i < 3; ++i) {
      const ThreeServos::Leg& leg = three.leg[i];
      const double least = std::abs(leg.horn - leg.rod) * (1 + 1e-9);
      const double most = (leg.horn + leg.rod) * (1 - 1e-9);
      const double square = joint[i].x * joint[i].x + joint[i].z * joint[i].z;
      if (!(square > least * least && square < most * most)) return false;
    }
    return true;
  };
  // The least of the directions' tilts; by the symmetry of equal legs, a third of a turn suffices.
  double found = 1.4;
  bool is_limited = false;
  // In an order that jumps about, few directions limit it more than all before. 61 and 181 are
  // prime.
  const int directions = three.equal ? 61 : 181;
  for (int j = 0; j < directions; ++j) {
    const double azimuth = 2 * std::numbers::pi / 3 * (j * 23 % directions) / 60;
    const double east = std::cos(azimuth), north = std::sin(azimuth);
    if (reached(found, east, north)) continue;
    is_limited = true;
    double low = 0, high = found;
    while (high - low > 1e-12) {
      const double middle = low + (high - low) / 2;
      (reached(middle, east, north) ? low : high) = middle;
    }
    found = low;
  }
  constexpr double between_those = 0.999;  // allows for directions between the samples
  return is_limited ? between_those * found : found;
}

}  // namespace bbsim::model
