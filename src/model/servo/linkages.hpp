// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What stands between the servos and the plane, with all that is not of one instant: the whole of a
// measured curve, where curves end, and what may be commanded.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/servo/linkage.hpp"
#include "model/servo/three_servos.hpp"
#include "model/signals/spline.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

// Between which values a command is kept.
struct CommandRange {
  double low = -unlimited, high = unlimited;

  [[nodiscard]] bool binds() const { return low > -unlimited || high < unlimited; }
  [[nodiscard]] static CommandRange within(double size) { return {-size, size}; }
};

// One axis' curve, whole.
struct Linkage {
  LinkCurve curve;                // in the piece that holds at home
  std::optional<Spline> table{};  // of a measured curve
  CommandRange reach{};           // angles of the plane that the curve comes to, rad
  std::string low_end, high_end;  // why the curve ends there: "horn and rod are in line"

  // The angle of the plane, rad; without its offset.
  [[nodiscard]] double angle(double servo) const;
  // The servo's angle for it. The nearest one for what the curve does not come to.
  [[nodiscard]] double servo_for(double angle) const;
  // What the servo is told where the controller wants this angle.
  [[nodiscard]] double told(double wanted) const;

  // Which piece of a measured curve holds after `present` did: at a servo's angle that goes in a
  // direction, and at an angle that is commanded; and between which values a piece holds.
  [[nodiscard]] std::size_t piece_at(std::size_t present, double servo, double direction) const;
  [[nodiscard]] std::size_t command_piece_at(std::size_t present, double wanted) const;
  [[nodiscard]] CommandRange piece_range(std::size_t piece) const;
  [[nodiscard]] CommandRange command_piece_range(std::size_t piece) const;
};

// All of it: nothing, two linkages, or three servos.
struct Between {
  std::vector<Linkage> linkages{};  // none, or two
  std::optional<ThreeServos> three{};

  [[nodiscard]] bool none() const { return linkages.empty() && !three; }
  [[nodiscard]] bool has_pieces() const;
  // What servos are told where a law wants these angles: two or three.
  [[nodiscard]] std::array<double, 3> told(Pair wanted) const;
  // What the controller takes the servos' angles and rates for: of phi, of theta, and their rates.
  void believed(const double* servo, const double* rate, double (&into)[4]) const;
  // What the law's commands may be, so that there is an answer to each.
  [[nodiscard]] CommandRange reach(int axis) const;

  [[nodiscard]] Linkages at_home() const;
};

// Throws InputError for a linkage that does not close at home, or is at a dead point there, and for
// a measured curve that turns back.
[[nodiscard]] Linkage make_linkage(const RodLinkage& of, Assumed assumed);
[[nodiscard]] Linkage make_linkage(const CurveLinkage& of, Assumed assumed);
[[nodiscard]] ThreeServos make_three_servos(const ThreeServoPlate& of, Assumed assumed);

// What the scene's controller takes it for: a ratio, as most firmware does, unless it says
// otherwise; but nobody moves three servos without inverse kinematics.
[[nodiscard]] Assumes assumes_of(const Scenario& scene);

[[nodiscard]] Between between_of(const Scenario& scene);

// The greatest tilt, in any direction, that all three legs reach at the height of home, rad.
[[nodiscard]] double greatest_tilt(const ThreeServos& three);

}  // namespace bbsim::model
