// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Exact derivatives of a model near a point: the plant, the control law and the closed loop, by
// dual numbers through the model itself. All linear results start here: LQR gains, poles, `check`
// and `linearize`.
//
// Units are SI. Commands are those of phi and theta, in rad, rad/s^2, N m or V depending on what
// the controller drives. With push rods and measured curves they are servo angles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "model/control/law.hpp"
#include "model/control/linear_system.hpp"
#include "model/model.hpp"

namespace bbsim::model {

// The point at which a model is differentiated.
struct LinearPoint {
  // In the order of RigLoop<true>, or of the model's CoupledLoop. Missing states at the end are
  // zero.
  std::vector<double> state = std::vector<double>(RigLoop<true>::size);
  double time = 0;     // for the push on the ball, s
  Pair command{0, 0};  // for a given motion its accelerations, rad/s^2
  std::array<Jet<double>, 2> reference{};
  bool home = false;  // all are zero, and the plane is level, whatever its offsets
};

[[nodiscard]] LinearPoint home_point();

// Why a scene has no linear equations, as with dry friction; empty if it has. require_linear()
// throws the reason as an InputError.
[[nodiscard]] std::string why_not_linear(const Scenario& scene);
void require_linear(const Scenario& scene);

// The point of rest. The plane is level, or tilted against a push on the ball. The ball is where
// the controller leads it under the reference of t = 0, or at its start without a controller.
// Newton's method over positions, angles and integrals together. Throws InputError if there is no
// such point, or if the law's command would exceed its limit.
[[nodiscard]] LinearPoint equilibrium(const Scenario& scene);

// Three servos also raise and lower the plate. About home they are alike, and without that heave
// they act like two ideal servos of phi and theta.
enum class Heave { kept, left_out };

// Places of the states that not all models have.
struct StatePlaces {
  int servos;           // two or three; their angles follow the spin, then their rates
  int integral, motor;  // integrals of the law and of the motors' position loops: two each
  bool motor_integrates;
};
inline constexpr int spin_state = 4;  // after x, y and their rates
inline constexpr const char* spin_name = "r*spin";

// Effect of n states and two commands on the states' rates, whatever moves the gimbal. Leaves out
// the law, limits, dead band, backlash and everything dry. A given motion has the gimbal's
// accelerations as its commands.
struct PlantDerivatives {
  StatePlaces places;
  Eigen::VectorXd state, rates;  // n, at the point
  Eigen::MatrixXd of_state;      // n x n
  Eigen::MatrixXd of_command;    // n x 2
  // n x servos: jump of the states when a servo's rate jumps by 1 rad/s, as a first-order servo's
  // does. It kicks the ball.
  Eigen::MatrixXd kick;
  // For a controller that knows only servo angles. `believed`, 4 x n: its phi, theta and their
  // rates. `servo_commands`, servos x 2: what servos receive of a law's command. Empty if servos
  // turn the plane directly.
  Eigen::MatrixXd believed, servo_commands;
  // At the point, for a model with a controller: as its sensor and servos report it.
  Feedback<double> fed{};
};
[[nodiscard]] PlantDerivatives plant_derivatives(const Model& model, const LinearPoint& at,
                                                 Heave heave = Heave::kept);

// Derivatives of a continuous loop: of the rates by states and reference, and of the law's commands
// by states. Columns of the reference: values, rates and accelerations, two of each.
struct LoopDerivatives {
  StatePlaces places;
  Eigen::MatrixXd of_state;          // n x n
  Eigen::MatrixXd of_reference;      // n x 6
  Eigen::MatrixXd command_of_state;  // 2 x n
};
[[nodiscard]] LoopDerivatives loop_derivatives(const Model& model, const LinearPoint& at,
                                               Heave heave = Heave::kept);

// u = of_feedback (position, velocity, angles, rates, integrals) + of_reference (values, rates,
// accelerations), two of each, as deviations from the point.
struct LawDerivatives {
  Eigen::Matrix<double, 2, 10> of_feedback = Eigen::Matrix<double, 2, 10>::Zero();
  Eigen::Matrix<double, 2, 6> of_reference = Eigen::Matrix<double, 2, 6>::Zero();
};
// Without limits. Not for feedback linearization, which needs the plant's equations. Zero for a
// held command.
[[nodiscard]] LawDerivatives law_derivatives(const ControlLaw& law, const Feedback<double>& at,
                                             const std::array<Jet<double>, 2>& reference);

// Indices of the states in a linear system of these axes (0: x and phi; 1: y and theta): positions,
// velocities, angles, rates, a motor's integrals. The spin is one of them if it acts on another,
// after the velocities or last.
enum class SpinStands { after_velocities, last };
[[nodiscard]] std::vector<int> linear_states(const StatePlaces& places,
                                             const Eigen::MatrixXd& of_state,
                                             const std::vector<int>& axes, SpinStands spin);
// For a closed loop: the spin after the velocities, and those integrals of the law that change.
[[nodiscard]] std::vector<int> loop_states(const LoopDerivatives& loop,
                                           const std::vector<int>& axes);
// The axes that move; symmetry may leave one out.
[[nodiscard]] std::vector<int> moving_axes(const Model& model);
// Names and units of these states.
[[nodiscard]] std::vector<LinearSignal> state_signals(const StatePlaces& places,
                                                      const std::string& command_unit,
                                                      const std::vector<int>& states);
// The signals with these indices.
[[nodiscard]] std::vector<LinearSignal> signals_of(const std::vector<LinearSignal>& all,
                                                   const std::vector<int>& indices);

// The plant for LQR gains: about home, with the states x, y, x', y', phi, theta, phi', theta', then
// a motor's two integrals.
[[nodiscard]] LinearPlant plant_at_home(const RigLoop<true>& loop);
[[nodiscard]] LinearPlant plant_at_home(const CoupledLoop<>& loop);

// A sensor's reading of a position, as a matrix without its offset.
[[nodiscard]] Eigen::Matrix2d seen_matrix(const Sensor& sensor);

}  // namespace bbsim::model
