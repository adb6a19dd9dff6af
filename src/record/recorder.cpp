#include "record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "record/instants.hpp"

namespace bbsim::record {

using scenario::Column;
using scenario::Measure;
using Kind = Measure::Kind;

namespace {

// Of a run that an event stopped.
model::Sample end_of(const solve::Outcome& outcome) {
  const model::Occurrence& at = outcome.occurrences.back();
  model::Sample end = at.sample;
  if (!at.own.empty()) end.own = at.own.data();
  return end;
}

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

template <class Wanted>
std::vector<std::size_t> those(const std::vector<Measure>& measures, Wanted wanted) {
  std::vector<std::size_t> found;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (wanted(measures[m].kind)) found.push_back(m);
  }
  return found;
}

// Columns, and behind them those of some measures.
std::vector<const Column*> with_columns_of(std::vector<const Column*> columns,
                                           const std::vector<Measure>& measures,
                                           const std::vector<std::size_t>& which) {
  for (const std::size_t m : which) columns.push_back(measures[m].column);
  return columns;
}

// Each once, and those that instants are told by.
std::vector<const Column*> traced_by(const std::vector<Measure>& measures,
                                     const std::vector<std::size_t>& which) {
  std::vector<const Column*> columns;
  for (const std::size_t m : which) {
    for (const Column* column : {measures[m].column, measures[m].instant.column}) {
      if (column != nullptr && std::ranges::find(columns, column) == columns.end()) {
        columns.push_back(column);
      }
    }
  }
  return columns;
}

std::vector<Extremes::Sought> sought_by(const std::vector<Measure>& measures,
                                        const std::vector<std::size_t>& which) {
  std::vector<Extremes::Sought> sought;
  for (const std::size_t m : which) {
    sought.push_back({measures[m].column, measures[m].kind == Kind::least});
  }
  return sought;
}

}  // namespace

Recorder::Recorder(Asked asked)
    : asked_(std::move(asked)),
      at_end_(those(asked_.measures, [](Kind kind) { return kind == Kind::end; })),
      of_motion_(those(asked_.measures,
                       [](Kind kind) { return kind == Kind::greatest || kind == Kind::least; })),
      of_rows_(those(asked_.measures, [](Kind kind) { return kind == Kind::rms; })),
      of_curves_(those(asked_.measures,
                       [](Kind kind) {
                         return kind == Kind::step || kind == Kind::when || kind == Kind::find;
                       })),
      rows_(with_columns_of(asked_.columns, asked_.measures, of_rows_)),
      end_(with_columns_of({}, asked_.measures, at_end_)),
      extremes_(sought_by(asked_.measures, of_motion_)),
      traces_(traced_by(asked_.measures, of_curves_)),
      traces_end_(traces_.columns()) {
  if (!asked_.measures.empty() && are_track_measures(asked_.measures)) {
    track_.emplace(asked_.measures);
  }
  if (asked_.peaks) loads_.emplace();
}

void Recorder::begin(const model::Model& model, const model::BallConstants& constants,
                     const solve::OutputGrid& grid, file::TableWriter* table,
                     const Manner& manner) {
  model_ = &model;
  grid_ = &grid;
  table_ = table;
  quick_ = manner.quick && track_ && has_track(model);
  with_loads_ = loads_ && (scenario::need_dynamics(asked_.columns) || has_plate_inertia(constants));
  gaps_.assign(asked_.columns.size(), {});
  sums_.assign(of_rows_.size(), {});
  if (!asked_.columns.empty() || !quick_) rows_.begin(model, constants);
  fan_.clear();
  if (with_loads_) {
    loads_->begin(model, constants);
    fan_.add(loads_->extremes());
  }
  if (quick_) {
    track_->begin(model, constants, grid, manner.same_signals);
    fan_.add(*track_);
    return;
  }
  last_time_ = 0;
  last_ = model.initial;
  last_.resize(model.row_size());
  end_.begin(model, constants);
  extremes_.begin(model, constants);
  traces_.begin(model, constants);
  traces_end_.begin(model, constants);
  if (!of_motion_.empty()) fan_.add(extremes_);
  if (!of_curves_.empty()) fan_.add(traces_);
}

bool Recorder::wants_positions_only() const {
  return quick_ && asked_.columns.empty() && !with_loads_ && track_->wants_positions_only(*model_);
}

bool Recorder::wants_rows() const {
  return !quick_ || !asked_.columns.empty() || with_loads_ || track_->wants_rows();
}

void Recorder::accept(std::size_t first, std::size_t count, const double* values) {
  if (count == 0) return;
  times_.resize(count);
  for (std::size_t i = 0; i < count; ++i) times_[i] = (*grid_)[first + i];
  // A run may end before its first step.
  if (first == 0 && with_loads_) loads_->extremes().note(times_[0], values);
  if (quick_) {
    track_->accept(first, count, values);
    if (!asked_.columns.empty()) take_rows(count, values);
    return;
  }
  if (first == 0 && !of_motion_.empty()) extremes_.note(times_[0], values);
  last_time_ = times_.back();
  const double* const last = values + (count - 1) * model_->row_size();
  last_.assign(last, last + model_->row_size());
  if (!rows_.columns().empty()) take_rows(count, values);
}

void Recorder::take_rows(std::size_t count, const double* values) {
  rows_.evaluate(times_.data(), values, count);
  const std::size_t columns = asked_.columns.size();
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      const double value = rows_[columns + k][i];
      if (std::isnan(value)) continue;
      sums_[k].squares.add(value);
      ++sums_[k].rows;
    }
  }
  if (columns == 0) return;
  look_for_gaps(count);
  block_.resize(columns);
  for (std::size_t c = 0; c < columns; ++c) block_[c] = rows_[c];
  table_->append(block_, count);
}

void Recorder::look_for_gaps(std::size_t count) {
  for (std::size_t c = 0; c < gaps_.size(); ++c) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(rows_[c][i])) continue;
      if (gaps_[c].rows++ == 0) gaps_[c].from = times_[i];
    }
  }
}

void Recorder::finish(const solve::Outcome& outcome, double* results) {
  if (quick_) {
    track_->finish(results);
  } else if (outcome.rows == 0) {  // it ended before it began
    std::fill_n(results, asked_.measures.size(), nothing);
  } else {
    finish_each(outcome, results);
  }
}

void Recorder::finish_each(const solve::Outcome& outcome, double* results) {
  const bool stopped = outcome.ending == solve::Ending::stopped;
  const model::Sample last =
      stopped ? end_of(outcome) : model_->sample(last_time_, last_.data(), model::Detail::all);
  for (Rows* const end : {&end_, &traces_end_}) end->evaluate(last);
  if (model_->hybrid()) {  // the last piece ends before what switches at its end
    if (!of_motion_.empty()) extremes_.note(last);
    if (with_loads_) loads_->extremes().note(last);
  }
  for (std::size_t k = 0; k < at_end_.size(); ++k) results[at_end_[k]] = end_[k][0];
  for (std::size_t k = 0; k < of_rows_.size(); ++k) {
    results[of_rows_[k]] = sums_[k].rows == 0 ? nothing : sums_[k].squares.root_mean(sums_[k].rows);
  }
  for (std::size_t k = 0; k < of_motion_.size(); ++k) results[of_motion_[k]] = extremes_[k].value;
  if (of_curves_.empty()) return;
  traces_.finish(stopped ? outcome.occurrences.back().t : last_time_, traces_end_);
  const CurveOf curve_of = [this](const Column& column) -> const Curve& {
    return traces_.of(column);
  };
  for (const std::size_t m : of_curves_) results[m] = measured(asked_.measures[m], curve_of);
}

std::vector<double> Recorder::end_row(const solve::Outcome& outcome) {
  if (outcome.ending != solve::Ending::stopped || asked_.columns.empty() || times_.empty() ||
      !(outcome.occurrences.back().t > times_.back())) {
    return {};
  }
  rows_.evaluate(end_of(outcome));
  std::vector<double> row;
  for (std::size_t c = 0; c < asked_.columns.size(); ++c) row.push_back(rows_[c][0]);
  return row;
}

std::string Recorder::why_not_finite(std::size_t columns) const {
  std::string text;
  for (std::size_t c = 0; c < std::min(columns, gaps_.size()); ++c) {
    if (gaps_[c].rows == 0) continue;
    char line[120];
    std::snprintf(line, sizeof line, " is no finite number in %zu rows, the first at t = %.6g s",
                  gaps_[c].rows, gaps_[c].from);
    text += (text.empty() ? "" : "; ") + std::string(asked_.columns[c]->name) + line;
  }
  return text;
}

std::optional<MotorPeaks> Recorder::peaks() const {
  if (!with_loads_) return {};
  return loads_->peaks();
}

}  // namespace bbsim::record
