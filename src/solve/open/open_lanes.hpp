// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Many balls under given motions at once: another case in each SIMD lane.
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

// The gimbal's angles as functions of time: start + rate t + sums of amplitude sin(frequency t +
// phase), plus tables that are those of all cases; phi, theta.
struct GivenMotion {
  struct Wave {
    int component;
    double amplitude, frequency, phase;
  };
  double start[2] = {0, 0}, rate[2] = {0, 0};
  Wave waves[most_harmonics];
  int wave_count = 0;  // in all cases of a group, with the same components
  const model::Tabulated* tables = nullptr;
  std::size_t table_count = 0;

  void add_constant(int component, double value) { start[component] += value; }
  void add_ramp(int component, double from, double slope) {
    start[component] += from;
    rate[component] += slope;
  }
  // No more than there is place for.
  void add_sinusoid(int component, double amplitude, double frequency, double phase) {
    waves[wave_count++] = {component, amplitude, frequency, phase};
  }
};

// One case, in SI: model::OpenLoop<Shape::full>.
struct OpenCase {
  double radius = 0, gravity = 0;
  double initial[states] = {};  // x, y, x', y', u
  GivenMotion motion;
};

// How long steps are at first. Both numbers cost time alone if they do not suit.
struct Pace {
  int nodes = 12;      // of Radau IIA: 8, 12 or 16
  double angle = 2.0;  // the part of the motion's tempo in a step, rad
};

// What a case came to.
struct Reached {
  double state[states];     // at the end
  double distance_squared;  // the greatest from the plane's origin, m^2
  double versine;           // 1 - cos(tilt), and the square of the plane's angular velocity: no
  double rate_squared;      // numbers where there are tables, whose extremes are for others
};

// Integrates groups of cases from t = 0 to the end, in lock step: a group takes one step for all
// its lanes, short enough for each, by collocation at Radau IIA's nodes. Allocates nothing once it
// is made; one for each thread.
//
// What a case comes to depends, within the tolerance, on its companions in the group, and on
// nothing else: the same group gives the same bits whichever thread and whatever ran before.
class OpenLanes {
 public:
  // Steps end at the stops, which are ordered, in (0, end) and the same for all cases, s. Throws
  // InputError as choose_kernels() does.
  OpenLanes(Tolerances tolerances, double end, std::vector<double> stops, Pace pace);

  // The first `count` cases, 1 <= count <= group. Whether each was carried to the end; one that was
  // not, for values that are not finite, for a step that shrank to nothing, for too many steps, or
  // because it would hold the others back, is for another integrator.
  std::array<bool, group> integrate(const OpenCase* cases, int count);

  // Of the last group.
  [[nodiscard]] Reached reached(int lane) const;
  [[nodiscard]] Statistics statistics() const { return statistics_; }

  // The fastest pace at which this group's steps all succeed at once, and what it costs then, in
  // sums over nodes; none if its cases are not carried at all.
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
  std::vector<double> stops_;  // the end among them
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
