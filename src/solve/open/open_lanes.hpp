// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates many balls under given motions at once, with one case in each SIMD lane.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "model/signals/signal_pair.hpp"
#include "solve/open/kernel.hpp"
#include "solve/open/lost_lanes.hpp"
#include "solve/outcome.hpp"

namespace bbsim::solve::open {

// The gimbal's angles (phi, theta) as functions of time: start + rate t + sums of amplitude
// sin(frequency t + phase), plus terms that all cases share.
struct GivenMotion {
  struct Wave {
    int component;
    double amplitude, frequency, phase;
  };
  double start[2] = {0, 0}, rate[2] = {0, 0};
  Wave waves[most_harmonics];
  int wave_count = 0;  // the same in all cases of a group, and with the same components
  model::SharedTerms shared;

  void add_constant(int component, double value) { start[component] += value; }
  void add_ramp(int component, double from, double slope) {
    start[component] += from;
    rate[component] += slope;
  }
  // At most most_harmonics sinusoids.
  void add_sinusoid(int component, double amplitude, double frequency, double phase) {
    waves[wave_count++] = {component, amplitude, frequency, phase};
  }
};

// One case, in SI units: model::OpenLoop<Shape::full>.
struct OpenCase {
  double radius = 0, gravity = 0;
  double initial[states] = {};  // x, y, x', y', u
  GivenMotion motion;
};

// The first steps of a group. A poor choice only costs time.
struct Pace {
  int nodes = 12;      // of Radau IIA: 8, 12 or 16
  double angle = 2.0;  // the tempo of the motion times the first step, rad
};

// The results of a case.
struct Reached {
  double state[states];     // at the end
  double distance_squared;  // the greatest from the plate's origin, m^2
  // Greatest 1 - cos(tilt) and squared angular velocity of the plate. NaN with shared
  // terms, whose extremes are computed elsewhere.
  double versine;
  double rate_squared;
};

// Integrates groups of cases from t = 0 to the end in lock step, by collocation at Radau IIA's
// nodes. All lanes of a group take the same step, which is short enough for each. After
// construction nothing allocates. Use one object per thread.
//
// Within the tolerance, the results of a case depend on its companions in the group, and on nothing
// else. The same group gives the same bits in every thread and after any other group.
class OpenLanes {
 public:
  // `stops` (s): ordered times in (0, end), the same for all cases, at which steps end. `end` in s.
  // Throws InputError as choose_kernels() does.
  OpenLanes(Tolerances tolerances, double end, std::vector<double> stops, Pace pace);

  // Integrates the first `count` cases, 1 <= count <= group. Returns for each whether it reached
  // the end. A case does not if values are not finite, if its step shrinks to nothing, if it takes
  // too many steps, or if it would hold the others back. Another integrator must run it.
  std::array<bool, group> integrate(const OpenCase* cases, int count);

  // Of the last group.
  [[nodiscard]] Reached reached(int lane) const;
  [[nodiscard]] Statistics statistics() const { return statistics_; }

  // The fastest pace at which all of this group's steps pass at the first attempt, and its cost in
  // sums over nodes. Empty if no case reaches the end.
  struct Measured {
    Pace pace;
    double cost;
  };
  [[nodiscard]] std::optional<Measured> measure(const OpenCase* cases, int count);

 private:
  struct Free {
    void operator()(void* memory) const;
  };

  void load(const OpenCase* cases, int count);
  void load_waves(const OpenCase* cases, int count);
  struct Tempo;
  [[nodiscard]] static double tempo(const OpenCase* cases, int count);
  [[nodiscard]] bool go(double from, double to);
  double judge(const Attempt& attempt, bool at_limit);
  void turn(const OpenCase* cases, int count);

  const Kernel* kernel_;
  const Kernels& kernels_;
  Tolerances tolerances_;
  double end_;
  std::vector<double> stops_;  // includes the end
  Pace pace_;
  std::unique_ptr<void, Free> workspace_;
  Scenes scenes_{};
  LostLanes<group> lost_;
  double next_ = 0;  // step, s
  Statistics statistics_;
  alignas(64) double state_[states][group]{};
  alignas(64) double distance_squared_[group]{};
  Turning turning_{};
};

}  // namespace bbsim::solve::open
