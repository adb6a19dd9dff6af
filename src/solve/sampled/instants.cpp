// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/instants.hpp"

#include <cmath>

#include "base/instant.hpp"

namespace bbsim::solve::sampled {
namespace {

// The remainder of a time after whole periods, s.
double between(double time, double period) {
  return time - std::floor(time / period) * period;
}

}  // namespace

Instants::Instants(const model::SampledLoop& loop, bool cut) {
  const Sampling& sampling = loop.sampling;
  // A command is held for one period. The first piece lasts until the first command.
  lengths_ = {sampling.period, between(sampling.delay, sampling.period), 0};
  if (cut) lengths_[2] = lengths_[0] - lengths_[1];
  samples_[0].after = lengths_[0] - lengths_[1];  // a sample, after a command
  samples_[1].after = between(-loop.sensor.delay - lengths_[1], lengths_[0]);
}

double Instants::nominal(double time, double length) const {
  const double rounding = 2 * rounding_of(time + length);
  for (const double nominal_length : lengths_) {
    if (std::abs(nominal_length - length) <= rounding && nominal_length > 0) return nominal_length;
  }
  return length;
}

std::optional<double> Instants::recurring(double time, double after, double length) const {
  if (length != lengths_[0] && length != lengths_[1]) return {};
  const double rounding = 2 * rounding_of(time + after);
  for (const CachedAnswer& sample : samples_) {
    if (std::abs(sample.after - after) <= rounding) return sample.after;
  }
  return {};
}

const model::ImpulseAnswer& Instants::answer(const model::HeldLaw& law, double time, double after) {
  const double rounding = 2 * rounding_of(time + after);
  for (CachedAnswer& sample : samples_) {
    if (std::abs(sample.after - after) > rounding) continue;
    if (!sample.known || !(sample.law == law))
      sample = {sample.after, true, law, model::answer(law, sample.after)};
    return sample.answer;
  }
  if (!other_.known || other_.after != after || !(other_.law == law)) {
    other_ = {after, true, law, model::answer(law, after)};
  }
  return other_.answer;
}

}  // namespace bbsim::solve::sampled
