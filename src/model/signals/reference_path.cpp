// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/signals/reference_path.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "base/instant.hpp"

namespace bbsim::model {
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
