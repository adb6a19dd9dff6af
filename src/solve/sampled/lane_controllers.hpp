// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sampled controllers of rigs in lanes. Those that sample in the same round are computed
// together, whatever their times.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "model/hybrid/hybrid_system.hpp"
#include "solve/sampled/lane_kernel.hpp"

namespace bbsim::solve::sampled {

// Holds the law and memory of each controller from take_over() on. The runs' own controllers
// (Sampling::controller()) no longer change.
class LaneControllers {
 public:
  explicit LaneControllers(const LaneKernels& kernels);

  // Starts a new group without controllers.
  void begin();
  void take_over(std::size_t lane, const model::SampledController& from);

  // Takes the sample of a lane's run that is due at t (s), from states z. finish() computes the
  // commands and passes them to the runs, which must live until then.
  void sample(std::size_t lane, model::HybridSystem& run, double t, const double* z);
  void finish();

 private:
  const LaneKernels& kernels_;
  std::unique_ptr<LaneControl> control_;  // aligned
  std::array<model::SinceSeen, group> since_{};
  std::array<model::Sampling*, group> asked_{};  // since the last finish()
  bool any_ = false;                             // whether any of these sees the ball
};

}  // namespace bbsim::solve::sampled
