// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The servos of a rig: their modes (servo/servo_axis.hpp), and the jump of the ball's velocity when
// one of them stops; and pieces of measured curves between servos and plane.
#pragma once

#include <array>
#include <vector>

#include "model/hybrid/part.hpp"
#include "model/servo/servo_axis.hpp"

namespace bbsim::model {

// The first zero crossing of a guard.
struct Crossing {
  double time = unlimited;  // s; infinite if no guard crosses
  std::size_t guard = 0;
};

class Servos : public Part {
 public:
  explicit Servos(SwitchedModel& model);

  [[nodiscard]] std::size_t guards() const { return guards_; }
  void append_scales(std::vector<double>& scales) const;
  void evaluate(const GuardContext& now, double* values) const;
  [[nodiscard]] bool reset(double t, double* z);

  // Gives each servo its command. Returns for each whether the command that it follows jumps.
  [[nodiscard]] std::array<bool, most_servos> follow(
      const std::array<double, most_servos>& commands);
  // Whether the last reset() may have changed a mode.
  [[nodiscard]] bool chose() const { return chose_; }

  // The motions of the servos from the states z at t, in the present mode, while their commands are
  // held.
  [[nodiscard]] HeldMotions held_motions(double t, const double* z) const;
  // The first crossing within (t, end], for servos with these motions from t.
  [[nodiscard]] Crossing next_crossing(double t, const HeldMotions& motions, double end);
  // Whether a stepper has begun to lose steps since the last call.
  [[nodiscard]] bool takes_loss() {
    bool any = false;
    for (ServoAxis& axis : axes_) any = axis.takes_loss() || any;
    return any;
  }
  [[nodiscard]] const ServoAxis& axis(std::size_t i) const { return axes_[i]; }

 private:
  // Of a shaft that rings, its driver's state: that one switches.
  [[nodiscard]] AxisState state(std::size_t i, double t, const Demands& demands,
                                const double* z) const {
    const SwitchedModel::ServoReading at = model_.counted(i, t, z);
    return {at.angle, at.rate, demands.demand[i], demands.servo_command[i]};
  }
  [[nodiscard]] bool stay_free(const double* z) const;
  bool lags(std::size_t i, const AxisState& axis, double t);
  void kick_ball(double* z, const double* before, const RigExtras& plane_before,
                 const RigExtras& plane);

  SwitchedModel& model_;
  std::vector<ServoAxis> axes_;
  std::size_t guards_ = 0;
  bool chose_ = true;
  KnownAnswers answers_;
};

// Pieces of measured curves between servos and plane. The system holds one piece of each curve at
// a time, to keep the right-hand side smooth.
class CurvePieces : public Part {
 public:
  explicit CurvePieces(SwitchedModel& model);

  [[nodiscard]] static std::size_t guards() { return std::size_t{2} * Guard::count; }
  static void append_scales(std::vector<double>& scales) {
    scales.insert(scales.end(), guards(), 1.0);
  }
  void evaluate(const GuardContext& now, double* values) const;
  [[nodiscard]] bool reset(double t, double* z) {
    choose(t, z);
    return false;
  }
  // The direction of the motion may have changed.
  void after_jump(double t, const double* z) { choose(t, z); }

 private:
  // Guards per axis: the ends of the horn's piece and of the command's piece.
  struct Guard {
    enum : std::size_t { high, low, command_high, command_low, count };
  };

  [[nodiscard]] const Linkage& linkage(std::size_t axis) const {
    return model_.rig().mechanism.linkages[axis];
  }
  // Whether the commands of a continuous law also go through the curve.
  [[nodiscard]] bool converts_commands(const Linkage& linkage) const {
    return !model_.rig().sampled && linkage.curve.assumed == Assumed::exact;
  }
  void choose(double t, const double* z);
  void put();

  SwitchedModel& model_;
  std::size_t pieces_[2]{0, 0}, command_pieces_[2]{0, 0};
};

}  // namespace bbsim::model
