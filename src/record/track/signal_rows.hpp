// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Evaluates two functions of time (a gimbal's motion or a reference) at many times at once.
#pragma once

#include <cstddef>
#include <vector>

#include "model/signals/signal_pair.hpp"
#include "record/track/kernels/track_kernels.hpp"
#include "record/track/padded_rows.hpp"

namespace bbsim::record {

class SignalRows {
 public:
  SignalRows() : kernels_(choose_track_kernels()) {}

  // The memory for the times, s. Keeps the previous times if there is room already.
  [[nodiscard]] double* times(std::size_t count);
  // Evaluates the signals at the first `count` times. Reuses the sinusoids of the previous call if
  // the frequency and the times are the same.
  void evaluate(const model::SignalPair& signals, std::size_t count);

  [[nodiscard]] const double* value(std::size_t component) const {
    return values_[component].data();
  }
  [[nodiscard]] const double* rate(std::size_t component) const { return rates_[component].data(); }

 private:
  void evaluate_all(const model::SignalPair& signals, std::size_t count);
  void evaluate_waves(const model::SignalView& signals, std::size_t count);

  struct Sampled {
    double frequency = 0;
    bool done = false;
    PaddedRows sines, cosines;
  };

  const TrackKernels& kernels_;
  PaddedRows times_, values_[2], rates_[2];
  std::vector<Sampled> sampled_;  // at timed_
  std::vector<double> timed_;
  std::vector<Wave> waves_;
};

}  // namespace bbsim::record
