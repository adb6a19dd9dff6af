// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A switching scene's part in the derivatives of a run by keys: the jumps of S = dz/dp, and the
// derivatives of a row's extras.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "model/hybrid/hybrid_system.hpp"

namespace bbsim::study {

// An instant at which something is due or may have switched: the run after it, and the states
// (m, rad, s) with their rates before and after it.
struct SwitchInstant {
  const model::HybridSystem& run;
  double t;
  const Eigen::VectorXd &before, &rates_before, &after, &rates_after;
};

class Switches {
 public:
  virtual ~Switches() = default;

  virtual void begin_run() = 0;
  // Takes S, one column per key, across the instant. Returns how far each key moves the time of its
  // switch. Throws InputError if there is no derivative.
  [[nodiscard]] virtual Eigen::VectorXd pass(const SwitchInstant& now, Eigen::MatrixXd& slopes) = 0;
  // The derivatives of a row's extras by key k. `slope` has those of the states z.
  [[nodiscard]] virtual Eigen::VectorXd extras(std::size_t k, double t, const Eigen::VectorXd& z,
                                               const Eigen::VectorXd& slope) const = 0;
};

}  // namespace bbsim::study
