// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a replay shows: plain data, from wherever it came.
//
// Frames as in docs/explanation/model.md, (M15): the plane's frame is turned from the world's
// by R = R_x(base_tilt) R_y(phi) R_z(skew) R_x(theta) R_z(yaw - skew), about the gimbal's centre.
// SI units and radians.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/quaternion.hpp"

namespace bbsim::replay {

struct Series {
  std::string name, unit, meaning;  // as in `bbsim columns`; unit "1" if dimensionless
  std::vector<double> values;       // one a row; NaN where there is none
};

// Something that happened: "edge" at 0.54 s, which stopped the run.
struct Event {
  double t = 0;
  std::string name, action;  // action: stop or note
  double x = 0, y = 0;       // the contact point, plane frame
};

// A rectangle or a disc about the plane's origin.
struct Plate {
  std::optional<std::array<double, 2>> size{};  // along x and y
  std::optional<double> diameter{};
};

struct Mounting {
  double height = 0;  // of the plane of contact above the gimbal's centre
  double skew = 0, yaw = 0, base_tilt = 0;
};

// Poles of the loop about home: of a continuous one in 1/s, of a sampled one those of a period.
struct Poles {
  std::vector<std::complex<double>> values;
  std::optional<double> period{};
};

// A run, or the log of a rig. Only the columns t and x or y have to be there: without the other,
// the ball stays on its axis.
struct Run {
  std::string name;                 // what tells it from other runs: its file
  std::string title;                // of its scenario
  std::string status, reason;       // done, failed, interrupted or stopped; why, if it ended early
  double end = 0;                   // time that was asked for; 0 if it is not known
  std::optional<double> reached{};  // when it ended, s, which may be after its last row
  // Whether the last row is none of its file, but the instant at which an event stopped the run.
  bool has_end_row = false;
  bool units_known = true;  // else columns without a unit are in whatever it is
  std::vector<Series> columns;
  // Rotations from the ball's own frame to the plane's, one a row. Where it is empty,
  // orientation_of() says what the columns tell.
  std::vector<Quaternion> orientation;
  // Whether its way tells how the ball turns: not if it may slide, or if nobody knows.
  bool rolls = true;
  std::vector<Event> events;
  Plate plate;
  std::optional<double> ball_radius{};
  Mounting mounting;
  std::vector<std::array<double, 2>> reference;  // points of the whole path, plane frame
  std::optional<double> friction{};              // coefficient that friction_demand is held against
  std::string scenario_file, scenario_text;
  std::vector<std::string> overrides;  // each "key.path=value"
  std::string summary;                 // JSON, as `run --summary` writes it; empty: unknown
  std::vector<std::string> check;      // what `bbsim check` prints, line by line
  std::optional<Poles> poles{};
  std::string version;  // of the bbsim that ran it
};

// One column of a sweep's table: numbers, or words such as solver.method's.
struct SweepColumn {
  std::string name, unit;
  std::vector<double> values;
  std::vector<std::string> words;  // instead of values
  bool drawn = false;              // a key's values are by chance
  std::string along{};             // the first key with which this one's values always go

  [[nodiscard]] std::size_t rows() const { return words.empty() ? values.size() : words.size(); }
};

// Many runs of one scene. All columns have one row a case.
struct Sweep {
  std::string name, title;
  std::vector<SweepColumn> keys, measures;
  std::vector<double> cases;        // their numbers
  std::vector<std::string> status;  // "done", or why a case ended early
  std::string scenario_file, scenario_text;
  std::vector<std::string> overrides;  // that held for all cases
};

struct Scene {
  std::string title;
  std::vector<Run> runs;  // the first one leads; the others are its ghosts
  std::vector<Sweep> sweeps;
  std::string version;  // of the bbsim that makes the page
};

// The column of that name, or nullptr.
[[nodiscard]] const Series* find_series(const Run& run, std::string_view name);

// The number of rows in its column t.
[[nodiscard]] std::size_t row_count(const Run& run);

// The same, of its file: without the row that is its end.
[[nodiscard]] std::size_t rows_of_file(const Run& run);

// Its column x or y; zeros where it has none.
[[nodiscard]] std::vector<double> coordinate(const Run& run, std::string_view name);

// Throws InputError where a scene cannot be shown: nothing in it, a run without t, without x and y
// or without rows, columns of different lengths, times that do not increase.
void check_scene(const Scene& scene);

}  // namespace bbsim::replay
