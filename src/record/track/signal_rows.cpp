// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/signal_rows.hpp"

#include <algorithm>

namespace bbsim::record {

double* SignalRows::times(std::size_t count) {
  times_.resize(count);
  return times_.data();
}

void SignalRows::evaluate(const model::SignalPair& signals, std::size_t count) {
  times_.pad(count);
  for (PaddedRows* const column : {&values_[0], &values_[1], &rates_[0], &rates_[1]}) {
    column->resize(count);
  }
  const model::SignalView view = signals.view();
  if (view.shared.any()) {
    evaluate_all(signals, count);
    return;
  }
  evaluate_waves(view, count);
  double* const values[2] = {values_[0].data(), values_[1].data()};
  double* const rates[2] = {rates_[0].data(), rates_[1].data()};
  kernels_.signals(view, waves_.data(), times_.data(), count, values, rates);
}

void SignalRows::evaluate_all(const model::SignalPair& signals, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto jets = signals.at(times_.data()[i]);
    for (std::size_t c = 0; c < 2; ++c) {
      values_[c].data()[i] = jets[c].value;
      rates_[c].data()[i] = jets[c].rate;
    }
  }
  for (PaddedRows* const column : {&values_[0], &values_[1], &rates_[0], &rates_[1]}) {
    column->pad(count);
  }
}

void SignalRows::evaluate_waves(const model::SignalView& signals, std::size_t count) {
  const double* const times = times_.data();
  if (!std::equal(timed_.begin(), timed_.end(), times, times + count)) {
    timed_.assign(times, times + count);
    for (Sampled& sampled : sampled_) sampled.done = false;
  }
  if (sampled_.size() < signals.harmonic_count) sampled_.resize(signals.harmonic_count);
  waves_.clear();
  for (std::size_t k = 0; k < signals.harmonic_count; ++k) {
    Sampled& sampled = sampled_[k];
    const double frequency = signals.harmonics[k].frequency;
    if (!sampled.done || sampled.frequency != frequency) {
      sampled.done = true;
      sampled.frequency = frequency;
      sampled.sines.resize(count);
      sampled.cosines.resize(count);
      kernels_.wave(frequency, times, count, sampled.sines.data(), sampled.cosines.data());
    }
    waves_.push_back({sampled.sines.data(), sampled.cosines.data()});
  }
}

}  // namespace bbsim::record
