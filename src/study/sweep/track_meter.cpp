#include "study/sweep/track_meter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "record/square_sum.hpp"

namespace bbsim::study {
namespace {

using Kind = record::Measure::Kind;

// Calls `use` with the system, if it is one whose rows are a track.
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

bool is_track_measure(const record::Measure& measure) {
  if (measure.kind == Kind::end) return measure.column->needs != record::Needs::gamma;
  const std::string_view name = measure.column->name;
  if (name == "tracking_error") return measure.kind == Kind::greatest || measure.kind == Kind::rms;
  return measure.kind == Kind::greatest &&
         (name == "tilt" || name == "tilt_rate" || name == "distance");
}

}  // namespace

bool is_square(double squared) {
  return squared > 1e-280 && squared < 1e300;
}

void PaddedRows::resize(std::size_t rows) {
  const std::size_t room = (rows + row_padding - 1) / row_padding * row_padding;
  if (room <= room_) return;
  data_.reset(static_cast<double*>(::operator new (room * sizeof(double), std::align_val_t{64})));
  room_ = room;
}

void PaddedRows::pad(std::size_t rows) {
  double* const values = data_.get();
  for (std::size_t i = rows; i % row_padding != 0; ++i) values[i] = values[rows - 1];
}

bool are_track_measures(const std::vector<record::Measure>& measures) {
  return std::all_of(measures.begin(), measures.end(), is_track_measure);
}

bool has_track(const model::Model& model) {
  bool has = false;
  if (!model.hybrid()) with_track(model, [&](const auto&, bool) { has = true; });
  return has;
}

bool shares_signals(const SweepPlan& plan) {
  return std::all_of(plan.axes().begin(), plan.axes().end(), [](const Axis& axis) {
    return axis.independent && !axis.key.starts_with("gimbal.motion") &&
           !axis.key.starts_with("controller.reference");
  });
}

const model::SignalPair& signals_of(const model::Model& model) {
  const model::SignalPair* found = nullptr;
  with_track(model, [&](const model::SignalPair& signals, bool) { found = &signals; });
  return *found;
}

TrackMeter::TrackMeter(std::vector<record::Measure> measures)
    : measures_(std::move(measures)), kernels_(choose_sweep_kernels()) {
  for (const record::Measure& measure : measures_) {
    if (measure.kind == Kind::end) continue;
    const std::string_view name = measure.column->name;
    wants_gimbal_ = wants_gimbal_ || name == "tilt" || name == "tilt_rate";
    wants_error_ = wants_error_ || name == "tracking_error";
  }
}

void TrackMeter::evaluate_signals(const model::SignalPair& signals) {
  const std::size_t rows = grid_->size();
  if (timed_ != *grid_) {
    timed_ = *grid_;
    sampled_.clear();
    times_.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) times_.data()[i] = (*grid_)[i];
    times_.pad(rows);
  }
  for (PaddedRows* const column : {&signal_[0], &signal_[1], &signal_rate_[0], &signal_rate_[1]}) {
    column->resize(rows);
  }
  double* const values[2] = {signal_[0].data(), signal_[1].data()};
  double* const rates[2] = {signal_rate_[0].data(), signal_rate_[1].data()};
  const model::SignalView view = signals.view();
  if (view.table_count == 0) {
    sampled_.resize(view.harmonic_count);
    waves_.clear();
    for (std::size_t k = 0; k < view.harmonic_count; ++k) {
      Sampled& sampled = sampled_[k];
      const double frequency = view.harmonics[k].frequency;
      if (sampled.sines.data() == nullptr || sampled.frequency != frequency) {
        sampled.frequency = frequency;
        sampled.sines.resize(rows);
        sampled.cosines.resize(rows);
        kernels_.wave(frequency, times_.data(), rows, sampled.sines.data(), sampled.cosines.data());
      }
      waves_.push_back({sampled.sines.data(), sampled.cosines.data()});
    }
    kernels_.signals(view, waves_.data(), times_.data(), rows, values, rates);
    return;
  }
  for (std::size_t i = 0; i < rows; ++i) {
    const auto jets = signals.at(times_.data()[i]);
    for (std::size_t c = 0; c < 2; ++c) {
      values[c][i] = jets[c].value;
      rates[c][i] = jets[c].rate;
    }
  }
  for (PaddedRows* const column : {&signal_[0], &signal_[1], &signal_rate_[0], &signal_rate_[1]}) {
    column->pad(rows);
  }
}

bool TrackMeter::wants_positions_only(const model::Model& model) const {
  if (model.closed_loop()) return false;
  return std::all_of(measures_.begin(), measures_.end(), [](const record::Measure& measure) {
    return measure.kind != Kind::end || measure.column->name == "x" || measure.column->name == "y";
  });
}

void TrackMeter::begin(const model::Model& model, const model::BallConstants& constants,
                       const solve::OutputGrid& grid, bool same_signals) {
  model_ = &model;
  constants_ = &constants;
  grid_ = &grid;
  rows_ = 0;
  x_.resize(grid.size());
  y_.resize(grid.size());
  with_track(model, [&](const model::SignalPair& signals, bool closed) {
    closed_ = closed;
    if (closed) {
      for (PaddedRows* const column : {&phi_, &theta_, &phi_rate_, &theta_rate_}) {
        column->resize(grid.size());
      }
    }
    if ((closed ? wants_error_ : wants_gimbal_) && !(same_signals && has_signals_)) {
      evaluate_signals(signals);
      has_signals_ = true;
    }
  });
  PaddedRows& phi = closed_ ? phi_ : signal_[0];
  PaddedRows& theta = closed_ ? theta_ : signal_[1];
  PaddedRows& phi_rate = closed_ ? phi_rate_ : signal_rate_[0];
  PaddedRows& theta_rate = closed_ ? theta_rate_ : signal_rate_[1];
  track_ = {0,
            x_.data(),
            y_.data(),
            phi.data(),
            theta.data(),
            phi_rate.data(),
            theta_rate.data(),
            closed_ ? signal_[0].data() : nullptr,
            closed_ ? signal_[1].data() : nullptr};
}

void TrackMeter::accept(std::size_t first, std::size_t count, const double* values) {
  take(first, count, values, model_->row_size(), 1);
}

// States of a ball anywhere on the plane: x, y, x', y', u; then, of a loop, the gimbal's phi,
// theta, phi', theta'.
void TrackMeter::take(std::size_t first, std::size_t count, const double* values,
                      std::size_t row_stride, std::size_t stride) {
  const auto copy = [&](std::size_t state, PaddedRows& to) {
    double* const column = to.data() + first;
    const double* const from = values + state * stride;
    for (std::size_t i = 0; i < count; ++i) column[i] = from[i * row_stride];
  };
  copy(0, x_);
  copy(1, y_);
  if (closed_ && wants_gimbal_) {
    copy(5, phi_);
    copy(6, theta_);
    copy(7, phi_rate_);
    copy(8, theta_rate_);
  }
  rows_ = first + count;
  last_.resize(model_->row_size());
  for (std::size_t s = 0; s < last_.size(); ++s) {
    last_[s] = values[(count - 1) * row_stride + s * stride];
  }
}

// Of a run that ended early: what pads its last rows must not be what would have come later.
void TrackMeter::cut_signals() {
  const double** const used[] = {
      closed_ ? &track_.x_reference : &track_.phi, closed_ ? &track_.y_reference : &track_.theta,
      closed_ ? nullptr : &track_.phi_rate, closed_ ? nullptr : &track_.theta_rate};
  if (!has_signals_) return;
  for (std::size_t i = 0; i < 4; ++i) {
    if (used[i] == nullptr) continue;
    cut_[i].resize(rows_);
    std::copy_n(*used[i], rows_, cut_[i].data());
    cut_[i].pad(rows_);
    *used[i] = cut_[i].data();
  }
}

double TrackMeter::tilt_at(std::size_t row) const {
  const auto phi = model::sin_cos(track_.phi[row]), theta = model::sin_cos(track_.theta[row]);
  return std::atan2(std::hypot(phi.sin, phi.cos * theta.sin), phi.cos * theta.cos);
}

// One by one, without an overflow on the way.
double TrackMeter::greatest_distance(bool from_reference) const {
  double greatest = 0;
  for (std::size_t i = 0; i < rows_; ++i) {
    const double x = from_reference ? track_.x[i] - track_.x_reference[i] : track_.x[i];
    const double y = from_reference ? track_.y[i] - track_.y_reference[i] : track_.y[i];
    greatest = std::max(greatest, std::hypot(x, y));
  }
  return greatest;
}

double TrackMeter::rms_tracking_error() const {
  record::SquareSum squares;
  for (std::size_t i = 0; i < rows_; ++i) {
    squares.add(
        std::hypot(track_.x[i] - track_.x_reference[i], track_.y[i] - track_.y_reference[i]));
  }
  return squares.root_mean(rows_);
}

void TrackMeter::finish(double* results) {
  x_.pad(rows_);
  y_.pad(rows_);
  if (closed_ && wants_gimbal_) {
    for (PaddedRows* const column : {&phi_, &theta_, &phi_rate_, &theta_rate_}) column->pad(rows_);
  }
  track_.rows = rows_;
  if (rows_ < grid_->size()) cut_signals();
  Extremes extremes;
  kernels_.extremes(track_, wants_gimbal_, wants_error_, &extremes);

  const auto root = [&](double squared, bool from_reference) {
    return is_square(squared) ? std::sqrt(squared) : greatest_distance(from_reference);
  };
  model::Sample last;
  bool has_last = false;
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    const record::Measure& measure = measures_[m];
    const std::string_view name = measure.column->name;
    if (measure.kind == Kind::end) {
      if (name == "x" || name == "y") {
        results[m] = last_[name == "x" ? 0 : 1];
        continue;
      }
      if (!has_last) last = model_->sample((*grid_)[rows_ - 1], last_.data());
      has_last = true;
      const model::Dynamics dynamics = model::dynamics(last, *constants_);
      results[m] = measure.column->value({last, &dynamics});
    } else if (measure.kind == Kind::rms) {
      results[m] = is_square(extremes.error_squared_sum)
                       ? std::sqrt(extremes.error_squared_sum / static_cast<double>(rows_))
                       : rms_tracking_error();
    } else if (name == "tilt") {
      results[m] = tilt_at(extremes.steepest);
    } else if (name == "tilt_rate") {
      results[m] = std::isfinite(extremes.rate_squared) ? std::sqrt(extremes.rate_squared)
                                                        : std::numeric_limits<double>::infinity();
    } else {
      results[m] = name == "distance" ? root(extremes.distance_squared, false)
                                      : root(extremes.error_squared, true);
    }
  }
}

}  // namespace bbsim::study
