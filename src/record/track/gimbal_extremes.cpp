// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/gimbal_extremes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simd/instruction_set.hpp"

namespace bbsim::record {
namespace {

// Over half a stretch, 2 rad, the first coefficient beyond degree 16 is that of a Bessel function,
// J_17(2) = 3e-15.
constexpr std::size_t parts = 16;
constexpr double stretch = 4;  // rad

// A gimbal that turns more often than this reaches all of its angles anyway.
constexpr double most_stretches = 1e5;
constexpr std::size_t together = 60;  // stretches evaluated in one call

}  // namespace

const TrackKernels& choose_track_kernels() {
  return simd::kernels_by([](auto isa) -> const auto& { return track_kernels<decltype(isa)>(); });
}

double repeats_after(const model::SignalView& motion) {
  const bool repeats = motion.rate[0] == 0 && motion.rate[1] == 0 && !motion.shared.any() &&
                       motion.harmonic_count == 1;
  if (!repeats) return std::numeric_limits<double>::infinity();
  const bool level = motion.start[0] == 0 && motion.start[1] == 0;
  return (level ? 1 : 2) * std::numbers::pi / std::abs(motion.harmonics[0].frequency);
}

double tilt_of(double versine) {
  return versine < 1 ? 2 * std::asin(std::sqrt(versine / 2))
                     : std::numbers::pi - 2 * std::asin(std::sqrt(std::max(0.0, 1 - versine / 2)));
}

GimbalExtremes::GimbalExtremes()
    : kernels_(choose_track_kernels()), points_(search_.points(parts)) {}

GimbalExtremes::Greatest GimbalExtremes::of(const model::SignalPair& motion, double end) {
  versine_most_ = rate_squared_most_ = 0;
  count_ = 0;
  spans_.clear();
  double from = 0;
  for (const double knot : motion.knots()) {
    if (knot > from && knot < end) {
      cover(motion, from, knot);
      from = knot;
    }
  }
  cover(motion, from, std::min(end, repeats_after(motion.view())));
  flush(motion);
  return {tilt_of(versine_most_), std::sqrt(rate_squared_most_)};
}

// Adds stretches over a time without knots in it.
void GimbalExtremes::cover(const model::SignalPair& motion, double from, double to) {
  const double wanted = std::ceil((to - from) * motion.bandwidth(from, to) / stretch);
  const double pieces = std::clamp(wanted, 1.0, most_stretches);
  const double length = (to - from) / pieces;
  for (double i = 0; i < pieces; ++i) {
    if (spans_.size() == together) flush(motion);
    double* const times = angles_.times(together * points_.size()) + count_;
    const double start = from + i * length;
    for (std::size_t p = 0; p < points_.size(); ++p) times[p] = start + length * points_[p];
    spans_.push_back({count_, parts});
    count_ += points_.size();
  }
}

void GimbalExtremes::flush(const model::SignalPair& motion) {
  versine_.resize(count_);
  rate_squared_.resize(count_);
  angles_.evaluate(motion, count_);
  double versine, rate_squared;
  kernels_.gimbal({angles_.value(0), angles_.value(1), angles_.rate(0), angles_.rate(1)}, count_,
                  {versine_.data(), rate_squared_.data()}, &versine, &rate_squared);
  versine_most_ = search_.greatest_between(spans_, versine_.data(), Spacing::close,
                                           std::max(versine, versine_most_));
  rate_squared_most_ = search_.greatest_between(spans_, rate_squared_.data(), Spacing::close,
                                                std::max(rate_squared, rate_squared_most_));
  spans_.clear();
  count_ = 0;
}

}  // namespace bbsim::record
