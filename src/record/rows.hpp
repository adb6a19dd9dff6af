// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows of a run as columns: the one way from states to numbers, for tables, measures and sweeps.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "record/ball_turn.hpp"
#include "record/column_values.hpp"

namespace bbsim::record {

// Evaluates columns, a block of rows at a time, and of each row what they need and no more: the
// controller's law is not computed for a position, nor are sines of a given motion.
class Rows {
 public:
  explicit Rows(std::vector<const scenario::Column*> columns);

  // Begins a run; the two outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants);

  // Evaluates `count` rows (Model::row_size() numbers each) at their times (s). Orientations go on
  // from the row before.
  void evaluate(const double* times, const double* rows, std::size_t count);
  // A row that is a sample already.
  void evaluate(const model::Sample& sample);

  [[nodiscard]] const std::vector<const scenario::Column*>& columns() const { return columns_; }
  [[nodiscard]] bool need_dynamics() const { return needs_dynamics_; }
  // A column of the rows that were evaluated last.
  [[nodiscard]] const double* operator[](std::size_t column) const {
    return numbers_.data() + column * count_;
  }

 private:
  // Of a block so many rows are samples at a time: they stay in the processor's first cache, and
  // take a start of the program little memory.
  static constexpr std::size_t strip = 32;

  void resize(std::size_t count);
  // The columns of the rows that are samples, from row `first` of the block on.
  void fill(std::size_t first);

  std::vector<const scenario::Column*> columns_;
  std::vector<FillColumn> fills_;
  model::Detail detail_ = model::Detail::ball;
  bool needs_dynamics_ = false, needs_orientation_ = false;
  const model::Model* model_ = nullptr;
  const model::BallConstants* constants_ = nullptr;
  std::optional<BallTurn> turn_;

  std::size_t count_ = 0;               // rows of the block
  std::vector<model::Sample> samples_;  // of a strip of it, as what follows from them
  std::vector<model::Dynamics> dynamics_;
  std::vector<Quaternion> orientations_;
  std::vector<double> numbers_;  // column after column
};

}  // namespace bbsim::record
