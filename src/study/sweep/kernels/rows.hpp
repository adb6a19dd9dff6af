// The sweep's kernels, for one instruction set.
#pragma once

#include "solve/collocation/pack.hpp"
#include "study/sweep/kernels/sweep_kernels.hpp"

namespace bbsim::study {

template <class Isa>
struct RowKernels {
  static constexpr int lanes = Isa::lanes;
  using P = solve::collocation::Pack<Isa, lanes>;
  using Sine = solve::collocation::SineTable;

  static constexpr std::size_t padded(std::size_t rows) {
    return (rows + row_padding - 1) / row_padding * row_padding;
  }

  BBSIM_INLINE static P larger(P a, P b) { return P::of(a.v > b.v ? a.v : b.v); }
  BBSIM_INLINE static P magnitude(P a) { return P::of(a.v < 0 ? -a.v : a.v); }
  BBSIM_INLINE static double largest(P a) {
    double most = a[0];
    for (int i = 1; i < lanes; ++i) most = a[i] > most ? a[i] : most;
    return most;
  }

  // Of |angle| <= pi/4.
  BBSIM_INLINE static P sine(P angle) {
    const auto u = angle.v * angle.v, u2 = u * u;
    const auto p =
        (Sine::sine[0] + u * Sine::sine[1]) +
        u2 * ((Sine::sine[2] + u * Sine::sine[3]) + u2 * (Sine::sine[4] + u * Sine::sine[5]));
    return P::of(angle.v + (angle.v * u) * p);
  }

  // Grows with the tilt: its sine squared, up to a right angle; then 2 less that.
  BBSIM_INLINE static P steepness(P phi, P theta, bool small) {
    if (small) {
      const P s = sine(phi), t = sine(theta);
      return s * s + (P(1.0) - s * s) * (t * t);
    }
    const auto p = sin_cos(phi), t = sin_cos(theta);
    const P squared = p.sin * p.sin + p.cos * p.cos * (t.sin * t.sin);
    const P up = p.cos * t.cos;
    return P::of(up.v > 0 ? squared.v : 2.0 - squared.v);
  }

  static std::size_t steepest(const Track& track, bool small) {
    P most = P(-1.0), where = P(0.0);
    alignas(64) double first[lanes];
    for (int l = 0; l < lanes; ++l) first[l] = l;
    P row = P::load(first);
    const std::size_t end = padded(track.rows);
    for (std::size_t i = 0; i < end; i += lanes) {
      const P now = steepness(P::load(track.phi + i), P::load(track.theta + i), small);
      const auto more = now.v > most.v;
      most = P::of(more ? now.v : most.v);
      where = P::of(more ? row.v : where.v);
      row += P(double(lanes));
    }
    int best = 0;
    for (int l = 1; l < lanes; ++l) {
      if (most[l] > most[best] || (most[l] == most[best] && where[l] < where[best])) best = l;
    }
    const auto found = static_cast<std::size_t>(where[best]);
    return found < track.rows ? found : track.rows - 1;
  }

  static void extremes(const Track& track, bool gimbal, bool reference, Extremes* result) {
    P distance = P(0.0), rate = P(0.0), angle = P(0.0), error = P(0.0), sum_of = P(0.0);
    const std::size_t end = padded(track.rows), whole = track.rows / lanes * lanes;
    for (std::size_t i = 0; i < end; i += lanes) {
      const P x = P::load(track.x + i), y = P::load(track.y + i);
      distance = larger(x * x + y * y, distance);
      if (gimbal) {
        const P phi_rate = P::load(track.phi_rate + i), theta_rate = P::load(track.theta_rate + i);
        rate = larger(phi_rate * phi_rate + theta_rate * theta_rate, rate);
        angle = larger(
            larger(magnitude(P::load(track.phi + i)), magnitude(P::load(track.theta + i))), angle);
      }
      if (reference) {
        const P dx = x - P::load(track.x_reference + i), dy = y - P::load(track.y_reference + i);
        const P squared = dx * dx + dy * dy;
        error = larger(squared, error);
        if (i < whole) sum_of += squared;
      }
    }
    result->distance_squared = largest(distance);
    if (gimbal) {
      result->rate_squared = largest(rate);
      result->steepest = steepest(track, largest(angle) < 0.78);
    }
    if (reference) {
      result->error_squared = largest(error);
      double total = sum(sum_of);
      for (std::size_t i = whole; i < track.rows; ++i) {
        const double dx = track.x[i] - track.x_reference[i];
        const double dy = track.y[i] - track.y_reference[i];
        total += dx * dx + dy * dy;
      }
      result->error_squared_sum = total;
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

  // What SignalView::at() computes, with the waves at hand.
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

  static double farthest(const Superposition& motion, const double* factors) {
    P most = P(0.0);
    const std::size_t end = padded(motion.rows);
    constexpr std::size_t together = 4;  // packs of rows, to fill the pipeline
    for (std::size_t i = 0; i < end; i += together * lanes) {
      P x[together], y[together];
      for (std::size_t p = 0; p < together; ++p) x[p] = y[p] = P(0.0);
      for (std::size_t k = 0; k < motion.terms; ++k) {
        const P factor = P(factors[k]);
#pragma GCC unroll 4
        for (std::size_t p = 0; p < together; ++p) {
          if (i + p * lanes >= end) break;
          x[p] += factor * P::load(motion.x_terms[k] + i + p * lanes);
          y[p] += factor * P::load(motion.y_terms[k] + i + p * lanes);
        }
      }
#pragma GCC unroll 4
      for (std::size_t p = 0; p < together; ++p) most = larger(x[p] * x[p] + y[p] * y[p], most);
    }
    return largest(most);
  }

  static constexpr SweepKernels named(const char* name) {
    return {name, &extremes, &wave, &signals, &farthest};
  }
};

}  // namespace bbsim::study
