#include "record/meter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bbsim::record {

using scenario::Measure;
using scenario::Needs;
using Kind = Measure::Kind;

Meter::Meter(std::vector<Measure> measures)
    : measures_(std::move(measures)), sums_(measures_.size()) {
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    values_.push_back(value_of(*measures_[m].column));
    const Needs needs = measures_[m].column->needs;
    const bool dynamics = needs == Needs::dynamics || needs == Needs::plate;
    switch (measures_[m].kind) {
      case Kind::end:
        end_needs_dynamics_ = end_needs_dynamics_ || dynamics;
        break;
      case Kind::rms:
        of_rows_.push_back(m);
        rows_need_dynamics_ = rows_need_dynamics_ || dynamics;
        break;
      default:
        of_motion_.push_back(m);
        motion_needs_dynamics_ = motion_needs_dynamics_ || dynamics;
    }
  }
  extremes_.emplace(of_motion_.size(), [this](const model::Sample& sample, double* numbers) {
    const model::Dynamics dynamics = dynamics_at(sample, motion_needs_dynamics_);
    for (const std::size_t m : of_motion_) {
      const double value = values_[m]({sample, &dynamics});
      *numbers++ = measures_[m].kind == Kind::least ? -value : value;
    }
  });
}

void Meter::begin(const model::Model& model, const model::BallConstants& constants,
                  const solve::OutputGrid& grid) {
  model_ = &model;
  constants_ = &constants;
  grid_ = &grid;
  std::fill(sums_.begin(), sums_.end(), Sum{});
  extremes_->begin(model);
}

solve::PieceSink* Meter::pieces() {
  return of_motion_.empty() ? nullptr : &*extremes_;
}

model::Dynamics Meter::dynamics_at(const model::Sample& sample, bool needed) const {
  return needed ? model::dynamics(sample, *constants_) : model::Dynamics{};
}

void Meter::accept(std::size_t first, std::size_t count, const double* values) {
  const auto sample = [&](std::size_t i) {
    return model_->sample((*grid_)[first + i], values + i * model_->row_size());
  };
  // A run may end before its first step.
  if (first == 0 && !of_motion_.empty()) extremes_->note(sample(0));
  if (count > 0) last_ = sample(count - 1);
  if (of_rows_.empty()) return;
  for (std::size_t i = 0; i < count; ++i) {
    const model::Sample row = sample(i);
    const model::Dynamics dynamics = dynamics_at(row, rows_need_dynamics_);
    for (const std::size_t m : of_rows_) {
      const double value = values_[m]({row, &dynamics});
      if (std::isnan(value)) continue;
      sums_[m].squares.add(value);
      ++sums_[m].rows;
    }
  }
}

void Meter::finish(const solve::Outcome& outcome, double* results) {
  const bool stopped = outcome.ending == solve::Ending::stopped;
  const model::Sample& last = stopped ? outcome.occurrences.back().sample : last_;
  const model::Dynamics dynamics = dynamics_at(last, end_needs_dynamics_);
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    if (measures_[m].kind == Kind::end) results[m] = values_[m]({last, &dynamics});
  }
  for (const std::size_t m : of_rows_) {
    results[m] = sums_[m].rows == 0 ? std::numeric_limits<double>::quiet_NaN()
                                    : sums_[m].squares.root_mean(sums_[m].rows);
  }
  for (std::size_t i = 0; i < of_motion_.size(); ++i) {
    const std::size_t m = of_motion_[i];
    const double greatest = (*extremes_)[i].value;
    results[m] = measures_[m].kind == Kind::least ? -greatest : greatest;
  }
}

}  // namespace bbsim::record
