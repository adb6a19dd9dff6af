#include "record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"

namespace bbsim::record {

using scenario::any_needs;
using scenario::Needs;

Recorder::Recorder(const model::Model& model, const model::BallConstants& constants,
                   const solve::OutputGrid& grid, std::vector<const scenario::Column*> columns,
                   file::TableWriter& writer)
    : model_(model),
      constants_(constants),
      grid_(grid),
      columns_(std::move(columns)),
      writer_(writer),
      needs_dynamics_(any_needs(columns_, Needs::dynamics) || any_needs(columns_, Needs::plate)),
      with_plate_(std::any_of(constants.plate_inertia.begin(), constants.plate_inertia.end(),
                              [](double moment) { return moment > 0; })),
      gaps_(columns_.size()),
      block_(columns_.size()) {
  for (const scenario::Column* column : columns_) values_.push_back(value_of(*column));
  if (any_needs(columns_, Needs::orientation)) turn_.emplace(model.radius);
  if (!needs_dynamics_ && !with_plate_) return;
  loads_.emplace(6, [this](const model::Sample& sample, double* numbers) {
    const model::MotorLoad load = model::motor_load(sample, constants_);
    for (const double one : {load.torque_phi, load.torque_theta, load.power}) {
      *numbers++ = one;
      *numbers++ = -one;
    }
  });
  loads_->begin(model_);
}

solve::PieceSink* Recorder::pieces() {
  return loads_ ? &*loads_ : nullptr;
}

void Recorder::accept(std::size_t first, std::size_t count, const double* values) {
  for (auto& column : block_) column.resize(count);
  const std::size_t row_size = model_.row_size();
  // A run may end before its first step.
  if (first == 0 && count > 0 && loads_) loads_->note(model_.sample(grid_[0], values));
  for (std::size_t i = 0; i < count; ++i) {
    const model::Sample sample = model_.sample(grid_[first + i], values + i * row_size);
    model::Dynamics dynamics;
    if (needs_dynamics_) dynamics = model::dynamics(sample, constants_);
    const Quaternion* const orientation = turn_ ? &turn_->go_to(sample) : nullptr;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      block_[c][i] = values_[c]({sample, &dynamics, orientation});
    }
  }

  look_for_gaps(first, count);

  std::vector<const double*> pointers;
  for (const auto& column : block_) pointers.push_back(column.data());
  writer_.append(pointers, count);
}

void Recorder::look_for_gaps(std::size_t first, std::size_t count) {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(block_[c][i])) continue;
      if (gaps_[c].rows++ == 0) gaps_[c].from = grid_[first + i];
    }
  }
}

std::string Recorder::why_not_finite(std::size_t columns) const {
  std::string text;
  for (std::size_t c = 0; c < std::min(columns, columns_.size()); ++c) {
    if (gaps_[c].rows == 0) continue;
    char line[120];
    std::snprintf(line, sizeof line, " is no finite number in %zu rows, the first at t = %.6g s",
                  gaps_[c].rows, gaps_[c].from);
    text += (text.empty() ? "" : "; ") + std::string(columns_[c]->name) + line;
  }
  return text;
}

std::optional<MotorPeaks> Recorder::peaks() const {
  if (!loads_) return {};
  const auto peak = [this](std::size_t load) {
    const Extremes::Greatest up = (*loads_)[2 * load], down = (*loads_)[2 * load + 1];
    const Extremes::Greatest& more = down.value > up.value ? down : up;
    return Peak{more.t, more.value};
  };
  return MotorPeaks{peak(0), peak(1), peak(2), with_plate_};
}

}  // namespace bbsim::record
