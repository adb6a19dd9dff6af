// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The values of keys, such as gains, that are best on the worst of many rigs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "scenario/expectation.hpp"
#include "scenario/family.hpp"

namespace bbsim::api {

struct TuneRequest {
  const ScenarioFamily& family;
  std::vector<std::string> free;       // KEY=FROM:TO; KEY may be several tied keys
  std::string minimize;                // a measure
  std::vector<std::string> require{};  // MEASURE < VALUE
  std::vector<std::string> vary{};     // KEY=SPEC, as in a sweep; none: one rig
  std::optional<double> samples{};     // rigs to draw
  std::optional<double> hold_out{};    // further ones, on which the result is tried
  double quantile = 1;                 // the share of rigs that counts
  std::size_t threads = 0;             // 0: as many as there are processors
};

struct Tuned {
  struct Parameter {
    std::string key, unit;  // SI; no unit: a number
    double before, value, from, to;
  };
  struct Requirement {
    scenario::Expectation expectation;
    double before, value;  // on the worst rig that counts; perhaps not finite
    bool holds;
  };
  std::vector<Parameter> parameters;
  scenario::Measure minimized;
  double before = 0, objective = 0;  // on the worst rig that counts; perhaps infinite
  std::vector<Requirement> requirements;
  std::size_t rigs = 0, tried = 0;
  // Fresh rigs, and the share of these on which all requirements hold, if there are any.
  std::size_t held_out = 0;
  double share_that_holds = 0;
};

struct TuneResult {
  // ended_early: a requirement does not hold, or no value of the measure is finite; interrupted:
  // with what was best until then.
  ExitCode code = ExitCode::done;
  std::string reason;          // of a code other than done
  std::optional<Tuned> tuned;  // nothing if it was interrupted before anything was known
  std::string text, json;      // a report
  std::string scenario;        // its text with the values in it
};

// Throws InputError. The tuned scenario's text is made only if it is asked for.
[[nodiscard]] TuneResult tune(const TuneRequest& request, bool with_scenario, Watch& watch);

}  // namespace bbsim::api
