// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/rig_lane_measures.hpp"

#include <algorithm>
#include <cmath>

#include "base/maxima.hpp"
#include "solve/sampled/monitor_ranges.hpp"
#include "sweep/lane_measures.hpp"

namespace bbsim::sweep {
namespace {

using Kind = scenario::Measure::Kind;
using solve::Size;
using solve::sampled::LaneStep;
using solve::sampled::Range;

// Number of intervals that resolve polynomials of degree 9, their squares and the sines of a servo
// over a piece or a part of one.
constexpr std::size_t parts = 16;

// A piece is searched if its bound exceeds the greatest value so far by this fraction.
constexpr double worth = 1e-9;

}  // namespace

RigLaneMeasures::RigLaneMeasures(const std::vector<scenario::Measure>& measures,
                                 const std::vector<const scenario::Column*>& series,
                                 const solve::OutputGrid& grid)
    : measures_(measures),
      grid_(grid),
      end_(scenario::end_columns(measures)),
      series_(series),
      points_(parts),
      times_(parts + 1),
      values_(parts + 1),
      track_(parts + 1) {
  for (const scenario::Measure& measure : measures_) {
    if (measure.kind == Kind::rms) wants_rms_ = true;
    if (const auto size = size_of(measure)) wants_[*size] = true;
  }
}

solve::sampled::LaneAsked RigLaneMeasures::asks_for() const {
  return {wants_[Size::versine] || wants_[Size::rate_squared], wants_[Size::error_squared],
          !series_.columns().empty()};
}

void RigLaneMeasures::begin(const model::SignalPair& reference) {
  reference_ = &reference;
  for (auto& greatest : greatest_) greatest.fill(0);
  squares_.fill({});
  for (std::vector<double>& rows : rows_) rows.clear();
  if (!wants_rms_ || !at_rows_.empty()) return;
  at_rows_.resize(grid_.size());
  for (std::size_t i = 0; i < grid_.size(); ++i) {
    const auto at = reference.at(grid_[i]);
    at_rows_[i] = {at[0].value, at[1].value};
  }
}

void RigLaneMeasures::accept(const LaneStep& step) {
  for (std::size_t lane = 0; lane < group; ++lane) {
    if (!step.has(lane)) continue;
    track_of_ = group;
    for (std::size_t i = 0; i < solve::size_count; ++i) {
      const auto size = static_cast<Size>(i);
      if (!wants_[i]) continue;
      const Range range = step.at_nodes(size, lane);
      double& greatest = greatest_[i][lane];
      if (step.is_whole(lane)) greatest = larger(greatest, range.most);
      const double threshold = (1 + worth) * greatest;
      if (solve::sampled::widened(range).most > threshold &&
          step.bounds(size, lane).most > threshold) {
        look_closer(step, size, lane);
      }
    }
  }
}

double RigLaneMeasures::size_at(Size size, std::size_t point) const {
  const LaneStep::Track& at = track_[point];
  const auto square = [](double value) { return value * value; };
  switch (size) {
    case Size::versine: {
      const double a = square(std::sin(at.phi / 2)), b = square(std::sin(at.theta / 2));
      return 2 * (a + b) - 4 * a * b;
    }
    case Size::rate_squared:
      return square(at.phi_rate) + square(at.theta_rate);
    case Size::distance_squared:
      return square(at.x) + square(at.y);
    default: {
      const auto [x, y] = reference_->at(times_[point]);
      return square(at.x - x.value) + square(at.y - y.value);
    }
  }
}

void RigLaneMeasures::look_closer(const LaneStep& step, Size size, std::size_t lane) {
  if (track_of_ != lane) {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      times_[i] = step.from(lane) + (step.to(lane) - step.from(lane)) * points_[i];
    }
    step.evaluate(lane, times_.data(), times_.size(), track_.data());
    track_of_ = lane;
  }
  double& most = greatest(size, lane);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    values_[i] = size_at(size, i);
    most = larger(most, values_[i]);
  }
  for_each_bracket(points_, values_.data(), most, Between::smooth, [&](const Bracket& bracket) {
    const Peak peak = climb(bracket, good_place * (bracket.to.at - bracket.from.at),
                            [&](double s) { return points_.at(values_.data(), s); });
    most = std::max(most, peak.value);
  });
}

void RigLaneMeasures::accept_row(std::size_t lane, std::size_t row, double x, double y) {
  if (!wants_rms_) return;
  const std::array<double, 2>& reference = at_rows_[row];
  squares_[lane].add(x - reference[0]);
  squares_[lane].add(y - reference[1]);
}

void RigLaneMeasures::accept_whole(std::size_t lane, std::span<const double> row) {
  rows_[lane].insert(rows_[lane].end(), row.begin(), row.end());
}

void RigLaneMeasures::accept_end(std::size_t lane, double t, std::span<const double> row) {
  last_time_[lane] = t;
  last_row_[lane].assign(row.begin(), row.end());
}

// The last piece does not include a switch at its end, so take the end separately.
void RigLaneMeasures::take_end(std::size_t lane, const model::Model& model) {
  const model::Sample end =
      model.sample(last_time_[lane], last_row_[lane].data(), model::Detail::gimbal);
  times_[0] = end.t;
  track_[0] = {end.ball.x,       end.ball.y,         end.gimbal.phi,
               end.gimbal.theta, end.gimbal.phi_dot, end.gimbal.theta_dot};
  track_of_ = group;
  for (std::size_t i = 0; i < solve::size_count; ++i) {
    if (!wants_[i]) continue;
    const auto size = static_cast<Size>(i);
    greatest(size, lane) = larger(greatest(size, lane), size_at(size, 0));
  }
}

bool RigLaneMeasures::finish(std::size_t lane, const model::Model& model,
                             const model::BallConstants& constants, double* results) {
  take_end(lane, model);
  for (const Size size : {Size::distance_squared, Size::error_squared}) {
    if (wants_[size] && !is_square(greatest(size, lane))) return false;
  }
  end_.begin(model, constants);
  if (!end_.columns().empty()) end_.evaluate(&last_time_[lane], last_row_[lane].data(), 1);
  std::size_t at_end = 0;
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    if (measures_[m].kind == Kind::end) {
      results[m] = end_[at_end++][0];
    } else if (measures_[m].kind == Kind::rms) {
      results[m] = squares_[lane].root_mean(grid_.size());
    } else {
      const Size size = *size_of(measures_[m]);
      results[m] = value_of(size, greatest(size, lane));
    }
  }
  return true;
}

void RigLaneMeasures::write_series(std::size_t lane, const model::Model& model,
                                   const model::BallConstants& constants, file::TableWriter& into) {
  std::vector<double> times(grid_.size());
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = grid_[i];
  series_.begin(model, constants);
  series_.evaluate(times.data(), rows_[lane].data(), times.size());
  std::vector<const double*> columns;
  for (std::size_t c = 0; c < series_.columns().size(); ++c) columns.push_back(series_[c]);
  into.append(columns, times.size());
}

}  // namespace bbsim::sweep
