// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What switches where friction is dry, contacts slide and motors have limits: which mode a coupled
// scene is in, and when it leaves it (docs/explanation/losses-and-torques.md).
//
// A dry force keeps something at rest as long as less than its limit is needed for that, and
// opposes its motion otherwise. Motion along a line is one of two signs, so that only its start and
// its end switch. In the plane it has any direction, and none at rest: so near rest that neither a
// position nor a velocity can tell within the tolerance, a direction is held instead.
#pragma once

#include <cstddef>
#include <vector>

#include "base/pair.hpp"
#include "model/control/integral_limit.hpp"
#include "model/model.hpp"

namespace bbsim::model {

// What is asked of position loops, as motors have it: rad, and rad/s.
struct MotorCommands {
  Pair value{0, 0}, rate{0, 0};
};

class DrySwitches {
 public:
  // `resolution` (m/s): velocities below it are taken to be near rest.
  DrySwitches(const DryParts& parts, double resolution) : parts_(parts), resolution_(resolution) {}

  // Contact, rolling, spin and the motors' friction have `motor_guard` guards; each motor's limits
  // have four after them.
  static constexpr std::size_t motor_guard = 7, guards = motor_guard + 8;
  void append_scales(std::vector<double>& scales) const;

  // Chooses the mode that the model goes on in from here. What has come to rest is put to rest:
  // changes z. `commanded`: MotorCommands::value.
  void settle(Model& model, double t, double* z, const Pair& commanded) const;

  // Whether a motor's integral may wait at a limit of its torque: MotorCommands count then.
  [[nodiscard]] bool integrates() const { return parts_.integrates && parts_.limits_torque(); }

  // Whether one moves along a limit: MotorCommands::rate counts then.
  [[nodiscard]] bool moves_along_limit(const Model& model) const;

  // An integral that moves along a limit is no state meanwhile: it is what keeps the torque there.
  // It becomes one again before anything else may change. Sets z.
  void leave_limits(Model& model, double t, double* z);
  // To be told of a guard that has fallen, before settle(): what is asked of a motor may have come
  // to a limit.
  void note_limit(const Model& model, std::size_t guard);
  // The command of motor i jumps, and with it what is asked: away from a limit where it was.
  void command_jumps(std::size_t i) {
    if (i < 2) reached_[i] = 0;
  }
  // After settle(): how what is asked of a motor goes on from a limit that it has come to.
  void settle_at_limits(Model& model, double t, const double* z, const MotorCommands& commands);

  // Positive as long as nothing switches; `guards` numbers.
  void evaluate(const Model& model, double t, const double* z, const MotorCommands& commands,
                double* values) const;

  // What somebody may want to be told of.
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
  // The speed next to rest, m/s. At a later time, a rounding of the time is more of one.
  [[nodiscard]] double slow(double t, const CoupledBall& ball) const;
  static void settle_direction(DryDirection& of, double slow, const double (&v)[2], bool was_still);
  static void start(Scene& scene, double t, const double* z, bool slip, bool roll);
  [[nodiscard]] int faults(Scene& scene, double t, const double* z, const AtZero& zero, bool slide,
                           bool rest) const;

  DryParts parts_;
  double resolution_;
  double reached_[2]{0, 0};  // the side of a limit that what is asked of a motor is exactly at
};

}  // namespace bbsim::model
