#include "record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"

namespace bbsim::record {

Recorder::Recorder(const model::Model& model, const model::BallConstants& constants,
                   const solve::OutputGrid& grid, std::vector<const scenario::Column*> columns,
                   file::TableWriter& writer)
    : model_(model),
      constants_(constants),
      grid_(grid),
      rows_(std::move(columns)),
      writer_(writer),
      with_plate_(std::any_of(constants.plate_inertia.begin(), constants.plate_inertia.end(),
                              [](double moment) { return moment > 0; })),
      gaps_(rows_.columns().size()) {
  rows_.begin(model_, constants_);
  if (!rows_.need_dynamics() && !with_plate_) return;
  std::vector<Extremes::Sought> sought;
  for (const char* name : {"motor_torque_phi", "motor_torque_theta", "motor_power"}) {
    const scenario::Column* const load = scenario::find_column(name);
    sought.push_back({load});
    sought.push_back({load, true});
  }
  loads_.emplace(std::move(sought));
  loads_->begin(model_, constants_);
}

solve::PieceSink* Recorder::pieces() {
  return loads_ ? &*loads_ : nullptr;
}

void Recorder::accept(std::size_t first, std::size_t count, const double* values) {
  // A run may end before its first step.
  if (first == 0 && count > 0 && loads_) loads_->note(grid_[0], values);
  times_.resize(count);
  for (std::size_t i = 0; i < count; ++i) times_[i] = grid_[first + i];
  rows_.evaluate(times_.data(), values, count);
  look_for_gaps(count);

  std::vector<const double*> columns;
  for (std::size_t c = 0; c < rows_.columns().size(); ++c) columns.push_back(rows_[c]);
  writer_.append(columns, count);
}

void Recorder::look_for_gaps(std::size_t count) {
  for (std::size_t c = 0; c < gaps_.size(); ++c) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(rows_[c][i])) continue;
      if (gaps_[c].rows++ == 0) gaps_[c].from = times_[i];
    }
  }
}

std::string Recorder::why_not_finite(std::size_t columns) const {
  std::string text;
  for (std::size_t c = 0; c < std::min(columns, gaps_.size()); ++c) {
    if (gaps_[c].rows == 0) continue;
    char line[120];
    std::snprintf(line, sizeof line, " is no finite number in %zu rows, the first at t = %.6g s",
                  gaps_[c].rows, gaps_[c].from);
    text += (text.empty() ? "" : "; ") + std::string(rows_.columns()[c]->name) + line;
  }
  return text;
}

std::optional<MotorPeaks> Recorder::peaks() const {
  if (!loads_) return {};
  const auto peak = [this](std::size_t load) {
    const Extremes::Extreme most = (*loads_)[2 * load], least = (*loads_)[2 * load + 1];
    return -least.value > most.value ? Peak{least.t, -least.value} : Peak{most.t, most.value};
  };
  return MotorPeaks{peak(0), peak(1), peak(2), with_plate_};
}

}  // namespace bbsim::record
