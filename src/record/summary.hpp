// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a run was and how it went: as JSON, and as attributes of an HDF5 file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/greatest.hpp"
#include "file/table_writer.hpp"
#include "model/events/occurrence.hpp"

namespace bbsim::record {

// Something that was watched for and happened: where the ball was, and the gimbal.
struct EventRecord {
  double t = 0;  // s
  std::string name, action;
  double x = 0, y = 0, vx = 0, vy = 0, spin = 0;            // m, m/s, rad/s
  double phi = 0, theta = 0, phi_rate = 0, theta_rate = 0;  // rad, rad/s
};

[[nodiscard]] EventRecord event_record(const model::Occurrence& occurrence);

// The largest sizes over the run of what the two motors give to carry the ball, and the plate if
// its inertia is known, and when (s).
struct MotorPeaks {
  Peak torque_phi, torque_theta;  // N m
  Peak power;                     // W
  bool with_plate = false;
};

// What was expected of a measure (--expect), and what it came to.
struct ExpectationRecord {
  std::string text;
  double value = 0;
  bool holds = false;
};

struct RunSummary {
  std::string version;
  std::string instruction_set;  // that the kernels are for, such as avx2
  std::string scenario;         // its file, as the user named it
  std::string scenario_text;    // that file's content; in JSON only, attributes get it apart
  std::string title;
  std::vector<std::string> overrides;  // each "key.path=value"
  std::string status;                  // done, failed, interrupted or stopped
  std::string reason;                  // why the run ended early; empty if it did not
  std::string reason_code = "none";    // the same in a word: solve::name_of()
  std::vector<std::string> warnings;   // what may not be as the user meant it, one sentence each
  double end_time = 0;                 // what the run reached, s
  std::size_t rows = 0;
  std::string output;                    // file, "-" for standard output
  std::vector<std::string> states;       // names of the integrated states
  std::vector<std::string> model_notes;  // what is modelled and why, one sentence each
  std::string method;
  double rtol = 0, atol = 0;
  std::vector<EventRecord> events;
  // What was measured (--measure), by name.
  std::vector<std::pair<std::string, double>> measures;
  std::vector<ExpectationRecord> expectations;
  std::optional<MotorPeaks> peaks;  // where a column needs the forces, or with plate.inertia
  // A run with solver.error has these: the bound asked for and the estimate reached, m.
  std::optional<double> error_bound, error_estimate;
  struct {
    std::size_t steps = 0, rhs_evaluations = 0, jacobian_evaluations = 0;
    std::size_t nonlinear_iterations = 0, error_test_failures = 0;
    double cpu_seconds = 0;
  } statistics;
};

// An object with the members' names as keys, indented, ended by a newline. Doubles read back to
// the bit, those that are not finite are null. Bytes that are no UTF-8 are replaced by U+FFFD.
[[nodiscard]] std::string to_json(const RunSummary& summary);

// Writes to_json() whole or not at all; "-" is standard output. Throws OutputError.
void write_summary(const std::string& file, const RunSummary& summary);

// Attributes have the same names, those of `statistics` without a prefix, and `scenario_text`;
// numbers are numbers, and lists have one entry a line. Left out are what differs between runs that
// are alike: `output` and `cpu_seconds`.
[[nodiscard]] file::Attributes to_attributes(const RunSummary& summary,
                                             const std::string& scenario_text);

}  // namespace bbsim::record
