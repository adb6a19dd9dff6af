// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures of a run. A measure reduces a column over the run to one number, or describes the
// loop near home.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/instant.hpp"
#include "scenario/columns.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::scenario {

// A missing bound means the start or the end of the run.
struct Window {
  std::optional<double> from{}, to{};  // s

  [[nodiscard]] bool is_whole() const { return !from && !to; }
  [[nodiscard]] double begin() const {
    return from.value_or(-std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] double end() const { return to.value_or(std::numeric_limits<double>::infinity()); }
  // Times within rounding of a bound belong to the window.
  [[nodiscard]] bool holds(double t) const {
    return (!from || t >= *from - rounding_of(*from)) && (!to || t <= *to + rounding_of(*to));
  }

  friend bool operator==(const Window&, const Window&) = default;
};

// Splits a name that ends in "from TIME", "to TIME" or both into the rest, the window, and the
// window's text. Other names have the whole run as their window.
struct WindowedName {
  std::string_view base;
  Window window{};
  std::string_view text{};
};
[[nodiscard]] WindowedName split_window(std::string_view name);

// Why the window does not fit a run from `start` to `end` (s): "the window is empty; allowed: ...".
// Empty if it fits.
[[nodiscard]] std::string window_fault(const Window& window, double start, double end);

// A measure of the control loop near home: stability, margins and bandwidths. It depends on the
// scenario, but not on its motion.
struct LoopMeasure {
  enum class Kind {
    stable,
    spectral_radius,
    spectral_abscissa,
    gain_margin,
    gain_reduction,
    phase_margin,
    delay_margin,
    bandwidth,
    feedback_bandwidth
  } kind;
  std::size_t axis;  // 0: phi and x, or stability and spectra; 1: theta and y
  std::string_view name, unit, meaning;

  // Whether it comes from the loop's frequency response rather than from its poles.
  [[nodiscard]] bool of_response() const { return kind > Kind::spectral_abscissa; }
};

inline constexpr std::array loop_measures = {
    LoopMeasure{LoopMeasure::Kind::stable, 0, "stable", "1",
                "1 if all modes of the loop near home decay, otherwise 0"},
    LoopMeasure{LoopMeasure::Kind::spectral_radius, 0, "spectral_radius", "1",
                "of a sampled loop near home: factor of its slowest mode per sample"},
    LoopMeasure{LoopMeasure::Kind::spectral_abscissa, 0, "spectral_abscissa", "1/s",
                "greatest real part of the loop's poles near home; of a sampled loop, "
                "ln(spectral_radius) per period"},
    LoopMeasure{LoopMeasure::Kind::gain_margin, 0, "phi_gain_margin", "1",
                "smallest factor above 1 on phi's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::gain_reduction, 0, "phi_gain_reduction", "1",
                "greatest factor below 1 on phi's command that makes the loop unstable; 0: none"},
    LoopMeasure{LoopMeasure::Kind::phase_margin, 0, "phi_phase_margin", "rad",
                "smallest turn of phase, lag or lead, of phi's command that makes the loop "
                "unstable"},
    LoopMeasure{LoopMeasure::Kind::delay_margin, 0, "phi_delay_margin", "s",
                "shortest further delay of phi's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::gain_margin, 1, "theta_gain_margin", "1",
                "smallest factor above 1 on theta's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::gain_reduction, 1, "theta_gain_reduction", "1",
                "greatest factor below 1 on theta's command that makes the loop unstable; 0: none"},
    LoopMeasure{LoopMeasure::Kind::phase_margin, 1, "theta_phase_margin", "rad",
                "smallest turn of phase, lag or lead, of theta's command that makes the loop "
                "unstable"},
    LoopMeasure{LoopMeasure::Kind::delay_margin, 1, "theta_delay_margin", "s",
                "shortest further delay of theta's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::bandwidth, 0, "x_bandwidth", "rad/s",
                "where the response of x to x_reference first falls to 1/sqrt(2)"},
    LoopMeasure{LoopMeasure::Kind::feedback_bandwidth, 0, "x_feedback_bandwidth", "rad/s",
                "the bandwidth of x without the reference's accelerations"},
    LoopMeasure{LoopMeasure::Kind::bandwidth, 1, "y_bandwidth", "rad/s",
                "where the response of y to y_reference first falls to 1/sqrt(2)"},
    LoopMeasure{LoopMeasure::Kind::feedback_bandwidth, 1, "y_feedback_bandwidth", "rad/s",
                "the bandwidth of y without the reference's accelerations"},
};

// Why the scene lacks the measure, as far as its keys tell.
[[nodiscard]] Missing missing(const LoopMeasure& measure, const Scenario& scenario);

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
//   a measure of the loop, such as phi_delay_margin (LoopMeasure); it has no window
//   any of these with "from TIME", "to TIME" or both: for that part of the run
// A VALUE may have a unit of the column's dimension: "5 cm". The measure's own name has numbers in
// SI instead, except those of the window.
// `find` knows the columns: those of a scenario, or of a stored file.
using FindColumn = std::function<const Column*(std::string_view name)>;
[[nodiscard]] std::optional<Measure> find_measure(std::string_view name,
                                                  const FindColumn& find = find_column);

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

// For messages about an unknown name: " (did you mean x.RiseTime?)" from the existing columns, by
// default those of a scenario, or an empty text; and the text of the allowed names.
[[nodiscard]] std::string measure_hint(
    std::string_view name, std::span<const std::string_view> columns = measured_columns());
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
