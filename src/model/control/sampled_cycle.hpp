// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A cycle of a sampled loop as a linear map.
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

// Zero-order hold: z after `time` (s) under a constant u, z(time) = A z + B u. By the exponential
// of [A, B; 0, 0]: Van Loan, IEEE Trans. Automatic Control 23 (1978).
[[nodiscard]] LinearPlant zero_order_hold(const LinearPlant& plant, double time);

// Parts of a sampled loop. The first states of the plant are x, y, x', y', the servos' angles and
// their rates; others may follow.
struct CycleParts {
  int servos = 2;
  Eigen::MatrixXd a, b;
  // Jump of the states when a servo's rate jumps by 1 rad/s: one column per servo. A first-order
  // servo takes its new rate at once and kicks the ball.
  Eigen::MatrixXd jump;
  // With a mechanism between servos and plane: phi, theta and their rates as the controller infers
  // them from the plant's states; and what the servos receive of a command.
  Eigen::MatrixXd fed{}, servo_commands{};
  // Derivatives of the law's commands: by the position, velocity, angles, rates and integrals fed
  // back, two each; and by the reference's values, rates and accelerations.
  Eigen::Matrix<double, 2, 10> of_feedback = Eigen::Matrix<double, 2, 10>::Zero();
  Eigen::Matrix<double, 2, 6> of_reference = Eigen::Matrix<double, 2, 6>::Zero();
  Sampling sampling;  // with the nominal period
  Sensor sensor;      // exposes for each sample, unless it has frames of a known cycle
  Eigen::Matrix2d of_integral = Eigen::Matrix2d::Zero();  // rates of the integral parts, by e
  std::optional<double> time_constant[most_servos]{};     // of first-order servos, s
};

// The map of a cycle with n states, and the effect of a reference (its values, rates and
// accelerations, two of each) and of commands that stay constant throughout.
struct SampledMap {
  Eigen::MatrixXd a;             // n x n
  Eigen::MatrixXd of_reference;  // n x 6
  Eigen::MatrixXd of_command;    // n x 2; 0 if the loop is closed
  // 2 x n, at the sample that begins the cycle: what it sees, m, and the law's commands.
  Eigen::MatrixXd seen, law;
};

// A sampled loop, linear, from a sample until the pattern of samples and frames repeats: to the
// next sample, without frames or with one for each (common_cycle()). Its states in order: the
// plant's; measurements still needed; the controller's position and velocity; the commands'
// integral parts, if the law has them; commands not yet applied; the held command, if the cycle
// begins with it.
class SampledCycle {
 public:
  // Samples that see a sensor's frames at different ages make a cycle of several samples. Under
  // `of_equal_age` each sample gets its own frame, so one system describes all samples.
  enum class Frames { as_they_are, of_equal_age };
  // About a point, from the plant there and the rig's sampled controller.
  SampledCycle(const PlantDerivatives& plant, const Rig& rig, const LinearPoint& at, Frames frames);

  [[nodiscard]] int size() const;
  // Signals of the states.
  [[nodiscard]] std::vector<LinearSignal> signals(const std::string& command_unit) const;
  // Place and number of the controller's own states, from the position on.
  [[nodiscard]] int controller_at() const;
  [[nodiscard]] int controller_size() const;

  // The map with closed loops; an open loop takes its command from outside.
  [[nodiscard]] SampledMap map(bool phi_open = false, bool theta_open = false) const;

 private:
  enum class Act { expose, sample, apply, end };
  struct Step {
    std::size_t way;  // motion up to the act, among `ways_`; 0: none
    Act act;
  };
  // For several states at once: one column each.
  using Pairs = Eigen::Matrix<double, 2, Eigen::Dynamic>;
  struct Parts;
  struct Inputs;
  [[nodiscard]] Parts unpacked(const Eigen::MatrixXd& states) const;
  [[nodiscard]] Eigen::MatrixXd packed(Parts& parts) const;
  // Calls use(rows) for the parts in the order of the states.
  template <class Use>
  void for_each_part(Parts& of, Use use) const;
  void plan();
  Pairs sample(Parts& of, const Inputs& inputs) const;  // returns the law's commands
  void expose(Parts& of) const;
  void apply(Parts& of) const;

  CycleParts parts_;
  StatePlaces places_;
  std::vector<int> states_;                   // of the plant, by index
  std::vector<Eigen::Index> integrating_;     // commands with an integral part
  bool begins_held_ = false;                  // whether the cycle begins with a held command
  std::size_t exposures_ = 0, commands_ = 0;  // in the queues at the cycle's start
  std::vector<Step> steps_;
  std::vector<LinearPlant> ways_;
  // How many exposures are dropped before each sample, and at the cycle's end.
  std::vector<int> skipped_;
  int skipped_last_ = 0;
};

}  // namespace bbsim::model
