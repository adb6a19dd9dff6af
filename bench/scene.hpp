// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene for measurements: its model, its output times and its solution.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::bench {

// Receives the rows of a run. For all tools, memory is allocated before the clock starts.
class Rows : public solve::StateSink {
 public:
  Rows(std::size_t rows, std::size_t row_size) : row_size_(row_size), values_(rows * row_size) {}

  void accept(std::size_t first, std::size_t count, const double* values) override {
    std::copy(values, values + count * row_size_, row(first));
  }

  [[nodiscard]] double* row(std::size_t i) { return values_.data() + i * row_size_; }
  [[nodiscard]] const double* row(std::size_t i) const { return values_.data() + i * row_size_; }

 private:
  std::size_t row_size_;
  std::vector<double> values_;
};

struct Scene {
  std::string name;
  model::Model model;  // without gamma
  solve::OutputGrid grid;
  std::vector<double> times;  // of the grid, s
  std::vector<double> x, y;   // reference solution at the output times, m
  double radius = 0, gravity = 0;
};

// Loads FOLDER/scenarios/NAME.yaml and its solution FOLDER/reference/NAME.csv. Throws InputError if
// either is missing or invalid, or if their output times differ.
[[nodiscard]] Scene load_scene(const std::string& folder, const std::string& name);

// max |dx|, |dy| over the output times, m; infinite if a value is not finite.
[[nodiscard]] double largest_error(const Scene& scene, const Rows& rows);

}  // namespace bbsim::bench
