// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Evaluates columns from rows of a run, for tables, measures and sweeps.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "record/column_values.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Evaluates columns, a block of rows at a time, and computes only the quantities that they need. A
// position needs neither the control law nor the sines of a given motion.
class Rows {
 public:
  explicit Rows(std::vector<const scenario::Column*> columns);

  // Begins a run. Both arguments must outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants);

  // Lets runs with one reference compute it once. The cache must outlive this object.
  void share_reference(model::SharedSignals& shared) { shared_reference_ = &shared; }

  // Evaluates `count` rows (Model::row_size() numbers each) at their times (s). Orientations
  // continue from the row before.
  void evaluate(const double* times, const double* rows, std::size_t count);
  // Evaluates a single row, given as a sample.
  void evaluate(const model::Sample& sample);

  [[nodiscard]] const std::vector<const scenario::Column*>& columns() const { return columns_; }
  [[nodiscard]] bool need_dynamics() const { return needs_dynamics_; }
  // Whether only the ball's states of a row count.
  [[nodiscard]] bool need_ball_only() const { return needs_ball_only_; }
  // Evaluates a piece of the motion at times (s).
  void evaluate(const solve::Piece& piece, const double* times, std::size_t count);
  // A column of the rows evaluated last.
  [[nodiscard]] const double* operator[](std::size_t column) const {
    return numbers_.data() + column * count_;
  }

 private:
  // The number of rows that are samples at a time. They fit into the first-level cache and keep the
  // program's memory small at its start.
  static constexpr std::size_t strip = 32;

  void resize(std::size_t count);
  void take_samples(const double* times, const double* rows, std::size_t count);
  // Fills the columns from the samples; the first one is row `first` of the block.
  void fill(std::size_t first);

  std::vector<const scenario::Column*> columns_;
  std::vector<FillColumn> fills_;
  model::Detail detail_ = model::Detail::ball;
  bool needs_dynamics_ = false, needs_orientation_ = false, needs_ball_only_ = false;
  const model::Model* model_ = nullptr;
  const model::BallConstants* constants_ = nullptr;
  model::SharedSignals* shared_reference_ = nullptr;
  std::optional<BallTurn> turn_;

  std::size_t count_ = 0;               // of the block
  std::vector<model::Sample> samples_;  // of a strip of the block, like the next two
  std::vector<model::Dynamics> dynamics_;
  std::vector<Quaternion> orientations_;
  std::vector<double> numbers_;  // column after column
  std::vector<double> rows_;     // of a piece
};

}  // namespace bbsim::record
