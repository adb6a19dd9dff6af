// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The linkages of a scene with the data that do not depend on the instant: whole measured curves,
// the ends of curves, and the range of commands.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "model/servo/linkage.hpp"
#include "model/servo/three_servos.hpp"
#include "model/signals/spline.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// Bounds on a command.
struct CommandRange {
  double low = -unlimited, high = unlimited;

  [[nodiscard]] bool binds() const { return low > -unlimited || high < unlimited; }
  [[nodiscard]] static CommandRange within(double size) { return {-size, size}; }
};

// The whole curve of one axis.
struct Linkage {
  LinkCurve curve;                // with the piece at home
  std::optional<Spline> table{};  // a measured curve
  CommandRange reach{};           // plane angles within the curve's range, rad
  std::string low_end, high_end;  // why the curve ends: "horn and rod are in line"

  // The plane's angle without its offset, rad.
  [[nodiscard]] double angle(double servo) const;
  // The servo's angle for a plane angle; the nearest one for angles out of reach.
  [[nodiscard]] double servo_for(double angle) const;
  // The command to the servo for an angle that the controller wants.
  [[nodiscard]] double command_for(double wanted) const;

  // The next piece of a measured curve after `present`: for a servo angle that moves in
  // `direction`, and for a commanded plane angle; and the range of each piece.
  [[nodiscard]] std::size_t piece_at(std::size_t present, double servo, double direction) const;
  [[nodiscard]] std::size_t command_piece_at(std::size_t present, double wanted) const;
  [[nodiscard]] CommandRange piece_range(std::size_t piece) const;
  [[nodiscard]] CommandRange command_piece_range(std::size_t piece) const;
};

// The mechanism of a scene: none, two linkages, or three servos.
struct Mechanism {
  std::vector<Linkage> linkages{};  // empty, or two
  std::optional<ThreeServos> three{};
  // The controller's assumption about the three servos, and the servo angles that it takes for
  // zero, rad.
  std::optional<ThreeServos> assumed{};
  std::array<double, 3> zero{};

  [[nodiscard]] const ThreeServos& as_assumed() const { return assumed ? *assumed : *three; }
  [[nodiscard]] bool none() const { return linkages.empty() && !three; }
  [[nodiscard]] bool has_pieces() const;
  // The commands to two or three servos for the angles that a law wants.
  [[nodiscard]] std::array<double, 3> commands_for(Pair wanted) const;
  // The tilt that three servos at these angles give the plate, without its offsets; NaN if no tilt
  // fits them.
  [[nodiscard]] Pair tilt(const std::array<double, 3>& servo) const;
  // What the controller infers from the servos' angles and rates: phi, theta, and their rates.
  void believed(const double* servo, const double* rate, double (&into)[4]) const;
  // The range of commands of the law that the mechanism can reach.
  [[nodiscard]] CommandRange reach(int axis) const;

  [[nodiscard]] Linkages at_home() const;
};

// Throws InputError if a linkage does not close at home or has a dead point there, or if a measured
// curve is not monotonic. Rows of a smoothed curve are merged if an interpolant turns back between
// them.
[[nodiscard]] Linkage make_linkage(const RodLinkage& of, Assumed assumed);
[[nodiscard]] Linkage make_linkage(const CurveLinkage& given, Assumed assumed);
// `key` names the plate in messages.
[[nodiscard]] ThreeServos make_three_servos(const ThreeServoPlate& of, Assumed assumed,
                                            const std::string& key = "gimbal.three_servos");

// The controller's model of the mechanism. Default: ratio, as in most firmware; exact for three
// servos, which need inverse kinematics.
[[nodiscard]] Assumes assumes_of(const Scenario& scene);

[[nodiscard]] Mechanism mechanism_of(const Scenario& scene);

// The greatest twist about the normal that this tilt gives in any direction, rad; 0 for equal legs.
[[nodiscard]] double greatest_twist(const ThreeServos& three, double tilt);

// The greatest tilt that all three legs reach in every direction at the height of home, rad.
[[nodiscard]] double greatest_tilt(const ThreeServos& three);

}  // namespace bbsim::model
