// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/stored_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/instant.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "record/curve.hpp"

namespace bbsim::record {

using scenario::Column;
using scenario::Measure;
using Kind = Measure::Kind;

StoredRun::StoredRun(file::Table table, const std::string& name)
    : name_(name), table_(std::move(table)) {
  for (const file::Column& of : table_.columns) {
    const std::string& column = of.name;
    const Column* const known = scenario::find_column(column);
    columns_.push_back(
        known != nullptr ? *known : Column{column, column, "", column, scenario::Needs::ball});
    columns_.back().name = column;
  }
  const Column* const t = find("t");
  if (t == nullptr) {
    throw InputError(
        name_ + ": found no column t; allowed: the result of a run, or a log with --map t=COLUMN");
  }
  times_ = &values_of(*t);
  if (times_->empty()) throw InputError(name_ + ": has no rows; allowed: at least one");
  for (std::size_t i = 0; i < times_->size(); ++i) {
    if (std::isfinite((*times_)[i]) && (i == 0 || (*times_)[i] >= (*times_)[i - 1])) continue;
    throw InputError(name_ + ": column t, row " + std::to_string(i + 1) + ": found " +
                     number_text((*times_)[i]) + "; allowed: a finite number, not before the last");
  }
}

const Column* StoredRun::find(std::string_view name) const {
  const auto found = std::ranges::find(columns_, name, &Column::name);
  return found == columns_.end() ? nullptr : &*found;
}

const std::vector<double>& StoredRun::values_of(const Column& column) const {
  return table_.columns[static_cast<std::size_t>(&column - columns_.data())].numbers;
}

std::vector<Measure> StoredRun::measures_named(const std::vector<std::string>& names) const {
  std::vector<Measure> measures;
  for (const std::string& name : names) {
    const auto measure =
        scenario::find_measure(name, [this](std::string_view column) { return find(column); });
    if (!measure) {
      const std::vector<std::string> its = table_.names();
      std::string columns;
      for (const std::string& column : its) columns += " " + column;
      const std::vector<std::string_view> known(its.begin(), its.end());
      throw InputError("measure: found " + name +
                       scenario::measure_hint(scenario::split_window(name).base, known) + "; " +
                       name_ + " has the columns" + columns +
                       "; allowed: " + scenario::allowed_measures());
    }
    if (measure->kind == Kind::loop) {
      throw InputError("measure: found " + name + ", which is of the loop and not of a motion; " +
                       "allowed: measures of the motion; bbsim run SCENARIO --measure " + name);
    }
    const std::string outside =
        scenario::window_fault(measure->window, times_->front(), times_->back());
    if (!outside.empty()) throw InputError("measure: found " + name + ", but " + outside);
    measures.push_back(*measure);
  }
  scenario::require_once(measures);
  return measures;
}

std::string StoredRun::lacks_reference(const Measure& measure) const {
  const bool is_coordinate = measure.column->name == "x" || measure.column->name == "y";
  if (measure.kind != Kind::step || measure.reference != nullptr || !is_coordinate) return "";
  return std::string(measure.column->name) + "_reference";
}

StoredRun::Cut StoredRun::cut_of(const scenario::Window& window) const {
  const std::vector<double>& times = *times_;
  Cut cut{0, times.size(), {}, {}};
  const auto is_before = [&](double t) { return t < window.begin() && !window.holds(t); };
  while (cut.first < times.size() && is_before(times[cut.first])) ++cut.first;
  while (cut.last > cut.first && !window.holds(times[cut.last - 1])) --cut.last;
  const bool any = cut.first < cut.last;
  const auto coincide = [](double a, double b) { return std::abs(a - b) <= rounding_of(b); };
  if (window.from && cut.first > 0 && !(any && coincide(times[cut.first], *window.from))) {
    cut.before = window.from;
  }
  if (window.to && cut.last < times.size() && !(any && coincide(times[cut.last - 1], *window.to))) {
    cut.after = window.to;
  }
  return cut;
}

std::vector<double> StoredRun::filled(const Column& column) const {
  const std::vector<double>& times = *times_;
  std::vector<double> values = values_of(column);
  std::size_t last = values.size();  // row of the last number
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    for (std::size_t k = last + 1; k < i; ++k) {
      const double length = times[i] - times[last];
      const double part = length > 0 ? (times[k] - times[last]) / length : 0;
      values[k] = values[last] + part * (values[i] - values[last]);
    }
    last = i;
  }
  return values;
}

std::vector<double> StoredRun::cut(const std::vector<double>& values, const Cut& cut) const {
  const std::vector<double>& times = *times_;
  // The value at time t, between rows i - 1 and i.
  const auto between = [&](std::size_t i, double t) {
    const double part = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return values[i - 1] + part * (values[i] - values[i - 1]);
  };
  std::vector<double> kept;
  if (cut.before) kept.push_back(between(cut.first, *cut.before));
  const auto row = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  kept.insert(kept.end(), row(cut.first), row(cut.last));
  if (cut.after) kept.push_back(between(cut.last, *cut.after));
  return kept;
}

Measured StoredRun::value_of(const Measure& measure) const {
  constexpr const char* no_value = "there is no finite value";
  const Cut within = cut_of(measure.window);
  if (measure.kind == Kind::rms) {
    const std::vector<double>& all = values_of(*measure.column);
    SquareSum squares;
    std::size_t rows = 0;
    for (std::size_t i = within.first; i < within.last; ++i) {
      if (std::isnan(all[i])) continue;
      squares.add(all[i]);
      ++rows;
    }
    if (rows > 0) return {squares.root_mean(rows)};
    return {no_number, within.first < within.last ? no_value : "no row is within its window"};
  }
  if (!is_of_curves(measure)) {
    const std::vector<double> values = cut(filled(*measure.column), within);
    if (measure.kind == Kind::end) return {values.back(), no_value};
    double least = infinity, greatest = -infinity;
    bool any = false;
    for (const double value : values) {
      if (std::isnan(value)) continue;
      any = true;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
    if (!any) return {no_number, no_value};
    return {measure.kind == Kind::least ? least : greatest};
  }
  const std::vector<double> times = cut(*times_, within);
  std::map<const Column*, Curve> curves;
  return measured(measure, [&](const Column& column) -> const Curve& {
    const auto [found, is_new] = curves.try_emplace(&column);
    if (is_new) {
      const std::vector<double> of = cut(filled(column), within);
      Curve& curve = found->second;
      if (of.size() == 1) curve.add_line(times.front(), times.front(), of[0], of[0]);
      for (std::size_t i = 1; i < of.size(); ++i) {
        curve.add_line(times[i - 1], times[i], of[i - 1], of[i]);
      }
    }
    return found->second;
  });
}

}  // namespace bbsim::record
