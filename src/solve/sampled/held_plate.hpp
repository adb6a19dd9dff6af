// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The servos of one rig over a piece under a held command, and the plate that they move.
#pragma once

#include <cstddef>
#include <vector>

#include "model/model.hpp"
#include "model/servo/held_motion.hpp"
#include "model/systems/list.hpp"
#include "solve/sampled/kernel.hpp"
#include "solve/sampled/motion_tables.hpp"

namespace bbsim::solve::sampled {

using model::with_given_plate;

class HeldPlate {
 public:
  // with_given_plate() must hold for the model, which must live.
  explicit HeldPlate(const model::Model& model);

  [[nodiscard]] std::size_t servos() const { return servos_; }
  [[nodiscard]] const model::RigMode& mode() const { return *mode_; }
  [[nodiscard]] const model::ServoResponses& response() const { return response_; }

  // Sets the servos' motions from states z at t, in the present mode.
  void set_motions(double t, const double* z, model::HeldMotions& motions) const;

  // Sets the servos of a piece of `length` s in the present mode, and the plate at its start if it
  // is behind a mechanism. The tables and this object must live as long as the motion is used.
  void prepare(const model::HeldMotions& motions, double length, MotionTables& tables,
               PlateMotion& motion);
  // Writes the servos' angles and rates at the end of the piece into states z.
  void write_end(const PlateMotion& motion, double* z) const;
  // Goes on from the end of a piece whose plate was computed.
  void pass(const PlateMotion& motion);

  // Whether the mechanism is certain to stay within its range over the piece.
  [[nodiscard]] bool stays_off_dead_points(const PlateMotion& motion,
                                           const model::HeldMotions& motions, double length) const;

 private:
  void start_plate(const model::Linkages& link, PlateMotion& motion) const;
  void start_plate(const model::ThreeServos& link, PlateMotion& motion);

  std::size_t servos_ = 2;
  const model::RigMode* mode_ = nullptr;
  model::ServoResponses response_;
  const model::Linkages* linkages_ = nullptr;
  const model::ThreeServos* three_ = nullptr;
  // A pose of three servos near the next one, the horns' angles in it, rad, and the plate there.
  struct Known {
    PlateMotion::Legs legs;
    double horn[3], rate[3], acceleration[3];
    model::GimbalAngle<double> plane[2];
    double edges[model::ThreeServos::edge_count];
    bool has_plate;
  } known_{};
  std::vector<MotionTable> drifting_;  // of steppers that ring, over the last piece
  double gain_ = 1;                    // of three servos, at home (PlateMotion::gain)
};

}  // namespace bbsim::solve::sampled
