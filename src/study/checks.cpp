// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/real.hpp"
#include "solve/radau/radau.hpp"

namespace bbsim::study {
namespace {

// The tolerance of checks. If the run's tolerance times check_factor is finer, they use that.
constexpr double usual_rtol = 1e-13, check_factor = 1e-2;
// A check with so many times the steps of the run sees only rounding, as near a dead point. A
// coarser one is better, and cheaper by far. Short runs may have this many more.
constexpr std::size_t most_growth = 100, short_run = 100;
// An estimate is a distance between runs, which may be close by luck.
constexpr double safety = 1.5;
// If the distance between checks exceeds this fraction of the estimate, they are too noisy, and the
// estimate is widened.
constexpr double noise = 0.1, safety_in_noise = 3;

// The distance between two runs, m: the largest at an output time that both have. For runs that an
// event stopped, it includes how far the ball moves between their ends.
double distance(const Track& a, const Track& b) {
  if (a.outcome.ending != b.outcome.ending) return infinity;
  double largest = 0;
  if (a.outcome.ending == solve::Ending::stopped) {
    const model::Occurrence& stop = a.outcome.occurrences.back();
    if (stop.name != b.outcome.occurrences.back().name) return infinity;
    largest = std::abs(a.outcome.reached - b.outcome.reached) *
              std::hypot(stop.sample.ball.x_dot, stop.sample.ball.y_dot);
  }
  const std::size_t common = std::min(a.positions.size(), b.positions.size());
  for (std::size_t i = 0; i < common; ++i) {
    const double apart = std::abs(a.positions[i] - b.positions[i]);
    if (!(apart <= largest)) largest = apart;
  }
  return std::isnan(largest) ? infinity : largest;
}

// No two runs can resolve less than a few roundings of the position.
double rounding(const Track& run) {
  double size = 0;
  for (const double position : run.positions) size = larger(size, std::abs(position));
  return 4 * std::numeric_limits<double>::epsilon() * size;
}

}  // namespace

solve::Tolerances tolerances_of(double rtol) {
  return {rtol, 1e-2 * rtol};
}

int coordinates(const model::Model& model) {
  return model.spin_state() < 0 ? 1 : 2;
}

bool came_to_its_end(const solve::Outcome& outcome) {
  return outcome.ending == solve::Ending::done || outcome.ending == solve::Ending::stopped;
}

Tracker::Tracker(const model::Model& model, std::vector<double>& positions, solve::StateSink* rows)
    : row_size_(model.row_size()),
      coordinates_(static_cast<std::size_t>(coordinates(model))),
      positions_(positions),
      rows_(rows) {}

void Tracker::accept(std::size_t first, std::size_t count, const double* values) {
  for (std::size_t i = 0; i < count; ++i) {
    const double* const row = values + i * row_size_;
    positions_.insert(positions_.end(), row, row + coordinates_);
  }
  if (rows_ != nullptr) rows_->accept(first, count, values);
}

// The checks for a run. The first has other stages than the run, and neighbors have different
// stages. A rig beyond the paper's has kernels of 8 and 12 stages only.
std::array<solve::CheckRun, 4> Checks::kinds(const Track& run, double rtol) const {
  using solve::radau::choose_stages, solve::radau::stages_of;
  const int most = stages_of(model_, 16), fewer = most == 16 ? 12 : 8;
  std::array<solve::CheckRun, 4> kinds{{{most, 2}, {fewer, 3}, {most, 4}, {fewer, 5}}};
  const bool alike = run.outcome.method == Method::radau &&
                     stages_of(model_, choose_stages(model_, rtol)) == kinds[0].stages;
  if (alike) std::swap(kinds[0], kinds[1]);
  for (solve::CheckRun& kind : kinds) {
    kind.most_steps = most_growth * static_cast<std::size_t>(kind.parts) *
                      (run.outcome.statistics.steps + short_run);
  }
  return kinds;
}

void Checks::use(double rtol) {
  if (rtol != rtol_) tracks_.clear();
  rtol_ = rtol;
}

const Track* Checks::check(solve::CheckRun how) {
  for (const CheckTrack& done : tracks_) {
    if (done.how.stages == how.stages && done.how.parts == how.parts) return done.track.get();
  }
  auto track = std::make_unique<Track>();
  Tracker tracker(model_, track->positions);
  track->outcome =
      solve::integrate_check_run(model_, how, tolerances_of(rtol_), grid_, tracker, watch_);
  ++runs_;
  interrupted_ = interrupted_ || track->outcome.ending == solve::Ending::interrupted;
  if (!came_to_its_end(track->outcome)) track.reset();
  tracks_.push_back({how, std::move(track)});
  return tracks_.back().track.get();
}

// Empty if a check does not reach its end.
std::optional<double> Checks::distance_from(const Track& run,
                                            const std::array<solve::CheckRun, 4>& kinds,
                                            bool confirm) {
  const Track* const first = check(kinds[0]);
  if (first == nullptr) return {};
  double apart = distance(run, *first);
  if (!confirm || apart == infinity) return safety * apart;
  const Track* const second = check(kinds[1]);
  if (second == nullptr) return {};
  apart = std::max(apart, distance(run, *second));
  double spread = distance(*first, *second);
  const auto in_noise = [&] { return safety_in_noise * std::max(apart, spread); };
  if (spread <= noise * apart || in_noise() <= rounding(run)) return safety * apart;
  for (const std::size_t more : {2, 3}) {
    const Track* const third = check(kinds[more]);
    if (third == nullptr) return {};
    apart = std::max(apart, distance(run, *third));
    spread = std::max({spread, distance(*first, *third), distance(*second, *third)});
  }
  return in_noise();
}

double Checks::estimate(const Track& run, double rtol, bool confirm) {
  const double wanted = std::max(finest_rtol, std::min(usual_rtol, rtol * check_factor));
  for (double tried = std::max(wanted, least_); tried <= rtol; tried *= 10) {
    use(tried);
    const auto apart = distance_from(run, kinds(run, rtol), confirm);
    if (apart) return std::max(*apart, rounding(run));
    if (interrupted_) break;
    least_ = 10 * tried;
  }
  return infinity;
}

std::vector<double> Checks::row_estimates(const Track& run, double estimate) const {
  const auto n = static_cast<std::size_t>(coordinates(model_));
  std::vector<double> rows(run.positions.size() / n, no_number);
  for (const CheckTrack& done : tracks_) {
    if (done.track == nullptr) continue;
    const std::size_t common = std::min(run.positions.size(), done.track->positions.size());
    for (std::size_t i = 0; i < common; ++i) {
      rows[i / n] = std::fmax(rows[i / n], std::abs(run.positions[i] - done.track->positions[i]));
    }
  }
  double largest = 0;
  for (const double error : rows) largest = std::fmax(largest, error);
  // Between rounding and the estimate of the whole run.
  const double factor =
      largest > 0 ? std::clamp(estimate / largest, safety, safety_in_noise) : safety;
  const double least = rounding(run);
  for (double& error : rows) {
    if (!std::isnan(error)) error = std::max(factor * error, least);
  }
  return rows;
}

}  // namespace bbsim::study
