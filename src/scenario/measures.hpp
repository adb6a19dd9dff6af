// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is kept of a run: one number of a column over the run.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/columns.hpp"
#include "scenario/window.hpp"

namespace bbsim::scenario {

// What python-control's step_info() tells of a response, by its names (RiseTime). A response is a
// step from y_0, the column's value at the start, to y_f, what its reference is worth at the end;
// without a reference, to its own value there. Of d = y_f - y_0, the distance, which is not 0:
//   rise_time           from the first time at y_0 + 0.1 d to the first at y_0 + 0.9 d, s
//   settling_time       from the start to the time after which it stays within 0.02 |d| of y_f, s
//   settling_min, _max  the column's least and greatest value from the first time at y_0 + 0.9 d on
//   overshoot           how far it goes beyond y_f, % of d
//   undershoot          how far it goes to the other side of y_0, % of d
//   peak, peak_time     the size of its value where it is farthest from y_0; s from the start
//   steady_state_value  its value at the end
// From y_0 = 0 and without a reference these are step_info()'s. Of a distance of 0 they are no
// numbers.
enum class StepMetric {
  rise_time,
  settling_time,
  settling_min,
  settling_max,
  overshoot,
  undershoot,
  peak,
  peak_time,
  steady_state_value
};

// An instant of a run, as of SPICE's .measure.
struct Instant {
  enum class Kind {
    crosses,      // the column passes through the level
    stays_below,  // it is below the level after that, to the end; at the level it is not
    stays_above,
    at  // a time that is given
  } kind = Kind::crosses;
  enum class Way { either, rise, fall } way = Way::either;
  std::size_t number = 1;          // which crossing, from 1; 0: the last one
  const Column* column = nullptr;  // null of a time
  double level = 0;                // in the column's unit; or the time, s
};

struct Measure {
  // least, greatest: over the continuous motion, both sides of every switch included; rms: the root
  // of the mean square over the rows; end: at the last instant reached, the row at time.end or
  // where the scene stopped; step: see StepMetric; when: the time of an instant; find: the column's
  // value there. All but rms and end are of the continuous motion.
  enum class Kind { least, greatest, rms, end, step, when, find } kind = Kind::end;
  const Column* column = nullptr;  // of `when`: the one that is looked at
  std::string name;                // max_tilt, end_phi, x_end, x.RiseTime, when x=0.05 rise=1
  StepMetric metric = StepMetric::rise_time;
  Instant instant{};
  // Of step: where the column is meant to go, if there is such a column; a scene or a file may have
  // no value for it.
  const Column* reference = nullptr;
  Window window{};            // what the measure calls the run is this part of it
  std::string window_text{};  // as given: "from 5 s"

  [[nodiscard]] std::string meaning() const;
  [[nodiscard]] std::string unit() const;
};

// A measure's name:
//   min_, max_, rms_ or end_ and the name of a column; x_end and y_end are end_x and end_y
//   COLUMN.RiseTime, or another of python-control's names
//   when COLUMN=VALUE [rise=N|fall=N|cross=N], N from 1 or last; without, its first crossing
//   when COLUMN stays below VALUE, when COLUMN stays above VALUE
//   find COLUMN when ..., find COLUMN at TIME
//   any of these and "from TIME", "to TIME" or both: of that part of the run
// A VALUE may have a unit of the column's dimension: "5 cm". The name that comes back has numbers
// in SI instead, but for those of the window.
[[nodiscard]] std::optional<Measure> find_measure(std::string_view name);

// The same of columns that `find` knows: those of a stored file.
using FindColumn = std::function<const Column*(std::string_view name)>;
[[nodiscard]] std::optional<Measure> find_measure(std::string_view name, const FindColumn& find);

// Parts of a list at its commas.
[[nodiscard]] std::vector<std::string> split_measures(const std::vector<std::string>& lists);

// For the message about a name that is none: " (did you mean x.RiseTime?)", by the columns that
// there are, or nothing; and what is allowed.
[[nodiscard]] std::string measure_hint(std::string_view name,
                                       std::span<const std::string_view> columns);
[[nodiscard]] std::string measure_hint(std::string_view name);  // of a scenario
[[nodiscard]] std::string allowed_measures();

// The measure of that name, which the scene has the columns and the time for. Throws InputError,
// which begins with `where`, that the name comes from.
[[nodiscard]] Measure measure_named(std::string_view where, const std::string& name,
                                    const Scenario& scenario);

// The measures of these names, each given once, which the scene has the columns and the time for.
// Throws InputError.
[[nodiscard]] std::vector<Measure> measures_named(const std::vector<std::string>& names,
                                                  const Scenario& scenario);

// Throws InputError where two have one name.
void require_once(const std::vector<Measure>& measures);

// x_end, y_end, max_tilt, max_tilt_rate, max_distance, and with a controller rms_tracking_error and
// max_tracking_error.
[[nodiscard]] std::vector<std::string> default_measures(bool closed_loop);

// The columns of those that are taken at the end, in their order.
[[nodiscard]] std::vector<const Column*> end_columns(const std::vector<Measure>& measures);

// What the columns of these measures are computed from.
[[nodiscard]] bool any_needs(const std::vector<Measure>& measures, Needs what);

// Why the scene cannot fill a column of the measure, or does not come to its window.
[[nodiscard]] Missing missing(const Measure& measure, const Scenario& scenario);

// Why a measure has no number, as far as whoever takes it knows; null if it has one.
using Whys = std::vector<const char*>;

// Each of the measures that is no finite number, with the reason why: that in `whys`, which is
// empty if nothing is known. Empty if all are.
[[nodiscard]] std::string why_not_finite(const std::vector<Measure>& measures,
                                         const double* results, const Whys& whys);

}  // namespace bbsim::scenario
