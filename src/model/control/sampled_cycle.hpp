// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a sampled loop does in a period, as a linear map.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/control/derivatives.hpp"
#include "model/control/linear_system.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// z after `time` (s) under a constant u: z(time) = A z + B u. By the exponential of [A, B; 0, 0]:
// Van Loan, IEEE Trans. Automatic Control 23 (1978).
[[nodiscard]] LinearPlant zero_order_hold(const LinearPlant& plant, double time);

// What a sampled loop is made of, about any point. The first states of the plant are x, y, x', y',
// the servos' angles and their rates; others may follow.
struct CycleParts {
  int servos = 2;
  Eigen::MatrixXd a, b;
  // What the states get when a servo's rate jumps by 1 rad/s: a column of each. A servo of first
  // order takes its new rate at once, and kicks the ball.
  Eigen::MatrixXd jump;
  // Where servos are not of phi and theta: what the controller takes their states for, phi, theta
  // and their rates, of the plant's states; and what servos are told of a command.
  Eigen::MatrixXd fed{}, told{};
  // The law's commands: of the position, velocity, angles, rates and integrals fed back, two each;
  // and of the reference's values, rates and accelerations.
  Eigen::Matrix<double, 2, 10> of_feedback = Eigen::Matrix<double, 2, 10>::Zero();
  Eigen::Matrix<double, 2, 6> of_reference = Eigen::Matrix<double, 2, 6>::Zero();
  Sampling sampling;  // whose period is the nominal one
  Sensor sensor;      // which looks for each sample where it has no frames of a known cycle
  Eigen::Matrix2d of_integral = Eigen::Matrix2d::Zero();  // rates of the integral parts, of e
  std::optional<double> time_constant[most_servos]{};     // of servos of first order, s
};

// About a point: of the plant there, and of the rig's sampled controller. `states` gets the numbers
// of the plant's states that the cycle has.
[[nodiscard]] CycleParts cycle_parts(const PlantDerivatives& plant, const Rig& rig,
                                     const LinearPoint& at, std::vector<int>& states);

// A cycle with n states: what it makes of them, and of a reference (its values, rates and
// accelerations, two of each) and commands that stay the same throughout.
struct SampledMap {
  Eigen::MatrixXd a;             // n x n
  Eigen::MatrixXd of_reference;  // n x 6
  Eigen::MatrixXd of_command;    // n x 2; 0 where the loop is closed
  // 2 x n: what the sample at the cycle's start sees of the states, m, and what the law says then.
  Eigen::MatrixXd seen, law;
};

// What a sampled loop does from a sample on, linear, until samples and frames meet again: to the
// next sample, if there are no frames, or one for each (common_cycle.hpp). Of its state, in this
// order: the plant's; what was seen and is not yet done with; the position and velocity that the
// controller has; the commands' integral parts, if the law has them; the commands not yet applied;
// the command that is held, if the cycle begins with it.
class SampledCycle {
 public:
  explicit SampledCycle(CycleParts parts);

  [[nodiscard]] int size() const;
  // How many periods of the samples it takes.
  [[nodiscard]] int samples() const { return static_cast<int>(skipped_.size()); }
  // Of the states after the plant's.
  [[nodiscard]] std::vector<LinearSignal> memory(const std::string& command_unit) const;
  // Where among the states the controller's own are: from the position on, so many.
  [[nodiscard]] int controller_at() const;
  [[nodiscard]] int controller_size() const;

  // With the loops of the commands closed; an open one takes its command from outside.
  [[nodiscard]] SampledMap map(bool phi_open = false, bool theta_open = false) const;

 private:
  enum class Act { expose, sample, apply, end };
  struct Step {
    std::size_t way;  // until then, among `ways_`; 0: none
    Act act;
  };
  // Of several states at once: a column each.
  using Pairs = Eigen::Matrix<double, 2, Eigen::Dynamic>;
  struct Parts;
  struct Inputs;
  [[nodiscard]] Parts unpacked(const Eigen::MatrixXd& states) const;
  [[nodiscard]] Eigen::MatrixXd packed(const Parts& parts) const;
  void plan();
  Pairs sample(Parts& of, const Inputs& inputs) const;  // returns what the law says
  void expose(Parts& of) const;
  void apply(Parts& of) const;

  CycleParts parts_;
  std::vector<Eigen::Index> integrating_;     // the commands with an integral part
  bool begins_held_ = false;                  // with a command, for a part of its first period
  std::size_t exposures_ = 0, commands_ = 0;  // in the queues at the cycle's start
  std::vector<Step> steps_;
  std::vector<LinearPlant> ways_;
  // How many exposures are done with before each sample, and at the cycle's end.
  std::vector<int> skipped_;
  int skipped_last_ = 0;
};

}  // namespace bbsim::model
