// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of one scenario at different values of its keys, which advance one sample at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/stepped_run.hpp"
#include "model/model.hpp"
#include "scenario/family.hpp"
#include "solve/sampled/stepped_lanes.hpp"

namespace bbsim::api {

// Column of an observation.
struct ObservationColumn {
  std::string_view name, unit, meaning;
};

// Rigs that SIMD lanes can carry run in lanes if there are enough runs and nobody wants their rows.
// Each other run is a SteppedRun.
class Environments {
 public:
  // `keys` are set at each begin(). `keeps_rows`: results have the rows of output.columns. Throws
  // InputError if the controller takes no samples.
  Environments(ScenarioFamily family, std::size_t count, std::vector<std::string> keys,
               bool keeps_rows);

  [[nodiscard]] static std::span<const ObservationColumn> columns();
  [[nodiscard]] std::size_t count() const { return runs_.size(); }
  // Scenario without settings.
  [[nodiscard]] const Scenario& scenario() const { return scenario_; }

  // Start of a run: a value for each key, and the seed of a sensor or sampling that draws.
  struct Beginning {
    std::vector<std::string> values;
    std::size_t seed = 0;
  };
  // Restarts runs `which`. Throws InputError; then no run has changed.
  void begin(std::span<const std::size_t> which, std::span<const Beginning> how);
  // Restarts runs `which`. Applies two commands to each other run that is not over, and advances it
  // to its next sample, or to its end at the sample at time.end, whose commands would move nothing.
  // Throws InputError, also for commands that are not finite; then no run has changed.
  void step(std::span<const double> commands, std::span<const std::size_t> which,
            std::span<const Beginning> how);

  // Present sample of each run, or the last if it is over; row-major, count() x columns().
  [[nodiscard]] const std::vector<double>& observations() const { return observations_; }
  // terminated(): ended early, by an event or a failure. truncated(): ended at time.end.
  [[nodiscard]] bool terminated(std::size_t which) const;
  [[nodiscard]] bool truncated(std::size_t which) const;
  // For a run that was terminated: the squared distance from the reference, summed over its last
  // step and those that were left, of a ball as far away as the plate allows, or as it was if that
  // is farther, m^2. Otherwise 0.
  [[nodiscard]] double cost_of_ending(std::size_t which) const;
  // Result of a run that is over, else null. A run in a lane is repeated for it.
  [[nodiscard]] const RunResult* result(std::size_t which);
  // Number of runs in lanes.
  [[nodiscard]] std::size_t in_lanes() const;

 private:
  using Lanes = solve::sampled::SteppedLanes;
  static constexpr std::size_t group = solve::sampled::group;

  struct Run {
    std::unique_ptr<SteppedRun> alone;  // null in a lane
    Beginning beginning;
    double end = 0, period = 0;            // s
    double farthest = 0;                   // squared distance from the reference, m^2
    std::size_t steps = 0;                 // so far
    std::vector<Pair> commands;            // so far, in a lane
    std::unique_ptr<SteppedRun> repeated;  // for a run in a lane that is over
  };
  // A run that can begin without a fault.
  struct Ready {
    Run run;
    std::optional<model::Model> model;  // for a lane
  };

  [[nodiscard]] Scenario scenario_of(const Beginning& beginning) const;
  [[nodiscard]] Ready prepare(std::size_t which, const Beginning& beginning) const;
  [[nodiscard]] std::vector<Ready> prepare(std::span<const std::size_t> which,
                                           std::span<const Beginning> how) const;
  void begin(std::span<const std::size_t> which, std::vector<Ready> ready);
  [[nodiscard]] std::optional<model::Model> model_for_lane(const Scenario& scenario) const;
  [[nodiscard]] std::unique_ptr<SteppedRun> repeat(const Run& run) const;
  void step_lanes(std::size_t of_group, std::span<const double> commands,
                  std::span<const char> moves);
  // Gives a single run at its last sample, at time.end, the command that ends it.
  static void end_at_last_sample(const Run& run, const Pair& command);
  [[nodiscard]] Lanes::State lane_state(std::size_t which) const;
  [[nodiscard]] bool is_over(std::size_t which) const;
  void observe(std::size_t which);

  ScenarioFamily family_;
  Scenario scenario_;
  std::vector<std::string> keys_;
  bool keeps_rows_;
  std::vector<Run> runs_;
  std::vector<std::unique_ptr<Lanes>> lanes_;  // each of `group` runs; empty without lanes
  std::vector<double> observations_;
};

}  // namespace bbsim::api
