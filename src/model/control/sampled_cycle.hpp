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

// z and u after `time` (s) under a constant command: z(time) = a z + b u.
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

// What a sampled loop does from a sample on, linear, until samples and frames meet again: to the
// next sample, if there are no frames, or one for each (common_cycle.hpp). Of its state, in this
// order: the plant's; what was seen and is not yet done with; the position and velocity that the
// controller has; the commands' integral parts, if the law has them; the commands not yet applied;
// the command that is held, if the cycle begins with it.
class SampledCycle {
 public:
  explicit SampledCycle(CycleParts parts);

  struct Input {
    Eigen::Matrix<double, 6, 1> reference = Eigen::Matrix<double, 6, 1>::Zero();
    // Where the loop is open, this is commanded in place of what the law says.
    bool open[2]{false, false};
    Eigen::Vector2d command = Eigen::Vector2d::Zero();
  };
  struct Output {
    Eigen::VectorXd state;  // a cycle later
    Eigen::Vector2d seen;   // by the sample at the cycle's start, m
    Eigen::Vector2d law;    // what the law says then
  };
  [[nodiscard]] Output run(const Eigen::VectorXd& state, const Input& input) const;

  [[nodiscard]] int size() const;
  // How many periods of the samples it takes.
  [[nodiscard]] int samples() const { return static_cast<int>(skipped_.size()); }
  // Of the states after the plant's.
  [[nodiscard]] std::vector<LinearSignal> memory(const std::string& command_unit) const;
  // Where among the states the controller's own are: from the position on, so many.
  [[nodiscard]] int controller_at() const;
  [[nodiscard]] int controller_size() const;

  // What a cycle does to the state, the loop closed.
  [[nodiscard]] Eigen::MatrixXd map() const;

 private:
  enum class Act { expose, sample, apply, end };
  struct Step {
    std::size_t way;  // until then, among `ways_`; 0: none
    Act act;
  };
  // Of several states at once: a column each.
  struct Parts;
  struct Outputs;
  [[nodiscard]] Outputs run_all(const Eigen::MatrixXd& states, const Input& input) const;
  [[nodiscard]] Parts unpacked(const Eigen::MatrixXd& states) const;
  [[nodiscard]] Eigen::MatrixXd packed(const Parts& parts) const;
  void plan();
  void sample(Parts& of, const Input& input, Outputs& output) const;
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
