// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the columns (scenario/columns.hpp) are: numbers of a row.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/quaternion.hpp"
#include "model/ball/dynamics.hpp"
#include "model/sample.hpp"
#include "scenario/columns.hpp"

namespace bbsim::record {

// Some rows. `dynamics` and `orientations`, from the ball's own frame to the plane's, are null
// where no column needs them.
struct RowBlock {
  std::size_t count;
  const model::Sample* samples;
  const model::BallConstants* constants;
  const model::Dynamics* dynamics;
  const Quaternion* orientations;
};

// Writes a column of the rows, as many numbers as there are rows.
using FillColumn = void (*)(const RowBlock& rows, double* column);

// `own_columns` are those that the scene's own controller gives: Model::own_columns(). One that is
// not among them is no number.
[[nodiscard]] FillColumn fill_of(const scenario::Column& column,
                                 const std::vector<std::string>& own_columns);

}  // namespace bbsim::record
