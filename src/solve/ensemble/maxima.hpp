// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Maxima of a group of cases over a step, at the nodes and between them.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/peaks.hpp"
#include "solve/ensemble/workspace.hpp"

namespace bbsim::solve::ensemble {

using simd::HermitePoint;

template <class Of>
struct Maxima : Of {
  using Of::angles, Of::phi, Of::places, Of::theta, Of::x, Of::y;
  using Of::lanes, Of::nq, Of::nv, Of::packs, Of::rows, Of::s;
  using typename Of::Courses, typename Of::Half, typename Of::Mask, typename Of::P,
      typename Of::Pack, typename Of::Scene, typename Of::Signals, typename Of::Workspace;
  static constexpr bool given = Of::actuation == Actuation::given;

  static constexpr bool of_plate(int which) { return which == versine || which == rate_squared; }

  // The reference at a node. Given angles have none.
  BBSIM_INLINE static Signals reference_at(const Pack& of, int node) {
    if constexpr (given) {
      return no_reference();
    } else {
      return of.method.reference[node];
    }
  }
  BBSIM_INLINE static Signals no_reference() {
    const model::Jet<P> zero{P(0.0), P(0.0), P(0.0)};
    return {zero, zero};
  }

  // One of the sizes and its slope, for a pack's states at an instant. Slopes are
  // with respect to the fraction of the step.
  template <int which>
  BBSIM_INLINE static void look_at(const P* q, const P* v, const P* k, const Signals& reference,
                                   P h, P& size, P& slope) {
    if constexpr (which == versine) {
      // Angles beyond 10^5 rad, which have no practical use, lose the last digits.
      const SinCos<P> half_phi = sin_cos_of_moderate(P(0.5) * q[phi]);
      const SinCos<P> half_theta = sin_cos_of_moderate(P(0.5) * q[theta]);
      const P a = half_phi.sin * half_phi.sin, b = half_theta.sin * half_theta.sin;
      const P cos_phi = P(1.0) - P(2.0) * a, cos_theta = P(1.0) - P(2.0) * b;
      size = P(2.0) * (a + b) - P(4.0) * (a * b);
      slope = P(2.0) * h *
              (v[phi] * (half_phi.sin * half_phi.cos) * cos_theta +
               v[theta] * (half_theta.sin * half_theta.cos) * cos_phi);
    } else if constexpr (which == rate_squared) {
      size = v[phi] * v[phi] + v[theta] * v[theta];
      slope = P(2.0) * h * (v[phi] * k[phi] + v[theta] * k[theta]);
    } else {
      P from_x = q[x], from_y = q[y], rate_x = v[x], rate_y = v[y];
      if constexpr (which == error_squared) {
        from_x -= reference[0].value;
        from_y -= reference[1].value;
        rate_x -= reference[0].rate;
        rate_y -= reference[1].rate;
      }
      size = from_x * from_x + from_y * from_y;
      slope = P(2.0) * h * (from_x * rate_x + from_y * rate_y);
    }
  }

  template <int which>
  BBSIM_INLINE static void between(Workspace& w, int p, const Scene& scene, P part, P& size,
                                   P& slope) {
    constexpr Half half = of_plate(which) ? angles : places;
    const P h = Of::length(w, p), t = Of::from(w, p) + h * part;
    P q[nq], v[nv], k[nv], first[2], second[2];
    Signals reference{};
    if constexpr (given && half == angles) {
      const Signals at = Of::angles_at(w, p, scene, t);
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        q[phi + i] = at[i].value;
        v[phi + i] = at[i].rate;
        k[phi + i] = at[i].acceleration;
      }
    } else {
      Of::template make_courses<half>(w);
      const Courses& courses = w.of[p].courses[half];
      if constexpr (which == rate_squared) {
        courses.rates_at(part, first, second);
        v[phi] = first[0];
        v[theta] = first[1];
        k[phi] = second[0] / h;
        k[theta] = second[1] / h;
      } else {
        courses.at(part, first, second);
        q[2 * half] = first[0];
        q[2 * half + 1] = first[1];
        v[2 * half] = second[0];
        v[2 * half + 1] = second[1];
      }
      if constexpr (which == error_squared) reference = scene.signals(t);
    }
    look_at<which>(q, v, k, reference, h, size, slope);
  }

  template <int which>
  [[gnu::flatten]] static void look_pack(Workspace& w, int p, Mask wanted, double* greatest) {
    const Scene scene = Of::scene(w, p);
    Pack& of = w.of[p];
    const P h = Of::length(w, p);
    HermitePoint<P> places[s + 1];
    Signals reference{};
    if constexpr (which == error_squared) reference = scene.signals(Of::from(w, p));
    places[0].at = P(0.0);
    P k[nv];
    if constexpr (given) {
#pragma GCC unroll 2
      for (int i = phi; i <= theta; ++i) k[i] = of.k_end[i];
    } else if constexpr (which == rate_squared) {
      // The polynomial's own acceleration at its start, where it has no node.
      Of::template make_courses<angles>(w);
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        P sum(0.0);
        for (int m = 0; m < s; ++m) {
          sum += (m % 2 == 0 ? P(1.0) : P(-1.0)) * of.courses[angles].k[i][m];
        }
        k[phi + i] = sum / h;
      }
    }
    look_at<which>(of.q, of.v, k, reference, h, places[0].value, places[0].slope);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      places[j + 1].at = P(rows.c[j]);
      look_at<which>(of.q_at[j], of.v_at[j], of.k[j], reference_at(of, j), h, places[j + 1].value,
                     places[j + 1].slope);
    }
    const P before = P::load(greatest + p * lanes);
    P most = before;
    simd::raise_to_peak<s>(places, s + 1, most, [&](P part, P& size, P& slope) {
      between<which>(w, p, scene, part, size, slope);
    });
    choose(wanted, most, before).store(greatest + p * lanes);
  }

  // Upper bounds of all sizes over the step, as in simd::promise_between, with
  // squares of angles instead of sines.
  [[gnu::flatten]] static void bound(const Workspace& w, int p, P (&bounds)[size_count]) {
    const Scene scene = Of::scene(w, p);
    const Pack& of = w.of[p];
    const P h = Of::length(w, p);
    P before[size_count], rise_before[size_count];
    const auto take = [&](const P(&q)[nq], const P(&v)[nv], const P(&k)[nv],
                          const Signals& reference, P width, bool first)
        __attribute__((always_inline)) {
      P sizes[size_count], slopes[size_count];  // half the derivatives by time
      sizes[versine] = P(0.5) * (q[phi] * q[phi] + q[theta] * q[theta]);
      slopes[versine] = P(0.5) * (q[phi] * v[phi] + q[theta] * v[theta]);
      sizes[rate_squared] = v[phi] * v[phi] + v[theta] * v[theta];
      slopes[rate_squared] = v[phi] * k[phi] + v[theta] * k[theta];
      sizes[distance_squared] = q[x] * q[x] + q[y] * q[y];
      slopes[distance_squared] = q[x] * v[x] + q[y] * v[y];
      const P from_x = q[x] - reference[0].value, from_y = q[y] - reference[1].value;
      sizes[error_squared] = from_x * from_x + from_y * from_y;
      slopes[error_squared] =
          from_x * (v[x] - reference[0].rate) + from_y * (v[y] - reference[1].rate);
#pragma GCC unroll 4
      for (int i = 0; i < (given ? error_squared : size_count); ++i) {
        if (first) {
          bounds[i] = sizes[i];
        } else {
          const P rise = rise_before[i] + larger_of(-slopes[i], P(0.0));
          bounds[i] = larger_of(bounds[i], larger_of(before[i], sizes[i]) + width * rise);
        }
        before[i] = sizes[i];
        rise_before[i] = larger_of(slopes[i], P(0.0));
      }
    };
    take(of.q, of.v, of.k_end, given ? no_reference() : scene.signals(Of::from(w, p)), P(0.0),
         true);
    constexpr double beyond = 2 * 0.25;  // 2, because the slopes are halved
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      const P width = P(beyond * (rows.c[j] - (j > 0 ? rows.c[j - 1] : 0))) * h;
      take(of.q_at[j], of.v_at[j], of.k[j], reference_at(of, j), width, false);
    }
  }

  template <int which>
  BBSIM_INLINE static void raise_if_worth(Workspace& w, int p, Mask taken,
                                          const P (&bounds)[size_count], Greatest& greatest) {
    const Mask wanted = taken & (Mask)(bounds[which].v > P::load(greatest.of[which] + p * lanes).v);
    if (simd::any_of<P>(wanted)) look_pack<which>(w, p, wanted, greatest.of[which]);
  }

  static void raise_maxima(void* workspace, const Lanes& taken, const Lanes& turning,
                           Greatest& greatest) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      const Mask of = Of::mask(taken, p);
      if (!simd::any_of<P>(of)) continue;
      P bounds[size_count];
      bound(w, p, bounds);
      const Mask plate = of & Of::mask(turning, p);
      raise_if_worth<versine>(w, p, plate, bounds, greatest);
      raise_if_worth<rate_squared>(w, p, plate, bounds, greatest);
      raise_if_worth<distance_squared>(w, p, of, bounds, greatest);
      if constexpr (!given) raise_if_worth<error_squared>(w, p, of, bounds, greatest);
    }
  }
};

}  // namespace bbsim::solve::ensemble
