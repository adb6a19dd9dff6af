// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Powell's COBYLA minimizes a function under constraints, without derivatives, from linear models.
// It comes from the library NLopt, which is loaded at the first call.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace bbsim::tune {

struct Cobyla {
  std::vector<double> lower, upper;  // bounds of x; may be infinite
  std::size_t constraints = 0;
  double step = 0.1;        // size of the first models
  double tolerance = 1e-4;  // on each number of x, to end the search
  std::size_t most = 100;   // largest number of calls of the function
  // Computes the value at x and the constraints, which should become 0 or less. All must be finite.
  // Returning false ends the search.
  std::function<bool(const std::vector<double>& x, double& value, double* constraints)> function;
};

// Begins at x. search.function must remember the best point. Throws InputError if NLopt is missing.
void minimize(const Cobyla& search, std::vector<double> x);

}  // namespace bbsim::tune
