// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/measures.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "scenario/coupled.hpp"
#include "yaml/quantity.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::scenario {
namespace {

// Returns null for an unknown name.
const LoopMeasure* find_loop_measure(std::string_view name) {
  const auto* const found = std::ranges::find(loop_measures, name, &LoopMeasure::name);
  return found == loop_measures.end() ? nullptr : found;
}

// Removes " WORD TIME" from the end of the text, if present.
std::optional<double> take_last(std::string_view& text, std::string_view word) {
  const std::size_t place = text.rfind(word);
  if (place == std::string_view::npos || place == 0) return {};
  const std::optional<double> time = yaml::value_in(text.substr(place + word.size()), "s");
  if (time) text = trimmed(text.substr(0, place));
  return time;
}

using Kind = Measure::Kind;

struct Prefix {
  std::string_view text;
  Kind kind;
  std::string_view meaning;
};
constexpr Prefix prefixes[] = {{"min_", Kind::least, "minimum over the continuous motion of: "},
                               {"max_", Kind::greatest, "maximum over the continuous motion of: "},
                               {"rms_", Kind::rms, "root mean square over the rows of: "},
                               {"end_", Kind::end, "at the end of the run: "}};

struct Metric {
  StepMetric metric;
  std::string_view name, unit, meaning;  // unit: empty for the column's unit
};
constexpr Metric metrics[] = {
    {StepMetric::rise_time, "RiseTime", "s", "time from 10 % to 90 % of its step: "},
    {StepMetric::settling_time, "SettlingTime", "s",
     "time from the start after which it stays within 2 % of its step: "},
    {StepMetric::settling_min, "SettlingMin", "", "minimum once it has reached 90 % of its step: "},
    {StepMetric::settling_max, "SettlingMax", "", "maximum once it has reached 90 % of its step: "},
    {StepMetric::overshoot, "Overshoot", "%",
     "distance beyond its step's end, in percent of the step: "},
    {StepMetric::undershoot, "Undershoot", "%",
     "distance to the other side of its step's start, in percent of the step: "},
    {StepMetric::peak, "Peak", "", "absolute value where it is farthest from its start: "},
    {StepMetric::peak_time, "PeakTime", "s",
     "time from the start to where it is farthest from its start: "},
    {StepMetric::steady_state_value, "SteadyStateValue", "", "at the end of the run: "},
};

const Metric& metric_of(StepMetric metric) {
  return metrics[static_cast<std::size_t>(metric)];
}

// Removes `word` and the blanks after it from the front of the text.
bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  const std::string_view rest = text.substr(word.size());
  if (!rest.empty() && rest.front() != ' ' && rest.front() != '\t') return false;
  text = trimmed(rest);
  return true;
}

// Reads the value of rise=, fall= or cross=.
bool read_number(std::string_view text, std::size_t& number) {
  number = text == "last" ? 0 : number_in<std::size_t>(text).value_or(0);
  return number >= 1 || text == "last";
}

bool is_usable(const Column* column) {
  // Measures of a quaternion's components have no meaning.
  return column != nullptr && column->needs != Needs::orientation;
}

// Reads "x=0.05 rise=2" or "tracking_error stays below 2 mm".
std::optional<Instant> read_condition(std::string_view text, const FindColumn& find) {
  Instant instant;
  std::string_view level;
  const std::size_t stays = text.find(" stays ");
  std::size_t end = stays;  // of the column's name
  if (stays != std::string_view::npos) {
    level = trimmed(text.substr(stays + 7));
    if (take_word(level, "below")) {
      instant.kind = Instant::Kind::stays_below;
    } else if (take_word(level, "above")) {
      instant.kind = Instant::Kind::stays_above;
    } else {
      return {};
    }
  } else {
    struct Word {
      std::string_view text;
      Instant::Way way;
    };
    constexpr Word words[] = {{" rise=", Instant::Way::rise},
                              {" fall=", Instant::Way::fall},
                              {" cross=", Instant::Way::either}};
    for (const Word& word : words) {
      const std::size_t place = text.find(word.text);
      if (place == std::string_view::npos) continue;
      instant.way = word.way;
      if (!read_number(trimmed(text.substr(place + word.text.size())), instant.number)) return {};
      text = text.substr(0, place);
      break;
    }
    end = text.find('=');
    if (end == std::string_view::npos) return {};
    level = text.substr(end + 1);
  }
  instant.column = find(trimmed(text.substr(0, end)));
  if (!is_usable(instant.column)) return {};
  const std::optional<double> value = yaml::value_in(level, instant.column->unit);
  if (!value) return {};
  instant.level = *value;
  return instant;
}

std::string text_of(const Instant& instant) {
  const std::string level = number_text(instant.level);
  if (instant.kind == Instant::Kind::at) return "at " + level;
  const std::string column = "when " + std::string(instant.column->name);
  if (instant.kind == Instant::Kind::stays_below) return column + " stays below " + level;
  if (instant.kind == Instant::Kind::stays_above) return column + " stays above " + level;
  constexpr const char* ways[] = {" cross=", " rise=", " fall="};
  return column + "=" + level + ways[static_cast<std::size_t>(instant.way)] +
         (instant.number == 0 ? "last" : std::to_string(instant.number));
}

std::optional<Measure> read_when_or_find(std::string_view text, const FindColumn& find) {
  Measure measure;
  measure.kind = Kind::when;
  if (take_word(text, "find")) {
    measure.kind = Kind::find;
    const std::size_t blank = text.find_first_of(" \t");
    if (blank == std::string_view::npos) return {};
    measure.column = find(text.substr(0, blank));
    if (!is_usable(measure.column)) return {};
    text = trimmed(text.substr(blank));
    if (take_word(text, "at")) {
      const std::optional<double> time = yaml::value_in(text, "s");
      if (!time) return {};
      measure.instant.kind = Instant::Kind::at;
      measure.instant.level = *time;
      measure.name = "find " + std::string(measure.column->name) + " " + text_of(measure.instant);
      return measure;
    }
  }
  if (!take_word(text, "when")) return {};
  const std::optional<Instant> instant = read_condition(text, find);
  if (!instant) return {};
  measure.instant = *instant;
  measure.name = text_of(*instant);
  if (measure.kind == Kind::find) {
    measure.name = "find " + std::string(measure.column->name) + " " + measure.name;
  } else {
    measure.column = instant->column;
  }
  return measure;
}

// The column of the reference that a column follows.
const Column* reference_of(const Column& column, const FindColumn& find) {
  return column.name == "x" || column.name == "y" ? find(std::string(column.name) + "_reference")
                                                  : nullptr;
}

// Reads a measure without a window.
std::optional<Measure> find_whole(std::string_view name, const FindColumn& find) {
  if (const LoopMeasure* const loop = find_loop_measure(name)) {
    Measure measure{Kind::loop, nullptr, std::string(name)};
    measure.loop = loop;
    return measure;
  }
  const std::size_t dot = name.rfind('.');
  if (dot != std::string_view::npos) {
    for (const Metric& metric : metrics) {
      if (name.substr(dot + 1) != metric.name) continue;
      const Column* const column = find(name.substr(0, dot));
      if (!is_usable(column)) return {};
      Measure measure{Kind::step, column, std::string(name), metric.metric};
      measure.reference = reference_of(*column, find);
      return measure;
    }
  }
  if (name.starts_with("when ") || name.starts_with("find ")) return read_when_or_find(name, find);
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.text)) continue;
    const Column* const column = find(name.substr(prefix.text.size()));
    if (column == nullptr) continue;
    if (!is_usable(column)) return {};
    return Measure{prefix.kind, column, std::string(name)};
  }
  return {};
}

}  // namespace

WindowedName split_window(std::string_view name) {
  name = trimmed(name);
  WindowedName split{name};
  split.window.to = take_last(split.base, " to ");
  split.window.from = take_last(split.base, " from ");
  split.text = trimmed(name.substr(split.base.size()));
  return split;
}

std::string window_fault(const Window& window, double start, double end) {
  if (window.from && window.to && !(*window.from < *window.to)) {
    return "the window is empty; allowed: from a time to a later time";
  }
  const double rounding = rounding_of(end);
  const bool within = (!window.from || (*window.from >= start && *window.from < end)) &&
                      (!window.to || (*window.to > start && *window.to <= end + rounding));
  if (within) return "";
  return "the run is from " + number_text(start) + " to " + number_text(end) +
         " s; allowed: a window within it";
}

Missing missing(const LoopMeasure& measure, const Scenario& scenario) {
  const char* const instead = "measures of the motion, such as max_tilt";
  if (!scenario.controller) return {"there is no controller", instead};
  if (scenario.controller->law == Law::commands) return {"commands close no loop", instead};
  if (scenario.controller->own) {
    return {"only the controller knows its law; `bbsim check` tries to identify it", instead};
  }
  if (measure.kind == LoopMeasure::Kind::spectral_radius && !scenario.controller->sampling) {
    return {"the controller takes no samples", "spectral_abscissa; or give controller.sampling"};
  }
  if (measure.of_response() && dry_part(scenario) != nullptr) {
    return {"dry friction has no linear equations", "viscous losses alone"};
  }
  return {};
}

std::string Measure::meaning() const {
  if (kind == Kind::loop) return std::string(loop->meaning);
  const std::string of =
      std::string(column->meaning) + (window_text.empty() ? "" : ", " + window_text);
  switch (kind) {
    case Kind::step:
      return std::string(metric_of(metric).meaning) + of;
    case Kind::when:
      return "time: " + name;
    case Kind::find:
      return text_of(instant) + ": " + of;
    default:
      break;
  }
  for (const Prefix& prefix : prefixes) {
    if (prefix.kind == kind) return std::string(prefix.meaning) + of;
  }
  return "";
}

std::string Measure::unit() const {
  if (kind == Kind::loop) return std::string(loop->unit);
  if (kind == Kind::when) return "s";
  if (kind == Kind::step && !metric_of(metric).unit.empty()) {
    return std::string(metric_of(metric).unit);
  }
  return std::string(column->unit);
}

std::optional<Measure> find_measure(std::string_view name, const FindColumn& find) {
  const WindowedName windowed = split_window(name);
  std::optional<Measure> measure = find_whole(windowed.base, find);
  if (!measure || windowed.window.is_whole()) return measure;
  if (measure->kind == Kind::loop) return {};
  measure->window = windowed.window;
  measure->window_text = windowed.text;
  measure->name += " " + measure->window_text;
  return measure;
}

std::vector<std::string> split_measures(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists) {
    for (const std::string_view name : split(list, ",")) names.emplace_back(trimmed(name));
  }
  return names;
}

std::vector<std::string> measures_of(std::span<const std::string_view> columns) {
  std::vector<std::string> measures;
  for (const std::string_view column : columns) {
    const std::string its(column);
    for (const Prefix& prefix : prefixes) measures.push_back(std::string(prefix.text) + its);
    for (const Metric& metric : metrics) measures.push_back(its + "." + std::string(metric.name));
  }
  return measures;
}

std::vector<std::string_view> measured_columns() {
  std::vector<std::string_view> usable;
  for (const Column& column : catalogue) {
    if (is_usable(&column)) usable.push_back(column.name);
  }
  return usable;
}

std::string measure_hint(std::string_view name, std::span<const std::string_view> columns) {
  name = trimmed(name);
  // If the name is known, the window is at fault.
  if (find_loop_measure(name) != nullptr) return ", which takes no time window";
  if (std::ranges::find(columns, name) != columns.end()) {
    return " (did you mean end_" + std::string(name) + "?)";
  }
  if (name == "x_end" || name == "y_end") {  // until 0.3.0
    return " (did you mean end_" + std::string(name.substr(0, 1)) + "?)";
  }
  std::vector<std::string> measures = measures_of(columns);
  for (const LoopMeasure& loop : loop_measures) measures.emplace_back(loop.name);
  const std::vector<std::string_view> known(measures.begin(), measures.end());
  return yaml::hint(name, known);
}

std::string allowed_measures() {
  return "min_, max_, rms_ or end_ before a column of `bbsim columns` (but not ball_q...), such as "
         "max_tilt, rms_x, end_phi; COLUMN.RiseTime, SettlingTime, SettlingMin, SettlingMax, "
         "Overshoot, Undershoot, Peak, PeakTime or SteadyStateValue; \"when COLUMN=VALUE rise=N\" "
         "(or fall=, cross=; N or last), \"when COLUMN stays below VALUE\" (or above); \"find "
         "COLUMN when ...\", \"find COLUMN at TIME\"; any of these \"from TIME\", \"to TIME\" or "
         "\"from TIME to TIME\"; and, without these, measures of the loop: stable, "
         "spectral_radius, spectral_abscissa, phi_ or theta_ before gain_margin, gain_reduction, "
         "phase_margin or delay_margin, x_ or y_ before bandwidth or feedback_bandwidth";
}

Measure measure_named(std::string_view where, const std::string& name, const Scenario& scenario) {
  const std::string found = std::string(where) + ": found " + name;
  const std::optional<Measure> measure = find_measure(name);
  if (!measure) {
    throw InputError(found + measure_hint(split_window(name).base) +
                     "; allowed: " + allowed_measures());
  }
  const std::string outside = window_fault(measure->window, 0, scenario.time.end);
  if (!outside.empty()) throw InputError(found + ", but " + outside);
  if (const Missing lacks = missing(*measure, scenario)) {
    throw InputError(found + ", but " + lacks.why);
  }
  return *measure;
}

SplitMeasures split_loop_measures(const std::vector<Measure>& measures) {
  SplitMeasures split;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (measures[m].kind == Kind::loop) {
      split.loop_places.push_back(m);
    } else {
      split.motion_places.push_back(m);
      split.of_motion.push_back(measures[m]);
    }
  }
  return split;
}

void require_once(const std::vector<Measure>& measures) {
  for (std::size_t i = 0; i < measures.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (measures[i].name != measures[j].name) continue;
      throw InputError("measure: found " + measures[i].name + " twice");
    }
  }
}

std::vector<Measure> measures_named(const std::vector<std::string>& names,
                                    const Scenario& scenario) {
  std::vector<Measure> measures;
  for (const std::string& name : names) {
    measures.push_back(measure_named("measure", name, scenario));
  }
  require_once(measures);
  return measures;
}

std::vector<std::string> default_measures(bool closed_loop) {
  std::vector<std::string> names{"end_x", "end_y", "max_tilt", "max_tilt_rate", "max_distance"};
  if (closed_loop) names.insert(names.end(), {"rms_tracking_error", "max_tracking_error"});
  return names;
}

std::vector<const Column*> end_columns(const std::vector<Measure>& measures) {
  std::vector<const Column*> columns;
  for (const Measure& measure : measures) {
    if (measure.kind == Measure::Kind::end) columns.push_back(measure.column);
  }
  return columns;
}

bool any_needs(const std::vector<Measure>& measures, Needs what) {
  return std::any_of(measures.begin(), measures.end(), [what](const Measure& measure) {
    if (measure.kind == Kind::loop) return false;
    const Column* const watched = measure.instant.column;
    return measure.column->needs == what || (watched != nullptr && watched->needs == what);
  });
}

Missing missing(const Measure& measure, const Scenario& scenario) {
  if (measure.kind == Kind::loop) return missing(*measure.loop, scenario);
  if (!measure.window.is_whole() && !window_fault(measure.window, 0, scenario.time.end).empty()) {
    return {"its window is not within the run", "a window that is"};
  }
  const Missing lacks = missing(*measure.column, scenario);
  if (lacks || measure.instant.column == nullptr) return lacks;
  return missing(*measure.instant.column, scenario);
}

std::string why_not_finite(const std::vector<Measure>& measures, const double* results,
                           const Whys& whys) {
  std::string text;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (std::isfinite(results[m])) continue;
    if (measures[m].kind == Kind::loop && !std::isnan(results[m])) continue;
    text += (text.empty() ? "" : "; ") + measures[m].name +
            (std::isnan(results[m]) ? " is not a number" : " is infinite");
    if (m < whys.size() && whys[m] != nullptr) text += std::string(": ") + whys[m];
  }
  return text;
}

}  // namespace bbsim::scenario
