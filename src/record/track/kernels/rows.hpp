// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The kernels, for one instruction set.
#pragma once

#include "record/track/kernels/track_kernels.hpp"
#include "simd/compare.hpp"

namespace bbsim::record {

template <class Isa>
struct RowKernels {
  static constexpr int lanes = Isa::lanes;
  using P = simd::Pack<Isa, lanes>;
  using Sine = simd::SineTable;

  static constexpr std::size_t padded(std::size_t rows) {
    return (rows + row_padding - 1) / row_padding * row_padding;
  }

  // The polynomial holds for |angle| <= pi/4.
  BBSIM_INLINE static P sine(P angle) {
    const auto u = angle.v * angle.v, u2 = u * u;
    const auto p =
        (Sine::sine[0] + u * Sine::sine[1]) +
        u2 * ((Sine::sine[2] + u * Sine::sine[3]) + u2 * (Sine::sine[4] + u * Sine::sine[5]));
    return P::of(angle.v + (angle.v * u) * p);
  }

  // 1 - cos(phi) cos(theta), without cancellation.
  BBSIM_INLINE static P versine(P sin_half_phi, P sin_half_theta) {
    const P a = sin_half_phi * sin_half_phi, b = sin_half_theta * sin_half_theta;
    return P(2.0) * (a + b) - P(4.0) * (a * b);
  }

  BBSIM_INLINE static double largest_angle(const GimbalTrack& track, std::size_t end) {
    P most = P(0.0);
    for (std::size_t i = 0; i < end; i += lanes) {
      const P phi = simd::size_of(P::load(track.phi + i)),
              theta = simd::size_of(P::load(track.theta + i));
      most = simd::larger_of(simd::larger_of(phi, theta), most);
    }
    return simd::largest_of(most);
  }

  static void gimbal(const GimbalTrack& track, std::size_t rows, const GimbalSizes& sizes,
                     double* versine_most, double* rate_squared_most) {
    const std::size_t end = padded(rows);
    const bool small = largest_angle(track, end) < 1.57;
    P versines = P(0.0), rates = P(0.0);
    for (std::size_t i = 0; i < end; i += lanes) {
      const P phi = P(0.5) * P::load(track.phi + i), theta = P(0.5) * P::load(track.theta + i);
      const P tilted =
          small ? versine(sine(phi), sine(theta)) : versine(sin_cos(phi).sin, sin_cos(theta).sin);
      tilted.store(sizes.versine + i);
      versines = simd::larger_of(tilted, versines);
      const P phi_rate = P::load(track.phi_rate + i), theta_rate = P::load(track.theta_rate + i);
      const P squared = phi_rate * phi_rate + theta_rate * theta_rate;
      squared.store(sizes.rate_squared + i);
      rates = simd::larger_of(squared, rates);
    }
    *versine_most = simd::largest_of(versines);
    *rate_squared_most = simd::largest_of(rates);
  }

  static double distances(const double* x, const double* y, std::size_t rows, double* squares) {
    P most = P(0.0);
    const std::size_t end = padded(rows);
    for (std::size_t i = 0; i < end; i += lanes) {
      const P dx = P::load(x + i), dy = P::load(y + i);
      const P squared = dx * dx + dy * dy;
      squared.store(squares + i);
      most = simd::larger_of(squared, most);
    }
    return simd::largest_of(most);
  }

  static double sum_of(const double* values, std::size_t rows) {
    P total = P(0.0);
    const std::size_t whole = rows / lanes * lanes;
    for (std::size_t i = 0; i < whole; i += lanes) total += P::load(values + i);
    double all = sum(total);
    for (std::size_t i = whole; i < rows; ++i) all += values[i];
    return all;
  }

  static void above(const double* values, std::size_t rows, double limit, unsigned char* marks) {
    static_assert(row_padding % lanes == 0);
    const std::size_t end = padded(rows);
    for (std::size_t i = 0; i < end; i += row_padding) {
      typename P::Mask more = P::load(values + i).v > limit;
      for (std::size_t k = lanes; k < row_padding; k += lanes) {
        more |= P::load(values + i + k).v > limit;
      }
      marks[i / row_padding] = simd::any_of<P>(more) ? 1 : 0;
    }
  }

  static void wave(double frequency, const double* times, std::size_t rows, double* sines,
                   double* cosines) {
    const std::size_t end = padded(rows);
    for (std::size_t i = 0; i < end; i += lanes) {
      const auto both = sin_cos(P(frequency) * P::load(times + i));
      both.sin.store(sines + i);
      both.cos.store(cosines + i);
    }
  }

  // As SignalView::at(), with the waves already computed.
  static void signals(const model::SignalView& view, const Wave* waves, const double* times,
                      std::size_t rows, double* const values[2], double* const rates[2]) {
    const std::size_t end = padded(rows);
    for (int c = 0; c < 2; ++c) {
      const P start = P(view.start[c]), rate = P(view.rate[c]);
      for (std::size_t i = 0; i < end; i += lanes) {
        P value = start + rate * P::load(times + i), slope = rate;
        for (std::size_t k = 0; k < view.harmonic_count; ++k) {
          const P sine = P::load(waves[k].sines + i), cosine = P::load(waves[k].cosines + i);
          const P a = P(view.harmonics[k].sine[c]), b = P(view.harmonics[k].cosine[c]);
          value += a * sine + b * cosine;
          slope += P(view.harmonics[k].frequency) * (a * cosine - b * sine);
        }
        value.store(values[c] + i);
        slope.store(rates[c] + i);
      }
    }
  }

  static constexpr TrackKernels kernels{&gimbal, &distances, &sum_of, &above, &wave, &signals};
};

}  // namespace bbsim::record
