// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/signals/signal_pair.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/instant.hpp"

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

std::vector<double> SignalPair::knots(bool only_jumps) const {
  std::vector<double> times;
  for (const Spline& spline : splines_) {
    if (only_jumps && !spline.jumps()) continue;
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

SignalPair given_motion(const Scenario& scenario) {
  const Gimbal& gimbal = scenario.gimbal;
  SignalPair motion;
  motion.add(0, gimbal.motion->phi);
  motion.add(1, gimbal.motion->theta);
  motion.add_constant(0, gimbal.mounting.phi_offset);
  motion.add_constant(1, gimbal.mounting.theta_offset);
  return motion;
}

namespace {

constexpr double quarter_turn = std::numbers::pi / 2;  // a cosine is a sine with this phase

// Holds values[i + 1] from jumps[i] on. Drops jumps to the same value, and jumps at the end of the
// run, which have no time to act.
void add_steps(SignalPair& path, std::size_t component, const std::vector<double>& values,
               const std::vector<double>& jumps, double end) {
  std::vector<double> held{values.front()}, times;
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    if (jumps[i] > 0 && jumps[i] >= end - rounding_of(end)) break;
    if (values[i + 1] == held.back()) continue;
    held.push_back(values[i + 1]);
    times.push_back(jumps[i]);
  }
  if (times.empty()) {
    path.add_constant(component, held.front());
  } else {
    path.add_table(component, Spline::held_between_knots(std::move(times), held));
  }
}

struct Path {
  double end;  // of the run, s

  SignalPair operator()(const PointReference& point) const { return constant(point.position); }

  SignalPair operator()(const CircleReference& circle) const {
    SignalPair path = constant(circle.centre);
    path.add_sinusoid(0, circle.radius, circle.rate, circle.phase + quarter_turn);
    path.add_sinusoid(1, circle.radius, circle.rate, circle.phase);
    return path;
  }

  SignalPair operator()(const LissajousReference& figure) const {
    const auto& [amplitude, rate, phase, centre] = figure;
    SignalPair path = constant(centre);
    path.add_sinusoid(0, amplitude[0], rate[0], phase[0] + quarter_turn);
    path.add_sinusoid(1, amplitude[1], rate[1], phase[1]);
    return path;
  }

  SignalPair operator()(const WaypointReference& way) const {
    const auto spline = way.rest ? Spline::at_rest_at_knots : Spline::at_rest_at_ends;
    SignalPair path;
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<double> values;
      for (const Pair& point : way.points) values.push_back(point[i]);
      path.add_table(i, spline(way.times, values));
    }
    return path;
  }

  SignalPair operator()(const TableReference& table) const {
    SignalPair path;
    path.add_table(0, Spline(table.times, table.x));
    path.add_table(1, Spline(table.times, table.y));
    return path;
  }

  SignalPair operator()(const CommandProfiles& commands) const {
    SignalPair angles;
    angles.add(0, commands.phi);
    angles.add(1, commands.theta);
    return angles;
  }

  SignalPair operator()(const StaircaseReference& stairs) const {
    SignalPair path;
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<double> values;
      for (const Pair& point : stairs.points) values.push_back(point[i]);
      add_steps(path, i, values, stairs.jumps, end);
    }
    return path;
  }

  SignalPair operator()(const SquareReference& square) const {
    SignalPair path;
    for (std::size_t i = 0; i < 2; ++i) {
      const double high = square.centre[i] + square.amplitude[i];
      const double low = square.centre[i] - square.amplitude[i];
      const double shift = square.phase[i] / (2 * std::numbers::pi);  // in periods
      // Jumps up at (k - shift) periods, and down `duty` periods later.
      const double first = std::floor(shift) - 1;
      std::vector<double> values{low}, jumps;
      for (std::size_t n = 0; jumps.size() < most_jumps + 4; ++n) {
        const double at = first + std::floor(static_cast<double>(n) / 2) - shift;
        double t = (n % 2 == 0 ? at : at + square.duty) * square.period;
        if (std::abs(t) <= rounding_of(square.period)) t = 0;
        if (t > end) break;
        values.push_back(n % 2 == 0 ? high : low);
        jumps.push_back(t);
      }
      add_steps(path, i, values, jumps, end);
    }
    return path;
  }

  static SignalPair constant(const Pair& position) {
    SignalPair path;
    for (std::size_t i = 0; i < 2; ++i) path.add_constant(i, position[i]);
    return path;
  }
};

}  // namespace

SignalPair reference_path(const Reference& reference, double end) {
  return std::visit(Path{end}, reference);
}

}  // namespace bbsim::model
