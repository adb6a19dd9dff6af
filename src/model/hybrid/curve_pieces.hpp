// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Pieces of measured curves between servos and plane. The system holds one piece of each curve at
// a time, to keep the right-hand side smooth.
#pragma once

#include "model/hybrid/part.hpp"

namespace bbsim::model {

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
