// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "base/real.hpp"

namespace bbsim::record {

using scenario::Measure;

namespace {

// The sample at which an event stopped the run.
model::Sample end_of(const solve::Outcome& outcome) {
  const model::Occurrence& at = outcome.occurrences.back();
  model::Sample end = at.sample;
  if (!at.own.empty()) end.own = at.own.data();
  return end;
}

// The greatest and the least value of each load of the motors.
std::vector<Extremes::Query> most_and_least_loads() {
  std::vector<Extremes::Query> queries;
  for (const char* name : {"motor_torque_phi", "motor_torque_theta", "motor_power"}) {
    const scenario::Column* const load = scenario::find_column(name);
    queries.push_back({load});
    queries.push_back({load, true});
  }
  return queries;
}

bool has_plate_inertia(const model::BallConstants& constants) {
  return std::ranges::any_of(constants.body.plate, [](double moment) { return moment > 0; });
}

// Groups the measures by their windows.
std::vector<std::unique_ptr<WindowMeasures>> by_window(const std::vector<Measure>& measures) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const auto same = std::ranges::find_if(groups, [&](const std::vector<std::size_t>& group) {
      return measures[group.front()].window == measures[m].window;
    });
    (same == groups.end() ? groups.emplace_back() : *same).push_back(m);
  }
  std::vector<std::unique_ptr<WindowMeasures>> windows;
  for (std::vector<std::size_t>& group : groups) {
    windows.push_back(std::make_unique<WindowMeasures>(measures, std::move(group)));
  }
  return windows;
}

// The columns, followed by those whose rows the windows need.
std::vector<const scenario::Column*> with_columns_of(
    std::vector<const scenario::Column*> columns,
    const std::vector<std::unique_ptr<WindowMeasures>>& windows) {
  for (const auto& window : windows) {
    const auto wanted = window->row_columns();
    columns.insert(columns.end(), wanted.begin(), wanted.end());
  }
  return columns;
}

std::optional<std::size_t> position_of(const std::vector<std::string>& names, const char* name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

Recorder::Recorder(RecordRequest request)
    : request_(std::move(request)),
      windows_(by_window(request_.measures)),
      rows_(with_columns_of(request_.columns, windows_)) {
  std::size_t first = request_.columns.size();
  for (const auto& window : windows_) {
    first_columns_.push_back(first);
    first += window->row_columns().size();
  }
  if (request_.peaks) loads_.emplace(most_and_least_loads());
}

void Recorder::begin(const model::Model& model, const model::BallConstants& constants,
                     const solve::OutputGrid& grid, file::TableWriter* table) {
  model_ = &model;
  grid_ = &grid;
  table_ = table;
  with_plate_ = has_plate_inertia(constants);
  with_loads_ = loads_ && (scenario::need_dynamics(request_.columns) || with_plate_);
  gaps_.assign(request_.columns.size(), {});
  rows_.begin(model, constants);
  fan_.clear();
  if (with_loads_) {
    loads_->begin(model, constants);
    fan_.add(*loads_);
  }
  last_time_ = 0;
  last_ = model.initial;
  last_.resize(model.row_size());
  for (const auto& window : windows_) window->begin(model, constants, fan_);
}

void Recorder::accept(std::size_t first, std::size_t count, const double* values) {
  if (count == 0) return;
  times_.resize(count);
  for (std::size_t i = 0; i < count; ++i) times_[i] = (*grid_)[first + i];
  // A run may end before its first step, without a piece.
  if (first == 0 && with_loads_) loads_->note(times_[0], values);
  if (first == 0) {
    for (const auto& window : windows_) window->accept_start(times_[0], values);
  }
  last_time_ = times_.back();
  std::copy_n(values + (count - 1) * last_.size(), last_.size(), last_.begin());
  if (!rows_.columns().empty()) take_rows(count, values);
}

void Recorder::take_rows(std::size_t count, const double* values) {
  rows_.evaluate(times_.data(), values, count);
  const std::size_t columns = request_.columns.size();
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    windows_[w]->accept_rows(times_, [&](std::size_t k) { return rows_[first_columns_[w] + k]; });
  }
  if (columns == 0) return;
  look_for_gaps(count);
  block_.resize(columns);
  for (std::size_t c = 0; c < columns; ++c) block_[c] = rows_[c];
  table_->append(block_, count);
}

// A number of a controller may be missing: a sketch has not printed it yet.
void Recorder::look_for_gaps(std::size_t count) {
  for (std::size_t c = 0; c < gaps_.size(); ++c) {
    if (request_.columns[c]->needs == scenario::Needs::own) continue;
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(rows_[c][i])) continue;
      if (gaps_[c].rows++ == 0) gaps_[c].from = times_[i];
    }
  }
}

void Recorder::finish(const solve::Outcome& outcome, double* results) {
  whys_.assign(request_.measures.size(), nullptr);
  if (outcome.rows == 0) {
    std::fill_n(results, request_.measures.size(), no_number);
    whys_.assign(request_.measures.size(), "the run ended before it began");
    return;
  }
  const bool stopped = outcome.ending == solve::Ending::stopped;
  const RunEnd end =
      stopped ? RunEnd{outcome.occurrences.back().t, end_of(outcome)}
              : RunEnd{last_time_, model_->sample(last_time_, last_.data(), model::Detail::all)};
  if (model_->hybrid() && with_loads_) loads_->note(end.sample);
  for (const auto& window : windows_) window->finish(end, results, whys_);
}

std::vector<double> Recorder::end_row(const solve::Outcome& outcome) {
  if (outcome.ending != solve::Ending::stopped || request_.columns.empty() || times_.empty() ||
      !(outcome.occurrences.back().t > times_.back())) {
    return {};
  }
  rows_.evaluate(end_of(outcome));
  std::vector<double> row;
  for (std::size_t c = 0; c < request_.columns.size(); ++c) row.push_back(rows_[c][0]);
  return row;
}

std::string Recorder::why_not_finite(std::size_t columns) const {
  std::string text;
  for (std::size_t c = 0; c < std::min(columns, gaps_.size()); ++c) {
    if (gaps_[c].rows == 0) continue;
    char line[120];
    std::snprintf(line, sizeof line, " is not a finite number in %zu rows, the first at t = %.6g s",
                  gaps_[c].rows, gaps_[c].from);
    text += (text.empty() ? "" : "; ") + std::string(request_.columns[c]->name) + line;
  }
  return text;
}

std::optional<MotorPeaks> Recorder::peaks() const {
  if (!with_loads_) return {};
  const auto peak = [this](std::size_t load) {
    const Extremes::Extreme most = (*loads_)[2 * load], least = (*loads_)[2 * load + 1];
    return -least.value > most.value ? Peak{least.t, -least.value} : Peak{most.t, most.value};
  };
  return MotorPeaks{peak(0), peak(1), peak(2), with_plate_};
}

bool EdgeNote::wanted(const Scenario& scenario) {
  return (scenario.plate.size || scenario.plate.diameter) && !scenario.events.edge;
}

EdgeNote::EdgeNote(const model::Model& model, const Plate& plate, const solve::OutputGrid& grid,
                   solve::StateSink& next)
    : plate_(plate), grid_(grid), next_(next), row_size_(model.row_size()) {
  const std::vector<std::string> names = model.state_names();
  x_ = position_of(names, "x");
  y_ = position_of(names, "y");
}

bool EdgeNote::is_beyond(double x, double y) const {
  if (plate_.size) {
    return std::abs(x) > (*plate_.size)[0] / 2 || std::abs(y) > (*plate_.size)[1] / 2;
  }
  return std::hypot(x, y) > *plate_.diameter / 2;
}

void EdgeNote::accept(std::size_t first, std::size_t count, const double* values) {
  next_.accept(first, count, values);
  for (std::size_t i = 0; i < count && !left_; ++i) {
    const double* const row = values + i * row_size_;
    const double x = x_ ? row[*x_] : 0, y = y_ ? row[*y_] : 0;
    if (is_beyond(x, y)) left_ = OffPlate{grid_[first + i], x, y};
  }
}

}  // namespace bbsim::record
