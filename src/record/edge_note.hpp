// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Notes where a ball leaves a plate of known size, in scenes that have no event for it. This checks
// rows as they pass, with two comparisons a row.
#pragma once

#include <cstddef>
#include <optional>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

// The first row whose contact point is beyond the edge.
struct OffPlate {
  double t = 0;         // s
  double x = 0, y = 0;  // m
};

class EdgeNote : public solve::StateSink {
 public:
  // Whether the scene's plate has a size and no event at its edge.
  [[nodiscard]] static bool wanted(const Scenario& scenario);

  // Passes all rows on to `next`.
  EdgeNote(const model::Model& model, const Plate& plate, const solve::OutputGrid& grid,
           solve::StateSink& next);

  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override { return next_.pieces(); }

  [[nodiscard]] const std::optional<OffPlate>& left() const { return left_; }

 private:
  [[nodiscard]] bool is_beyond(double x, double y) const;

  const Plate plate_;
  const solve::OutputGrid& grid_;
  solve::StateSink& next_;
  std::size_t row_size_;
  std::optional<std::size_t> x_, y_;  // indices of states; empty if symmetry keeps the state at 0
  std::optional<OffPlate> left_;
};

}  // namespace bbsim::record
