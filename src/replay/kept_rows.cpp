// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/kept_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace bbsim::replay {
namespace {

// Keeps the rows of the least and the greatest finite value of a column in [begin, end).
void keep_extremes(const std::vector<double>& values, std::size_t begin, std::size_t end,
                   std::vector<std::size_t>& kept) {
  std::size_t least = end, greatest = end;
  for (std::size_t row = begin; row < end; ++row) {
    if (!std::isfinite(values[row])) continue;
    if (least == end || values[row] < values[least]) least = row;
    if (greatest == end || values[row] > values[greatest]) greatest = row;
  }
  if (least == end) return;
  kept.push_back(least);
  kept.push_back(greatest);
}

void make_set(std::vector<std::size_t>& rows) {
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

// Empty if there are more than `most`.
std::vector<std::size_t> rows_of_plots(const Run& run, std::size_t buckets, std::size_t most) {
  const std::size_t rows = row_count(run);
  std::vector<std::size_t> kept, bucket;
  for (std::size_t b = 0; b < buckets; ++b) {
    const std::size_t begin = rows * b / buckets, end = rows * (b + 1) / buckets;
    bucket.assign({begin, end - 1});
    for (const Series& column : run.columns) {
      if (column.name != "t") keep_extremes(column.values, begin, end, bucket);
    }
    make_set(bucket);
    kept.insert(kept.end(), bucket.begin(), bucket.end());
    if (kept.size() > most) return {};
  }
  return kept;
}

// The error of interpolation between two rows at a row between them, in tolerances.
class Motion {
 public:
  Motion(const Run& run, const std::vector<Quaternion>& orientation)
      : t_(find_series(run, "t")->values), orientation_(orientation) {
    add(find_series(run, "x"), 0);
    add(find_series(run, "y"), 0);
    double extent = 0;
    for (const Line& line : lines_) {
      for (const double value : *line.values) {
        if (std::isfinite(value)) extent = std::max(extent, std::abs(value));
      }
    }
    for (Line& line : lines_) line.tolerance = std::max(extent * position_tolerance, 1e-12);
    add(find_series(run, "phi"), angle_tolerance);
    add(find_series(run, "theta"), angle_tolerance);
  }

  [[nodiscard]] double error(std::size_t from, std::size_t to, std::size_t row) const {
    const double part = (t_[row] - t_[from]) / (t_[to] - t_[from]);
    double worst = 0;
    for (const Line& line : lines_) {
      const std::vector<double>& v = *line.values;
      const double off = std::abs(v[from] + part * (v[to] - v[from]) - v[row]) / line.tolerance;
      if (off > worst) worst = off;  // false for NaN
    }
    return orientation_.empty() ? worst : std::max(worst, turn_error(from, to, row, part));
  }

  // Whether the ball turns so far between two kept rows that interpolation is ambiguous. Adds up
  // its small turns, because it may turn a whole number of times.
  [[nodiscard]] bool turns_too_far(std::size_t from, std::size_t to) const {
    if (orientation_.empty()) return false;
    double turned = 0;
    for (std::size_t row = from + 1; row <= to; ++row) {
      turned += angle_between(orientation_[row - 1], orientation_[row]);
      if (turned > largest_turn) return true;
    }
    return false;
  }

 private:
  struct Line {
    const std::vector<double>* values;
    double tolerance;
  };

  void add(const Series* series, double tolerance) {
    if (series != nullptr) lines_.push_back({&series->values, tolerance});
  }

  static double dot(const Quaternion& a, const Quaternion& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  }

  static double angle_between(const Quaternion& a, const Quaternion& b) {
    return 2 * std::acos(std::min(1.0, std::abs(dot(a, b))));
  }

  // The page interpolates orientations by spherical linear interpolation.
  [[nodiscard]] double turn_error(std::size_t from, std::size_t to, std::size_t row,
                                  double part) const {
    const Quaternion& a = orientation_[from];
    Quaternion b = orientation_[to];
    double cosine = dot(a, b);
    if (cosine < 0) {
      for (double& component : b) component = -component;
      cosine = -cosine;
    }
    const double angle = std::acos(std::min(1.0, cosine));
    double weight_a = 1 - part, weight_b = part;
    if (angle > 1e-6) {
      weight_a = std::sin((1 - part) * angle) / std::sin(angle);
      weight_b = std::sin(part * angle) / std::sin(angle);
    }
    Quaternion between{};
    for (std::size_t i = 0; i < between.size(); ++i) {
      between[i] = weight_a * a[i] + weight_b * b[i];
    }
    return angle_between(between, orientation_[row]) / orientation_tolerance;
  }

  const std::vector<double>& t_;
  const std::vector<Quaternion>& orientation_;
  std::vector<Line> lines_;
};

// The rows between two kept rows, with the one where interpolation is worst.
struct Stretch {
  double error;
  std::size_t from, to, worst;

  friend bool operator<(const Stretch& a, const Stretch& b) { return a.error < b.error; }
};

Stretch stretch(const Motion& motion, std::size_t from, std::size_t to) {
  Stretch result{0, from, to, from};
  for (std::size_t row = from + 1; row < to; ++row) {
    const double error = motion.error(from, to, row);
    if (error > result.error) {
      result.error = error;
      result.worst = row;
    }
  }
  if (result.error < 2 && to - from > 1 && motion.turns_too_far(from, to)) {
    result.error = 2;  // above the tolerance
    result.worst = from + (to - from) / 2;
  }
  return result;
}

double keep_motion(const Motion& motion, std::size_t most, std::vector<std::size_t>& kept) {
  std::priority_queue<Stretch> stretches;
  for (std::size_t i = 1; i < kept.size(); ++i) {
    stretches.push(stretch(motion, kept[i - 1], kept[i]));
  }
  while (!stretches.empty() && stretches.top().error > 1 && kept.size() < most) {
    const Stretch worst = stretches.top();
    stretches.pop();
    kept.push_back(worst.worst);
    stretches.push(stretch(motion, worst.from, worst.worst));
    stretches.push(stretch(motion, worst.worst, worst.to));
  }
  return stretches.empty() ? 0 : stretches.top().error;
}

}  // namespace

KeptRows kept_rows(const Run& run, const std::vector<Quaternion>& orientation, std::size_t most) {
  const std::size_t rows = row_count(run);
  KeptRows kept;
  if (rows <= most) {
    kept.rows.resize(rows);
    std::iota(kept.rows.begin(), kept.rows.end(), std::size_t{0});
    return kept;
  }
  kept.rows = {0, rows - 1};
  for (std::size_t buckets = 1; buckets <= rows; buckets *= 2) {
    std::vector<std::size_t> more = rows_of_plots(run, buckets, most / 2);
    if (more.empty()) break;
    kept.rows = std::move(more);
    kept.buckets = buckets;
  }
  kept.motion_error = keep_motion(Motion(run, orientation), most, kept.rows);
  make_set(kept.rows);
  return kept;
}

}  // namespace bbsim::replay
