// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Two functions of time with their derivatives: the gimbal's angles, or a reference path.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/ball/rolling.hpp"
#include "model/signals/spline.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// A sinusoid of both components: sine[i] sin(frequency t) + cosine[i] cos(frequency t). Scalar,
// here and below, is a double, or a pack of them with other signals in each lane.
template <class Scalar>
struct BasicHarmonic {
  Scalar frequency;  // rad/s
  Scalar sine[2], cosine[2];
};
using Harmonic = BasicHarmonic<double>;

// A spline of one component: a table, or a path past waypoints.
struct Tabulated {
  std::size_t component;
  SplineView spline;
};

// A look at a SignalPair without owning it: what evaluates the signals, for any type of time.
//
// Plain arrays and no library calls, so that code for one instruction set stays apart from the
// rest of the program.
template <class Scalar>
struct BasicSignalView {
  Scalar start[2], rate[2];
  const BasicHarmonic<Scalar>* harmonics;
  std::size_t harmonic_count;
  const Tabulated* tables;
  std::size_t table_count;

  // Both components at time t (s).
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> at(const Time& t) const {
    std::array<Jet<Time>, 2> jets;
    for (std::size_t i = 0; i < 2; ++i) {
      jets[i] = {start[i] + rate[i] * t, Time(rate[i]), Time(0.0)};
    }
    for (std::size_t k = 0; k < harmonic_count; ++k) {
      const BasicHarmonic<Scalar>& harmonic = harmonics[k];
      const Scalar w = harmonic.frequency;
      const SinCos<Time> wave = sin_cos(Time(w * t));
      for (std::size_t i = 0; i < 2; ++i) {
        const Time value = harmonic.sine[i] * wave.sin + harmonic.cosine[i] * wave.cos;
        jets[i].value += value;
        jets[i].rate += w * (harmonic.sine[i] * wave.cos - harmonic.cosine[i] * wave.sin);
        jets[i].acceleration -= (w * w) * value;
      }
    }
    for (std::size_t k = 0; k < table_count; ++k) {
      const Jet<Time> jet = tables[k].spline.at(t);
      Jet<Time>& sum = jets[tables[k].component];
      sum.value += jet.value;
      sum.rate += jet.rate;
      sum.acceleration += jet.acceleration;
    }
    return jets;
  }
};

using SignalView = BasicSignalView<double>;

// A sum of constants, ramps, sinusoids and splines on each of two components.
//
// A sine costs more than the rest of the right-hand side, so sinusoids of one frequency, on
// either component and of any phase, share one: a sin(wt + p) = a cos p sin wt + a sin p cos wt.
class SignalPair {
 public:
  void add_constant(std::size_t component, double value) { start_[component] += value; }
  void add_ramp(std::size_t component, double start, double rate);
  void add_sinusoid(std::size_t component, double amplitude, double frequency, double phase);
  void add_table(std::size_t component, Spline spline);
  void add(std::size_t component, const Profile& profile);

  // Whether a component is zero at all times.
  [[nodiscard]] bool is_zero(std::size_t component) const;

  // Times at which some derivative jumps: the knots of the splines, sorted.
  [[nodiscard]] std::vector<double> knots() const;

  // The largest frequency of a sinusoid, rad/s; 0 if there is none.
  [[nodiscard]] double highest_frequency() const;

  // How fast sines of the components change between two times with no knot between them, rad/s: the
  // bandwidth of the fastest sinusoid, and of the sine of an angle that itself changes fast;
  // cos(phi) cos(theta) is a mean of cos(phi + theta) and cos(phi - theta).
  [[nodiscard]] double bandwidth(double from, double to) const;

  // Both components at time t (s).
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> at(const Time& t) const {
    return view().at(t);
  }

  // Valid as long as this pair lives and is not changed.
  [[nodiscard]] SignalView view() const {
    return {{start_[0], start_[1]}, {rate_[0], rate_[1]}, harmonics_.data(),
            harmonics_.size(),      tables_.data(),       tables_.size()};
  }

 private:
  double start_[2] = {0, 0}, rate_[2] = {0, 0};
  std::vector<Harmonic> harmonics_;
  std::vector<Spline> splines_;
  std::vector<Tabulated> tables_;  // the same splines, as views
};

}  // namespace bbsim::model
