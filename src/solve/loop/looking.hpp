// What a group of closed loops is greatest at over a step, at the nodes and between them.
//
// Included only by the kernels; see simd/pack.hpp for why all is inlined or tagged.
#pragma once

#include "simd/peaks.hpp"
#include "solve/loop/workspace.hpp"

namespace bbsim::solve::loop {

using simd::Looked;

template <class Of>
struct Looking : Of {
  using Of::angles, Of::phi, Of::places, Of::theta, Of::x, Of::y;
  using Of::lanes, Of::nq, Of::nv, Of::packs, Of::rows, Of::s;
  using typename Of::Courses, typename Of::Half, typename Of::Loop, typename Of::Mask,
      typename Of::P, typename Of::Pack, typename Of::Reference, typename Of::Rule,
      typename Of::Workspace;

  // What is looked at, of a pack's states at an instant; slopes by the part of the step.
  template <int which>
  BBSIM_INLINE static void look_at(const P* q, const P* v, const P* k, const Reference& reference,
                                   P h, P& size, P& slope) {
    if constexpr (which == versine) {
      // Beyond 10^5 rad, in which nobody is interested, without the last digits.
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
  BBSIM_INLINE static void between(Workspace& w, int p, const Loop& loop, P part, P& size,
                                   P& slope) {
    constexpr Half half = which == versine || which == rate_squared ? angles : places;
    Of::template make_courses<half>(w);
    const Courses& courses = w.of[p].courses[half];
    const P h(w.h);
    P q[nq], v[nv], k[nv], first[2], second[2];
    Reference reference{};
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
      if constexpr (which == error_squared) reference = loop.reference(P(w.t) + h * part);
    }
    look_at<which>(q, v, k, reference, h, size, slope);
  }

  template <int which>
  [[gnu::flatten]] static void look_pack(Workspace& w, int p, double* greatest) {
    const Loop loop(w.loops, p);
    Pack& of = w.of[p];
    const P h(w.h);
    Looked<P> places[s + 1];
    Reference reference{};
    if constexpr (which == error_squared) reference = loop.reference(P(w.t));
    places[0].at = P(0.0);
    P k[nv];
    if constexpr (which == rate_squared) {
      // The polynomial's own slope: it starts at no node.
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
      look_at<which>(of.q_at[j], of.v_at[j], of.k[j], of.reference[j], h, places[j + 1].value,
                     places[j + 1].slope);
    }
    P most = P::load(greatest + p * lanes);
    simd::raise_to_peak<s>(places, s + 1, most, [&](P part, P& size, P& slope) {
      between<which>(w, p, loop, part, size, slope);
    });
    most.store(greatest + p * lanes);
  }

  // How far a time within the step is from a node at most, in parts of it.
  static constexpr double farthest = [] {
    double most = Rule::c[0];
    for (int j = 1; j < s; ++j) {
      const double half = (Rule::c[j] - Rule::c[j - 1]) / 2;
      if (half > most) most = half;
    }
    return most;
  }();

  // What some numbers may be greatest at, by their values at the nodes and their slopes there.
  template <int count>
  struct Reach {
    P value[count], slope[count];

    BBSIM_INLINE Reach() {
#pragma GCC unroll 8
      for (int i = 0; i < count; ++i) value[i] = slope[i] = P(0.0);
    }
    BBSIM_INLINE void take(int i, P at, P rate) {
      value[i] = larger_of(value[i], size_of(at));
      slope[i] = larger_of(slope[i], size_of(rate));
    }
    BBSIM_INLINE P square(int i, P h) const {
      constexpr double beyond = 1.5;  // of the slopes, what is between nodes
      const P most = value[i] + P(beyond * farthest) * h * slope[i];
      return most * most;
    }
  };

  // Bounds from above of all that is looked at.
  [[gnu::flatten]] static void bound(const Workspace& w, int p, P (&bounds)[looks]) {
    const Loop loop(w.loops, p);
    const Pack& of = w.of[p];
    Reach<nq> places;
    Reach<2> rates, errors;
    const auto take = [&](const P(&q)[nq], const P(&v)[nv], const Reference& reference)
        __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int i = 0; i < nq; ++i) places.take(i, q[i], v[i]);
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        const model::Jet<P>& aim = reference[static_cast<std::size_t>(i)];
        errors.take(i, q[i] - aim.value, v[i] - aim.rate);
      }
    };
    take(of.q, of.v, loop.reference(P(w.t)));
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      take(of.q_at[j], of.v_at[j], of.reference[j]);
      rates.take(0, of.v_at[j][phi], of.k[j][phi]);
      rates.take(1, of.v_at[j][theta], of.k[j][theta]);
    }
    rates.take(0, of.v[phi], of.k_end[phi]);
    rates.take(1, of.v[theta], of.k_end[theta]);
    const P h(w.h);
    bounds[versine] = P(0.5) * (places.square(phi, h) + places.square(theta, h));
    bounds[rate_squared] = rates.square(0, h) + rates.square(1, h);
    bounds[distance_squared] = places.square(x, h) + places.square(y, h);
    bounds[error_squared] = errors.square(0, h) + errors.square(1, h);
  }

  template <int which>
  BBSIM_INLINE static void look_if_worth(Workspace& w, int p, const P (&bounds)[looks],
                                         Greatest& greatest) {
    if (simd::any_of<P>((Mask)(bounds[which].v > P::load(greatest.of[which] + p * lanes).v))) {
      look_pack<which>(w, p, greatest.of[which]);
    }
  }

  static void look(void* workspace, Greatest& greatest) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      P bounds[looks];
      bound(w, p, bounds);
      look_if_worth<versine>(w, p, bounds, greatest);
      look_if_worth<rate_squared>(w, p, bounds, greatest);
      look_if_worth<distance_squared>(w, p, bounds, greatest);
      look_if_worth<error_squared>(w, p, bounds, greatest);
    }
  }
};

}  // namespace bbsim::solve::loop
