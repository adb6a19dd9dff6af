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
