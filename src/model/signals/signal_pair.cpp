// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/signals/signal_pair.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "model/signals/add_profile.hpp"

namespace bbsim::model {

void SignalPair::add_ramp(std::size_t component, double start, double rate) {
  start_[component] += start;
  rate_[component] += rate;
}

void SignalPair::add_sinusoid(std::size_t component, double amplitude, double frequency,
                              double phase) {
  if (amplitude == 0) return;
  if (frequency == 0) {
    add_constant(component, amplitude * std::sin(phase));
    return;
  }
  const auto same = [frequency](const Harmonic& h) { return h.frequency == frequency; };
  auto harmonic = std::find_if(harmonics_.begin(), harmonics_.end(), same);
  if (harmonic == harmonics_.end()) {
    harmonic = harmonics_.insert(harmonics_.end(), Harmonic{frequency, {0, 0}, {0, 0}});
  }
  harmonic->sine[component] += amplitude * std::cos(phase);
  harmonic->cosine[component] += amplitude * std::sin(phase);
}

void SignalPair::add_table(std::size_t component, Spline spline) {
  tables_.push_back({component, spline.view()});
  splines_.push_back(std::move(spline));
}

void SignalPair::add(std::size_t component, const Profile& profile) {
  add_profile(profile, component, *this, [&](const auto& part) {
    if constexpr (std::is_same_v<decltype(part), const Pulse&>) {
      const double end = part.start + part.duration, middle = part.start + part.duration / 2;
      if (part.value == 0) return;
      add_table(component, Spline::at_rest_at_knots({part.start, middle, end}, {0, part.value, 0}));
    } else {
      const auto zero = [](double value) { return value == 0; };
      if (std::all_of(part.values.begin(), part.values.end(), zero)) return;
      add_table(component, Spline(part.times, part.values));
    }
  });
}

template <class Counts>
std::vector<double> SignalPair::knots_of(Counts counts) const {
  std::vector<double> times;
  for (const Spline& spline : splines_) {
    if (!counts(spline)) continue;
    times.insert(times.end(), spline.knots().begin(), spline.knots().end());
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

bool SignalPair::is_zero(std::size_t component) const {
  const auto silent = [component](const Harmonic& h) {
    return h.sine[component] == 0 && h.cosine[component] == 0;
  };
  const auto elsewhere = [component](const Tabulated& t) { return t.component != component; };
  return start_[component] == 0 && rate_[component] == 0 &&
         std::all_of(harmonics_.begin(), harmonics_.end(), silent) &&
         std::all_of(tables_.begin(), tables_.end(), elsewhere);
}

std::vector<double> SignalPair::knots() const {
  return knots_of([](const Spline&) { return true; });
}

std::vector<double> SignalPair::jumps() const {
  return knots_of([](const Spline& spline) { return spline.jumps(); });
}

double SignalPair::highest_frequency() const {
  double highest = view().shared.highest_frequency;
  for (const Harmonic& h : harmonics_) highest = std::max(highest, std::abs(h.frequency));
  return highest;
}

double SignalPair::bandwidth(double from, double to) const {
  double rate = std::abs(rate_[0]) + std::abs(rate_[1]);
  for (const Harmonic& harmonic : harmonics_) {
    for (std::size_t i = 0; i < 2; ++i) {
      rate += std::abs(harmonic.frequency) * std::hypot(harmonic.sine[i], harmonic.cosine[i]);
    }
  }
  const double of_sinusoids = 2 * highest_frequency() + rate;
  if (!view().shared.any()) return of_sinusoids;
  double most = 0;
  for (const double t : {from, (from + to) / 2, to}) {
    const auto [first, second] = at(t);
    most = std::max(most, std::abs(first.rate) + std::abs(second.rate));
  }
  constexpr double between = 1.5;  // covers the rate between these three times
  return of_sinusoids + between * most;
}

}  // namespace bbsim::model
