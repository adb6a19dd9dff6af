// What linearise() is made of: the right-hand side and the law, differentiated about a point.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/control/linearise.hpp"
#include "model/control/sampled_cycle.hpp"

namespace bbsim::model {

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
// another, a motor's own integral where it has one. Integrals of the law's error are left to it.
[[nodiscard]] std::vector<LinearSignal> coupled_signals(const Model& model);
[[nodiscard]] std::vector<int> coupled_states(const Model& model, const Eigen::MatrixXd& of_state);
// Where the integrals of the law's error are.
[[nodiscard]] int coupled_integral(const Model& model);

}  // namespace bbsim::model
