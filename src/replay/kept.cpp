// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/kept.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <queue>
#include <set>

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
    for (const file::Column& column : run.columns) {
      if (column.name != "t") keep_extremes(column.numbers, begin, end, bucket);
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
  Motion(const Run& run, const std::vector<Quaternion>& orientation) : t_(run.find("t")->numbers) {
    add(run.find("x"), 0);
    add(run.find("y"), 0);
    double extent = 0;
    for (const Line& line : lines_) {
      for (const double value : *line.values) {
        if (std::isfinite(value)) extent = std::max(extent, std::abs(value));
      }
    }
    for (Line& line : lines_) line.tolerance = std::max(extent * position_tolerance, 1e-12);
    add(run.find("phi"), angle_tolerance);
    add(run.find("theta"), angle_tolerance);
    add_parts(orientation);
  }

  [[nodiscard]] double error(std::size_t from, std::size_t to, std::size_t row) const {
    const double part = (t_[row] - t_[from]) / (t_[to] - t_[from]);
    double worst = 0;
    for (const Line& line : lines_) {
      const std::vector<double>& v = *line.values;
      const double off = std::abs(v[from] + part * (v[to] - v[from]) - v[row]) / line.tolerance;
      if (off > worst) worst = off;  // false for NaN
    }
    return worst;
  }

 private:
  struct Line {
    const std::vector<double>* values;
    double tolerance;
  };

  void add(const file::Column* series, double tolerance) {
    if (series != nullptr) lines_.push_back({&series->numbers, tolerance});
  }

  // The parts of the ball's orientation as lines, with signs that do not jump. The page
  // interpolates along the sphere, which is better. A part errs by half the angle.
  void add_parts(const std::vector<Quaternion>& orientation) {
    double sign = 1;
    for (std::size_t row = 0; row < orientation.size(); ++row) {
      const Quaternion &now = orientation[row], &before = orientation[row > 0 ? row - 1 : 0];
      if (std::inner_product(now.begin(), now.end(), before.begin(), 0.0) < 0) sign = -sign;
      for (std::size_t part = 0; part < now.size(); ++part) {
        parts_[part].push_back(sign * now[part]);
      }
    }
    for (const std::vector<double>& part : parts_) {
      if (!orientation.empty()) lines_.push_back({&part, orientation_tolerance / 4});
    }
  }

  const std::vector<double>& t_;
  std::array<std::vector<double>, 4> parts_;
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

// The rank of each case's value among the distinct values of a key.
struct Levels {
  std::vector<std::size_t> of_case;
  std::size_t count = 0;
};

template <class Value>
Levels levels_of(const std::vector<Value>& values) {
  std::vector<Value> distinct = values;
  std::ranges::sort(distinct);
  const auto end = std::unique(distinct.begin(), distinct.end());
  Levels levels{{}, static_cast<std::size_t>(end - distinct.begin())};
  for (const Value& value : values) {
    levels.of_case.push_back(std::lower_bound(distinct.begin(), end, value) - distinct.begin());
  }
  return levels;
}

bool is_grid(const std::vector<Levels>& keys, std::size_t cases) {
  double combinations = 1;
  for (const Levels& key : keys) combinations *= static_cast<double>(key.count);
  if (combinations != static_cast<double>(cases)) return false;
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < cases; ++i) {
    std::size_t number = 0;
    for (const Levels& key : keys) number = number * key.count + key.of_case[i];
    seen.insert(number);
  }
  return seen.size() == cases;
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

std::vector<std::size_t> cases_kept(const Sweep& sweep, std::size_t most) {
  const std::size_t cases = sweep.status.size();
  std::vector<Levels> keys;
  for (const SweepColumn& key : sweep.keys) {
    if (!key.along.empty()) continue;
    keys.push_back(key.texts.empty() ? levels_of(key.numbers) : levels_of(key.texts));
  }
  std::vector<std::size_t> strides(keys.size(), 1);
  std::size_t every = 1;
  if (cases > most && is_grid(keys, cases)) {
    const auto left = [&](std::size_t k) { return (keys[k].count + strides[k] - 1) / strides[k]; };
    const auto total = [&] {
      std::size_t product = 1;
      for (std::size_t k = 0; k < keys.size(); ++k) product *= left(k);
      return product;
    };
    while (total() > most) {
      std::size_t longest = 0;
      for (std::size_t k = 1; k < keys.size(); ++k) {
        if (left(k) > left(longest)) longest = k;
      }
      strides[longest] *= 2;
    }
  } else {
    every = (cases + most - 1) / most;
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cases; i += std::max<std::size_t>(every, 1)) {
    bool keep = true;
    for (std::size_t k = 0; k < keys.size(); ++k) keep &= keys[k].of_case[i] % strides[k] == 0;
    if (keep) kept.push_back(i);
  }
  return kept;
}

}  // namespace bbsim::replay
