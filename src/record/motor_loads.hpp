// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The most that the motors of an ideal gimbal have to give in a run.
#pragma once

#include "model/model.hpp"
#include "record/extremes.hpp"
#include "record/summary.hpp"

namespace bbsim::record {

class MotorLoads {
 public:
  MotorLoads();

  // Begins a run; the two outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants);
  // Who is to be told of the run's motion, and of its first row.
  [[nodiscard]] Extremes& extremes() { return extremes_; }
  [[nodiscard]] MotorPeaks peaks() const;

 private:
  Extremes extremes_;  // the greatest and the least of each load
  bool with_plate_ = false;
};

[[nodiscard]] bool has_plate_inertia(const model::BallConstants& constants);

}  // namespace bbsim::record
