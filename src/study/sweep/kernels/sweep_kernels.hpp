// Measures of many rows at a time, in SIMD lanes: what a sweep sees of the kernels, whatever the
// instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

#include "model/signal_pair.hpp"

namespace bbsim::study {

// Arrays of rows are aligned to 64 bytes and padded to a multiple of this; what lies beyond the
// last row repeats it.
inline constexpr std::size_t row_padding = 8;

// The rows of one case, each quantity for itself.
struct Track {
  std::size_t rows = 0;
  const double *x = nullptr, *y = nullptr;                      // m
  const double *phi = nullptr, *theta = nullptr;                // rad
  const double *phi_rate = nullptr, *theta_rate = nullptr;      // rad/s
  const double *x_reference = nullptr, *y_reference = nullptr;  // m; null in open loop
};

// No number where a row holds none.
struct Extremes {
  double distance_squared = 0;   // greatest x^2 + y^2
  double rate_squared = 0;       // greatest phi'^2 + theta'^2
  std::size_t steepest = 0;      // the row with the greatest tilt
  double error_squared = 0;      // greatest squared distance from the reference
  double error_squared_sum = 0;  // over the rows
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

struct SweepKernels {
  const char* name;  // as of the integrator's kernels
  // `gimbal` and `reference` say whether the track has those.
  void (*extremes)(const Track& track, bool gimbal, bool reference, Extremes* extremes);
  void (*wave)(double frequency, const double* times, std::size_t rows, double* sines,
               double* cosines);
  // Both components and their rates at the times (s); without splines. A wave for each harmonic.
  void (*signals)(const model::SignalView& signals, const Wave* waves, const double* times,
                  std::size_t rows, double* const values[2], double* const rates[2]);
  // The greatest x^2 + y^2 over the rows.
  double (*farthest)(const Superposition& motion, const double* factors);
};

// Those of the instruction set that the integrator uses.
[[nodiscard]] const SweepKernels& choose_sweep_kernels();

}  // namespace bbsim::study
