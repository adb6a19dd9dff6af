// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The greatest and least values that columns of a run take, over its continuous motion.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/chebyshev.hpp"
#include "base/greatest.hpp"
#include "model/model.hpp"
#include "record/rows.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Looks at each piece of a run at as many points as the integrator's polynomial has detail there,
// both ends included, hence at both sides of every switch. Where a number may be greater between
// two points than it was anywhere before, it goes for that maximum on the polynomial.
class Extremes : public solve::PieceSink {
 public:
  struct Sought {
    const scenario::Column* column;
    bool least = false;  // the greatest value otherwise
  };
  struct Extreme {
    double value;
    double t;  // s
  };

  // What is no number is passed over. No column may need orientations, which come of rows in turn.
  explicit Extremes(std::vector<Sought> sought);

  // Begins anew; the two outlive the run.
  void begin(const model::Model& model, const model::BallConstants& constants);
  // A row that may be of no piece, such as the start of a run that ends there, or the end where it
  // switches.
  void note(double t, const double* row);
  void note(const model::Sample& sample);

  void begin_run() override;
  void accept(const solve::Piece& piece) override;

  [[nodiscard]] std::size_t size() const { return greatest_.size(); }
  // No number before there was one.
  [[nodiscard]] Extreme operator[](std::size_t i) const {
    return {signs_[i] * greatest_[i].value, greatest_[i].t};
  }

 private:
  void sample(const solve::Piece& piece, const ChebyshevPoints& points);
  [[nodiscard]] bool may_exceed(std::size_t i, const std::optional<solve::Bounds>& bounds) const;
  [[nodiscard]] bool matters_not(const solve::Piece& piece) const;
  [[nodiscard]] bool may_matter(std::size_t i, const ChebyshevPoints& points) const;
  [[nodiscard]] bool is_shown(std::size_t i, const ChebyshevPoints& points) const;
  void take(std::size_t i, double value, double t);
  void climb_within(std::size_t i, const solve::Piece& piece, const ChebyshevPoints& points);

  Rows columns_;
  std::vector<std::optional<solve::Load>> loads_;  // of each column, if it is one
  bool loads_alone_ = false;                       // whether all are
  std::vector<double> signs_;  // -1 where the least value is the greatest of the column turned over
  const model::Model* model_ = nullptr;
  const model::BallConstants* constants_ = nullptr;
  std::vector<Extreme> greatest_;
  ChebyshevTables tables_;
  std::vector<double> times_, rows_;
  std::vector<double> values_, finer_;  // of each column, its values at the points
  std::vector<std::size_t> matter_;     // those that may be greater in this piece than before
};

}  // namespace bbsim::record
