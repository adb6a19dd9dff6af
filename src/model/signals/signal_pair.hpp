// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Two functions of time with their derivatives: the gimbal's angles, or a reference path.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

#include "model/ball/rolling.hpp"
#include "model/signals/spline.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// Adds a profile's constants, sinusoids and ramps to `to`, with add_constant(component, ...) and so
// on. Passes all other terms, which lanes share (SharedTerms), to add_shared(part).
template <class Signals, class Component, class AddShared>
void add_profile(const Profile& profile, Component component, Signals& to, AddShared add_shared) {
  for (const ProfileTerm& term : profile) {
    std::visit(
        [&](const auto& part) {
          using Part = std::decay_t<decltype(part)>;
          if constexpr (std::is_same_v<Part, double>) {
            to.add_constant(component, part);
          } else if constexpr (std::is_same_v<Part, Sinusoid>) {
            to.add_constant(component, part.offset);
            to.add_sinusoid(component, part.amplitude, part.frequency, part.phase);
          } else if constexpr (std::is_same_v<Part, Ramp>) {
            to.add_ramp(component, part.start, part.rate);
          } else {
            add_shared(part);
          }
        },
        term);
  }
}

// A sinusoid in both components: sine[i] sin(frequency t) + cosine[i] cos(frequency t). Here and
// below, Scalar is double, or a pack with one signal per lane.
template <class Scalar>
struct BasicHarmonic {
  Scalar frequency;  // rad/s
  Scalar sine[2], cosine[2];
};
using Harmonic = BasicHarmonic<double>;

// A spline in one component: a table, or a path through waypoints.
struct Tabulated {
  std::size_t component;
  SplineView spline;
};

// Terms other than constants, ramps and sinusoids. All lanes of a group share them. So far these
// are splines. Terms with other formulas belong here, too.
struct SharedTerms {
  const Tabulated* tables = nullptr;
  std::size_t table_count = 0;
  double highest_frequency = 0;  // of other formulas, rad/s; integrators stop at splines' knots

  [[nodiscard]] bool any() const { return table_count > 0; }

  template <class Time>
  void add_to(std::array<Jet<Time>, 2>& jets, const Time& t) const {
    for (std::size_t k = 0; k < table_count; ++k) {
      const Jet<Time> jet = tables[k].spline.at(t);
      Jet<Time>& sum = jets[tables[k].component];
      sum.value += jet.value;
      sum.rate += jet.rate;
      sum.acceleration += jet.acceleration;
    }
  }
};

// A view of a SignalPair that evaluates the signals for any type of time.
//
// It uses plain arrays and no library calls, so that code for one instruction set stays separate
// from the rest of the program.
template <class Scalar>
struct BasicSignalView {
  Scalar start[2], rate[2];
  const BasicHarmonic<Scalar>* harmonics;
  std::size_t harmonic_count;
  SharedTerms shared;

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
    shared.add_to(jets, t);
    return jets;
  }
};

using SignalView = BasicSignalView<double>;

// A sum of constants, ramps, sinusoids and splines in each of two components.
//
// A sine costs more than the rest of the right-hand side. Sinusoids of the same frequency, in
// either component and with any phase, therefore share one:
// a sin(wt + p) = a cos p sin wt + a sin p cos wt.
class SignalPair {
 public:
  void add_constant(std::size_t component, double value) { start_[component] += value; }
  void add_ramp(std::size_t component, double start, double rate);
  void add_sinusoid(std::size_t component, double amplitude, double frequency, double phase);
  void add_table(std::size_t component, Spline spline);
  void add(std::size_t component, const Profile& profile);

  // Whether the component is zero at all times.
  [[nodiscard]] bool is_zero(std::size_t component) const;

  // Times at which a derivative or a value jumps: the knots of the splines, sorted. `only_jumps`:
  // only those at which a value jumps.
  [[nodiscard]] std::vector<double> knots(bool only_jumps = false) const;

  // The highest frequency of a sinusoid or another formula, rad/s; 0 if there are none.
  [[nodiscard]] double highest_frequency() const;

  // Bound on the bandwidth of sines of the components between two times with no knot between them,
  // rad/s. It is the bandwidth of the fastest sinusoid plus the rates of both components, because
  // cos(phi) cos(theta) is the mean of cos(phi + theta) and cos(phi - theta).
  [[nodiscard]] double bandwidth(double from, double to) const;

  // Both components at time t (s).
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> at(const Time& t) const {
    return view().at(t);
  }

  // The view is valid until this pair changes or is destroyed.
  [[nodiscard]] SignalView view() const {
    return {{start_[0], start_[1]},
            {rate_[0], rate_[1]},
            harmonics_.data(),
            harmonics_.size(),
            {tables_.data(), tables_.size()}};
  }

 private:
  double start_[2] = {0, 0}, rate_[2] = {0, 0};
  std::vector<Harmonic> harmonics_;
  std::vector<Spline> splines_;
  std::vector<Tabulated> tables_;  // the same splines, as views
};

// Two signals at a time.
struct KnownSignals {
  double t = -1;  // s
  std::array<Jet<double>, 2> value{};

  // evaluate() gives the value at `time`, if it is not the known one.
  template <class Evaluate>
  const std::array<Jet<double>, 2>& at(double time, Evaluate evaluate) {
    if (t != time) *this = {time, evaluate()};
    return value;
  }
};

// A cache of signals for runs that advance together.
class SharedSignals {
 public:
  // The entry for t, which may hold another time.
  [[nodiscard]] KnownSignals& entry(double t) {
    return known_[std::bit_cast<std::uint64_t>(t) * 0x9e3779b97f4a7c15u >> (64 - bits)];
  }

 private:
  static constexpr int bits = 7;
  std::array<KnownSignals, std::size_t{1} << bits> known_;
};

// phi and theta of a scene with gimbal.motion, including the mounting's offsets.
[[nodiscard]] SignalPair given_motion(const Scenario& scenario);

// x and y (m), or phi and theta (rad), of the reference as functions of time (s) for a run until
// `end`, with the jumps before the end. A square wave jumps at most most_jumps times in a run.
[[nodiscard]] SignalPair reference_path(const Reference& reference, double end);

}  // namespace bbsim::model
