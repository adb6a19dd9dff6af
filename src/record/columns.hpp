// The one table of output columns: CSV headers, HDF5 datasets, `bbsim columns` and the docs.
#pragma once

#include <span>
#include <string_view>

#include "model/dynamics.hpp"
#include "model/quaternion.hpp"
#include "model/sample.hpp"

namespace bbsim::record {

// One row as the columns see it. `dynamics` and `orientation`, from the ball's own frame to the
// plane's, are null unless a column of the run needs them.
struct Row {
  const model::Sample& sample;
  const model::Dynamics* dynamics;
  const model::Quaternion* orientation = nullptr;
};

// What a column is computed from: `reference` is there with a controller, `samples` with one in
// discrete time, `plate` where the plate's inertia is known;
// `orientation` comes of all rows so far, with gamma.
enum class Needs { state, gamma, orientation, reference, samples, dynamics, plate };

struct Column {
  std::string_view name;
  std::string_view unit;     // "1" if dimensionless
  std::string_view meaning;  // one phrase, without a full stop
  Needs needs;
  double (*value)(const Row&);
};

// All columns, in the order of `bbsim columns`.
[[nodiscard]] std::span<const Column> all_columns();

// The column of that name, or nullptr.
[[nodiscard]] const Column* find_column(std::string_view name);

}  // namespace bbsim::record
