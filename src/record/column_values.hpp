// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Computes the columns (scenario/columns.hpp) from rows of a run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/quaternion.hpp"
#include "model/ball/dynamics.hpp"
#include "model/sample.hpp"
#include "scenario/columns.hpp"

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

}  // namespace bbsim::record
