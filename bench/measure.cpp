// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/cpu_clock.hpp"

namespace bbsim::bench {
namespace {

// Reading the clock takes about a microsecond, so batches of runs take at least this time, s.
constexpr double least_batch = 1e-4;
// The least time is final once this many batches in a row have not lowered it by over 1/200.
constexpr int standing = 30;
constexpr double lowered = 0.995;

struct Candidate {
  const Tool* tool;
  Point point;
  int batch = 1;
  int since = 0;     // batches since the least time last fell
  double total = 0;  // s
  bool settled = false;
};

void run_batch(Candidate& candidate, const Scene& scene, Rows& rows) {
  Point& point = candidate.point;
  const CpuClock clock;
  for (int i = 0; i < candidate.batch; ++i) candidate.tool->run(scene, point.tolerances, rows);
  const double all = clock.seconds();
  const double each = all / candidate.batch;
  candidate.since = each < lowered * point.seconds ? 0 : candidate.since + 1;
  point.seconds = std::min(point.seconds, each);
  point.runs += candidate.batch;
  candidate.total += all;
  if (all < least_batch) candidate.batch *= 2;  // the first run, which set the batch size, was cold
}

}  // namespace

std::vector<Point> measure(const Scene& scene, const std::vector<double>& rtols, double budget) {
  Rows rows(scene.grid.size(), scene.model.size());
  std::vector<Candidate> candidates;
  for (const double rtol : rtols) {
    for (const Tool& tool : all_tools()) {
      Candidate candidate{&tool, {tool.name, {rtol, rtol / 100}}};
      const CpuClock clock;
      if (!tool.run(scene, candidate.point.tolerances, rows)) continue;
      const double once = clock.seconds();
      candidate.point.error = largest_error(scene, rows);
      if (!std::isfinite(candidate.point.error)) continue;
      candidate.point.seconds = std::numeric_limits<double>::infinity();
      candidate.batch = std::max(1, static_cast<int>(std::ceil(least_batch / once)));
      candidates.push_back(candidate);
    }
  }
  for (bool settled = false; !settled;) {
    settled = true;
    for (Candidate& candidate : candidates) {
      if (candidate.settled) continue;
      run_batch(candidate, scene, rows);
      candidate.settled = candidate.since >= standing || candidate.total >= budget;
      settled = settled && candidate.settled;
    }
  }
  std::vector<Point> points;
  points.reserve(candidates.size());
  for (const Candidate& candidate : candidates) points.push_back(candidate.point);
  return points;
}

}  // namespace bbsim::bench
