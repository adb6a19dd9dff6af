// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/signals/reference_path.hpp"

#include <numbers>
#include <variant>
#include <vector>

namespace bbsim::model {
namespace {

constexpr double quarter_turn = std::numbers::pi / 2;  // a cosine is a sine with this phase

struct Path {
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

  static SignalPair constant(const Pair& position) {
    SignalPair path;
    for (std::size_t i = 0; i < 2; ++i) path.add_constant(i, position[i]);
    return path;
  }
};

}  // namespace

SignalPair reference_path(const Reference& reference) {
  return std::visit(Path{}, reference);
}

}  // namespace bbsim::model
