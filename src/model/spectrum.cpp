// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/control/derivatives.hpp"
#include "model/control/sampled_cycle.hpp"
#include "model/eigenvalues.hpp"
#include "model/systems/list.hpp"

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
    Eigen::MatrixXd perturbed = matrix;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        // Arbitrary, unrelated numbers between -1 and 1.
        const double part = std::sin(static_cast<double>(way * (1 + 37 * i + 101 * j)));
        perturbed(i, j) += matrix(i, j) * rounding * part;
      }
    }
    Eigenvalues values = exact_eigenvalues(perturbed);
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
  if (std::ranges::all_of(values,
                          [&](const auto& value) { return std::abs(value.real()) > doubtful; }))
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
        values, [&](const auto& value) { return std::abs(std::abs(value) - 1) < distance; });
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

std::vector<int> states_of(const std::vector<LinearSignal>& signals, int axis) {
  const auto begins = [axis](const std::string& name) {
    return axis == 0 ? name.starts_with("x") || name.starts_with("vx") || name.starts_with("phi")
                     : name.starts_with("y") || name.starts_with("vy") || name.starts_with("theta");
  };
  std::vector<int> states;
  for (int i = 0; i < std::ssize(signals); ++i) {
    if (begins(signals[static_cast<std::size_t>(i)].name)) states.push_back(i);
  }
  return states;
}

std::vector<int> others_than(const std::vector<int>& states, Eigen::Index count) {
  std::vector<int> others;
  for (int i = 0; i < count; ++i) {
    if (std::ranges::find(states, i) == states.end()) others.push_back(i);
  }
  return others;
}

LinearLoop sampled_loop(const Model& model) {
  const LinearPoint home = home_point();
  const SampledCycle cycle(plant_derivatives(model, home, Heave::left_out), *model.rig, home,
                           SampledCycle::Frames::as_they_are);
  const SampledMap map = cycle.map();
  return {cycle.signals(""), map.a, map.law};
}

LinearLoop continuous_loop(const Model& model) {
  const LoopDerivatives of = loop_derivatives(model, home_point());
  const std::vector<int> states = loop_states(of, moving_axes(model));
  return {state_signals(of.places, "", states), of.of_state(states, states),
          of.command_of_state(Eigen::all, states)};
}

bool is_sampled(const Model& model) {
  return model.rig && model.rig->sampled && feeds_back(model.rig->sampled->law.kind);
}

bool is_continuous(const Model& model) {
  return std::visit([](const auto& system) { return has_loop(system); }, model.system);
}

// Whether a reference leads the ball along an axis.
bool is_led(const Model& model, int axis) {
  return std::visit(
      [axis](const auto& system) {
        if constexpr (requires { system.reference().is_zero(0); }) {
          return !system.reference().is_zero(static_cast<std::size_t>(axis));
        }
        return true;
      },
      model.system);
}

Eigen::MatrixXd without_idle(const Model& model, const LinearLoop& loop) {
  const std::optional<int> idle = idle_axis(model, loop);
  if (!idle) return loop.a;
  const std::vector<int> kept = states_without(loop.states, idle);
  return loop.a(kept, kept);
}

}  // namespace

bool stands_apart(const LinearLoop& loop, int axis) {
  const std::vector<int> own = states_of(loop.states, axis),
                         others = others_than(own, loop.a.rows());
  return loop.law.row(axis).isZero(0) && !own.empty() && !others.empty() &&
         loop.a(own, others).isZero(0) && loop.a(others, own).isZero(0);
}

std::optional<int> idle_axis(const Model& model, const LinearLoop& loop) {
  if (!model.closed_loop()) return {};
  const auto is_idle = [&](int axis) { return !is_led(model, axis) && stands_apart(loop, axis); };
  const bool x = is_idle(0), y = is_idle(1);
  if (x == y) return {};
  return x ? 0 : 1;
}

std::optional<int> idle_axis(const Model& model) {
  if (is_sampled(model)) return idle_axis(model, sampled_loop(model));
  if (is_continuous(model)) return idle_axis(model, continuous_loop(model));
  return {};
}

std::vector<int> states_without(const std::vector<LinearSignal>& states, std::optional<int> axis) {
  return others_than(axis ? states_of(states, *axis) : std::vector<int>{}, std::ssize(states));
}

Eigenvalues closed_loop_poles(const Model& model) {
  if (!is_continuous(model)) return {};
  return sorted_eigenvalues(without_idle(model, continuous_loop(model)));
}

Eigenvalues plant_poles(const Model& model) {
  const PlantDerivatives plant = plant_derivatives(model, home_point(), Heave::left_out);
  const std::vector<int> states =
      linear_states(plant.places, plant.of_state, moving_axes(model), SpinStands::last);
  return sorted_eigenvalues(plant.of_state(states, states));
}

Eigenvalues sampled_poles(const Model& model) {
  if (!is_sampled(model)) return {};
  return poles_of_period(without_idle(model, sampled_loop(model)));
}

int growing(const Eigenvalues& poles, bool by_period) {
  return static_cast<int>(std::ranges::count_if(poles, [=](const auto& pole) {
    return by_period ? std::abs(pole) > 1 + 4 * epsilon : pole.real() > 0;
  }));
}

bool stable(const Eigenvalues& poles, bool by_period) {
  return std::ranges::all_of(poles, [=](const auto& pole) {
    return by_period ? std::abs(pole) < 1 - 4 * epsilon : pole.real() < 0;
  });
}

}  // namespace bbsim::model
