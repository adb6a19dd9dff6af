// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Design of the experiment that identifies keys of a scenario best.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "design/design.hpp"
#include "scenario/family.hpp"

namespace bbsim::api {

struct DesignRequest {
  const ScenarioFamily& family;
  std::vector<std::string> free;     // KEY or KEY=FROM:TO
  std::string length{};              // a time; empty: the scenario's
  std::optional<double> rate{};      // Hz; the sensor's, or 50
  std::vector<std::string> noise{};  // COLUMN=SIZE; the sensor's, or 1 mm
  std::string window{};              // a time; empty: as for a fit
  // Angle, rate and length; empty: the defaults of limits.hpp.
  std::string tilt{}, tilt_rate{}, margin{};
  std::string table = "designed.csv";  // relative to the designed scenario's folder
  std::size_t threads = 0;             // 0: as many as processors
};

struct DesignResult {
  ExitCode code = ExitCode::done;  // or interrupted
  design::Designed designed;
  std::string text, json;  // a report
  std::string scenario;    // plays the table
  std::string table;       // CSV
  std::string sketch;
};

struct DesignParts {
  bool scenario = false, sketch = false;
};

// Throws InputError. Makes the scenario's text and the sketch only on request.
[[nodiscard]] DesignResult design(const DesignRequest& request, DesignParts parts, Watch& watch);

}  // namespace bbsim::api
