// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the greatest and least values of columns over the continuous motion of a run.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/maxima.hpp"
#include "model/model.hpp"
#include "record/rows.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Passes over a piece whose bounds exclude a greater value. Evaluates each other piece at as many
// points as the integrator's polynomial has detail there. Both ends are included, hence both sides
// of every switch. If a value between two points may exceed the greatest so far, a search on the
// polynomial finds it.
class Extremes : public solve::PieceSink {
 public:
  struct Query {
    const scenario::Column* column;
    bool least = false;  // the greatest value otherwise
  };
  struct Extreme {
    double value;
    double t;  // s
  };

  // Ignores NaN. No column may need orientations, which depend on the rows before.
  explicit Extremes(std::vector<Query> queries);

  // Begins a run. Both arguments must outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants);
  // Takes a row that may belong to no piece: the start of a run that ends there, or the end after a
  // switch.
  void note(double t, const double* row);
  void note(const model::Sample& sample);

  void begin_run() override;
  void accept(const solve::Piece& piece) override;
  [[nodiscard]] bool may_miss(solve::BoundsOfColumns& within) const override;

  [[nodiscard]] std::size_t size() const { return greatest_.size(); }
  // NaN until there is a value.
  [[nodiscard]] Extreme operator[](std::size_t i) const {
    return {signs_[i] * greatest_[i].value, greatest_[i].t};
  }

 private:
  void sample(const solve::Piece& piece, const ChebyshevPoints& points, std::size_t stride);
  [[nodiscard]] bool may_exceed(std::size_t i, const solve::Bounds& bounds) const;
  [[nodiscard]] solve::Bounds bounds_of(std::size_t i, const solve::Piece& piece,
                                        bool closely) const;
  void find_open(const solve::Piece& piece);
  [[nodiscard]] bool may_matter(std::size_t i, const ChebyshevPoints& points) const;
  [[nodiscard]] bool is_shown(std::size_t i, const ChebyshevPoints& points) const;
  void take(std::size_t i, double value, double t);
  void climb_within(std::size_t i, const solve::Piece& piece, const ChebyshevPoints& points);

  Rows columns_;
  std::vector<std::optional<solve::Bounded>> bounded_;  // for each column, if it may be
  std::vector<double> signs_;  // -1 to seek the least value: the greatest of the negated column
  const model::BallConstants* constants_ = nullptr;
  std::vector<Extreme> greatest_;
  ChebyshevTables tables_;
  std::vector<double> times_;
  std::vector<double> values_, finer_;  // for each column, its values at the points
  // Columns that may exceed their greatest value in this piece: by bounds, and by its points.
  std::vector<std::size_t> open_, matter_;
};

}  // namespace bbsim::record
