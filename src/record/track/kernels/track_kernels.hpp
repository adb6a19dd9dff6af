// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The interface of kernels that take measures of many instants at a time, in SIMD lanes.
//
// It has only plain data and pointers to functions. Nothing here may become code that two
// instruction sets share.
#pragma once

#include <cstddef>

#include "model/signals/signal_pair.hpp"

namespace bbsim::record {

// Arrays are aligned to 64 bytes. They are padded to a multiple of this with copies of the last
// value.
inline constexpr std::size_t row_padding = 8;

// The gimbal at some instants, in one array for each quantity.
struct GimbalTrack {
  const double *phi = nullptr, *theta = nullptr;            // rad
  const double *phi_rate = nullptr, *theta_rate = nullptr;  // rad/s
};

// The versine of its tilt, 1 - cos(tilt), and the square of its angular velocity, rad^2/s^2.
struct GimbalSizes {
  double *versine = nullptr, *rate_squared = nullptr;
};

// sin(frequency t) and cos(frequency t) at the times of the rows.
struct Wave {
  const double *sines = nullptr, *cosines = nullptr;
};

// Functions that fill an array of sizes return the greatest one. If a value is NaN, the result may
// be NaN.
struct TrackKernels {
  // Writes the greatest value of both sizes.
  void (*gimbal)(const GimbalTrack& track, std::size_t rows, const GimbalSizes& sizes,
                 double* versine, double* rate_squared);
  // Squared distances from the origin.
  double (*distances)(const double* x, const double* y, std::size_t rows, double* squares);
  double (*sum)(const double* values, std::size_t rows);
  // Writes 1 for each `row_padding` values if any of them exceeds the limit, otherwise 0.
  void (*above)(const double* values, std::size_t rows, double limit, unsigned char* any);
  void (*wave)(double frequency, const double* times, std::size_t rows, double* sines,
               double* cosines);
  // Both components and their rates at the times (s), without tables. `waves` has one wave for each
  // harmonic.
  void (*signals)(const model::SignalView& signals, const Wave* waves, const double* times,
                  std::size_t rows, double* const values[2], double* const rates[2]);
};

// The kernels of an instruction set (kernels.cpp).
template <class Isa>
[[nodiscard]] const TrackKernels& track_kernels();

// The kernels of the chosen instruction set. Throws InputError if there are none for it.
[[nodiscard]] const TrackKernels& choose_track_kernels();

}  // namespace bbsim::record
