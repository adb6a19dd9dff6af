// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What linearise() is made of: the right-hand side and the law, differentiated about a point.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/control/linearise.hpp"
#include "model/control/sampled_cycle.hpp"
#include "simd/gradient.hpp"

namespace bbsim::model {

// The ball's spin among the states, of systems that have it: after x, y and their rates.
inline constexpr int spin_state = 4;
inline constexpr const char* spin_name = "r*spin";

// Of the gimbal and the ball without a controller's law: rates at a point, and what states and the
// gimbal's commands add to them.
struct PlantDerivatives {
  Eigen::VectorXd rates;
  Eigen::MatrixXd of_state, of_command;
};

// Of a loop in continuous time: what states and reference add to the rates, and states to the
// commands. The reference's values, rates and accelerations, two of each.
struct LoopDerivatives {
  Eigen::MatrixXd of_state, of_reference, command_of_state;
};

// A number that knows how a loop's states and six more variables change it. Where there are fewer
// it is all the same: compilers take ten seconds over right-hand sides with another number.
inline constexpr int most_states = 19;
using Varied = simd::WithGradient<most_states + 6>;

// From rates whose variables are states, then commands, and whatever follows.
template <int n>
[[nodiscard]] PlantDerivatives plant_derivatives(const Varied (&rates)[n]) {
  static_assert(n <= most_states);
  return {simd::values(rates), simd::gradients(rates, 0, n), simd::gradients(rates, n, 2)};
}

// The same with a reference, and of the commands.
template <int n>
[[nodiscard]] LoopDerivatives loop_derivatives(const Varied (&rates)[n],
                                               const Varied (&commands)[2]) {
  static_assert(n <= most_states);
  return {simd::gradients(rates, 0, n), simd::gradients(rates, n, 6),
          simd::gradients(commands, 0, n)};
}

// A reference whose values, rates and accelerations are variables from number `first` on.
template <class Number>
[[nodiscard]] std::array<Jet<Number>, 2> varied(const std::array<Jet<double>, 2>& reference,
                                                int first) {
  std::array<Jet<Number>, 2> jets;
  for (std::size_t i = 0; i < 2; ++i) {
    const int number = first + static_cast<int>(i);
    jets[i] = {Number::variable(reference[i].value, number),
               Number::variable(reference[i].rate, number + 2),
               Number::variable(reference[i].acceleration, number + 4)};
  }
  return jets;
}

// What a law that hands on its reference, u = reference - position, makes such commands of:
// variables from number `first` on.
template <class Number>
[[nodiscard]] std::array<Jet<Number>, 2> reference_for(const Pair& command, const Number* position,
                                                       int first) {
  std::array<Jet<Number>, 2> jets;
  for (std::size_t i = 0; i < 2; ++i) {
    const Number wanted = Number::variable(command[i], first + static_cast<int>(i));
    jets[i] = {position[i] + wanted, Number(0.0), Number(0.0)};
  }
  return jets;
}

// Measured curves are of the pieces that hold at a point; levelled, where home is.
[[nodiscard]] Linkages linkages_at(const Between& between, const LinearPoint& at);

// What the law has to do with, at a point: what is fed back, as the controller knows it.
[[nodiscard]] Feedback<double> feedback_at(const Rig& rig, const LinearPoint& at);

// The law's commands are of angles of the plane, those of the plant of servos.
void link_controller(CycleParts& parts, const Linkages& link, const Rig& rig,
                     const LinearPoint& at);

// Scenes of systems/coupled.hpp (linear_coupled.cpp), whose states are those of a CoupledLoop; a
// gimbal that is given its motion is one of ideal linkages, whose accelerations are commanded. Of
// three servos the commands are phi and theta.
[[nodiscard]] PlantDerivatives coupled_plant_at(const Model& model, const LinearPoint& at);
[[nodiscard]] LoopDerivatives coupled_loop_at(const Model& model, const LinearPoint& at);
// `states`: which of them the cycle has.
[[nodiscard]] CycleParts coupled_cycle_at(const Model& model, const LinearPoint& at,
                                          std::vector<int>& states);
[[nodiscard]] LinearPoint coupled_equilibrium(const Scenario& scene, const Model& model);

// All states by name, and those that a plant and a continuous loop have: the spin where it acts on
// another, a motor's own integral where it has one. The integral parts of the law's commands are
// left to it.
[[nodiscard]] std::vector<LinearSignal> coupled_signals(const Model& model,
                                                        const std::string& command_unit);
[[nodiscard]] std::vector<int> coupled_states(const Model& model, const Eigen::MatrixXd& of_state);
// Where the integral parts of the law's commands are.
[[nodiscard]] int coupled_integral(const Model& model);

}  // namespace bbsim::model
