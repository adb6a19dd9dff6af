// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Search for values of keys, such as gains, that are best on the worst of many rigs.
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
  std::vector<std::string> vary{};     // KEY=SPEC, as in a sweep; empty: one rig
  std::optional<double> samples{};     // number of rigs to draw
  std::optional<double> hold_out{};    // number of fresh rigs that test the result
  double quantile = 1;                 // share of rigs that counts
  std::size_t threads = 0;             // 0: as many as processors
};

struct Tuned {
  struct Parameter {
    std::string key, unit;  // SI; no unit: a number
    double before, value, from, to;
  };
  struct Requirement {
    scenario::Expectation expectation;
    double before, value;  // on the worst rig that counts; may be infinite or NaN
    bool holds;
  };
  std::vector<Parameter> parameters;
  scenario::Measure minimized;
  double before = 0, objective = 0;  // on the worst rig that counts; may be infinite
  std::vector<Requirement> requirements;
  std::size_t rigs = 0, tried = 0;
  // Number of fresh rigs, and the share of them on which all requirements hold.
  std::size_t held_out = 0;
  double share_that_holds = 0;
};

struct TuneResult {
  // ended_early: a requirement does not hold, or the measure is never finite; interrupted: with the
  // best result so far.
  ExitCode code = ExitCode::done;
  std::string reason;          // for codes other than done
  std::optional<Tuned> tuned;  // empty if interrupted before any result
  std::string text, json;      // a report
  std::string scenario;        // text with the tuned values
};

// Throws InputError. Makes the tuned scenario's text only on request.
[[nodiscard]] TuneResult tune(const TuneRequest& request, bool with_scenario, Watch& watch);

}  // namespace bbsim::api
