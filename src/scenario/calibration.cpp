// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/number_text.hpp"
#include "base/text.hpp"

namespace bbsim::scenario {
namespace {

// Largest noise, as a fraction of the plate's range. A curve with larger deviations turns back.
constexpr double most_noise = 0.02;

struct Row {
  double servo, plate;
  double weight = 1;  // number of measurements
};

// Neighboring rows at one level.
struct Level {
  std::size_t first, last;  // rows
  double servo, plate;      // means
  double weight;
  double moved = 0;  // largest deviation of a row's plate angle from the mean, rad
};

bool strictly_rises(const std::vector<double>& of) {
  return std::ranges::adjacent_find(of, std::greater_equal<>()) == of.end();
}

bool strictly_falls(const std::vector<double>& of) {
  return std::ranges::adjacent_find(of, std::less_equal<>()) == of.end();
}

std::string degrees(double angle) {
  return short_number(angle * 180 / std::numbers::pi) + " deg";
}

void add(std::string& done, const std::string& what) {
  done += (done.empty() ? "" : ", ") + what;
}

// Sorts by the servo's angle. `repeated` counts the rows that repeat another row's angle.
std::vector<Row> sorted_rows(const CurveLinkage& curve, std::size_t& repeated) {
  std::vector<std::size_t> order(curve.servo.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return curve.servo[i]; });
  std::vector<Row> rows;
  for (const std::size_t i : order) {
    if (rows.empty() || curve.servo[i] != rows.back().servo) {
      rows.push_back({curve.servo[i], curve.plate[i]});
      continue;
    }
    Row& same = rows.back();
    same.weight += 1;
    same.plate += (curve.plate[i] - same.plate) / same.weight;
    ++repeated;
  }
  return rows;
}

Level merged(const Level& a, const Level& b) {
  const double weight = a.weight + b.weight, part = b.weight / weight;
  return {a.first, b.last, a.servo + part * (b.servo - a.servo),
          a.plate + part * (b.plate - a.plate), weight};
}

void measure_moves(const std::vector<Row>& rows, Level& level) {
  level.moved = 0;
  for (std::size_t i = level.first; i <= level.last; ++i) {
    level.moved = std::max(level.moved, std::abs(rows[i].plate - level.plate));
  }
}

// Pools rows into levels that rise strictly, or fall if `sign` is -1.
std::vector<Level> pool(const std::vector<Row>& rows, double sign) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Level level{i, i, rows[i].servo, rows[i].plate, rows[i].weight};
    while (!levels.empty() && sign * (level.plate - levels.back().plate) <= 0) {
      level = merged(levels.back(), level);
      levels.pop_back();
    }
    levels.push_back(level);
  }
  for (Level& level : levels) measure_moves(rows, level);
  return levels;
}

// Whether the rows from one level to another are flat: they differ by no more than their noise, but
// would differ by at least four times as much at the curve's mean slope.
bool is_flat(const std::vector<Row>& rows, const std::vector<Level>& levels, std::size_t from,
             std::size_t to) {
  const std::size_t first = levels[from].first, last = levels[to].last;
  if (first == last) return false;
  double noise = 0;
  for (std::size_t i = from; i <= to; ++i) noise = std::max(noise, levels[i].moved);
  const double range = std::abs(levels.back().plate - levels.front().plate);
  const double span = rows.back().servo - rows.front().servo;
  const double expected = range / span * (rows[last].servo - rows[first].servo);
  return noise <= most_noise * range && expected >= 4 * noise &&
         std::abs(levels[to].plate - levels[from].plate) <= noise;
}

// Replaces the flat levels at an end with one level, at the flat row nearest to the rest.
void cut_flat_end(const std::vector<Row>& rows, std::vector<Level>& levels, bool high,
                  std::string& done) {
  const std::size_t count = levels.size();
  for (std::size_t kept = 2; kept < count; ++kept) {
    const std::size_t from = high ? kept : 0, to = high ? count - 1 : count - 1 - kept;
    if (!is_flat(rows, levels, from, to)) continue;
    Level end = levels[from];
    for (std::size_t i = from + 1; i <= to; ++i) end = merged(end, levels[i]);
    end.servo = rows[high ? end.first : end.last].servo;
    end.first = end.last = high ? end.first : end.last;  // cut rows do not count as smoothed
    end.moved = 0;
    const auto at = levels.begin() + static_cast<std::ptrdiff_t>(from);
    levels.erase(at, levels.begin() + static_cast<std::ptrdiff_t>(to + 1));
    levels.insert(high ? levels.end() : levels.begin(), end);
    add(done, std::string("flat ") + (high ? "from " : "up to ") + degrees(end.servo) + ": a stop");
    return;
  }
}

}  // namespace

Calibration calibrate(CurveLinkage& curve) {
  const bool sorted = strictly_rises(curve.servo);
  if (sorted && (strictly_rises(curve.plate) || strictly_falls(curve.plate))) return {};
  Calibration calibration;
  std::size_t repeated = 0;
  const std::vector<Row> rows = sorted_rows(curve, repeated);
  if (std::ranges::adjacent_find(curve.servo, std::greater<>()) != curve.servo.end()) {
    add(calibration.done, "rows sorted by the servo's angle");
  }
  if (repeated > 0) {
    add(calibration.done, counted(repeated, "repeated angle") + " averaged");
  }
  const auto put = [&curve](const auto& all) {
    curve.servo.clear();
    curve.plate.clear();
    for (const auto& point : all) {
      curve.servo.push_back(point.servo);
      curve.plate.push_back(point.plate);
    }
  };
  put(rows);
  if (rows.empty() || strictly_rises(curve.plate) || strictly_falls(curve.plate))
    return calibration;

  const double sign = rows.back().plate >= rows.front().plate ? 1 : -1;
  std::vector<Level> levels = pool(rows, sign);
  const double range = std::abs(levels.back().plate - levels.front().plate);
  std::string cut;
  cut_flat_end(rows, levels, false, cut);
  cut_flat_end(rows, levels, true, cut);
  std::size_t moved = 0;
  double farthest = 0;
  for (const Level& level : levels) {
    if (level.last > level.first) moved += level.last - level.first + 1;
    farthest = std::max(farthest, level.moved);
  }
  if (farthest > most_noise * range) return calibration;
  if (moved > 0) {
    add(calibration.done,
        farthest > 0
            ? std::to_string(moved) + " rows of noise smoothed by at most " + degrees(farthest)
            : std::to_string(moved) + " rows at the same plate angle merged");
  }
  if (!cut.empty()) add(calibration.done, cut);
  calibration.changes = true;
  put(levels);
  curve.smoothed = moved > 0;
  return calibration;
}

}  // namespace bbsim::scenario
