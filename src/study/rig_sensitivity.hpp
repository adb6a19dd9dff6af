// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sampled rig's part in the derivatives of a run by keys (docs/explanation/sensitivity.md): those
// of the measurements, of the controller's memory and of pending commands, and the jumps of S where
// the motion switches.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <deque>
#include <vector>

#include "model/hybrid/hybrid_system.hpp"
#include "simd/gradient.hpp"
#include "study/neighbors.hpp"
#include "study/switches.hpp"

namespace bbsim::study {

class RigSensitivity : public Switches {
 public:
  // Throws InputError if a part of the rig has no derivatives.
  static void require_smooth_parts(const model::Model& model);
  // Reference values at t that the right-hand side does not contain; empty for rigs without
  // samples.
  [[nodiscard]] static Eigen::VectorXd reference(const model::Model& model, double t);

  // `model` and `keys` must outlive this object, which puts the run's present mode into the models
  // of `keys`. Throws InputError for a key that acts on rounding, noise or decisions only.
  RigSensitivity(const model::Model& model, std::vector<Neighbors>& keys);

  void begin_run() override;
  // Refuses runs in which a servo reaches its stop, or a first-order servo its rate limit.
  [[nodiscard]] Eigen::VectorXd pass(const SwitchInstant& now, Eigen::MatrixXd& slopes) override;
  [[nodiscard]] Eigen::VectorXd extras(std::size_t k, double t, const Eigen::VectorXd& z,
                                       const Eigen::VectorXd& slope) const override;

 private:
  // A number and its derivative by one key.
  using Moving = simd::WithGradient<1>;
  enum class Clock { exposure, sample, command };

  struct Key {
    model::SampledLaw<Moving> law;
    double period = 0;                      // derivative of the nominal period
    std::vector<model::SampleTimes> times;  // of each neighboring model
  };
  // A measurement; `slopes` has one column per key.
  struct Seen {
    double at = 0;  // s
    Eigen::MatrixXd slopes;
  };

  struct Moved {
    double value, slope;
  };

  [[nodiscard]] static double time_of(const model::SampledLoop& loop, model::SampleTimes& times,
                                      Clock clock, double number);
  [[nodiscard]] double move(std::size_t k, Clock clock, double number);
  void expose(const SwitchInstant& now, const Eigen::MatrixXd& slopes);
  void sample(const SwitchInstant& now, const Eigen::MatrixXd& slopes);
  void compute(std::size_t k, const SwitchInstant& now, const Eigen::MatrixXd& slopes);
  [[nodiscard]] std::array<Moved, 4> servo_numbers(std::size_t k, const SwitchInstant& now,
                                                   const Eigen::VectorXd& moves) const;
  void take_command(const model::RigMode& mode);
  void require_away_from_stops(const SwitchInstant& now, const model::RigMode& mode) const;
  [[nodiscard]] Eigen::VectorXd moves_at_rate_limit(const SwitchInstant& now,
                                                    const model::RigMode& mode,
                                                    const Eigen::MatrixXd& slopes) const;
  void turn_first_order(std::size_t k, const SwitchInstant& now, const model::RigMode& mode,
                        Eigen::Ref<Eigen::VectorXd> slope) const;
  void put(const model::RigMode& mode);

  const model::Model& model_;
  const model::SampledLoop& loop_;
  std::vector<Neighbors>& keys_;
  int servos_;
  Eigen::Index first_rate_;  // of the servos, among the states
  std::vector<Key> by_key_;
  // Values at the last instant.
  model::RigMode mode_;
  model::SampleExchange::Numbers numbers_{};
  model::SampleTimes times_;
  model::SinceSeen since_;
  model::SampledMemory<double> memory_{};
  // Derivatives, one column per key: of the memory, of the last command, of the command that acts,
  // and of those that the servos follow.
  Eigen::MatrixXd memory_slopes_, command_slopes_, wanted_slopes_, followed_slopes_;
  Seen last_seen_;
  std::deque<Seen> seen_;                 // exposed, not yet sampled
  std::deque<Eigen::MatrixXd> commands_;  // computed, not yet applied
};

}  // namespace bbsim::study
