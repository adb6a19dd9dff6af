// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/window_measures.hpp"

#include <cmath>
#include <utility>

#include "base/instant.hpp"
#include "base/real.hpp"

namespace bbsim::record {

using scenario::Column;
using scenario::Measure;
using Kind = Measure::Kind;

namespace {

std::vector<Measure> picked(const std::vector<Measure>& measures,
                            const std::vector<std::size_t>& which) {
  std::vector<Measure> chosen;
  for (const std::size_t m : which) chosen.push_back(measures[m]);
  return chosen;
}

template <class Predicate>
std::vector<std::size_t> those(const std::vector<Measure>& measures, Predicate predicate) {
  std::vector<std::size_t> found;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (predicate(measures[m])) found.push_back(m);
  }
  return found;
}

std::vector<const Column*> columns_of(const std::vector<Measure>& measures,
                                      const std::vector<std::size_t>& which) {
  std::vector<const Column*> columns;
  for (const std::size_t m : which) columns.push_back(measures[m].column);
  return columns;
}

// Each column once: those of curves, and those of `end` measures whose window may end before the
// run.
std::vector<const Column*> traced_by(const std::vector<Measure>& measures) {
  std::vector<const Column*> columns;
  for (const Measure& measure : measures) {
    if (!is_of_curves(measure) && !(measure.kind == Kind::end && measure.window.to)) continue;
    for (const Column* column : {measure.column, measure.instant.column}) {
      if (column != nullptr && std::ranges::find(columns, column) == columns.end()) {
        columns.push_back(column);
      }
    }
  }
  return columns;
}

// The references of steps, of which only the last value counts.
std::vector<const Column*> references_of(const std::vector<Measure>& measures) {
  const std::vector<const Column*> traced = traced_by(measures);
  std::vector<const Column*> columns;
  for (const Measure& measure : measures) {
    if (measure.reference == nullptr ||
        std::ranges::find(traced, measure.reference) != traced.end() ||
        std::ranges::find(columns, measure.reference) != columns.end()) {
      continue;
    }
    columns.push_back(measure.reference);
  }
  return columns;
}

std::vector<Extremes::Query> queries_of(const std::vector<Measure>& measures,
                                        const std::vector<std::size_t>& which) {
  std::vector<Extremes::Query> queries;
  for (const std::size_t m : which) {
    queries.push_back({measures[m].column, measures[m].kind == Kind::least});
  }
  return queries;
}

class PiecePart : public solve::Piece {
 public:
  PiecePart(const solve::Piece& whole, double from, double to)
      : Piece(from, to, whole.parts()), whole_(whole) {}

  void evaluate(const double* times, std::size_t count, double* rows) const override {
    whole_.evaluate(times, count, rows);
  }
  void evaluate_ball(const double* times, std::size_t count, double* rows) const override {
    whole_.evaluate_ball(times, count, rows);
  }
  // Bounds of the whole piece hold for its part.
  [[nodiscard]] std::optional<solve::Bounds> bounds(solve::Bounded column,
                                                    const model::BallConstants& constants,
                                                    bool closely) const override {
    return whole_.bounds(column, constants, closely);
  }

 private:
  const solve::Piece& whole_;
};

}  // namespace

WindowMeasures::WindowMeasures(const std::vector<Measure>& measures, std::vector<std::size_t> which)
    : measures_(picked(measures, which)),
      places_(std::move(which)),
      window_(measures_.front().window),
      at_end_(those(measures_, [](const Measure& measure) { return measure.kind == Kind::end; })),
      of_motion_(those(measures_,
                       [](const Measure& measure) {
                         return measure.kind == Kind::greatest || measure.kind == Kind::least;
                       })),
      of_rows_(those(measures_, [](const Measure& measure) { return measure.kind == Kind::rms; })),
      of_curves_(those(measures_, [](const Measure& measure) { return is_of_curves(measure); })),
      end_(columns_of(measures_, at_end_)),
      extremes_(queries_of(measures_, of_motion_)),
      traces_(traced_by(measures_), references_of(measures_)),
      extreme_pieces_(window_, extremes_),
      trace_pieces_(window_, traces_) {}

void WindowMeasures::begin(const model::Model& model, const model::BallConstants& constants,
                           PieceFan& fan) {
  model_ = &model;
  sums_.assign(of_rows_.size(), {});
  end_.begin(model, constants);
  extremes_.begin(model, constants);
  traces_.begin(model, constants);
  if (!of_motion_.empty()) fan.add(extreme_pieces_);
  if (!traces_.empty()) fan.add(trace_pieces_);
}

std::vector<const Column*> WindowMeasures::row_columns() const {
  return columns_of(measures_, of_rows_);
}

void WindowMeasures::accept_start(double t, const double* row) {
  if (!of_motion_.empty() && window_.holds(t)) extremes_.note(t, row);
}

void WindowMeasures::Sum::add(const scenario::Window& window, double t, double value) {
  if (std::isnan(value) || !window.holds(t)) return;
  squares.add(value);
  ++rows;
}

const Curve& WindowMeasures::curve_of(const Column& column) const {
  static const Curve none;
  // An open loop has no reference.
  if (column.needs == scenario::Needs::controller && !model_->closed_loop()) return none;
  return traces_.of(column);
}

void WindowMeasures::put(std::size_t which, const Measured& measured, double* results,
                         scenario::Whys& whys) const {
  results[places_[which]] = measured.value;
  whys[places_[which]] = std::isnan(measured.value) ? measured.why : nullptr;
}

void WindowMeasures::finish(const RunEnd& end, double* results, scenario::Whys& whys) {
  const bool before = end.t < window_.begin() && !window_.holds(end.t);
  const bool within = window_.holds(end.t);
  const char* const none = before ? "the run ends before its window" : "there is no finite value";
  end_.evaluate(end.sample);
  if (within) {
    // The last piece does not include a switch at its end.
    if (!of_motion_.empty() && model_->hybrid()) extremes_.note(end.sample);
    if (!traces_.empty()) traces_.finish(end.t, end.sample);
  }
  for (std::size_t k = 0; k < at_end_.size(); ++k) {
    const Measure& measure = measures_[at_end_[k]];
    const double value = before   ? no_number
                         : within ? end_[k][0]
                                  : curve_of(*measure.column).last_value();
    put(at_end_[k], {value, none}, results, whys);
  }
  for (std::size_t k = 0; k < of_rows_.size(); ++k) {
    const Sum& sum = sums_[k];
    const double value = sum.rows == 0 ? no_number : sum.squares.root_mean(sum.rows);
    put(of_rows_[k], {value, window_.is_whole() || before ? none : "no row is within its window"},
        results, whys);
  }
  for (std::size_t k = 0; k < of_motion_.size(); ++k) {
    put(of_motion_[k], {extremes_[k].value, none}, results, whys);
  }
  for (const std::size_t m : of_curves_) {
    Measured found = measured(
        measures_[m], [this](const Column& column) -> const Curve& { return curve_of(column); });
    if (before) found.why = none;
    put(m, found, results, whys);
  }
}

void WindowPieces::accept(const solve::Piece& piece) {
  const double from = std::max(piece.from(), window_.begin());
  const double to = std::min(piece.to(), window_.end());
  if (from == piece.from() && to == piece.to()) {
    sink_.accept(piece);
  } else if (to - from > rounding_of(to)) {
    sink_.accept(PiecePart(piece, from, to));
  }
}

}  // namespace bbsim::record
