// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Evaluates columns (scenario/columns.hpp) from rows of a run, for tables, measures and sweeps.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/quaternion.hpp"
#include "model/ball/dynamics.hpp"
#include "model/model.hpp"
#include "model/sample.hpp"
#include "scenario/columns.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Integrates the ball's orientation from row to row, for columns ball_qw to ball_qz.
// The rotation from the ball's frame to the plane's; the identity in the first row. A ball whose
// surface slips over the plane at s turns at w = (s_y - y', x' - s_x, r gamma') / r in the plane's
// frame, so q' = w q / 2. From row to row, at distance h, a Magnus expansion of fourth order
// integrates this:
//
//   q <- exp(d - h/12 d x (w1 - w0)) q,   d = (S_y - dy, dx - S_x, r dgamma) / r.
//
// A rolling ball has s = 0 and an exact d, the integral of w, because the states are exact. The
// error then comes from the turn of w between two rows. A sliding ball has S = h (s0 + s1) / 2,
// which is exact under constant friction. The error is of order h^2 where the friction turns,
// begins or ends between rows.
class BallTurn {
 public:
  explicit BallTurn(double radius) : radius_(radius) {}  // m

  // Advances to a row, which must have gamma.
  const Quaternion& go_to(const model::Sample& row);

 private:
  double radius_;
  bool begun_ = false;
  model::Sample last_{};
  Quaternion now_{1, 0, 0, 0};
};

// A block of rows. `dynamics` and `orientations` (from the ball's frame to the plane's) are null if
// no column needs them.
struct RowBlock {
  std::size_t count;
  const model::Sample* samples;
  const model::BallConstants* constants;
  const model::Dynamics* dynamics;
  const Quaternion* orientations;
};

// Writes a column: one number for each row.
using FillColumn = void (*)(const RowBlock& rows, double* column);

// `own_columns`: columns of the scene's controller, Model::own_columns(). A controller column that
// is not among them is NaN.
[[nodiscard]] FillColumn fill_of(const scenario::Column& column,
                                 const std::vector<std::string>& own_columns);

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
  [[nodiscard]] bool need_dynamics() const { return of_all_.dynamics; }
  // Whether only the ball's states of a row count.
  [[nodiscard]] bool need_ball_only() const { return of_all_.ball_only(); }
  // Evaluates a piece of the motion at times (s).
  void evaluate(const solve::Piece& piece, const double* times, std::size_t count);
  // Evaluates only some of the columns, by their indices. The others then have no values.
  void evaluate(const solve::Piece& piece, const double* times, std::size_t count,
                std::span<const std::size_t> which);
  // A column of the rows evaluated last.
  [[nodiscard]] const double* operator[](std::size_t column) const {
    return numbers_.data() + column * count_;
  }

 private:
  // The number of rows that are samples at a time. They fit into the first-level cache and keep the
  // program's memory small at its start.
  static constexpr std::size_t strip = 32;

  // What columns are computed from.
  struct Sources {
    model::Detail detail = model::Detail::ball;
    bool controller = false, dynamics = false, own = false;

    void add(scenario::Needs needs);
    [[nodiscard]] model::Detail all_details() const;
    [[nodiscard]] bool ball_only() const;
  };

  void resize(std::size_t count);
  void evaluate_some(const double* times, const double* rows, std::size_t count,
                     const Sources& from, std::span<const std::size_t> which);
  void take_samples(const double* times, const double* rows, std::size_t count,
                    model::Detail detail);
  // Fills columns from the samples; the first one is row `first` of the block.
  void fill(std::size_t first, bool with_dynamics, std::span<const std::size_t> which);

  std::vector<const scenario::Column*> columns_;
  std::vector<FillColumn> fills_;
  Sources of_all_;
  std::vector<std::size_t> all_;  // the indices of all columns
  const model::Model* model_ = nullptr;
  std::size_t row_size_ = 0;
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
