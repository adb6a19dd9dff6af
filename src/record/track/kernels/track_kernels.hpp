// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of many instants at a time, in SIMD lanes: what is seen of the kernels, whatever
// the instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

#include "model/signals/signal_pair.hpp"

namespace bbsim::record {

// Arrays are aligned to 64 bytes and padded to a multiple of this; what lies beyond the last value
// repeats it.
inline constexpr std::size_t row_padding = 8;

// The gimbal at some instants, each quantity for itself.
struct GimbalTrack {
  const double *phi = nullptr, *theta = nullptr;            // rad
  const double *phi_rate = nullptr, *theta_rate = nullptr;  // rad/s
};

// What grows with its tilt, 1 - cos(tilt), and the square of its angular velocity.
struct GimbalSizes {
  double *versine = nullptr, *rate_squared = nullptr;
};

// x and y as sums of `terms` known motions: x = sum of factor[k] * x_terms[k].
struct Superposition {
  std::size_t rows = 0, terms = 0;
  const double *const *x_terms = nullptr, *const *y_terms = nullptr;
};

// sin(frequency t) and cos(frequency t) at the times of the rows.
struct Wave {
  const double *sines = nullptr, *cosines = nullptr;
};

// Functions that fill an array of sizes return the greatest of them; no number may come of one that
// is none.
struct TrackKernels {
  // The greatest of both sizes.
  void (*gimbal)(const GimbalTrack& track, std::size_t rows, const GimbalSizes& sizes,
                 double* versine, double* rate_squared);
  // Squared distances from the origin.
  double (*distances)(const double* x, const double* y, std::size_t rows, double* squares);
  double (*sum)(const double* values, std::size_t rows);
  // Tells for each `row_padding` values whether any is above the limit: 1, or else 0.
  void (*above)(const double* values, std::size_t rows, double limit, unsigned char* any);
  void (*wave)(double frequency, const double* times, std::size_t rows, double* sines,
               double* cosines);
  // Both components and their rates at the times (s); without splines. A wave for each harmonic.
  void (*signals)(const model::SignalView& signals, const Wave* waves, const double* times,
                  std::size_t rows, double* const values[2], double* const rates[2]);
  // x^2 + y^2.
  double (*superpose)(const Superposition& motion, const double* factors, double* squares);
};

// Those of the instruction set that was chosen. Throws InputError if there is none such.
[[nodiscard]] const TrackKernels& choose_track_kernels();

}  // namespace bbsim::record
