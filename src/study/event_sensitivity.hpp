// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The derivatives by keys of a run that switches without samples: friction that begins or ends,
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

// For each neighboring value of each key, a HybridSystem goes through the same switches as the run.
// At each switch it starts from the run's state, moved along S, and finds its own switching time.
// The differences between these systems give the jump of S. It includes the derivatives of guard
// and reset map: the saltation matrix and its extension by keys.
class EventSensitivity : public Switches {
 public:
  // Share of a key's usual step, small enough that states moved along S stay close to the run's.
  static constexpr double step_share = 0x1p-11;

  // `model` and `keys` must outlive this, which puts the present mode into the models of `keys`.
  EventSensitivity(const model::Model& model, std::vector<Neighbors>& keys)
      : model_(model), keys_(keys), last_mode_(model.system) {}

  void begin_run() override;
  [[nodiscard]] Eigen::VectorXd pass(const SwitchInstant& now, Eigen::MatrixXd& slopes) override;
  [[nodiscard]] Eigen::VectorXd extras(std::size_t k, double t, const Eigen::VectorXd& z,
                                       const Eigen::VectorXd& slope) const override;

  // A neighboring system after the switches of an instant.
  struct Passed {
    double later = 0;       // delay relative to the run, s
    Eigen::VectorXd moved;  // the states at the run's time, after the switch
    Eigen::VectorXd rates;  // after the switch
  };

 private:
  using Beside = std::vector<std::unique_ptr<model::HybridSystem>>;

  void make_systems(const model::HybridSystem& run);
  void note_alignment(const SwitchInstant& now);
  [[nodiscard]] std::vector<Passed> pass_beside(
      std::size_t k, const SwitchInstant& now,
      std::span<const model::HybridSystem::Switch> switches, bool at_rest,
      const Eigen::Ref<const Eigen::VectorXd>& slope);
  [[nodiscard]] double jump(std::size_t k, const SwitchInstant& now,
                            const std::vector<Passed>& passed,
                            Eigen::Ref<Eigen::VectorXd> slope) const;

  const model::Model& model_;
  std::vector<Neighbors>& keys_;
  std::vector<Beside> beside_;  // for each key, one system per neighbor
  model::System last_mode_;     // the run's, before the present instant
  // The projection of note_alignment(); set while a direction is held near rest.
  std::optional<Eigen::MatrixXd> alignment_;
  std::size_t passed_ = 0;  // switches of the run so far
};

}  // namespace bbsim::study
