// The one table of output columns: CSV headers, HDF5 datasets, `bbsim columns` and the docs.
#pragma once

#include <span>
#include <string_view>

#include "model/sample.hpp"

namespace bbsim::record {

// The constants that forces, torques and energy take beside the motion.
struct BallConstants {
  double radius = 0, mass = 1, gravity = 0;  // m, kg, m/s^2
};

struct Column {
  std::string_view name;
  std::string_view unit;     // "1" if dimensionless
  std::string_view meaning;  // one phrase, without a full stop
  enum class Needs { state, gamma, reference, dynamics } needs;
  double (*value)(const model::Sample&, const BallConstants&);
};

// All columns, in the order of `bbsim columns`.
[[nodiscard]] std::span<const Column> all_columns();

// The column of that name, or nullptr.
[[nodiscard]] const Column* find_column(std::string_view name);

}  // namespace bbsim::record
