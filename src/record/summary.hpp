// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The summary of a run, as JSON and as attributes of an HDF5 file.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/maxima.hpp"
#include "file/table_writer.hpp"
#include "model/sample.hpp"
#include "solve/outcome.hpp"

namespace bbsim::record {

// The greatest loads of the two motors over the run and their times (s). The motors carry the ball,
// and the plate if its inertia is known.
struct MotorPeaks {
  Peak torque_phi, torque_theta;  // N m
  Peak power;                     // W
  bool with_plate = false;
};

// An expectation about a measure (--expect), and the value found.
struct ExpectationRecord {
  std::string text;
  double value = 0;
  bool holds = false;
};

// A column or measure without a reliable derivative by a key (--sensitivity).
struct UnreliableRecord {
  std::string key, column;
  double time = 0;  // of the column's first unreliable row, s; NaN for a measure
};

struct RunSummary {
  std::string version;
  std::string instruction_set;  // of the kernels, such as avx2
  std::string scenario;         // its file, as the user named it
  std::string scenario_text;    // that file's content, for JSON only
  std::string title;
  std::vector<std::string> overrides;  // each "key.path=value"
  std::string status;                  // done, failed, interrupted or stopped
  std::string reason;                  // why the run ended early; empty if it did not
  std::string reason_code = "none";    // the reason in a word: solve::name_of()
  std::vector<std::string> warnings;   // possible mistakes of the user, one sentence each
  double end_time = 0;                 // the time reached, s
  std::size_t rows = 0;
  std::string output;                    // file, "-" for standard output
  std::vector<std::string> states;       // names of the integrated states
  std::vector<std::string> model_notes;  // on modeling, with reasons, one sentence each
  std::string method;
  double rtol = 0, atol = 0;
  std::vector<model::Occurrence> events;
  // The results of --measure, by name.
  using Numbers = std::vector<std::pair<std::string, double>>;
  Numbers measures;
  // With --sensitivity: derivatives of each of these measures by keys.
  std::vector<std::pair<std::string, Numbers>> gradients;
  std::optional<std::vector<UnreliableRecord>> unreliable;
  std::vector<ExpectationRecord> expectations;
  std::optional<MotorPeaks> peaks;  // if a column needs forces, or with plate.inertia
  // With solver.error only: the requested bound and the estimate reached, m.
  std::optional<double> error_bound, error_estimate;
  struct Statistics : solve::Statistics {
    double cpu_seconds = 0;  // of the integration
  } statistics;
};

// A JSON object with the members' names as keys, indented, ended by a newline. Doubles read back
// bit for bit; those that are not finite are null. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string to_json(const RunSummary& summary);

// The same names and values as attributes, and `scenario_text`. Names of `statistics` have no
// prefix. Numbers are numbers, and lists have one entry per line. `output` and `cpu_seconds` are
// left out, because they differ between equal runs.
[[nodiscard]] file::Attributes to_attributes(const RunSummary& summary,
                                             const std::string& scenario_text);

// A member of JSON as an attribute: a text, a number, or the lines of a list.
[[nodiscard]] file::AttributeValue attribute_of(const nlohmann::ordered_json& value);

}  // namespace bbsim::record
