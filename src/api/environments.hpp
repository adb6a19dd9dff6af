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

namespace bbsim::api {

// A column of an observation.
struct ObservationColumn {
  std::string_view name, unit, meaning;
};

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

  // Begins run `which` anew, with a value for each key. A sensor or sampling that draws is given
  // `seed`. Throws InputError.
  void begin(std::size_t which, std::span<const std::string> values, std::size_t seed);
  // Gives run `which` its commands, and goes to its next sample; nothing if the run is over.
  void step(std::size_t which, Pair command);

  // Row-major, count() x columns(): of each run's present sample; of one that is over, the last.
  [[nodiscard]] const std::vector<double>& observations() const { return observations_; }
  // The run ended before time.end, by an event or a failure; at time.end.
  [[nodiscard]] bool terminated(std::size_t which) const;
  [[nodiscard]] bool truncated(std::size_t which) const;
  [[nodiscard]] const SteppedRun* run(std::size_t which) const { return runs_[which].get(); }

 private:
  void observe(std::size_t which);

  ScenarioFamily family_;
  Scenario scenario_;
  std::vector<std::string> keys_;
  bool keeps_rows_;
  std::vector<std::unique_ptr<SteppedRun>> runs_;
  std::vector<double> observations_;
};

}  // namespace bbsim::api
