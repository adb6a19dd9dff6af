// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The content of a replay, as plain data from any source; the sizes of plate and ball in its
// picture, and the ball's rotation.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/quaternion.hpp"
#include "file/table.hpp"
#include "results/result.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::replay {

// A number that the text of a scenario has: its slider.
struct LiveKey {
  std::string key, text;              // controller.pd.kp, and its value as the text has it
  std::string unit;                   // of numbers in SI; may be empty
  double value = 0;                   // SI
  std::optional<double> least, most;  // the range of allowed values, SI; empty: unbounded
  bool open = false;                  // `least` itself is not allowed
  bool whole = false;                 // without fractions
  std::string meaning;                // one phrase; may be empty
};

// What a live page shows beside its run: numbers to change, measures, tasks.
struct Live {
  struct Task {
    std::string text, expect;  // as in `exercise`
    bool holds = false;
  };
  struct Measure {
    std::string name, unit;
    double value = 0;
  };
  // The open loop of each command over the frequency, with the other one closed.
  struct Loops {
    struct Curve {
      std::string command;
      std::vector<double> gain, phase;  // rad
    };
    std::optional<double> period;  // s, of a sampled loop
    std::vector<double> frequencies;
    std::vector<Curve> curves;
    std::string margins;  // JSON, as `bbsim linearize` writes it
    bool stable = false;
  };
  std::vector<LiveKey> keys;      // in the order of their names
  std::vector<std::string> free;  // keys that a learner may change; empty: all
  std::vector<Task> tasks;
  std::vector<Measure> measures;
  std::optional<Loops> loops;  // of a loop that bbsim can linearize
};

// Poles of the loop about home: in 1/s for a continuous loop, in the z plane for a sampled one.
// `period` is that of the sampled loop, s.
struct Poles {
  std::vector<std::complex<double>> values;
  std::optional<double> period{};
};

// A run, or the log of a rig: columns of numbers, NaN where missing, with a unit ("1" if
// dimensionless). It needs only the columns t and x or y. If x or y is missing, the ball stays on
// the other axis. Its scenario is the one that describes it.
struct Run : results::Result {
  std::string name;  // its file, which identifies it
  // Rotations from the ball's frame to the plane's, one for each row. If empty, orientation_of()
  // derives them from the columns.
  std::vector<Quaternion> orientation{};
  // Whether the path determines the ball's rotation. It does not if the ball may slide, or if that
  // is unknown.
  bool rolls = true;
  std::vector<std::array<double, 2>> reference{};  // points of the whole path, plane frame
  std::vector<std::string> check{};                // the lines of `bbsim check`
  std::optional<Poles> poles{};
};

// A column of a sweep's table: numbers, or texts like those of solver.method.
struct SweepColumn : file::Column {
  bool drawn = false;   // the values of a key are random
  std::string along{};  // the first key to which this one is tied
};

// Many runs of one scene. All columns have one row for each case.
struct Sweep {
  std::string name, title;
  std::vector<SweepColumn> keys, measures;
  std::vector<double> cases;        // their numbers
  std::vector<std::string> status;  // "done", or why a case ended early
  Source source;                    // of the scenario, with the overrides of all cases
};

struct Scene {
  std::string title;
  std::vector<Run> runs;  // the first one leads; the others are its ghosts
  std::vector<Sweep> sweeps;
  std::optional<Live> live{};  // of a page that can run its scenario again
  std::string version;         // of the bbsim that makes the page
};

// The number of rows in column t.
[[nodiscard]] std::size_t row_count(const Run& run);

// The number of rows in the run's file: without an end row that is not from the file.
[[nodiscard]] std::size_t rows_of_file(const Run& run);

// The radius of the run's ball, m; empty if it is unknown.
[[nodiscard]] std::optional<double> ball_radius(const Run& run);

// Column x or y; zeros if the run does not have it.
[[nodiscard]] std::vector<double> coordinate(const Run& run, std::string_view name);

// Throws InputError if a scene cannot be shown: it is empty, a run has no t, neither x nor y or no
// rows, columns differ in length, or times do not increase.
void check_scene(const Scene& scene);

// The page draws with floats, which cannot hold the square of a larger distance.
inline constexpr double largest_drawn = 1e15;  // m

struct Stage {
  double width = 0, depth = 0;  // of the plate along x and y, m
  bool round = false;
  bool plate_given = false;  // otherwise it fits the paths
  double ball_radius = 0;    // of the leading run, m; a thirtieth of the plate if it is unknown
};

// The stage for all runs of the scene. The first run with a plate defines the plate. Otherwise the
// plate fits all paths and references that are drawn; if these stay on an axis, it is a beam.
[[nodiscard]] Stage stage_of(const Scene& scene);

// Orientations of a rolling ball in the plane's frame, with the identity in the first row. Between
// two rows the ball rolls straight and pivots evenly, by the rotation (-dy/r, dx/r, dgamma). The
// error is of second order in the distance of rows; a run's integrated rotation is better. A null
// `gamma` means no pivoting. Rows with a value that is not finite repeat the last orientation.
[[nodiscard]] std::vector<Quaternion> rolled(const std::vector<double>& x,
                                             const std::vector<double>& y,
                                             const std::vector<double>* gamma, double radius);

// The recorded orientations of the run, if it has them. Otherwise rolled() with this radius, the
// pivoting of gamma or spin, and the slip of columns slip_x and slip_y; the error of the slip is of
// second order in the distance of rows. Empty if the columns do not determine the rotation.
[[nodiscard]] std::vector<Quaternion> orientation_of(const Run& run, double radius);

}  // namespace bbsim::replay
