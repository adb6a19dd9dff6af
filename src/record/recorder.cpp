#include "record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"

namespace bbsim::record {

std::vector<const Column*> columns_named(const std::vector<std::string>& names) {
  std::vector<const Column*> columns;
  for (const std::string& name : names) {
    columns.push_back(find_column(name));
    if (columns.back() == nullptr) throw InputError("there is no column " + name);
  }
  return columns;
}

bool any_needs(const std::vector<const Column*>& columns, Needs what) {
  return std::any_of(columns.begin(), columns.end(),
                     [what](const Column* column) { return column->needs == what; });
}

Recorder::Recorder(const model::Model& model, const model::BallConstants& constants,
                   const solve::OutputGrid& grid, std::vector<const Column*> columns,
                   TableWriter& writer)
    : model_(model),
      constants_(constants),
      grid_(grid),
      columns_(std::move(columns)),
      writer_(writer),
      needs_dynamics_(any_needs(columns_, Needs::dynamics) || any_needs(columns_, Needs::plate) ||
                      constants.plate_inertia != std::array<double, 3>{0, 0, 0}),
      gaps_(columns_.size()),
      block_(columns_.size()) {}

void Recorder::accept(std::size_t first, std::size_t count, const double* values) {
  for (auto& column : block_) column.resize(count);
  const std::size_t row_size = model_.row_size();
  for (std::size_t i = 0; i < count; ++i) {
    const model::Sample sample = model_.sample(grid_[first + i], values + i * row_size);
    model::Dynamics dynamics;
    if (needs_dynamics_) {
      dynamics = model::dynamics(sample, constants_);
      note_peaks(sample, dynamics);
    }
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      block_[c][i] = columns_[c]->value({sample, &dynamics});
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

std::string Recorder::why_not_finite() const {
  std::string text;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (gaps_[c].rows == 0) continue;
    char line[120];
    std::snprintf(line, sizeof line, " is no finite number in %zu rows, the first at t = %.6g s",
                  gaps_[c].rows, gaps_[c].from);
    text += (text.empty() ? "" : "; ") + std::string(columns_[c]->name) + line;
  }
  return text;
}

void Recorder::note_peaks(const model::Sample& sample, const model::Dynamics& now) {
  if (!peaks_) {
    peaks_.emplace();
    const auto moves = [](double moment) { return moment > 0; };
    peaks_->with_plate =
        std::any_of(constants_.plate_inertia.begin(), constants_.plate_inertia.end(), moves);
  }
  const double phi = now.torque_phi + now.plate_torque_phi;
  const double theta = now.torque_theta + now.plate_torque_theta;
  const double power = phi * sample.gimbal.phi_dot + theta * sample.gimbal.theta_dot;
  peaks_->torque_phi = std::max(peaks_->torque_phi, std::abs(phi));
  peaks_->torque_theta = std::max(peaks_->torque_theta, std::abs(theta));
  peaks_->power = std::max(peaks_->power, std::abs(power));
}

}  // namespace bbsim::record
