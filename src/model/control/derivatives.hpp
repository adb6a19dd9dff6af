// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A model near a point: the plant, the control law and the closed loop, differentiated exactly, by
// dual numbers through the model itself. Everything that is linear in bbsim starts here: LQR gains,
// poles, `check` and `linearize`.
//
// Units are SI. Commands are those of phi and theta, in rad, rad/s^2, N m or V by what the
// controller drives; behind push rods and measured curves they are the servos'.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "model/control/law.hpp"
#include "model/control/linear_system.hpp"
#include "model/model.hpp"

namespace bbsim::model {

// Where a model is differentiated.
struct LinearPoint {
  // In the order of RigLoop<true>, or of the CoupledLoop that the model is. States beyond its end
  // are zero.
  std::vector<double> state = std::vector<double>(RigLoop<true>::size);
  double time = 0;     // of the push on the ball, s
  Pair command{0, 0};  // a given motion's are its accelerations, rad/s^2
  std::array<Jet<double>, 2> reference{};
  bool home = false;  // all are zero, and the plane is level there, whatever its offsets
};

[[nodiscard]] LinearPoint home_point();

// Why a scene has no linear equations, of which dry friction has none; empty if it has. The other
// one throws that as an InputError.
[[nodiscard]] std::string why_not_linear(const Scenario& scene);
void require_linear(const Scenario& scene);

// At rest: the plane level, or as a push on the ball asks for; the ball where the controller leads
// it under the reference of t = 0, or without a controller where it starts. Method: Newton's, over
// positions, angles and integrals together. Throws InputError if there is no such point, or if the
// law's command would be beyond its limit.
[[nodiscard]] LinearPoint equilibrium(const Scenario& scene);

// Three servos raise and lower the plate too. About home they are alike, and without that heave do
// what two ideal servos of phi and theta do.
enum class Heave { kept, left_out };

// Where states stand that not all models have.
struct StatePlaces {
  int servos;           // two or three; their angles stand after the spin, then their rates
  int integral, motor;  // the law's integrals, and those of the motors' position loops: two each
  bool motor_integrates;
};
inline constexpr int spin_state = 4;  // after x, y and their rates
inline constexpr const char* spin_name = "r*spin";

// What n states and the two commands do to the states' rates, whatever moves the gimbal: the law is
// left out, and so are limits, dead band, backlash and everything dry. A gimbal with a given motion
// is commanded by its accelerations.
struct PlantDerivatives {
  StatePlaces places;
  Eigen::VectorXd state, rates;  // n, at the point
  Eigen::MatrixXd of_state;      // n x n
  Eigen::MatrixXd of_command;    // n x 2
  // n x servos: by how much states jump when a servo's rate jumps by 1 rad/s, as one of first order
  // does. It kicks the ball.
  Eigen::MatrixXd kick;
  // For a controller that knows servos' angles only: 4 x n, what it takes them for, phi, theta and
  // their rates; and servos x 2, what they are told of a law's command. Empty where nothing stands
  // between the servos and the plane.
  Eigen::MatrixXd believed, told;
  // At the point, of a model with a controller: as its sensor and the servos tell it.
  Feedback<double> fed{};
};
[[nodiscard]] PlantDerivatives plant_derivatives(const Model& model, const LinearPoint& at,
                                                 Heave heave = Heave::kept);

// Of a loop in continuous time: what states and reference add to the rates, and states to the law's
// commands. Columns of a reference: its values, rates and accelerations, two of each.
struct LoopDerivatives {
  StatePlaces places;
  Eigen::MatrixXd of_state;          // n x n
  Eigen::MatrixXd of_reference;      // n x 6
  Eigen::MatrixXd command_of_state;  // 2 x n
};
[[nodiscard]] LoopDerivatives loop_derivatives(const Model& model, const LinearPoint& at,
                                               Heave heave = Heave::kept);

// u = of_feedback (position, velocity, angles, rates, integrals) + of_reference (values, rates,
// accelerations), two of each; as deviations from the point.
struct LawDerivatives {
  Eigen::Matrix<double, 2, 10> of_feedback = Eigen::Matrix<double, 2, 10>::Zero();
  Eigen::Matrix<double, 2, 6> of_reference = Eigen::Matrix<double, 2, 6>::Zero();
};
// Without limits. Not for feedback linearization, which asks for the plant's equations; a held
// command depends on nothing.
[[nodiscard]] LawDerivatives law_derivatives(const ControlLaw& law, const Feedback<double>& at,
                                             const std::array<Jet<double>, 2>& reference);

// The numbers of the states that a linear system of these axes (0: x and phi; 1: y and theta) has:
// positions, velocities, angles, rates, integrals of a motor; and, where it acts on another, the
// spin, after the velocities or last.
enum class SpinStands { after_velocities, last };
[[nodiscard]] std::vector<int> linear_states(const StatePlaces& places,
                                             const Eigen::MatrixXd& of_state,
                                             const std::vector<int>& axes, SpinStands spin);
// Those of a closed loop: the spin after the velocities, and the law's integrals that ever change.
[[nodiscard]] std::vector<int> loop_states(const LoopDerivatives& loop,
                                           const std::vector<int>& axes);
// The axes that move: symmetry may leave one out.
[[nodiscard]] std::vector<int> moving_axes(const Model& model);
// The names and units of all states, in their order.
[[nodiscard]] std::vector<LinearSignal> state_signals(const StatePlaces& places,
                                                      const std::string& command_unit);

// What LQR gains are of: the plant about home, with x, y, x', y', phi, theta, phi', theta' for its
// states, and a motor's two integrals after them.
[[nodiscard]] LinearPlant plant_at_home(const RigLoop<true>& loop);
[[nodiscard]] LinearPlant plant_at_home(const CoupledLoop<>& loop);

// What a sensor says of a position, as a matrix; without its offset.
[[nodiscard]] Eigen::Matrix2d seen_matrix(const Sensor& sensor);

}  // namespace bbsim::model
