// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/lane_controllers.hpp"

namespace bbsim::solve::sampled {

LaneControllers::LaneControllers(const LaneKernels& kernels)
    : kernels_(kernels), control_(std::make_unique<LaneControl>()) {}

void LaneControllers::begin() {
  *control_ = {};
  // A pack iterates until all its lanes are done. Unused lanes therefore need harmless numbers.
  for (double& elapsed : control_->elapsed.of) elapsed = 1;
  asked_ = {};
  any_ = false;
}

void LaneControllers::take_over(std::size_t l, const model::SampledController& from) {
  const model::SampledLaw<double>& law = from.law();
  LaneControl& to = *control_;
  to.law.law.kind = law.law.kind;
  to.law.integrates = to.law.integrates || law.integrates;
  model::for_each_number(to.law.law, law.law,
                         [l](Lanes& lanes, double number) { lanes.of[l] = number; });
  to.law.resolution.of[l] = law.resolution;
  to.law.filter.of[l] = law.filter;
  const Pair command = from.last_command();
  for (std::size_t i = 0; i < 2; ++i) {
    const auto put = [l](model::SampledLaw<Lanes>::Interval& range,
                         const model::SampledLaw<double>::Interval& of) {
      range.low.of[l] = of.low;
      range.high.of[l] = of.high;
    };
    put(to.law.limit[i], law.limit[i]);
    put(to.law.sine[i], law.sine[i]);
    put(to.law.reached[i], law.reached[i]);
    to.memory.position[i].of[l] = from.memory().position[i];
    to.memory.velocity[i].of[l] = from.memory().velocity[i];
    to.memory.integral[i].of[l] = from.memory().integral[i];
    to.command[i].of[l] = command[i];
  }
  since_[l] = from.since_seen();
}

void LaneControllers::sample(std::size_t l, model::HybridSystem& run, double t, const double* z) {
  LaneControl& control = *control_;
  model::Sampling& sampling = *run.sampling();
  asked_[l] = &sampling;
  const std::optional<Pair> seen = sampling.begin(run.instant_end(t));
  if (!seen) {
    since_[l].miss();
    return;
  }
  any_ = true;
  control.sees.of[l] = 1;
  control.is_first.of[l] = since_[l].any ? 0 : 1;
  control.elapsed.of[l] = since_[l].elapsed(run.model().rig->sampled->sampling.period);
  since_[l].see();
  const model::Rig& rig = *run.model().rig;
  const double* const angle = z + model::RigLayout::angle;
  const double* const rate = angle + rig.servos;
  double servo[4] = {angle[0], angle[1], rate[0], rate[1]};
  if (!rig.mechanism.none() && rig.sampled->law.feeds_servos_back()) {
    rig.mechanism.believed(angle, rate, servo);
  }
  const auto& reference = sampling.reference_at(t);
  for (std::size_t i = 0; i < 2; ++i) {
    control.reference[i][0].of[l] = reference[i].value;
    control.reference[i][1].of[l] = reference[i].rate;
    control.reference[i][2].of[l] = reference[i].acceleration;
    control.seen[i].of[l] = (*seen)[i];
    control.servo[i].of[l] = servo[i];
    control.servo[2 + i].of[l] = servo[2 + i];
  }
}

void LaneControllers::finish() {
  if (any_) {
    kernels_.control(*control_);
    for (double& sees : control_->sees.of) sees = 0;
    any_ = false;
  }
  const LaneControl& control = *control_;
  const auto both = [](const Lanes(&of)[2], std::size_t l) {
    return Pair{of[0].of[l], of[1].of[l]};
  };
  for (std::size_t l = 0; l < group; ++l) {
    if (asked_[l] == nullptr) continue;
    asked_[l]->end(both(control.command, l), both(control.memory.position, l));
    asked_[l] = nullptr;
  }
}

}  // namespace bbsim::solve::sampled
