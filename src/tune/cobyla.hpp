// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Powell's COBYLA, of the library NLopt, which is loaded when it is called: the least value of a
// function under constraints, from linear models of them, without derivatives.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace bbsim::tune {

struct Cobyla {
  std::vector<double> lower, upper;  // bounds of the numbers of x; may be infinite
  std::size_t constraints = 0;
  double step = 0.1;        // of the first models
  double tolerance = 1e-4;  // of each number of x
  std::size_t most = 100;   // calls of the function
  // Gives the value at x and the constraints, which should become 0 or less. All are finite. False
  // ends the search.
  std::function<bool(const std::vector<double>& x, double& value, double* constraints)> function;
};

// Begins at x. What is best is for `function` to remember. Throws InputError if there is no NLopt.
void minimize(const Cobyla& search, std::vector<double> x);

}  // namespace bbsim::tune
