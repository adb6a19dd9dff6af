// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The solution of a model in quad precision: what the integrators' results are measured against.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/quad.hpp"
#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {

// Rows at the times of the output grid, as far as the solution goes. A row is packed as those of
// solve::StateSink: the states, then, if the model asks for gamma, the integral of u = r gamma'.
struct ReferenceSolution {
  std::size_t row_size = 0;
  std::vector<Quad> values;  // row-major
  bool complete = false;     // to the end of the grid
  double reached = 0;        // s
  // The largest difference in x or y, over all rows, from a solution with another number of
  // stages and ten times the tolerance: about the error of that one, and more than of this. m
  double error_estimate = 0;
  std::size_t steps = 0;
  std::string reason;  // why it is not complete; empty if it was interrupted

  [[nodiscard]] std::size_t rows() const { return values.size() / row_size; }
  [[nodiscard]] const Quad* row(std::size_t i) const { return values.data() + i * row_size; }
};

// How many of the first states are coordinates of the contact point, in m: x and y, or one.
[[nodiscard]] int coordinates(const model::Model& model);

// Solves by Radau IIA collocation of order 47 in steps as long as the solution is smooth; it
// shares no code with the integrators but the model. Stiff models are no harder than others. The
// model's stops are reached and restarted from.
//
// `tolerance` bounds the error of one step, relative to 1 + |z| in each state's unit; steps are
// longer the larger it is. It is raised to what the number type can hold (1e-30 with 113 bits).
// The model is solved as its doubles hold it: the rounding of, say, 0.01 m to double, and of
// products of such constants, is part of the question, not of the answer's error.
//
// A solution that reaches infinity ends before it, with what was reached and a reason. `watch` is
// looked at after every step.
[[nodiscard]] ReferenceSolution solve_reference(const model::Model& model,
                                                const solve::OutputGrid& grid,
                                                double tolerance = 1e-22,
                                                const solve::Watch& watch = {});

}  // namespace bbsim::study
