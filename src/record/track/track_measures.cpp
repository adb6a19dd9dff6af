// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/track_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "record/square_sum.hpp"

namespace bbsim::record {
namespace {

using Kind = scenario::Measure::Kind;

// If the rows of the system are a track, calls `use` with its signals and whether its loop is
// closed.
template <class Use>
void with_track(const model::Model& model, Use use) {
  std::visit(
      [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        using model::Shape;
        if constexpr (std::is_same_v<System, model::OpenLoop<Shape::full>>) {
          use(system.motion(), false);
        } else if constexpr (std::is_same_v<System,
                                            model::ClosedLoop<Shape::full, Drives::acceleration>> ||
                             std::is_same_v<System,
                                            model::ClosedLoop<Shape::full, Drives::angle>>) {
          use(system.reference(), true);
        }
      },
      model.system);
}

bool is_track_measure(const scenario::Measure& measure) {
  if (!measure.window.is_whole()) return false;
  if (measure.kind == Kind::end) return measure.column->needs != scenario::Needs::gamma;
  const std::string_view name = measure.column->name;
  if (name == "tracking_error") return measure.kind == Kind::greatest || measure.kind == Kind::rms;
  return measure.kind == Kind::greatest &&
         (name == "tilt" || name == "tilt_rate" || name == "distance");
}

// Number of points searched in one call; a piece has fewer.
constexpr std::size_t points_together = 1024;

void subtract(const SignalRows& signals, std::size_t count, PaddedRows& x, PaddedRows& y) {
  for (std::size_t i = 0; i < count; ++i) {
    x.data()[i] -= signals.value(0)[i];
    y.data()[i] -= signals.value(1)[i];
  }
}

}  // namespace

bool are_track_measures(const std::vector<scenario::Measure>& measures) {
  return std::all_of(measures.begin(), measures.end(), is_track_measure);
}

bool has_track(const model::Model& model) {
  bool has = false;
  if (!model.hybrid()) with_track(model, [&](const auto&, bool) { has = true; });
  return has;
}

const model::SignalPair& signals_of(const model::Model& model) {
  const model::SignalPair* found = nullptr;
  with_track(model, [&](const model::SignalPair& signals, bool) { found = &signals; });
  return *found;
}

TrackMeasures::TrackMeasures(std::vector<scenario::Measure> measures)
    : measures_(std::move(measures)),
      kernels_(choose_track_kernels()),
      end_(scenario::end_columns(measures_)) {
  for (const scenario::Measure& measure : measures_) {
    if (measure.kind == Kind::end) continue;
    const std::string_view name = measure.column->name;
    wants_distance_ = wants_distance_ || name == "distance";
    wants_gimbal_ = wants_gimbal_ || name == "tilt" || name == "tilt_rate";
    if (name != "tracking_error") continue;
    (measure.kind == Kind::rms ? wants_rms_ : wants_error_) = true;
  }
}

bool TrackMeasures::wants_positions_only(const model::Model& model) const {
  if (model.closed_loop()) return false;
  return std::all_of(measures_.begin(), measures_.end(), [](const scenario::Measure& measure) {
    return measure.kind != Kind::end || measure.column->name == "x" || measure.column->name == "y";
  });
}

void TrackMeasures::begin(const model::Model& model, const model::BallConstants& constants,
                          const solve::OutputGrid& grid, bool same_signals) {
  model_ = &model;
  end_.begin(model, constants);
  grid_ = &grid;
  with_track(model, [&](const model::SignalPair& signals, bool closed) {
    signals_ = &signals;
    closed_ = closed;
  });
  if (!same_signals) {
    has_row_reference_ = false;
    motion_.reset();
  }
  for (PaddedRows* const column : {&x_, &y_, &sizes_}) column->resize(points_together);
  if (closed_ && wants_gimbal_) {
    for (PaddedRows* const column : {&phi_, &theta_, &phi_rate_, &theta_rate_, &more_sizes_}) {
      column->resize(points_together);
    }
  }
  begin_run();
}

// The start belongs to no piece, and a run may end there.
void TrackMeasures::begin_run() {
  greatest_ = {};
  taken_ = false;
  reached_ = 0;
  rows_ = 1;
  spans_.clear();
  points_ = 0;
  reference_.times(points_together)[0] = 0;
  last_ = model_->initial;
  last_.resize(model_->row_size());
  copy_points(last_.data(), 1);
}

void TrackMeasures::accept(const solve::Piece& piece) {
  const bool needs_points = wants_distance_ || (closed_ && (wants_gimbal_ || wants_error_));
  const std::size_t parts = piece.parts(), count = needs_points ? parts + 1 : 0;
  if (points_ + count > points_together) flush();
  times_.resize(count);
  if (needs_points) {
    const ChebyshevPoints& points = search_.points(parts);
    for (std::size_t i = 0; i < count; ++i) {
      times_[i] = piece.from() + (piece.to() - piece.from()) * points[i];
    }
    times_.back() = piece.to();
    spans_.push_back({points_, parts});
    if (closed_ && wants_error_) {
      std::copy(times_.begin(), times_.end(), reference_.times(points_together) + points_);
    }
  }
  // If rows are not wanted, only the last one is needed: it is the end of the run.
  bool has_row = false;
  if (!wants_rms_) {
    for (; rows_ < grid_->size() && (*grid_)[rows_] <= piece.to(); ++rows_) has_row = true;
    if (has_row) times_.push_back((*grid_)[rows_ - 1]);
  }
  reached_ = piece.to();
  if (times_.empty()) return;
  const std::size_t row = model_->row_size();
  piece_rows_.resize(times_.size() * row);
  piece.evaluate(times_.data(), times_.size(), piece_rows_.data());
  if (has_row) std::copy_n(&piece_rows_[count * row], row, last_.begin());
  if (needs_points) copy_points(piece_rows_.data(), count);
}

// The states of a ball anywhere on the plane are x, y, x', y', u. In a loop, phi, theta, phi',
// theta' of the gimbal follow.
void TrackMeasures::copy_points(const double* rows, std::size_t count) {
  const std::size_t row = model_->row_size();
  const auto copy = [&](std::size_t state, PaddedRows& to) {
    double* const column = to.data() + points_;
    for (std::size_t i = 0; i < count; ++i) column[i] = rows[i * row + state];
  };
  copy(0, x_);
  copy(1, y_);
  if (closed_ && wants_gimbal_) {
    copy(5, phi_);
    copy(6, theta_);
    copy(7, phi_rate_);
    copy(8, theta_rate_);
  }
  points_ += count;
}

void TrackMeasures::accept(std::size_t first, std::size_t count, const double* values) {
  if (!wants_rms_) return;
  const std::size_t row = model_->row_size();
  row_x_.resize(grid_->size());
  row_y_.resize(grid_->size());
  for (std::size_t i = 0; i < count; ++i) {
    row_x_.data()[first + i] = values[i * row];
    row_y_.data()[first + i] = values[i * row + 1];
  }
  rows_ = first + count;
  std::copy_n(values + (count - 1) * row, row, last_.begin());
}

void TrackMeasures::take(std::size_t count, const double* x, const double* y, const double* last,
                         const TrackExtremes& greatest) {
  if (wants_rms_) {
    row_x_.resize(grid_->size());
    row_y_.resize(grid_->size());
    std::copy_n(x, count, row_x_.data());
    std::copy_n(y, count, row_y_.data());
  }
  rows_ = count;
  std::copy_n(last, last_.size(), last_.begin());
  points_ = 0;
  greatest_ = greatest;
  taken_ = true;
}

// Searches the pieces so far for the greatest values.
void TrackMeasures::flush() {
  if (points_ == 0) return;
  if (closed_ && wants_gimbal_) {
    for (PaddedRows* const column : {&phi_, &theta_, &phi_rate_, &theta_rate_}) {
      column->pad(points_);
    }
    double versine, rate_squared;
    kernels_.gimbal({phi_.data(), theta_.data(), phi_rate_.data(), theta_rate_.data()}, points_,
                    {sizes_.data(), more_sizes_.data()}, &versine, &rate_squared);
    greatest_.versine = search_.greatest_between(spans_, sizes_.data(), Spacing::wide,
                                                 std::max(versine, greatest_.versine));
    greatest_.rate_squared = search_.greatest_between(
        spans_, more_sizes_.data(), Spacing::wide, std::max(rate_squared, greatest_.rate_squared));
  }
  if (wants_distance_) look_at_distances(greatest_.distance);
  if (closed_ && wants_error_) {
    reference_.evaluate(*signals_, points_);
    subtract(reference_, points_, x_, y_);
    look_at_distances(greatest_.error);
  }
  spans_.clear();
  points_ = 0;
}

// Searches the distances of (x_, y_). Leaves x_ and y_ unchanged, except for values that underflow.
void TrackMeasures::look_at_distances(double& greatest) {
  x_.pad(points_);
  y_.pad(points_);
  double squared = kernels_.distances(x_.data(), y_.data(), points_, sizes_.data());
  int exponent = 0;
  if (!is_square(squared)) {
    double size = 0;
    for (std::size_t i = 0; i < points_; ++i) {
      size = larger(size, larger(std::abs(x_.data()[i]), std::abs(y_.data()[i])));
    }
    if (size == 0) return;
    if (!std::isfinite(size)) {
      greatest = size;
      return;
    }
    std::frexp(size, &exponent);
    rescale(-exponent);
    squared = kernels_.distances(x_.data(), y_.data(), points_, sizes_.data());
  }
  const double before = std::scalbn(greatest, -exponent);
  squared = search_.greatest_between(spans_, sizes_.data(), Spacing::wide,
                                     std::max(squared, before * before));
  greatest = std::max(greatest, std::scalbn(std::sqrt(squared), exponent));
  if (exponent != 0) rescale(exponent);
}

void TrackMeasures::rescale(int exponent) {
  for (PaddedRows* const column : {&x_, &y_}) {
    for (std::size_t i = 0; i < points_; ++i) {
      column->data()[i] = std::scalbn(column->data()[i], exponent);
    }
    column->pad(points_);
  }
}

double TrackMeasures::rms_error() {
  if (timed_ != *grid_) {
    timed_ = *grid_;
    has_row_reference_ = false;
    double* const times = row_reference_.times(grid_->size());
    for (std::size_t i = 0; i < grid_->size(); ++i) times[i] = (*grid_)[i];
  }
  if (!has_row_reference_) row_reference_.evaluate(*signals_, grid_->size());
  has_row_reference_ = true;
  subtract(row_reference_, rows_, row_x_, row_y_);
  row_x_.pad(rows_);
  row_y_.pad(rows_);
  row_squares_.resize(rows_);
  static_cast<void>(kernels_.distances(row_x_.data(), row_y_.data(), rows_, row_squares_.data()));
  const double sum = kernels_.sum(row_squares_.data(), rows_);
  if (is_square(sum)) return std::sqrt(sum / static_cast<double>(rows_));
  SquareSum squares;
  for (std::size_t i = 0; i < rows_; ++i) {
    squares.add(std::hypot(row_x_.data()[i], row_y_.data()[i]));
  }
  return squares.root_mean(rows_);
}

void TrackMeasures::finish(double* results) {
  flush();
  GimbalExtremes::Greatest gimbal{tilt_of(greatest_.versine), std::sqrt(greatest_.rate_squared)};
  if (!closed_ && wants_gimbal_ && !taken_) gimbal = motion_extremes();
  if (!end_.columns().empty()) {
    const double t = (*grid_)[rows_ - 1];
    end_.evaluate(&t, last_.data(), 1);
  }
  std::size_t at_end = 0;
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    const scenario::Measure& measure = measures_[m];
    const std::string_view name = measure.column->name;
    if (measure.kind == Kind::end) {
      results[m] = end_[at_end++][0];
    } else if (measure.kind == Kind::rms) {
      results[m] = rms_error();
    } else {
      results[m] = name == "tilt"        ? gimbal.tilt
                   : name == "tilt_rate" ? gimbal.rate
                   : name == "distance"  ? greatest_.distance
                                         : greatest_.error;
    }
  }
}

// A given motion may be that of the previous run.
GimbalExtremes::Greatest TrackMeasures::motion_extremes() {
  if (!motion_ || motion_until_ != reached_) {
    motion_ = gimbal_.of(*signals_, reached_);
    motion_until_ = reached_;
  }
  return *motion_;
}

}  // namespace bbsim::record
