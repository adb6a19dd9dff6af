// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/log_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "base/maxima.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "record/compare.hpp"
#include "scenario/log_columns.hpp"

namespace bbsim::record {
namespace {

using Numbers = std::vector<double>;

const Numbers* find(const file::Table& table, std::string_view name) {
  const file::Column* const column = table.find(name);
  return column == nullptr ? nullptr : &column->numbers;
}

// The finite times and values of a column, with its rates if the table has them.
class Line {
 public:
  Line(const Numbers& times, const Numbers& values, const Numbers* rates = nullptr) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!std::isfinite(times[i]) || !std::isfinite(values[i])) continue;
      if (!t_.empty() && !(times[i] > t_.back())) continue;
      t_.push_back(times[i]);
      v_.push_back(values[i]);
      if (rates != nullptr) r_.push_back((*rates)[i]);
    }
  }

  [[nodiscard]] bool empty() const { return t_.empty(); }
  [[nodiscard]] double first() const { return t_.front(); }
  [[nodiscard]] double last() const { return t_.back(); }
  [[nodiscard]] const Numbers& times() const { return t_; }
  [[nodiscard]] const Numbers& values() const { return v_; }

  // Interpolated value; empty outside the rows.
  [[nodiscard]] std::optional<double> at(double t) const {
    if (t_.empty() || !(t >= t_.front()) || !(t <= t_.back())) return {};
    const auto after = static_cast<std::size_t>(std::ranges::upper_bound(t_, t) - t_.begin());
    const std::size_t i = std::max<std::size_t>(after, 1) - 1;
    if (i + 1 == t_.size() || t_[i] == t) return v_[i];
    const double h = t_[i + 1] - t_[i], s = (t - t_[i]) / h, slope = v_[i + 1] - v_[i];
    double value = v_[i] + s * slope;
    if (!r_.empty() && std::isfinite(r_[i]) && std::isfinite(r_[i + 1])) {
      const double a = h * r_[i] - slope, b = slope - h * r_[i + 1];
      value += s * (1 - s) * ((1 - s) * a + s * b);
    }
    return value;
  }

 private:
  Numbers t_, v_, r_;
};

const Numbers* rates_of(const file::Table& table, std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 4> rates = {
      {{"x", "vx"}, {"y", "vy"}, {"phi", "phi_rate"}, {"theta", "theta_rate"}}};
  for (const auto& [value, rate] : rates) {
    if (value == name) return find(table, rate);
  }
  return nullptr;
}

struct Pair {
  std::string name;
  Line log, run;
};

std::vector<Pair> pairs_of(const file::Table& log, const file::Table& run,
                           const std::vector<std::string>& columns) {
  const auto require = [](const file::Table& table, const std::string& column) {
    if (const Numbers* const found = find(table, column)) return found;
    const auto known = joined(table.names(), [](const auto& listed) { return shown(listed); });
    throw InputError(table.file + ": has no column " + shown(column) + "; it has " + known +
                     (column == "t" ? ". --map t=NAME:UNIT names the time" : ""));
  };
  const Numbers& log_times = *require(log, "t");
  const Numbers& run_times = *require(run, "t");
  std::vector<Pair> pairs;
  for (const std::string& name : columns.empty() ? log.names() : columns) {
    if (name == "t") continue;
    if (columns.empty() && find(run, name) == nullptr) continue;
    const Numbers& log_values = *require(log, name);
    const Numbers& run_values = *require(run, name);
    pairs.push_back({name, {log_times, log_values}, {run_times, run_values, rates_of(run, name)}});
  }
  if (pairs.empty()) {
    throw InputError(log.file + " and " + run.file +
                     " have no column in common; --map x=NAME:UNIT names the log's");
  }
  return pairs;
}

// How well the log, moved by `offset`, fits the run: the sum over the columns of -log(1 - c^2),
// with Pearson's correlation c. For noise of unknown size this is the logarithm of the likelihood,
// to which a column of noise alone adds next to nothing. Empty if the time in common is shorter
// than `least` or nothing varies.
struct Sums {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
};
std::optional<double> likeness(const std::vector<Pair>& pairs, double offset, double least) {
  constexpr double rounding = 1e-12;
  std::optional<double> total;
  for (const Pair& pair : pairs) {
    const double from = std::max(pair.log.first() + offset, pair.run.first());
    const double to = std::min(pair.log.last() + offset, pair.run.last());
    if (to - from < least) return {};
    Sums of;
    const Numbers& times = pair.log.times();
    const double b_about = pair.run.values().front(), a_about = pair.log.values().front();
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto run_value = pair.run.at(times[i] + offset);
      if (!run_value) continue;
      const double a = pair.log.values()[i] - a_about, b = *run_value - b_about;
      of.n += 1;
      of.a += a;
      of.b += b;
      of.aa += a * a;
      of.bb += b * b;
      of.ab += a * b;
    }
    if (of.n < 3) return {};
    const double va = of.aa - of.a * of.a / of.n, vb = of.bb - of.b * of.b / of.n;
    if (!(va > 1e-12 * of.aa) || !(vb > 1e-12 * of.bb)) continue;
    const double c = (of.ab - of.a * of.b / of.n) / std::sqrt(va * vb);
    total = total.value_or(0) + (c > 0 ? -std::log(std::max(1 - c * c, rounding)) : c);
  }
  return total;
}

// Thins the rows for a fast search.
Line thinned(const Line& line, std::size_t most) {
  Numbers times, values;
  const std::size_t step = std::max<std::size_t>(1, line.times().size() / most);
  for (std::size_t i = 0; i < line.times().size(); i += step) {
    times.push_back(line.times()[i]);
    values.push_back(line.values()[i]);
  }
  return {times, values};
}

}  // namespace

LogDistance log_distance(const file::Table& log, const file::Table& run,
                         const std::vector<std::string>& columns) {
  const std::vector<Pair> pairs = pairs_of(log, run, columns);
  const Line log_clock(*find(log, "t"), *find(log, "t")),
      run_clock(*find(run, "t"), *find(run, "t"));
  LogDistance distance;
  distance.rows_of_log = log_clock.times().size();
  bool any = false;
  for (const double t : log_clock.times()) {
    if (run_clock.empty() || t < run_clock.first() || t > run_clock.last()) continue;
    if (!any) distance.from = t;
    any = true;
    distance.to = t;
    ++distance.rows;
  }
  if (!any) {
    const auto span = [](const Line& line) {
      return line.empty() ? std::string("nothing")
                          : number_text(line.first()) + " to " + number_text(line.last()) + " s";
    };
    const auto length = [](const Line& line) {
      return line.empty() ? 0 : line.last() - line.first();
    };
    const auto doubt = scenario::doubt_of_span(length(log_clock), length(run_clock));
    throw InputError(log.file + " and " + run.file + " have no time in common: found " +
                     span(log_clock) + " and " + span(run_clock) +
                     (doubt ? "; the log's t looks like " + std::string(doubt->looks_like) +
                                  ": --map t=t:" + std::string(doubt->units)
                            : std::string()) +
                     "; --time-offset start, a time, or auto moves the log");
  }
  for (const Pair& pair : pairs) {
    ColumnDistance column{pair.name};
    double squares = 0;
    for (std::size_t i = 0; i < pair.log.times().size(); ++i) {
      const double t = pair.log.times()[i], log_value = pair.log.values()[i];
      const auto run_value = pair.run.at(t);
      if (!run_value) continue;
      const double difference = std::abs(log_value - *run_value);
      squares += difference * difference;
      if (column.rows++ == 0 || difference > column.greatest) {
        column.greatest = difference;
        column.at = t;
        column.log = log_value;
        column.run = *run_value;
      }
    }
    if (column.rows > 0) column.rms = std::sqrt(squares / static_cast<double>(column.rows));
    distance.columns.push_back(column);
  }
  return distance;
}

double time_offset(const file::Table& log, const file::Table& run,
                   const std::vector<std::string>& columns) {
  std::vector<Pair> pairs = pairs_of(log, run, columns);
  std::erase_if(pairs, [](const Pair& pair) { return pair.log.empty() || pair.run.empty(); });
  double from = -INFINITY, to = INFINITY, least = 0;
  std::vector<Pair> coarse;
  for (const Pair& pair : pairs) {
    const double log_span = pair.log.last() - pair.log.first();
    const double run_span = pair.run.last() - pair.run.first();
    least = std::max(least, std::min(log_span, run_span) / 2);
    from = std::max(from, pair.run.first() - pair.log.last());
    to = std::min(to, pair.run.last() - pair.log.first());
    coarse.push_back({pair.name, thinned(pair.log, 1000), pair.run});
  }
  std::optional<double> best, greatest;
  constexpr int offsets = 2000;
  const double step = pairs.empty() ? 0 : (to - from) / offsets;
  for (int i = 0; i <= offsets && step > 0; ++i) {
    const double offset = from + i * step;
    const auto found = likeness(coarse, offset, least);
    if (found && (!greatest || *found > *greatest)) {
      greatest = found;
      best = offset;
    }
  }
  if (!best) {
    throw InputError("--time-offset auto: " + log.file + " and " + run.file +
                     " have too little in common that varies; allowed: a time, or start");
  }
  const auto peak = [&](double offset) {
    return Peak{offset, likeness(coarse, offset, least * 0.9).value_or(0)};
  };
  return climb(within(peak(*best - step), peak(*best), peak(*best + step)), good_place * step,
               [&](double offset) { return peak(offset).value; })
      .at;
}

std::string to_text(const LogDistance& distance, const std::string& log_name,
                    const std::string& run_name) {
  std::vector<std::vector<std::string>> lines{
      {"column", "rms", "greatest", "at t", "in the log", "in the run", "rows"}};
  for (const ColumnDistance& column : distance.columns) {
    const bool any = column.rows > 0;
    const auto number = [any](double value) { return any ? rounded(value) : std::string("-"); };
    lines.push_back({column.name, number(column.rms), number(column.greatest), number(column.at),
                     number(column.log), number(column.run), std::to_string(column.rows)});
  }
  return aligned(lines) + log_name + " from " + run_name + ": " + std::to_string(distance.rows) +
         " of " + std::to_string(distance.rows_of_log) + " rows, " + rounded(distance.from) +
         " to " + rounded(distance.to) + " s\n";
}

}  // namespace bbsim::record
