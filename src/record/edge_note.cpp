// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/edge_note.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace bbsim::record {
namespace {

std::optional<std::size_t> position_of(const std::vector<std::string>& names, const char* name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

bool EdgeNote::wanted(const Scenario& scenario) {
  return (scenario.plate.size || scenario.plate.diameter) && !scenario.events.edge;
}

EdgeNote::EdgeNote(const model::Model& model, const Plate& plate, const solve::OutputGrid& grid,
                   solve::StateSink& next)
    : plate_(plate), grid_(grid), next_(next), row_size_(model.row_size()) {
  const std::vector<std::string> names = model.state_names();
  x_ = position_of(names, "x");
  y_ = position_of(names, "y");
}

bool EdgeNote::is_beyond(double x, double y) const {
  if (plate_.size) {
    return std::abs(x) > (*plate_.size)[0] / 2 || std::abs(y) > (*plate_.size)[1] / 2;
  }
  return std::hypot(x, y) > *plate_.diameter / 2;
}

void EdgeNote::accept(std::size_t first, std::size_t count, const double* values) {
  next_.accept(first, count, values);
  for (std::size_t i = 0; i < count && !left_; ++i) {
    const double* const row = values + i * row_size_;
    const double x = x_ ? row[*x_] : 0, y = y_ ? row[*y_] : 0;
    if (is_beyond(x, y)) left_ = OffPlate{grid_[first + i], x, y};
  }
}

}  // namespace bbsim::record
