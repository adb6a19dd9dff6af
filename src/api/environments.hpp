// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of one scenario at values of its keys that go on together, a sample at a time.
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

// A column of an observation.
struct ObservationColumn {
  std::string_view name, unit, meaning;
};

// Rigs that SIMD lanes can carry go in lanes, if there are enough runs and nobody wants their rows;
// all others are a SteppedRun each.
class Environments {
 public:
  // `keys` are set at each begin(). Runs that keep rows have those of output.columns in their
  // results. Throws InputError for a scenario whose controller takes no samples.
  Environments(ScenarioFamily family, std::size_t count, std::vector<std::string> keys,
               bool keeps_rows);

  [[nodiscard]] static std::span<const ObservationColumn> columns();
  [[nodiscard]] std::size_t count() const { return runs_.size(); }
  // The scenario without settings.
  [[nodiscard]] const Scenario& scenario() const { return scenario_; }

  // How a run begins: with a value for each key. A sensor or sampling that draws is given `seed`.
  struct Beginning {
    std::vector<std::string> values;
    std::size_t seed = 0;
  };
  // Begins runs `which` anew. Throws InputError.
  void begin(std::span<const std::size_t> which, std::span<const Beginning> how);
  // Gives each run that is flagged and not over its commands, two for each run, and goes to its
  // next sample. Throws InputError for commands that are not finite; no run has then moved.
  void step(std::span<const double> commands, std::span<const bool> which);

  // Row-major, count() x columns(): of each run's present sample; of one that is over, the last.
  [[nodiscard]] const std::vector<double>& observations() const { return observations_; }
  // The run ended before time.end, by an event or a failure; at time.end.
  [[nodiscard]] bool terminated(std::size_t which) const;
  [[nodiscard]] bool truncated(std::size_t which) const;
  // Of a run that is over; null if it is not. A run that went in a lane is run again for it.
  [[nodiscard]] const RunResult* result(std::size_t which);
  // The number of runs in lanes.
  [[nodiscard]] std::size_t in_lanes() const;

 private:
  using Lanes = solve::sampled::SteppedLanes;
  static constexpr std::size_t group = solve::sampled::group;

  struct Run {
    std::unique_ptr<SteppedRun> alone;  // null in a lane
    Beginning beginning;
    std::vector<Pair> commands;            // in a lane, so far
    std::unique_ptr<SteppedRun> repeated;  // of a run in a lane that is over
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
  std::vector<std::unique_ptr<Lanes>> lanes_;  // of `group` runs each; empty without lanes
  std::vector<double> observations_;
};

}  // namespace bbsim::api
