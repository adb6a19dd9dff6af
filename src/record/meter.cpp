#include "record/meter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "record/instants.hpp"

namespace bbsim::record {

using scenario::Measure;
using Kind = Measure::Kind;

namespace {

template <class Wanted>
std::vector<std::size_t> those(const std::vector<Measure>& measures, Wanted wanted) {
  std::vector<std::size_t> found;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (wanted(measures[m].kind)) found.push_back(m);
  }
  return found;
}

std::vector<const scenario::Column*> columns_of(const std::vector<Measure>& measures,
                                                const std::vector<std::size_t>& which) {
  std::vector<const scenario::Column*> columns;
  for (const std::size_t m : which) columns.push_back(measures[m].column);
  return columns;
}

// Each once, and those that instants are told by.
std::vector<const scenario::Column*> traced_by(const std::vector<Measure>& measures,
                                               const std::vector<std::size_t>& which) {
  std::vector<const scenario::Column*> columns;
  for (const std::size_t m : which) {
    for (const scenario::Column* column : {measures[m].column, measures[m].instant.column}) {
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

Meter::Meter(std::vector<Measure> measures)
    : measures_(std::move(measures)),
      at_end_(those(measures_, [](Kind kind) { return kind == Kind::end; })),
      of_motion_(those(measures_,
                       [](Kind kind) { return kind == Kind::greatest || kind == Kind::least; })),
      of_rows_(those(measures_, [](Kind kind) { return kind == Kind::rms; })),
      of_curves_(those(measures_,
                       [](Kind kind) {
                         return kind == Kind::step || kind == Kind::when || kind == Kind::find;
                       })),
      end_(columns_of(measures_, at_end_)),
      rows_(columns_of(measures_, of_rows_)),
      extremes_(sought_by(measures_, of_motion_)),
      traces_(traced_by(measures_, of_curves_)),
      traces_end_(traces_.columns()),
      pieces_(of_motion_.empty() ? nullptr : &extremes_, of_curves_.empty() ? nullptr : &traces_),
      sums_(of_rows_.size()) {}

void Meter::begin(const model::Model& model, const model::BallConstants& constants,
                  const solve::OutputGrid& grid) {
  model_ = &model;
  grid_ = &grid;
  std::fill(sums_.begin(), sums_.end(), Sum{});
  last_time_ = 0;
  last_ = model.initial;
  last_.resize(model.row_size());
  end_.begin(model, constants);
  rows_.begin(model, constants);
  extremes_.begin(model, constants);
  traces_.begin(model, constants);
  traces_end_.begin(model, constants);
}

solve::PieceSink* Meter::pieces() {
  return pieces_.sink();
}

void Meter::accept(std::size_t first, std::size_t count, const double* values) {
  if (count == 0) return;
  // A run may end before its first step.
  if (first == 0 && !of_motion_.empty()) extremes_.note((*grid_)[0], values);
  last_time_ = (*grid_)[first + count - 1];
  const double* const last = values + (count - 1) * model_->row_size();
  last_.assign(last, last + model_->row_size());
  if (of_rows_.empty()) return;
  times_.resize(count);
  for (std::size_t i = 0; i < count; ++i) times_[i] = (*grid_)[first + i];
  rows_.evaluate(times_.data(), values, count);
  for (std::size_t k = 0; k < of_rows_.size(); ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      const double value = rows_[k][i];
      if (std::isnan(value)) continue;
      sums_[k].squares.add(value);
      ++sums_[k].rows;
    }
  }
}

void Meter::finish(const solve::Outcome& outcome, double* results) {
  if (outcome.rows == 0) {  // it ended before it began
    std::fill_n(results, measures_.size(), std::numeric_limits<double>::quiet_NaN());
    return;
  }
  for (Rows* const end : {&end_, &traces_end_}) {
    if (outcome.ending == solve::Ending::stopped) {
      const model::Occurrence& at = outcome.occurrences.back();
      model::Sample last = at.sample;
      if (!at.own.empty()) last.own = at.own.data();
      end->evaluate(last);
    } else {
      end->evaluate(&last_time_, last_.data(), 1);
    }
  }
  for (std::size_t k = 0; k < at_end_.size(); ++k) results[at_end_[k]] = end_[k][0];
  for (std::size_t k = 0; k < of_rows_.size(); ++k) {
    results[of_rows_[k]] = sums_[k].rows == 0 ? std::numeric_limits<double>::quiet_NaN()
                                              : sums_[k].squares.root_mean(sums_[k].rows);
  }
  for (std::size_t k = 0; k < of_motion_.size(); ++k) results[of_motion_[k]] = extremes_[k].value;
  if (of_curves_.empty()) return;
  const bool stopped = outcome.ending == solve::Ending::stopped;
  traces_.finish(stopped ? outcome.occurrences.back().t : last_time_, traces_end_);
  const CurveOf curve_of = [this](const scenario::Column& column) -> const Curve& {
    return traces_.of(column);
  };
  for (const std::size_t m : of_curves_) results[m] = measured(measures_[m], curve_of);
}

}  // namespace bbsim::record
