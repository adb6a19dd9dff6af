// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The derivatives of a run by keys where it switches without samples: friction that begins or ends,
// limits of servos and motors, stops, backlash (docs/explanation/sensitivity.md).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "study/neighbors.hpp"
#include "study/switches.hpp"

namespace bbsim::study {

// Beside the run, a HybridSystem for each neighboring value of each key goes through the same
// switches. At each switch it starts from the run's state, moved along S, and finds its own time of
// the switch. The differences between them give the jump of S, which so has the derivatives of
// guard and reset map in it: the saltation matrix and its extension by keys.
class EventSensitivity : public Switches {
 public:
  // Of the usual step of a key: near enough that states moved along S stay close to the run's.
  static constexpr double step_share = 0x1p-11;

  // `model` and `keys` must outlive this, which puts the present mode into the models of `keys`.
  EventSensitivity(const model::Model& model, std::vector<Neighbors>& keys)
      : model_(model), keys_(keys), last_mode_(model.system) {}

  void begin_run() override;
  [[nodiscard]] Eigen::VectorXd pass(const Instant& now, Eigen::MatrixXd& slopes) override;
  [[nodiscard]] Eigen::VectorXd extras(std::size_t k, double t, const Eigen::VectorXd& z,
                                       const Eigen::VectorXd& slope) const override;

  // What a system beside is after the switches of an instant.
  struct Passed {
    double later = 0;       // than the run, s
    Eigen::VectorXd moved;  // the states at the run's time, after the switch
    Eigen::VectorXd rates;  // after it
  };

 private:
  using Beside = std::vector<std::unique_ptr<model::HybridSystem>>;

  void make_systems(const model::HybridSystem& run);
  void note_alignment(const Instant& now);
  [[nodiscard]] std::vector<Passed> pass_beside(
      std::size_t k, const Instant& now, std::span<const model::HybridSystem::Switch> switches,
      bool at_rest, const Eigen::Ref<const Eigen::VectorXd>& slope);
  [[nodiscard]] double jump(std::size_t k, const Instant& now, const std::vector<Passed>& passed,
                            Eigen::Ref<Eigen::VectorXd> slope) const;

  const model::Model& model_;
  std::vector<Neighbors>& keys_;
  std::vector<Beside> beside_;  // of each key, for each of its neighbors
  model::System last_mode_;     // the run's before the present instant
  // How S turns into the direction of a velocity near rest; set while that direction is held.
  std::optional<Eigen::MatrixXd> alignment_;
  std::size_t passed_ = 0;  // switches of the run
};

}  // namespace bbsim::study
