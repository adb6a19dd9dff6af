// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The peak loads of an ideal gimbal's motors in a run.
#pragma once

#include "model/model.hpp"
#include "record/extremes.hpp"
#include "record/summary.hpp"

namespace bbsim::record {

class MotorLoads {
 public:
  MotorLoads();

  // Begins a run. Both arguments must outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants);
  // Needs the pieces and the first row of the run.
  [[nodiscard]] Extremes& extremes() { return extremes_; }
  [[nodiscard]] MotorPeaks peaks() const;

 private:
  Extremes extremes_;  // the greatest and the least value of each load
  bool with_plate_ = false;
};

[[nodiscard]] bool has_plate_inertia(const model::BallConstants& constants);

}  // namespace bbsim::record
