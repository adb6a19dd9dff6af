// What the columns (scenario/columns.hpp) are: numbers of a row.
#pragma once

#include "base/quaternion.hpp"
#include "model/ball/dynamics.hpp"
#include "model/sample.hpp"
#include "scenario/columns.hpp"

namespace bbsim::record {

// One row as the columns see it. `dynamics` and `orientation`, from the ball's own frame to the
// plane's, are null unless a column of the run needs them.
struct Row {
  const model::Sample& sample;
  const model::Dynamics* dynamics;
  const Quaternion* orientation = nullptr;
};

using ColumnValue = double (*)(const Row&);

[[nodiscard]] ColumnValue value_of(const scenario::Column& column);

}  // namespace bbsim::record
