// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of one scenario at different values of its keys, which advance one sample at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/stepped_run.hpp"
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
  // Restarts runs `which`. Throws InputError.
  void begin(std::span<const std::size_t> which, std::span<const Beginning> how);
  // Applies two commands to each flagged run that is not over, and advances it to its next sample.
  // Throws InputError for commands that are not finite; then no run has moved.
  void step(std::span<const double> commands, std::span<const bool> which);

  // Present sample of each run, or the last if it is over; row-major, count() x columns().
  [[nodiscard]] const std::vector<double>& observations() const { return observations_; }
  // terminated(): ended early, by an event or a failure. truncated(): ended at time.end.
  [[nodiscard]] bool terminated(std::size_t which) const;
  [[nodiscard]] bool truncated(std::size_t which) const;
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
    std::vector<Pair> commands;            // so far, in a lane
    std::unique_ptr<SteppedRun> repeated;  // for a run in a lane that is over
  };

  [[nodiscard]] Scenario scenario_of(const Beginning& beginning) const;
  [[nodiscard]] bool put_into_lane(std::size_t which, const Scenario& scenario);
  [[nodiscard]] std::unique_ptr<SteppedRun> repeat(const Run& run) const;
  void step_lanes(std::size_t of_group, std::span<const double> commands,
                  std::span<const bool> which);
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
