// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/control/derivatives.hpp"
#include "model/control/sampled_cycle.hpp"
#include "model/eigenvalues.hpp"
#include "model/exact_eigenvalues.hpp"
#include "model/systems/any_jacobian.hpp"

namespace bbsim::model {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

void sort_by(Eigenvalues& values, double (*measure)(const std::complex<double>&)) {
  std::sort(values.begin(), values.end(), [measure](const auto& a, const auto& b) {
    const double p = measure(a), q = measure(b);
    return p != q ? p > q : a.imag() > b.imag();
  });
}

double real_part(const std::complex<double>& value) {
  return value.real();
}

double size_of(const std::complex<double>& value) {
  return std::abs(value);
}

// Eigenvalues of a matrix with rounded entries, by falling measure. `moved` estimates how far
// relative errors of the entries change each one's measure.
struct RoundedValues {
  Eigenvalues values;
  std::vector<double> moved;
};

RoundedValues rounded_values(const Eigen::MatrixXd& matrix, double rounding,
                             double (*measure)(const std::complex<double>&)) {
  RoundedValues known{exact_eigenvalues(matrix), {}};
  sort_by(known.values, measure);
  known.moved.assign(known.values.size(),
                     exact_rounding(matrix.rows()) * balanced(matrix).cwiseAbs().maxCoeff());
  for (const int way : {1, 2}) {
    Eigen::MatrixXd other = matrix;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        // Arbitrary, unrelated numbers between -1 and 1.
        const double part = std::sin(static_cast<double>(way * (1 + 37 * i + 101 * j)));
        other(i, j) += matrix(i, j) * rounding * part;
      }
    }
    Eigenvalues values = exact_eigenvalues(other);
    if (values.size() != known.values.size()) return {};
    sort_by(values, measure);
    for (std::size_t i = 0; i < values.size(); ++i) {
      // Two trials show less than the worst case.
      const double change = 10 * std::abs(measure(values[i]) - measure(known.values[i]));
      known.moved[i] = std::max(known.moved[i], change);
    }
  }
  return known;
}

}  // namespace

Eigenvalues sorted_eigenvalues(const Eigen::MatrixXd& matrix) {
  Eigenvalues values = eigenvalues_of(matrix);
  sort_by(values, real_part);
  if (values.empty()) return values;
  // Rounding splits a triple pole by its cube root.
  const double doubtful = 1e-5 * balanced(matrix).cwiseAbs().maxCoeff();
  if (std::ranges::all_of(values, [&](const auto& one) { return std::abs(one.real()) > doubtful; }))
    return values;
  RoundedValues known = rounded_values(matrix, 4 * epsilon, real_part);
  if (known.values.empty()) return values;
  for (std::size_t i = 0; i < known.values.size(); ++i) {
    std::complex<double>& value = known.values[i];
    const double rounding = std::max(known.moved[i], 8 * epsilon * std::abs(value.imag()));
    if (std::abs(value.real()) <= rounding) value.real(0);
  }
  sort_by(known.values, real_part);
  return known.values;
}

Eigenvalues poles_of_period(const Eigen::MatrixXd& map) {
  Eigenvalues values = eigenvalues_of(map);
  sort_by(values, size_of);
  // Rounding splits a double pole by its square root.
  const auto near = [&](double distance) {
    return std::ranges::any_of(
        values, [&](const auto& one) { return std::abs(std::abs(one) - 1) < distance; });
  };
  if (!near(1e-6)) return values;
  RoundedValues known{values, std::vector<double>(values.size(), 1e-9)};
  // The entries of an exponential carry more than their own rounding.
  if (map.rows() <= most_exact) known = rounded_values(map, 50 * epsilon, size_of);
  if (known.values.empty()) return values;
  for (std::size_t i = 0; i < known.values.size(); ++i) {
    std::complex<double>& value = known.values[i];
    const double size = std::abs(value);
    if (std::abs(size - 1) <= std::max(known.moved[i], 100 * epsilon)) value /= size;
  }
  sort_by(known.values, size_of);
  return known.values;
}

Eigenvalues eigenvalues(const Model& model, double t, const double* z) {
  const auto n = static_cast<Eigen::Index>(model.size());
  Eigen::MatrixXd matrix(n, n);
  jacobian(model.system, t, z, matrix.data());
  return sorted_eigenvalues(matrix);
}

namespace {

// Whether a continuous law or given torques move the gimbal.
template <class System>
bool has_loop(const System& system) {
  if constexpr (is_coupled_loop<System>) {
    return feeds_back(system.law().kind) || system.by == GimbalBy::given_torques;
  } else if constexpr (is_rig<System>) {
    return feeds_back(system.law().kind);
  } else {
    return !System::open_loop && !is_coupled<System>;
  }
}

}  // namespace

Eigenvalues closed_loop_poles(const Model& model) {
  if (!std::visit([](const auto& system) { return has_loop(system); }, model.system)) return {};
  const LoopDerivatives loop = loop_derivatives(model, home_point());
  const std::vector<int> states = loop_states(loop, moving_axes(model));
  return sorted_eigenvalues(loop.of_state(states, states));
}

Eigenvalues plant_poles(const Model& model) {
  const PlantDerivatives plant = plant_derivatives(model, home_point(), Heave::left_out);
  const std::vector<int> states =
      linear_states(plant.places, plant.of_state, moving_axes(model), SpinStands::last);
  return sorted_eigenvalues(plant.of_state(states, states));
}

Eigenvalues sampled_poles(const Model& model) {
  if (!model.rig || !model.rig->sampled || !feeds_back(model.rig->sampled->law.kind)) return {};
  const LinearPoint home = home_point();
  const PlantDerivatives plant = plant_derivatives(model, home, Heave::left_out);
  std::vector<int> states;
  return poles_of_period(SampledCycle(cycle_parts(plant, *model.rig, home, states)).map().a);
}

int growing(const Eigenvalues& poles) {
  return static_cast<int>(
      std::ranges::count_if(poles, [](const auto& pole) { return pole.real() > 0; }));
}

bool stable(const Eigenvalues& poles) {
  return std::ranges::all_of(poles, [](const auto& pole) { return pole.real() < 0; });
}

int growing_by_period(const Eigenvalues& poles) {
  return static_cast<int>(std::ranges::count_if(
      poles, [](const auto& pole) { return std::abs(pole) > 1 + 4 * epsilon; }));
}

bool stable_by_period(const Eigenvalues& poles) {
  return std::ranges::all_of(poles,
                             [](const auto& pole) { return std::abs(pole) < 1 - 4 * epsilon; });
}

}  // namespace bbsim::model
