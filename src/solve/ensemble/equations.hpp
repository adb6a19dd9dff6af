// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The equations of eight cases, one in each lane, and their derivatives.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include <array>
#include <utility>

#include "model/systems/system.hpp"
#include "simd/compare.hpp"
#include "simd/dual.hpp"
#include "solve/ensemble/kernel.hpp"

namespace bbsim::solve::ensemble {

using simd::is_finite, simd::larger_of, simd::size_of;

// A group's cases, one per lane: the numbers of Case, each for all lanes.
struct alignas(64) Cases {
  double radius[group], gravity[group];
  double kv[2][2][group], kp[2][2][group];
  double omega_n[group], zeta[group];
  double start[2][group], rate[2][group];
  struct Harmonic {
    double frequency[group], sine[2][group], cosine[2][group];
  } harmonics[most_harmonics];
};
static_assert(sizeof(Cases) == group * numbers * sizeof(double));

template <class Isa, Actuation of>
struct Equations {
  static constexpr Actuation actuation = of;
  static constexpr Drives drives =
      actuation == Actuation::by_servo ? Drives::angle : Drives::acceleration;
  static constexpr int lanes = Isa::lanes;
  static constexpr int packs = group / lanes;
  using P = simd::Pack<Isa, lanes>;
  using Vector = typename P::Vector;
  using Mask = typename P::Mask;
  // Gives the layout and names of the states.
  using System = model::ClosedLoop<model::Shape::full, drives>;
  static constexpr auto motions = System::motions;
  static constexpr int nv = System::motions.count;
  static constexpr int nq = System::size - nv;  // velocities with a position come first
  static_assert(System::size == states && nv == velocities);
  // Indices among the velocities.
  static constexpr int x = 0, y = 1, phi = 2, theta = 3, spin = 4;
  static_assert(motions.of[phi].position == 5 && motions.of[theta].position == 6);
  static_assert(nq == 4);
  using Signals = std::array<model::Jet<P>, 2>;

  BBSIM_INLINE static P lane(const double* values, int p) { return P::load(values + p * lanes); }

  // The numbers of one pack's cases.
  struct Scene {
    P start[2], rate[2];
    model::BasicHarmonic<P> harmonics[most_harmonics];
    int harmonic_count;
    P radius, gravity;
    model::BasicGains<P> gains;
    model::BasicServoLaw<P> servo;

    BBSIM_INLINE Scene(const Cases& from, int count, int p)
        : start{lane(from.start[0], p), lane(from.start[1], p)},
          rate{lane(from.rate[0], p), lane(from.rate[1], p)},
          harmonic_count(count),
          radius(lane(from.radius, p)),
          gravity(lane(from.gravity, p)),
          gains{{{lane(from.kv[0][0], p), lane(from.kv[0][1], p)},
                 {lane(from.kv[1][0], p), lane(from.kv[1][1], p)}},
                {{lane(from.kp[0][0], p), lane(from.kp[0][1], p)},
                 {lane(from.kp[1][0], p), lane(from.kp[1][1], p)}}},
          servo{lane(from.omega_n, p), lane(from.zeta, p)} {
#pragma GCC unroll 1
      for (int k = 0; k < count; ++k) {
        const Cases::Harmonic& wave = from.harmonics[k];
        harmonics[k] = {lane(wave.frequency, p),
                        {lane(wave.sine[0], p), lane(wave.sine[1], p)},
                        {lane(wave.cosine[0], p), lane(wave.cosine[1], p)}};
      }
    }

    // Whether the waves' angles stay within 10^5 rad until t. Cheaper sines are then the same bit
    // for bit.
    BBSIM_INLINE bool moderate_until(P t) const {
      Mask beyond{};
#pragma GCC unroll 1
      for (int k = 0; k < harmonic_count; ++k) {
        beyond |= (Mask)(size_of(harmonics[k].frequency * t).v >= 1e5);
      }
      return !simd::any_of<P>(beyond);
    }

    // The signals at t, without tables.
    template <bool moderate = false>
    BBSIM_INLINE Signals signals(P t) const {
      Signals jets;
#pragma GCC unroll 2
      for (std::size_t i = 0; i < 2; ++i) jets[i] = {start[i] + rate[i] * t, rate[i], P(0.0)};
#pragma GCC unroll 1
      for (int k = 0; k < harmonic_count; ++k) {
        const model::BasicHarmonic<P>& harmonic = harmonics[k];
        const P w = harmonic.frequency, angle = w * t;
        const SinCos<P> wave = moderate ? sin_cos_of_moderate(angle) : sin_cos(angle);
#pragma GCC unroll 2
        for (std::size_t i = 0; i < 2; ++i) {
          const P value = harmonic.sine[i] * wave.sin + harmonic.cosine[i] * wave.cos;
          jets[i].value += value;
          jets[i].rate += w * (harmonic.sine[i] * wave.cos - harmonic.cosine[i] * wave.sin);
          jets[i].acceleration -= (w * w) * value;
        }
      }
      return jets;
    }
  };

  template <class Real>
  BBSIM_INLINE static model::RollingState<Real, Real, Real> ball_of(const Real (&q)[nq],
                                                                    const Real (&v)[nv]) {
    return {q[x], q[y], v[x], v[y], v[spin]};
  }

  // The accelerations that a loop gives the gimbal at a state.
  template <class Real>
  BBSIM_INLINE static void turn(const Scene& scene, const Signals& reference, const Real (&q)[nq],
                                const Real (&v)[nv], Real (&turning)[2]) {
    const auto ball = ball_of(q, v);
#pragma GCC unroll 2
    for (std::size_t row = 0; row < 2; ++row) {
      const Real u = model::command<Real>(scene.gains, row, ball, reference);
      turning[row] = scene.servo.template acceleration<drives, Real>(u, q[phi + row], v[phi + row]);
    }
  }

  // The ball's accelerations x'', y'', u' at a state, with given accelerations of the gimbal.
  template <class Real>
  BBSIM_INLINE static void roll(const Scene& scene, const Real (&q)[nq], const Real (&v)[nv],
                                const Real (&turning)[2], Real (&k)[3]) {
    roll(scene, sin_cos(q[phi]), sin_cos(q[theta]), q, v, turning, k);
  }
  template <class Real>
  BBSIM_INLINE static void roll(const Scene& scene, const SinCos<Real>& phi_at,
                                const SinCos<Real>& theta_at, const Real (&q)[nq],
                                const Real (&v)[nv], const Real (&turning)[2], Real (&k)[3]) {
    const auto ball = ball_of(q, v);
    const model::GimbalAngle<Real> first{phi_at.sin, phi_at.cos, v[phi], turning[0]};
    const model::GimbalAngle<Real> second{theta_at.sin, theta_at.cos, v[theta], turning[1]};
    k[0] = model::Equation27::x<Real>(first, second, ball, scene.radius, scene.gravity);
    k[1] = model::Equation27::y<Real>(first, second, ball, scene.radius, scene.gravity);
    k[2] = model::Equation27::u<Real>(first, second, ball, scene.radius);
  }

  // Derivatives of the accelerations: the gimbal's and the ball's by the states, and the ball's by
  // the gimbal's accelerations. Leaves out derivatives of the spin and by the spin.
  struct Jacobian {
    P by_v[nq][nq], by_q[nq][nq], by_turning[2][2];
  };

  template <int direction>
  BBSIM_INLINE static void differentiate_by(const Scene& scene, const Signals& reference,
                                            const P (&q)[nq], const P (&v)[nv],
                                            const P (&turning)[2], Jacobian& at) {
    using D = simd::Dual<P, simd::Angles::moderate>;
    D q_moving[nq], v_moving[nv], turning_moving[2], rolling[3];
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      v_moving[i] = D(v[i], P(i == direction ? 1.0 : 0.0));
      if (i < nq) q_moving[i] = D(q[i], P(nq + i == direction ? 1.0 : 0.0));
      if (i < 2) turning_moving[i] = D(turning[i], P(2 * nq + i == direction ? 1.0 : 0.0));
    }
    roll(scene, q_moving, v_moving, turning_moving, rolling);
    if constexpr (direction < 2 * nq) {
      turn(scene, reference, q_moving, v_moving, turning_moving);
      auto& by = direction < nq ? at.by_v : at.by_q;
      constexpr int column = direction % nq;
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        by[i][column] = rolling[i].slope;
        by[phi + i][column] = turning_moving[i].slope;
      }
    } else {
      for (int i = 0; i < 2; ++i) at.by_turning[i][direction - 2 * nq] = rolling[i].slope;
    }
  }

  template <int... direction>
  BBSIM_INLINE static void differentiate(const Scene& scene, const Signals& reference,
                                         const P (&q)[nq], const P (&v)[nv], const P (&turning)[2],
                                         Jacobian& at, std::integer_sequence<int, direction...>) {
    (differentiate_by<direction>(scene, reference, q, v, turning, at), ...);
  }

  BBSIM_INLINE static void differentiate(const Scene& scene, const Signals& reference,
                                         const P (&q)[nq], const P (&v)[nv], const P (&turning)[2],
                                         Jacobian& at) {
    differentiate(scene, reference, q, v, turning, at,
                  std::make_integer_sequence<int, 2 * nq + 2>());
  }

  // Replaces the velocities with those that the tolerances bound. Removes the ball's immediate
  // response to the servo's own motion: by (27) near level, -r phi'' and r theta''.
  BBSIM_INLINE static void without_servos(const Scene& scene, P (&v)[nv]) {
    if constexpr (actuation == Actuation::by_servo) {
      v[x] += scene.radius * v[phi];
      v[y] -= scene.radius * v[theta];
    }
  }
};

}  // namespace bbsim::solve::ensemble
