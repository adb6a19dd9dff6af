// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Positions at the output times, as exact as they can be known.
#pragma once

#include <vector>

#include "base/quad.hpp"
#include "solve/check_run.hpp"
#include "study/checks.hpp"
#include "study/reference.hpp"

namespace bbsim_test {

// The states x and y, or one of them; a row for each time.
using Positions = std::vector<std::vector<double>>;

// In quad precision; for scenes that switch, with many more steps than any run, of 8 or 12 stages.
// Empty if the scene ends early, other than by an event.
inline Positions exact_positions(const bbsim::model::Model& model,
                                 const bbsim::solve::OutputGrid& grid) {
  using namespace bbsim;
  const auto n = static_cast<std::size_t>(study::coordinates(model));
  Positions rows;
  if (model.hybrid()) {
    solve::Trajectory fine(model.row_size());
    const auto outcome = solve::integrate_check_run(model, {12, 7}, {1e-14, 1e-16}, grid, fine, {});
    if (outcome.ending == solve::Ending::failed) return {};
    for (std::size_t i = 0; i < fine.rows(); ++i) rows.emplace_back(fine.row(i), fine.row(i) + n);
    return rows;
  }
  const study::ReferenceSolution quad = study::solve_reference(model, grid);
  if (!quad.complete) return {};
  for (std::size_t i = 0; i < quad.rows(); ++i) {
    rows.emplace_back();
    for (std::size_t k = 0; k < n; ++k) rows.back().push_back(plain(quad.row(i)[k]));
  }
  return rows;
}

}  // namespace bbsim_test
