// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The switches of dry friction, sliding contacts and motor limits: the mode of a coupled scene, and
// when it ends (docs/explanation/losses-and-torques.md).
//
// A dry force keeps a part at rest while rest needs less than its limit; otherwise it opposes the
// motion. Motion along a line has one of two signs, so only its start and end switch. Motion in the
// plane can have any direction, and at rest it has none. Below the speed that the tolerance
// resolves, the direction is held constant.
#pragma once

#include <cstddef>
#include <vector>

#include "base/pair.hpp"
#include "model/control/integral_limit.hpp"
#include "model/model.hpp"

namespace bbsim::model {

// The commands to position loops as the motors get them, rad, and their rates, rad/s.
struct MotorCommands {
  Pair value{0, 0}, rate{0, 0};
};

class DrySwitches {
 public:
  // `resolution` (m/s): slower velocities count as near rest.
  DrySwitches(const DryParts& parts, double resolution) : parts_(parts), resolution_(resolution) {}

  // Contact, rolling, spin and motor friction have the first `motor_guard` guards. Each motor has
  // four more for its limits.
  static constexpr std::size_t motor_guard = 7, guards = motor_guard + 8;
  void append_scales(std::vector<double>& scales) const;

  // Chooses the mode from here on. Changes z: sets velocities that have reached zero to exactly
  // zero. `commanded` is MotorCommands::value.
  void settle(Model& model, double t, double* z, const Pair& commanded) const;

  // Whether a motor's integral may wait at a torque limit. MotorCommands matter only then.
  [[nodiscard]] bool integrates() const { return parts_.integrates && parts_.limits_torque(); }

  // Whether a motor's torque moves along a limit. MotorCommands::rate matters only then.
  [[nodiscard]] bool moves_along_limit(const Model& model) const;

  // While a torque moves along its limit, its integral is not a state; the limit determines it.
  // Restores the state in z, before another change.
  void leave_limits(Model& model, double t, double* z);
  // Records that the torque asked of a motor reached a limit. Call it with the fallen guard before
  // settle().
  void note_limit(const Model& model, std::size_t guard);
  // The command of motor i jumps, so that the torque asked of it leaves the limit.
  void command_jumps(std::size_t i) {
    if (i < 2) reached_[i] = 0;
  }
  // Chooses how a torque exactly at its limit continues. Call it after settle().
  void settle_at_limits(Model& model, double t, const double* z, const MotorCommands& commands);

  // Writes `guards` values; all are positive until a switch.
  void evaluate(const Model& model, double t, const double* z, const MotorCommands& commands,
                double* values) const;

  // The parts of the mode that may be events.
  struct State {
    bool slides = false, rests = false;
    bool sticks[2] = {false, false};
    friend bool operator==(const State&, const State&) = default;
  };
  [[nodiscard]] State state(const Model& model) const;

 private:
  template <class Contact, class Motor>
  struct BasicScene;
  using Scene = BasicScene<ContactMode, MotorMode>;
  using SeenScene = BasicScene<const ContactMode, const MotorMode>;
  struct AtZero;
  void settle_limits(Scene& scene, double t, const double* z, const Pair& commanded) const;
  template <class AnyScene>
  [[nodiscard]] double push(const AnyScene& scene, int i, const double* z,
                            const Pair& commanded) const;
  template <class AnyScene>
  [[nodiscard]] OutwardRate outward_rate(const AnyScene& scene, int i, double side, const double* z,
                                         const Balance<double>& now,
                                         const MotorCommands& commands) const;
  [[nodiscard]] double most(double side, double rate) const;
  [[nodiscard]] bool overruns(double rate) const;
  // The speed limit for near rest, m/s. It grows with t, because the rounding of t does.
  [[nodiscard]] double slow(double t, const CoupledBall& ball) const;
  static void settle_direction(DryDirection& of, double slow, const double (&v)[2], bool was_still);
  static void start(Scene& scene, double t, const double* z, bool slip, bool roll);
  [[nodiscard]] int faults(Scene& scene, double t, const double* z, const AtZero& zero, bool slide,
                           bool rest) const;

  DryParts parts_;
  double resolution_;
  double reached_[2]{0, 0};  // side of the limit that a motor's torque is exactly at, or 0
};

}  // namespace bbsim::model
