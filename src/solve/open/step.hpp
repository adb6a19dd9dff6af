// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A step of a group of balls under given motions, for one instruction set.
//
// The gimbal's motion is given, so the ball's equation is linear in its five states:
//
//     k = f + A (x, y, x', y', u)
//
// The coefficients are computed once per step at the nodes of Radau IIA. Each lane has another
// case; the nodes are a loop. Substitution solves the remaining equations:
//
//     v = v(0) + h A1 k,    q = q(0) + c h v(0) + h^2 A2 k
//
// It goes from node to node and uses new values at once. An integral mostly depends on earlier
// nodes, so this contracts much faster than updating all nodes together: steps of some radians of
// the motion take three or four iterations. The decay of the Legendre coefficients of k gives the
// error estimate, as in radau/step.hpp.
#pragma once

#include "model/systems/system.hpp"
#include "simd/affine.hpp"
#include "simd/peaks.hpp"
#include "solve/collocation/convergence.hpp"
#include "solve/collocation/dense_output.hpp"
#include "solve/collocation/error_estimate.hpp"
#include "solve/collocation/node_rows.hpp"
#include "solve/open/kernel.hpp"

namespace bbsim::solve::open {

using simd::Looked;

// The parts that do not depend on the number of nodes.
template <class Isa>
struct Lanes {
  static constexpr int lanes = Isa::lanes;
  static constexpr int packs = group / lanes;
  using P = simd::Pack<Isa, lanes>;
  using Vector = typename P::Vector;
  using Mask = typename P::Mask;
  using Signals = model::BasicSignalView<P>;

  BBSIM_INLINE static P lane(const double* values, int p) { return P::load(values + p * lanes); }

  // The motions of one pack.
  struct Motion {
    model::BasicHarmonic<P> harmonics[most_harmonics];
    Signals signals;

    BBSIM_INLINE Motion(const Scenes& from, int p) {
#pragma GCC unroll 1
      for (int k = 0; k < from.harmonic_count; ++k) {
        const Scenes::Harmonic& one = from.harmonics[k];
        harmonics[k] = {lane(one.frequency, p),
                        {lane(one.sine[0], p), lane(one.sine[1], p)},
                        {lane(one.cosine[0], p), lane(one.cosine[1], p)}};
      }
      signals.harmonics = harmonics;
      signals.harmonic_count = static_cast<std::size_t>(from.harmonic_count);
      signals.shared = from.shared;
      for (int i = 0; i < 2; ++i) {
        signals.start[i] = lane(from.start[i], p);
        signals.rate[i] = lane(from.rate[i], p);
      }
    }
  };

  BBSIM_INLINE static SinCos<P> direction(P angle, bool small) {
    return small ? simd::sin_cos_of_small(angle) : sin_cos(angle);
  }

  // 1 - cos(tilt) without cancellation, and its slope.
  BBSIM_INLINE static void tilt(const std::array<model::Jet<P>, 2>& angles, bool small, P& versine,
                                P& slope) {
    const SinCos<P> half_phi = direction(P(0.5) * angles[0].value, small);
    const SinCos<P> half_theta = direction(P(0.5) * angles[1].value, small);
    const P a = half_phi.sin * half_phi.sin, b = half_theta.sin * half_theta.sin;
    const P cos_phi = P(1.0) - P(2.0) * a, cos_theta = P(1.0) - P(2.0) * b;
    versine = P(2.0) * (a + b) - P(4.0) * (a * b);
    slope = P(2.0) * (angles[0].rate * (half_phi.sin * half_phi.cos) * cos_theta +
                      angles[1].rate * (half_theta.sin * half_theta.cos) * cos_phi);
  }

  BBSIM_INLINE static void rate(const std::array<model::Jet<P>, 2>& angles, P& squared, P& slope) {
    squared = angles[0].rate * angles[0].rate + angles[1].rate * angles[1].rate;
    slope = P(2.0) *
            (angles[0].rate * angles[0].acceleration + angles[1].rate * angles[1].acceleration);
  }

  // The greatest squared rate of one sinusoid in both angles, over half a period or more. The
  // squared rate is a quadratic form in sin and cos. This is its greater eigenvalue.
  BBSIM_INLINE static P greatest_rate(const model::BasicHarmonic<P>& of) {
    const P(&a)[2] = of.sine, (&b)[2] = of.cosine;
    const P sines = a[0] * a[0] + a[1] * a[1], cosines = b[0] * b[0] + b[1] * b[1];
    const P mixed = a[0] * b[0] + a[1] * b[1], half = P(0.5) * (sines - cosines);
    const P most = P(0.5) * (sines + cosines) + simd::root_of(half * half + mixed * mixed);
    return of.frequency * of.frequency * most;
  }

  // Whether the rates are one sinusoid in every lane, over at least half a period.
  BBSIM_INLINE static bool is_one_wave(const Motion& motion, P until) {
    if (motion.signals.harmonic_count != 1) return false;
    const P half_period = P(3.141592653589793 * (1 - 1e-15)) /
                          simd::larger_of(simd::size_of(motion.harmonics[0].frequency), P(1e-300));
    const Mask no = (Mask)(motion.signals.rate[0].v != 0) | (Mask)(motion.signals.rate[1].v != 0) |
                    (Mask)(until.v < half_period.v);
    return !simd::any_of<P>(no);
  }

  static constexpr int together = 16;  // intervals per call of raise_to_peak()

  [[gnu::flatten]] static void turn_pack(const Scenes& scenes, int p, const double* until,
                                         int intervals, Turning& greatest) {
    const Motion motion(scenes, p);
    const bool small = scenes.small;
    const P part = lane(until, p) * P(1.0 / intervals);
    P versine(0.0), squared(0.0);
    const bool one_wave = is_one_wave(motion, lane(until, p));
    if (one_wave) squared = greatest_rate(motion.harmonics[0]);
#pragma GCC unroll 1
    for (int first = 0; first < intervals; first += together) {
      const int count = (intervals - first < together ? intervals - first : together) + 1;
      Looked<P> tilts[together + 1], rates[together + 1];
#pragma GCC unroll 1
      for (int i = 0; i < count; ++i) {
        const P t = P(double(first + i)) * part;
        const auto angles = motion.signals.at(t);
        tilts[i].at = rates[i].at = t;
        tilt(angles, small, tilts[i].value, tilts[i].slope);
        if (!one_wave) rate(angles, rates[i].value, rates[i].slope);
      }
      simd::raise_to_peak<together>(tilts, count, versine, [&](P t, P& value, P& slope) {
        tilt(motion.signals.at(t), small, value, slope);
      });
      if (one_wave) continue;
      simd::raise_to_peak<together>(rates, count, squared, [&](P t, P& value, P& slope) {
        rate(motion.signals.at(t), value, slope);
      });
    }
    versine.store(greatest.versine + p * lanes);
    squared.store(greatest.rate_squared + p * lanes);
  }

  static void directions(const double* angles, double* sines, double* cosines) {
    for (int p = 0; p < packs; ++p) {
      const SinCos<P> both = sin_cos(lane(angles, p));
      both.sin.store(sines + p * lanes);
      both.cos.store(cosines + p * lanes);
    }
  }

  static void turning(const Scenes& scenes, const double* until, int intervals, Turning& greatest) {
    for (int p = 0; p < packs; ++p) turn_pack(scenes, p, until, intervals, greatest);
  }
};

template <class Isa, int s>
struct Step : Lanes<Isa> {
  using Base = Lanes<Isa>;
  using Base::lane, Base::lanes, Base::packs;
  using typename Base::Mask, typename Base::Motion, typename Base::P, typename Base::Vector;
  using Ball = simd::Affine<P, states>;
  static constexpr int nv = 3, nq = 2;  // x', y', u; x, y

  static constexpr NodeRows<Isa, s> rows{};

  // Equation (27) at a node, times h. x'' does not depend on x', y'' not on y', and u' not on x, y
  // or u.
  struct Coefficients {
    P value[nv], x_by[4], y_by[4], u_by[2];

    BBSIM_INLINE void take(const Ball& x, const Ball& y, const Ball& u, P h) {
      value[0] = h * x.value;
      value[1] = h * y.value;
      value[2] = h * u.value;
      x_by[0] = h * x.by[0], x_by[1] = h * x.by[1], x_by[2] = h * x.by[3], x_by[3] = h * x.by[4];
      y_by[0] = h * y.by[0], y_by[1] = h * y.by[1], y_by[2] = h * y.by[2], y_by[3] = h * y.by[4];
      u_by[0] = h * u.by[2], u_by[1] = h * u.by[3];
    }
    BBSIM_INLINE void at(const P (&q)[nq], const P (&v)[nv], P (&k)[nv]) const {
      k[0] = (value[0] + x_by[0] * q[0] + x_by[1] * q[1]) + (x_by[2] * v[1] + x_by[3] * v[2]);
      k[1] = (value[1] + y_by[0] * q[0] + y_by[1] * q[1]) + (y_by[2] * v[0] + y_by[3] * v[2]);
      k[2] = value[2] + u_by[0] * v[0] + u_by[1] * v[1];
    }
  };

  struct Pack {
    P q[nq], v[nv];          // the present state
    P q_end[nq], v_end[nv];  // the end of the last attempt
    P k[s][nv];              // accelerations times h, at the nodes
    P q_at[s][nq], v_at[s][nv];
    P weight, q_weight[nq], v_weight[nv];  // inverse tolerances
    P distance_squared;                    // the greatest so far
  };

  struct alignas(64) Workspace {
    Scenes scenes;
    double rtol, atol;
    double t, h;  // of the last attempt
    Coefficients at[s];
    Pack of[packs];
  };

  [[gnu::flatten]] static void take_coefficients(Workspace& w, int p) {
    const Motion motion(w.scenes, p);
    const P r = lane(w.scenes.radius, p), g = lane(w.scenes.gravity, p), h(w.h);
    const bool small = w.scenes.small;
    const model::RollingState<Ball, Ball, Ball> ball{Ball::variable(0), Ball::variable(1),
                                                     Ball::variable(2), Ball::variable(3),
                                                     Ball::variable(4)};
#pragma GCC unroll 1
    for (int i = 0; i < s; ++i) {
      const auto angles = motion.signals.at(P(w.t + rows.c[i] * w.h));
      model::Axis<P> axis[2];
#pragma GCC unroll 2
      for (int n = 0; n < 2; ++n) {
        const SinCos<P> direction = Base::direction(angles[n].value, small);
        axis[n] = {direction.sin, direction.cos, angles[n].rate, angles[n].acceleration};
      }
      w.at[i].take(model::x_acceleration<Ball>(axis[0], axis[1], ball, r, g),
                   model::y_acceleration<Ball>(axis[0], axis[1], ball, r, g),
                   model::u_acceleration<Ball>(axis[0], axis[1], ball, r), h);
    }
  }

  // Integrates k from the start to `count` nodes. The table has one row per node.
  template <int count>
  BBSIM_INLINE static void integrate(const Pack& of, P h, int first, P (&q)[count][nq],
                                     P (&v)[count][nv]) {
    P once[count][nv], twice[count][nq];
#pragma GCC unroll 4
    for (int n = 0; n < count; ++n) {
#pragma GCC unroll 3
      for (int i = 0; i < nv; ++i) once[n][i] = P(0.0);
#pragma GCC unroll 3
      for (int i = 0; i < nq; ++i) twice[n][i] = P(0.0);
    }
    const auto add = [&](int j) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int n = 0; n < count; ++n) {
        const P a(rows.a[first + n][j]), b(rows.a_squared[first + n][j]);
#pragma GCC unroll 3
        for (int i = 0; i < nv; ++i) {
          once[n][i] += a * of.k[j][i];
          if (i < nq) twice[n][i] += b * of.k[j][i];
        }
      }
    };
      // Add the newest values last, so that no sum waits for them.
#pragma GCC unroll 2
    for (int j = first; j < s; ++j) add(j);
#pragma GCC unroll 2
    for (int j = 0; j < first; ++j) add(j);
#pragma GCC unroll 4
    for (int n = 0; n < count; ++n) {
      const P time = P(rows.c[first + n]) * h;
#pragma GCC unroll 3
      for (int i = 0; i < nv; ++i) {
        v[n][i] = of.v[i] + once[n][i];
        if (i < nq) q[n][i] = of.q[i] + (time * of.v[i] + h * twice[n][i]);
      }
    }
  }

  // Sets the weights from the tolerance and the largest states over the step.
  BBSIM_INLINE static void weigh(const Workspace& w, Pack& of) {
    const P rtol(w.rtol), atol(w.atol);
    P q_size(0.0), v_size(0.0);
#pragma GCC unroll 3
    for (int i = 0; i < nv; ++i) {
      P v = simd::size_of(of.v[i]), q(0.0);
#pragma GCC unroll 1
      for (int j = 0; j < s; ++j) {
        v = simd::larger_of(v, simd::size_of(of.v_at[j][i]));
        if (i < nq) q = simd::larger_of(q, simd::size_of(of.q_at[j][i]));
      }
      of.v_weight[i] = P(1.0) / (rtol * v + atol);
      v_size = simd::larger_of(v_size, v);
      if (i == nq) continue;
      q = simd::larger_of(q, simd::size_of(of.q[i]));
      of.q_weight[i] = P(1.0) / (rtol * q + atol);
      q_size = simd::larger_of(q_size, q);
    }
    of.weight = simd::larger_of(P(1.0) / (rtol * v_size + atol), P(w.h) / (rtol * q_size + atol));
  }

  static constexpr int most_iterations = 15;

  // Solves one pack. Returns whether substitution converged.
  [[gnu::flatten]] static bool solve(Workspace& w, int p, int& iterations) {
    Pack& of = w.of[p];
    const P h(w.h);
    // First guess: the ball keeps its velocity.
#pragma GCC unroll 1
    for (int i = 0; i < s; ++i) {
      const P time(w.h * rows.c[i]);
      const P q[nq] = {of.q[0] + time * of.v[0], of.q[1] + time * of.v[1]};
      w.at[i].at(q, of.v, of.k[i]);
    }
    const StopTest stop(1e-2, w.rtol);
    double last = 0;
    for (iterations = 1;; ++iterations) {
      P change[nv] = {P(0.0), P(0.0), P(0.0)};
      constexpr int together = 2;
      static_assert(s % together == 0);
#pragma GCC unroll 1
      for (int first = 0; first < s; first += together) {
        P q[together][nq], v[together][nv];
        integrate<together>(of, h, first, q, v);
#pragma GCC unroll 4
        for (int n = 0; n < together; ++n) {
          P k[nv];
          w.at[first + n].at(q[n], v[n], k);
#pragma GCC unroll 3
          for (int i = 0; i < nv; ++i) {
            change[i] = simd::larger_of(change[i], simd::size_of(k[i] - of.k[first + n][i]));
            of.k[first + n][i] = k[i];
            of.v_at[first + n][i] = v[n][i];
            if (i < nq) of.q_at[first + n][i] = q[n][i];
          }
        }
      }
      if (iterations == 1) weigh(w, of);
      const P most = simd::larger_of(simd::larger_of(change[0], change[1]), change[2]);
      const double now = simd::largest_of(most * of.weight);
      if (!simd::is_finite(now)) return true;  // estimate() tests the states
      const double contraction = iterations > 1 ? now / last : 1;
      if (stop.passes(now, contraction)) return true;
      if (iterations >= most_iterations || (iterations > 3 && contraction > 0.5)) return false;
      last = now;
    }
  }

  // The square of the error: the first coefficient left out, integrated once for a velocity and
  // twice for a position.
  [[gnu::flatten]] static P estimate(const Workspace& w, int p) {
    const Pack& of = w.of[p];
    constexpr double once = 1.0 / (2 * s + 1);
    const double twice = once * once * w.h;
    const LastCoefficients<P, s, nv> series(rows.legendre, of.k);
    P error(0.0);
    Mask finite = ~Mask{};
#pragma GCC unroll 3
    for (int i = 0; i < nv; ++i) {
      finite &= simd::is_finite(of.v_end[i]);
      P weight = P(once) * of.v_weight[i];
      if (i < nq) {
        finite &= simd::is_finite(of.q_end[i]);
        weight = simd::larger_of(weight, P(twice) * of.q_weight[i]);
      }
      error = simd::larger_of(error, series.left_out_squared(i, weight));
    }
    return P::of((Vector)((Mask)error.v | ~finite));  // all bits set: NaN
  }

  static void start(void* workspace, const Scenes& scenes, double rtol, double atol) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.scenes = scenes;
    w.rtol = rtol;
    w.atol = atol;
    w.t = w.h = 0;
    for (int p = 0; p < packs; ++p) {
      Pack& of = w.of[p];
      for (int i = 0; i < nq; ++i) of.q[i] = lane(scenes.initial[i], p);
      for (int i = 0; i < nv; ++i) of.v[i] = lane(scenes.initial[nq + i], p);
      of.distance_squared = P(0.0);
    }
  }

  static void attempt(void* workspace, double t, double h, Attempt& result) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.t = t;
    w.h = h;
    result.converged = true;
    result.iterations = 0;
    for (int p = 0; p < packs; ++p) {
      int iterations = 0;
      take_coefficients(w, p);
      result.converged = solve(w, p, iterations) && result.converged;
      result.iterations = iterations > result.iterations ? iterations : result.iterations;
      Pack& of = w.of[p];
      P q[1][nq], v[1][nv];
      integrate<1>(of, P(h), s - 1, q, v);
      for (int i = 0; i < nv; ++i) of.v_end[i] = v[0][i];
      for (int i = 0; i < nq; ++i) of.q_end[i] = q[0][i];
      estimate(w, p).store(result.error_squared + p * lanes);
    }
  }

  [[gnu::flatten]] static void look(Workspace& w, int p) {
    Pack& of = w.of[p];
    const P h(w.h);
    Looked<P> places[s + 1];
    const auto put = [&](Looked<P> & place, P part, const P(&q)[nq], const P(&v)[nv])
        __attribute__((always_inline)) {
      place.at = part;
      place.value = q[0] * q[0] + q[1] * q[1];
      place.slope = P(2.0) * h * (q[0] * v[0] + q[1] * v[1]);
    };
    put(places[0], P(0.0), of.q, of.v);
#pragma GCC unroll 1
    for (int i = 0; i + 1 < s; ++i) put(places[i + 1], P(rows.c[i]), of.q_at[i], of.v_at[i]);
    put(places[s], P(1.0), of.q_end, of.v_end);
    DenseOutput<P, s, nq> path;
    bool made = false;
    simd::raise_to_peak<s>(places, s + 1, of.distance_squared, [&](P part, P& value, P& slope) {
      if (!made) {
        path.make(
            rows.legendre,
            h, [&](int j, int i) __attribute__((always_inline)) { return of.k[j][i]; },
            [&](int i) __attribute__((always_inline)) { return of.q[i]; },
            [&](int i) __attribute__((always_inline)) { return of.v[i]; });
        made = true;
      }
      P q[nq], v[nq];
      path.at(part, q, v);
      value = q[0] * q[0] + q[1] * q[1];
      slope = P(2.0) * h * (q[0] * v[0] + q[1] * v[1]);
    });
  }

  static void accept(void* workspace) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      look(w, p);
      Pack& of = w.of[p];
      for (int i = 0; i < nq; ++i) of.q[i] = of.q_end[i];
      for (int i = 0; i < nv; ++i) of.v[i] = of.v_end[i];
    }
  }

  static void read(const void* workspace, double (*state)[group], double* distance_squared) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      const Pack& of = w.of[p];
      for (int i = 0; i < nq; ++i) of.q[i].store(state[i] + p * lanes);
      for (int i = 0; i < nv; ++i) of.v[i].store(state[nq + i] + p * lanes);
      of.distance_squared.store(distance_squared + p * lanes);
    }
  }

  static void twin(void* workspace, int to, int from) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    const auto copy = [&](double* values) { values[to] = values[from]; };
    Scenes& scenes = w.scenes;
    copy(scenes.radius);
    copy(scenes.gravity);
    for (int i = 0; i < 2; ++i) {
      copy(scenes.start[i]);
      copy(scenes.rate[i]);
    }
    for (int k = 0; k < scenes.harmonic_count; ++k) {
      Scenes::Harmonic& one = scenes.harmonics[k];
      copy(one.frequency);
      for (int i = 0; i < 2; ++i) {
        copy(one.sine[i]);
        copy(one.cosine[i]);
      }
    }
    const auto copy_lane = [&](auto value) {
      value(w.of[to / lanes]).v[to % lanes] = value(w.of[from / lanes]).v[from % lanes];
    };
    for (int i = 0; i < nq; ++i) copy_lane([i](Pack& of) -> P& { return of.q[i]; });
    for (int i = 0; i < nv; ++i) copy_lane([i](Pack& of) -> P& { return of.v[i]; });
    copy_lane([](Pack& of) -> P& { return of.distance_squared; });
  }

  static constexpr Kernel kernel{s, sizeof(Workspace), start, attempt, accept, read, twin};
};

template <class Isa>
inline constexpr Kernels kernels_of{Step<Isa, 8>::kernel, Step<Isa, 12>::kernel,
                                    Step<Isa, 16>::kernel, Lanes<Isa>::directions,
                                    Lanes<Isa>::turning};

}  // namespace bbsim::solve::open
