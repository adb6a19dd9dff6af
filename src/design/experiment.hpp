// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The information in a motion's log about keys of a scenario.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "design/limits.hpp"
#include "design/motion.hpp"
#include "fit/data.hpp"
#include "fit/free_key.hpp"
#include "fit/window_run.hpp"
#include "scenario/family.hpp"

namespace bbsim::design {

struct Task {
  const ScenarioFamily& family;  // has a placeholder as its motion or reference
  Plays plays = Plays::tilts;
  std::array<bool, 2> axes{true, true};  // that may move; in a groove, only one
  std::vector<fit::FreeKey> keys{};
  std::vector<const scenario::Column*> columns{};  // of the log
  std::vector<double> noise{};                     // standard deviation of each, SI
  std::optional<double> window{};                  // s; a default of fits if empty
  double length = 0, rate = 0;                     // of the log, s and Hz
  Limits limits{};
  std::size_t threads = 0;  // 0: as many as there are processors
  std::function<void(double fraction, const std::string& detail)> progress{};
  const std::atomic<bool>* stop = nullptr;

  [[nodiscard]] bool is_stopped() const {
    return stop != nullptr && stop->load(std::memory_order_relaxed);
  }
};

class Experiment {
 public:
  explicit Experiment(const Task& task);

  // The use of the limits; empty if the run does not reach its end.
  [[nodiscard]] std::optional<Use> use(const Motion& motion) const;
  // The motion at the largest scale that keeps the limits; empty if none does.
  struct Scaled {
    Motion motion;
    double scale;
  };
  [[nodiscard]] std::optional<Scaled> within_limits(Motion shape) const;
  // Fisher information about the keys' numbers u, if the start of each window is unknown: the
  // inverse of their least covariance.
  struct Information {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd effects;  // of each key on the log with known starts, in noise units
    std::size_t windows = 0, numbers = 0;
  };
  [[nodiscard]] Information information(const Motion& motion) const;

  // The same for a family of the scenario that reads the motion from tables.
  [[nodiscard]] std::optional<Use> use(const ScenarioFamily& family) const;
  [[nodiscard]] Information information(const ScenarioFamily& family) const;

  [[nodiscard]] const std::array<TableChange, 2>& nominal() const { return nominal_; }

 private:
  using Adapt = std::function<void(Scenario&)>;

  [[nodiscard]] Adapt playing(const Motion& motion) const;
  [[nodiscard]] Adapt as_it_is() const;
  // Returns the adapted scenario, with each key set to its starting value.
  [[nodiscard]] Scenario scene(const ScenarioFamily& family, const Adapt& adapt) const;
  [[nodiscard]] std::optional<Use> use(const ScenarioFamily& family, const Adapt& adapt) const;
  [[nodiscard]] Information information(const ScenarioFamily& family, const Adapt& adapt) const;

  const Task& task_;
  std::array<TableChange, 2> nominal_;
  fit::Log log_;  // without values
  bool dead_band_is_free_ = false;
};

}  // namespace bbsim::design
