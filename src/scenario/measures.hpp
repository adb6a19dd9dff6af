// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures of a run. A measure reduces a column over the run to one number, or describes the
// loop near home.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/columns.hpp"
#include "scenario/loop_measures.hpp"
#include "scenario/window.hpp"

namespace bbsim::scenario {

// The metrics of a step response, named as in python-control's step_info() (RiseTime). The step
// goes from y_0, the column's value at the start, to y_f, the final value of its reference. A
// column without a reference goes to its own final value. With the distance d = y_f - y_0:
//   rise_time           from the first time at y_0 + 0.1 d to the first at y_0 + 0.9 d, s
//   settling_time       from the start to the time after which it stays within 0.02 |d| of y_f, s
//   settling_min, _max  the least and greatest value from the first time at y_0 + 0.9 d on
//   overshoot           the distance beyond y_f, % of d
//   undershoot          the distance on the other side of y_0, % of d
//   peak, peak_time     the absolute value where it is farthest from y_0; s from the start
//   steady_state_value  the value at the end
// With y_0 = 0 and no reference, these equal step_info()'s. With d = 0 they are NaN.
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

// An instant of a run, as in SPICE's .measure.
struct Instant {
  enum class Kind {
    crosses,      // the column passes through the level
    stays_below,  // after the instant, the column stays strictly below the level to the end
    stays_above,
    at  // a given time
  } kind = Kind::crosses;
  enum class Way { either, rise, fall } way = Way::either;
  std::size_t number = 1;          // which crossing, from 1; 0: the last
  const Column* column = nullptr;  // null for `at`
  double level = 0;                // in the column's unit; for `at`: the time, s
};

struct Measure {
  // least, greatest: over the continuous motion, with both sides of every discontinuity. rms: the
  // root mean square over the rows. end: the value at the last instant, at time.end or where the
  // scene stopped. step: see StepMetric. when: the time of an instant. find: the column's value at
  // an instant. loop: of the loop near home, without any motion. All other kinds except rms and end
  // use the continuous motion.
  enum class Kind { least, greatest, rms, end, step, when, find, loop } kind = Kind::end;
  const Column* column = nullptr;  // for `when`: the column of the condition; null for `loop`
  std::string name;                // max_tilt, end_phi, x.RiseTime, when x=0.05 rise=1
  StepMetric metric = StepMetric::rise_time;
  Instant instant{};
  // For step: the column of the reference, or null. A scene or a file may lack values for it.
  const Column* reference = nullptr;
  const LoopMeasure* loop = nullptr;  // for `loop`
  Window window{};                    // restricts the measure to this part of the run
  std::string window_text{};          // as given: "from 5 s"

  [[nodiscard]] std::string meaning() const;
  [[nodiscard]] std::string unit() const;
};

// Reads a measure's name:
//   min_, max_, rms_ or end_ and the name of a column
//   COLUMN.RiseTime, or another of python-control's names
//   when COLUMN=VALUE [rise=N|fall=N|cross=N]: N is from 1, or `last`; default: the first crossing
//   when COLUMN stays below VALUE, when COLUMN stays above VALUE
//   find COLUMN when ..., find COLUMN at TIME
//   a measure of the loop, such as phi_delay_margin (loop_measures.hpp); it has no window
//   any of these with "from TIME", "to TIME" or both: for that part of the run
// A VALUE may have a unit of the column's dimension: "5 cm". The measure's own name has numbers in
// SI instead, except those of the window.
[[nodiscard]] std::optional<Measure> find_measure(std::string_view name);

// The same for the columns that `find` knows, such as those of a stored file.
using FindColumn = std::function<const Column*(std::string_view name)>;
[[nodiscard]] std::optional<Measure> find_measure(std::string_view name, const FindColumn& find);

// The measures of the motion, and the indices of measures of motion and loop in the full list.
struct SplitMeasures {
  std::vector<Measure> of_motion;
  std::vector<std::size_t> motion_places, loop_places;
};
[[nodiscard]] SplitMeasures split_loop_measures(const std::vector<Measure>& measures);

// Splits lists at their commas.
[[nodiscard]] std::vector<std::string> split_measures(const std::vector<std::string>& lists);

// The names of measures of columns with a prefix or step metric, and the columns that have them.
[[nodiscard]] std::vector<std::string> measures_of(std::span<const std::string_view> columns);
[[nodiscard]] std::vector<std::string_view> measured_columns();

// For messages about an unknown name: " (did you mean x.RiseTime?)" from the existing columns, or
// an empty text; and the text of the allowed names.
[[nodiscard]] std::string measure_hint(std::string_view name,
                                       std::span<const std::string_view> columns);
[[nodiscard]] std::string measure_hint(std::string_view name);  // with the columns of a scenario
[[nodiscard]] std::string allowed_measures();

// The measure with this name. Throws InputError, starting with `where`, if the name is unknown or
// the scene lacks the columns or the time for it.
[[nodiscard]] Measure measure_named(std::string_view where, const std::string& name,
                                    const Scenario& scenario);

// The measures with these names. Throws InputError if a name is unknown or given twice, or if the
// scene lacks the columns or the time for it.
[[nodiscard]] std::vector<Measure> measures_named(const std::vector<std::string>& names,
                                                  const Scenario& scenario);

// Throws InputError if two measures have the same name.
void require_once(const std::vector<Measure>& measures);

// end_x, end_y, max_tilt, max_tilt_rate, max_distance; with a controller also rms_tracking_error
// and max_tracking_error.
[[nodiscard]] std::vector<std::string> default_measures(bool closed_loop);

// The columns of the measures of kind `end`, in order.
[[nodiscard]] std::vector<const Column*> end_columns(const std::vector<Measure>& measures);

// Whether a column of these measures needs `what`.
[[nodiscard]] bool any_needs(const std::vector<Measure>& measures, Needs what);

// Why the scene cannot fill a column of the measure, or does not reach its window.
[[nodiscard]] Missing missing(const Measure& measure, const Scenario& scenario);

// Why each measure has no number, if known; otherwise null.
using Whys = std::vector<const char*>;

// Describes each measure without a finite number, with its reason from `whys`, which may be empty.
// Skips infinite measures of the loop, which are valid. Empty if none is left.
[[nodiscard]] std::string why_not_finite(const std::vector<Measure>& measures,
                                         const double* results, const Whys& whys);

}  // namespace bbsim::scenario
