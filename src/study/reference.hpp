// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The solution of a model, the reference for the integrators' errors: in quad precision or, for
// models that switch, by CVODE.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/quad.hpp"
#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {

// Rows at the times of the output grid, as far as the solution goes. A row is packed as for
// solve::StateSink: the states, then, if the model asks for gamma, the integral of u = r gamma'.
struct ReferenceSolution {
  std::size_t row_size = 0;
  std::vector<Quad> values;  // row-major
  bool complete = false;     // whether it reached the end of the grid
  double reached = 0;        // s
  // The largest difference in x or y over all rows from a solution with another number of stages
  // and ten times the tolerance, m. It is about the error of that solution, and larger than the
  // error of this one.
  double error_estimate = 0;
  std::size_t steps = 0;
  std::string reason;  // why it is not complete; empty if it was interrupted

  [[nodiscard]] std::size_t rows() const { return values.size() / row_size; }
  [[nodiscard]] const Quad* row(std::size_t i) const { return values.data() + i * row_size; }
};

// Solves by Radau IIA collocation of order 47, with steps as long as the solution's smoothness
// allows. Shares only the model with the integrators. Stiff models are no harder than others. Ends
// a step at each of the model's stops and restarts there.
//
// `tolerance` bounds the error of one step, relative to 1 + |z| in each state's unit. It is raised
// to what the number type can resolve (1e-30 with 113 bits). The model is solved with the constants
// that its doubles hold. The rounding of 0.01 m to double, for example, does not count as an error
// of the solution.
//
// A solution that reaches infinity ends before it, with the rows reached and a reason. `watch` is
// checked after every step.
[[nodiscard]] ReferenceSolution solve_reference(const model::Model& model,
                                                const solve::OutputGrid& grid,
                                                double tolerance = 1e-22,
                                                const solve::Watch& watch = {});

// Solves a model with switches or events by CVODE's Adams method at rtol 1e-13, from switch to
// switch, with the servos as states. Shares the driver and the events with the integrators, but
// neither collocation nor the servos' closed forms. The error estimate is the difference from rtol
// 1e-12.
[[nodiscard]] ReferenceSolution solve_by_cvode(const model::Model& model,
                                               const solve::OutputGrid& grid,
                                               const solve::Watch& watch = {});

}  // namespace bbsim::study
