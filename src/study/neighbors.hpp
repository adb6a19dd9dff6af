// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene at values of a key near the present one, and differences between such values.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "model/model.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::study {

// A key p of a scenario, with all numbers in SI.
struct VariedKey {
  std::string name;
  double value = 0;
  // A power of two. The scenario may be read at value + 4 step and value - 4 step.
  double step = 0;
  std::function<Scenario(double value)> scenario{};
};

// Weights of (f(p + i h) - f(p - i h)) / h in central differences, i from 1.
inline constexpr std::array eighth_order = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
inline constexpr std::array sixth_order = {3.0 / 4, -3.0 / 20, 1.0 / 60};
inline constexpr std::array fourth_order = {2.0 / 3, -1.0 / 12};
inline constexpr std::array second_order = {1.0 / 2};

// The weights of a difference between `pairs` pairs of values, 1 to 4.
[[nodiscard]] inline std::span<const double> central_weights(std::size_t pairs) {
  const std::span<const double> all[] = {second_order, fourth_order, sixth_order, eighth_order};
  return all[pairs - 1];
}

// `value(i)` is f(p + offset h) at the i-th of 2 `neighbors` nonzero offsets, in increasing order.
template <std::size_t n, class Value>
auto difference(const std::array<double, n>& weights, std::size_t neighbors, double step,
                const Value& value) {
  using Of = std::decay_t<decltype(value(neighbors))>;
  Of sum = weights[0] * (value(neighbors) - value(neighbors - 1));
  for (std::size_t i = 1; i < n; ++i) {
    sum += weights[i] * (value(neighbors + i) - value(neighbors - 1 - i));
  }
  sum /= step;
  return sum;
}

// The models of a scene at value + offset step of a key.
struct Neighbors {
  static constexpr std::array offsets = {-4, -3, -2, -1, 1, 2, 3, 4};

  VariedKey key;
  std::vector<model::Model> models{};
  // Pairs of neighbors for differences of the right-hand side; 0 if it does not depend on the key.
  std::size_t pairs = offsets.size() / 2;

  // The derivative by the key of a quantity that is `value(i)` for the i-th model.
  template <class Value>
  [[nodiscard]] auto slope(const Value& value) const {
    return difference(eighth_order, offsets.size() / 2, key.step, value);
  }
};

// The rates of `size` states z of a system at t (s).
[[nodiscard]] inline Eigen::VectorXd rates_of(const model::System& system, std::size_t size,
                                              double t, const double* z) {
  Eigen::VectorXd rates(static_cast<Eigen::Index>(size));
  std::visit([&](const auto& any) { any.derivative(t, z, rates.data()); }, system);
  return rates;
}

// The derivatives by the key of a row's extras, without the measured ball position, if the states z
// at t change by `slope`. The models must be in the present mode.
[[nodiscard]] Eigen::VectorXd slope_of_extras(const Neighbors& neighbors, double t,
                                              const Eigen::VectorXd& z,
                                              const Eigen::VectorXd& slope);

// Index of the measured ball position among the extras.
inline constexpr Eigen::Index measured_extras = model::RigExtras::size - 2;

[[noreturn]] inline void no_sensitivity(const std::string& what) {
  throw InputError("--sensitivity: " + what);
}

}  // namespace bbsim::study
