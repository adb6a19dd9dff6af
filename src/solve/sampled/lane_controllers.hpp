// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sampled controllers of rigs that go together: those that sample in one turn compute together,
// whatever their times.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "model/hybrid_system.hpp"
#include "solve/sampled/lane_kernel.hpp"

namespace bbsim::solve::sampled {

// The runs' own controllers (HybridSystem::computer()) stay what they were when they were taken
// over: their law and their memory are here from there on.
class LaneControllers {
 public:
  explicit LaneControllers(const LaneKernels& kernels);

  // A new group: no lane has a controller.
  void begin();
  void take_over(std::size_t lane, const model::SampledController& from);

  // The sample of a lane's run that is due at t, from states z; `run` lives until finish(), and
  // learns its command then.
  void sample(std::size_t lane, model::HybridSystem& run, double t, const double* z);
  void finish();

 private:
  const LaneKernels& kernels_;
  std::unique_ptr<LaneControl> control_;  // aligned
  std::array<model::SinceSeen, group> since_{};
  std::array<model::HybridSystem*, group> asked_{};  // since the last finish()
  bool any_ = false;                                 // whether some of them see the ball
};

}  // namespace bbsim::solve::sampled
