// A step of a group of closed loops, for one way to drive the gimbal, one number of nodes and one
// instruction set.
//
// Radau IIA as in radau/step.hpp, with another loop in each lane and the nodes in a loop: the
// unknowns are the accelerations k at the nodes,
//     v = v(0) + h A k,    q = q(0) + c h v(0) + h^2 A A k,    k = f(t, q, v, k),
// and Newton's iteration corrects them,
//     (I - Jk - h A (x) Jv - h^2 A A (x) Jq) dk = f - k,
// which the eigenvectors of A part into a complex system for each pair of eigenvalues. The spin is
// no part of it: nothing that is stiff comes by way of it.
//
// The ball's accelerations are taken where the gimbal's are k, not what the servos would do at the
// state: of a stiff servo that is a difference of large numbers, and as it stands before another
// factor at each node, one Jacobian for all of them would be far from each. As it is, what is stiff
// is linear, and loops about a plane that is nearly level have nearly the same Jacobian throughout
// a step: three corrections do.
#pragma once

#include <utility>

#include "model/systems/system.hpp"
#include "simd/dual.hpp"
#include "simd/peaks.hpp"
#include "solve/lane_courses.hpp"
#include "solve/loop/kernel.hpp"
#include "solve/radau/tables.hpp"

namespace bbsim::solve::loop {

using simd::is_finite, simd::larger_of, simd::Looked, simd::size_of;

template <class Isa, Drives drives, int s>
struct Step {
  static constexpr int lanes = Isa::lanes;
  static constexpr int packs = group / lanes;
  static constexpr int pairs = s / 2;
  using P = simd::Pack<Isa, lanes>;
  using Vector = typename P::Vector;
  using Mask = typename P::Mask;
  using Rule = radau::RadauTable<s>;
  // Of which come the layout of the states and what they are named.
  using System = model::ClosedLoop<model::Shape::full, drives>;
  static constexpr int n = System::size;
  static constexpr auto motions = System::motions;
  static constexpr int nv = System::motions.count;
  static constexpr int nq = n - nv;  // velocities with a position come first
  static_assert(n == states);
  // Among the velocities.
  static constexpr int x = 0, y = 1, phi = 2, theta = 3, spin = 4;
  static_assert(motions.of[phi].position == 5 && motions.of[theta].position == 6);
  static_assert(nq == 4);
  using Reference = std::array<model::Jet<P>, 2>;
  using Courses = LaneCourses<P, s, 2>;
  enum Half : int { places, angles };  // of the positions, and their velocities

  // The tables by rows: what one node takes from all. A copy of each instruction set's own.
  struct alignas(64) Rows {
    double c[s]{}, a[s][s]{}, a_squared[s][s]{}, legendre[s][s]{};
    double lambda_re[pairs]{}, lambda_im[pairs]{};
    double forward_re[s][pairs]{}, forward_im[s][pairs]{};
    double back_re[s][pairs]{}, back_im[s][pairs]{};
    consteval Rows() {
      for (int i = 0; i < s; ++i) {
        c[i] = Rule::c[i];
        for (int j = 0; j < s; ++j) {
          legendre[i][j] = Rule::legendre[i][j];
          a[i][j] = Rule::a[j][i];
          a_squared[i][j] = Rule::a_squared[j][i];
        }
        for (int k = 0; k < pairs; ++k) {
          forward_re[i][k] = Rule::forward_re[i][k];
          forward_im[i][k] = Rule::forward_im[i][k];
          back_re[i][k] = Rule::back_re[k][i];
          back_im[i][k] = Rule::back_im[k][i];
        }
      }
      for (int k = 0; k < pairs; ++k) {
        lambda_re[k] = Rule::lambda_re[k];
        lambda_im[k] = Rule::lambda_im[k];
      }
    }
  };
  static constexpr Rows rows{};

  // A complex number in each lane.
  struct Complex {
    P re, im;
    BBSIM_INLINE friend Complex operator*(const Complex& a, const Complex& b) {
      return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    BBSIM_INLINE friend Complex operator-(const Complex& a, const Complex& b) {
      return {a.re - b.re, a.im - b.im};
    }
  };

  struct Pack {
    P q[nq], v[nv];  // the present state
    P k_end[nv];     // accelerations there
    // At the nodes of the last attempt.
    P k[s][nv], q_at[s][nq], v_at[s][nv], residual[s][nq];
    Reference reference[s];
    Complex matrix[pairs][nq][nq], transformed[pairs][nq];
    P q_weight[nq], v_weight[nv];  // one over the tolerances
    Courses courses[2];            // of the last attempt, by halves
  };

  struct alignas(64) Workspace {
    Loops loops;
    double rtol, atol;
    double t, h;      // of the last attempt
    bool courses[2];  // whether they are those of it
    Pack of[packs];
  };

  // The loops of one pack.
  struct Loop {
    P start[2], rate[2], frequency, sine[2], cosine[2];
    P radius, gravity;
    model::BasicGains<P> gains;
    model::BasicServoLaw<P> servo;

    BBSIM_INLINE Loop(const Loops& from, int p)
        : start{lane(from.start[0], p), lane(from.start[1], p)},
          rate{lane(from.rate[0], p), lane(from.rate[1], p)},
          frequency(lane(from.frequency, p)),
          sine{lane(from.sine[0], p), lane(from.sine[1], p)},
          cosine{lane(from.cosine[0], p), lane(from.cosine[1], p)},
          radius(lane(from.radius, p)),
          gravity(lane(from.gravity, p)),
          gains{{{lane(from.kv[0][0], p), lane(from.kv[0][1], p)},
                 {lane(from.kv[1][0], p), lane(from.kv[1][1], p)}},
                {{lane(from.kp[0][0], p), lane(from.kp[0][1], p)},
                 {lane(from.kp[1][0], p), lane(from.kp[1][1], p)}}},
          servo{lane(from.omega_n, p), lane(from.zeta, p)} {}

    BBSIM_INLINE static P lane(const double* values, int p) { return P::load(values + p * lanes); }

    BBSIM_INLINE Reference reference(P t) const {
      const SinCos<P> wave = sin_cos(frequency * t);
      Reference jets;
#pragma GCC unroll 2
      for (std::size_t i = 0; i < 2; ++i) {
        jets[i].value = start[i] + rate[i] * t + (sine[i] * wave.sin + cosine[i] * wave.cos);
        jets[i].rate = rate[i] + frequency * (sine[i] * wave.cos - cosine[i] * wave.sin);
        jets[i].acceleration = P(0.0);  // no part of the loop
      }
      return jets;
    }
  };

  template <class Real>
  BBSIM_INLINE static model::RollingState<Real, Real, Real> ball_of(const Real (&q)[nq],
                                                                    const Real (&v)[nv]) {
    return {q[x], q[y], v[x], v[y], v[spin]};
  }

  // The gimbal's accelerations at a state.
  template <class Real>
  BBSIM_INLINE static void turn(const Loop& loop, const Reference& reference, const Real (&q)[nq],
                                const Real (&v)[nv], Real (&turning)[2]) {
    const auto ball = ball_of(q, v);
#pragma GCC unroll 2
    for (std::size_t row = 0; row < 2; ++row) {
      const Real u = model::command<Real>(loop.gains, row, ball, reference);
      turning[row] = loop.servo.template acceleration<drives, Real>(u, q[phi + row], v[phi + row]);
    }
  }

  // The ball's accelerations x'', y'', u' at a state in which the gimbal's are given.
  template <class Real>
  BBSIM_INLINE static void roll(const Loop& loop, const Real (&q)[nq], const Real (&v)[nv],
                                const Real (&turning)[2], Real (&k)[3]) {
    roll(loop, sin_cos(q[phi]), sin_cos(q[theta]), q, v, turning, k);
  }
  template <class Real>
  BBSIM_INLINE static void roll(const Loop& loop, const SinCos<Real>& phi_at,
                                const SinCos<Real>& theta_at, const Real (&q)[nq],
                                const Real (&v)[nv], const Real (&turning)[2], Real (&k)[3]) {
    const auto ball = ball_of(q, v);
    const model::Axis<Real> first{phi_at.sin, phi_at.cos, v[phi], turning[0]};
    const model::Axis<Real> second{theta_at.sin, theta_at.cos, v[theta], turning[1]};
    k[0] = model::x_acceleration<Real>(first, second, ball, loop.radius, loop.gravity);
    k[1] = model::y_acceleration<Real>(first, second, ball, loop.radius, loop.gravity);
    k[2] = model::u_acceleration<Real>(first, second, ball, loop.radius);
  }

  // Accelerations' derivatives, but for the spin's and by the spin: the gimbal's by the states, the
  // ball's by these and by the gimbal's accelerations.
  struct Jacobian {
    P by_v[nq][nq], by_q[nq][nq], by_turning[2][2];
  };

  template <int direction>
  BBSIM_INLINE static void differentiate_by(const Loop& loop, const Reference& reference,
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
    roll(loop, q_moving, v_moving, turning_moving, rolling);
    if constexpr (direction < 2 * nq) {
      turn(loop, reference, q_moving, v_moving, turning_moving);
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
  BBSIM_INLINE static void differentiate(const Loop& loop, const Reference& reference,
                                         const P (&q)[nq], const P (&v)[nv], const P (&turning)[2],
                                         Jacobian& at, std::integer_sequence<int, direction...>) {
    (differentiate_by<direction>(loop, reference, q, v, turning, at), ...);
  }

  BBSIM_INLINE static void differentiate(const Loop& loop, const Reference& reference,
                                         const P (&q)[nq], const P (&v)[nv], const P (&turning)[2],
                                         Jacobian& at) {
    differentiate(loop, reference, q, v, turning, at,
                  std::make_integer_sequence<int, 2 * nq + 2>());
  }

  // Elimination begins with the servo's axes, the stiffest; without pivoting.
  static constexpr int order[nq] = {phi, theta, x, y};

  // I - Jk - h l Jv - h^2 l^2 Jq for each eigenvalue l, and its LU factors in place, rows and
  // columns in that order; the diagonal holds its own inverse.
  BBSIM_INLINE static void factor(const Jacobian& at, double h, Pack& of) {
#pragma GCC unroll 1
    for (int k = 0; k < pairs; ++k) {
      const double re = h * rows.lambda_re[k], im = h * rows.lambda_im[k];
      const P re1(re), im1(im), re2(re * re - im * im), im2(2 * re * im);
      auto& m = of.matrix[k];
#pragma GCC unroll 8
      for (int i = 0; i < nq; ++i) {
#pragma GCC unroll 8
        for (int j = 0; j < nq; ++j) {
          const P by_v = at.by_v[order[i]][order[j]], by_q = at.by_q[order[i]][order[j]];
          P part(i == j ? 1.0 : 0.0);
          if (order[i] < phi && order[j] >= phi) part -= at.by_turning[order[i]][order[j] - phi];
          m[i][j] = {part - re1 * by_v - re2 * by_q, -(im1 * by_v) - im2 * by_q};
        }
      }
#pragma GCC unroll 8
      for (int p = 0; p < nq; ++p) {
        const P scale = P(1.0) / (m[p][p].re * m[p][p].re + m[p][p].im * m[p][p].im);
        m[p][p] = {m[p][p].re * scale, -(m[p][p].im * scale)};
#pragma GCC unroll 8
        for (int i = p + 1; i < nq; ++i) {
          m[i][p] = m[i][p] * m[p][p];
#pragma GCC unroll 8
          for (int j = p + 1; j < nq; ++j) m[i][j] = m[i][j] - m[i][p] * m[p][j];
        }
      }
    }
  }

  BBSIM_INLINE static void substitute(const Complex (&m)[nq][nq], Complex (&z)[nq]) {
#pragma GCC unroll 8
    for (int i = 1; i < nq; ++i) {
#pragma GCC unroll 8
      for (int j = 0; j < i; ++j) z[i] = z[i] - m[i][j] * z[j];
    }
#pragma GCC unroll 8
    for (int i = nq - 1; i >= 0; --i) {
#pragma GCC unroll 8
      for (int j = i + 1; j < nq; ++j) z[i] = z[i] - m[i][j] * z[j];
      z[i] = z[i] * m[i][i];
    }
  }

  // Adds Newton's correction for the residuals to k.
  BBSIM_INLINE static void correct(Pack& of) {
    constexpr int together = 2;
    static_assert(pairs % together == 0 && s % together == 0);
#pragma GCC unroll 1
    for (int first = 0; first < pairs; first += together) {
      Complex sum[together][nq];
#pragma GCC unroll 2
      for (int k = 0; k < together; ++k) {
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) sum[k][i] = {P(0.0), P(0.0)};
      }
#pragma GCC unroll 2
      for (int j = 0; j < s; ++j) {
#pragma GCC unroll 2
        for (int k = 0; k < together; ++k) {
          const P re(rows.forward_re[j][first + k]), im(rows.forward_im[j][first + k]);
#pragma GCC unroll 8
          for (int i = 0; i < nq; ++i) {
            sum[k][i].re += re * of.residual[j][order[i]];
            sum[k][i].im += im * of.residual[j][order[i]];
          }
        }
      }
#pragma GCC unroll 2
      for (int k = 0; k < together; ++k) {
        substitute(of.matrix[first + k], sum[k]);
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) of.transformed[first + k][order[i]] = sum[k][i];
      }
    }
#pragma GCC unroll 1
    for (int first = 0; first < s; first += together) {
      P sum[together][nq];
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) sum[j][i] = of.k[first + j][i];
      }
#pragma GCC unroll 2
      for (int k = 0; k < pairs; ++k) {
#pragma GCC unroll 2
        for (int j = 0; j < together; ++j) {
          const P re(rows.back_re[first + j][k]), im(rows.back_im[first + j][k]);
#pragma GCC unroll 8
          for (int i = 0; i < nq; ++i) {
            sum[j][i] += re * of.transformed[k][i].re;
            sum[j][i] += im * of.transformed[k][i].im;
          }
        }
      }
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) of.k[first + j][i] = sum[j][i];
      }
    }
  }

  // How far the last turn moved the states.
  struct Change {
    P q[nq], v[nv];
  };

  // What the tolerances count in place of the velocities: without what a servo's own motion gives
  // the ball at once, -r phi'' and r theta'', by (27) near home.
  BBSIM_INLINE static void without_servos(const Loop& loop, P (&v)[nv]) {
    if constexpr (drives == Drives::angle) {
      v[x] += loop.radius * v[phi];
      v[y] -= loop.radius * v[theta];
    }
  }

  // The states at the nodes.
  BBSIM_INLINE static void integrate(const Loop& loop, Pack& of, double h, Change& change) {
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      change.v[i] = P(0.0);
      if (i < nq) change.q[i] = P(0.0);
    }
    constexpr int together = 2;
#pragma GCC unroll 1
    for (int first = 0; first < s; first += together) {
      P once[together][nv], twice[together][nq];
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) {
          once[j][i] = P(0.0);
          if (i < nq) twice[j][i] = P(0.0);
        }
      }
#pragma GCC unroll 2
      for (int m = 0; m < s; ++m) {
#pragma GCC unroll 2
        for (int j = 0; j < together; ++j) {
          const P a(rows.a[first + j][m]), b(rows.a_squared[first + j][m]);
#pragma GCC unroll 8
          for (int i = 0; i < nv; ++i) {
            once[j][i] += a * of.k[m][i];
            if (i < nq) twice[j][i] += b * of.k[m][i];
          }
        }
      }
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
        const P time(rows.c[first + j] * h);
        P moved[nv];
        // Every other node tells enough: what is left is a polynomial over the step.
        const bool counts = j == together - 1;
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) {
          const P v = of.v[i] + P(h) * once[j][i];
          if (counts) moved[i] = v - of.v_at[first + j][i];
          of.v_at[first + j][i] = v;
          if (i >= nq) continue;
          const P q = of.q[i] + (time * of.v[i] + P(h * h) * twice[j][i]);
          if (counts) change.q[i] = larger_of(change.q[i], size_of(q - of.q_at[first + j][i]));
          of.q_at[first + j][i] = q;
        }
        if (!counts) continue;
        without_servos(loop, moved);
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) change.v[i] = larger_of(change.v[i], size_of(moved[i]));
      }
    }
  }

  // The tolerances over the step, by how far the states get in it. A servo's start would take
  // dozens of steps for motions that no angle shows and no row of the ball's place: its rate counts
  // as omega_n times an angle.
  BBSIM_INLINE static void weigh(const Workspace& w, const Loop& loop, Pack& of) {
    const P rtol(w.rtol), atol(w.atol);
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      P v = size_of(of.v[i]), q(0.0), least = atol;
      if (i < nq) q = size_of(of.q[i]);
#pragma GCC unroll 1
      for (int j = 0; j < s; ++j) {
        v = larger_of(v, size_of(of.v_at[j][i]));
        if (i < nq) q = larger_of(q, size_of(of.q_at[j][i]));
      }
      if (drives == Drives::angle && (i == phi || i == theta)) {
        least = atol * larger_of(P(1.0), loop.servo.omega_n);
      }
      of.v_weight[i] = P(1.0) / (rtol * v + least);
      if (i < nq) of.q_weight[i] = P(1.0) / (rtol * q + atol);
    }
  }

  BBSIM_INLINE static P weighted(const Pack& of, const Change& change) {
    P most(0.0);
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      most = larger_of(most, change.v[i] * of.v_weight[i]);
      if (i < nq) most = larger_of(most, change.q[i] * of.q_weight[i]);
    }
    return most;
  }

  // Whether no angle gets beyond a quarter of pi: sines are the same then, and cost less.
  BBSIM_INLINE static bool are_small(const Pack& of) {
    P most(0.0);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      most = larger_of(most, larger_of(size_of(of.q_at[j][phi]), size_of(of.q_at[j][theta])));
    }
    return !simd::any_of<P>((Mask)(most.v > 0.785));
  }

  template <bool small>
  BBSIM_INLINE static SinCos<P> direction(P angle) {
    if constexpr (small) return simd::sin_cos_of_small(angle);
    return sin_cos(angle);
  }

  // The accelerations at the nodes, and how far k is from them; of the spin k is them.
  template <bool small>
  [[gnu::noinline, gnu::flatten]] static void take_residuals(const Workspace& w, int p, Pack& of) {
    const Loop loop(w.loops, p);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      P turning[2], rolling[3];
      turn(loop, of.reference[j], of.q_at[j], of.v_at[j], turning);
      const P assumed[2] = {of.k[j][phi], of.k[j][theta]};
      roll(loop, direction<small>(of.q_at[j][phi]), direction<small>(of.q_at[j][theta]), of.q_at[j],
           of.v_at[j], assumed, rolling);
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        of.residual[j][i] = rolling[i] - of.k[j][i];
        of.residual[j][phi + i] = turning[i] - assumed[i];
      }
      of.k[j][spin] = rolling[2];
    }
  }

  static constexpr int most_iterations = 12;

  // One pack; returns which lanes came to rest.
  [[gnu::flatten]] static Mask solve(Workspace& w, int p, int& iterations) {
    Pack& of = w.of[p];
    const Loop loop(w.loops, p);
    // At first accelerations that go on as they were.
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      const double time = rows.c[j] * w.h;
      of.reference[j] = loop.reference(P(w.t + time));
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        const P gain = P(time) * of.k_end[i];
        of.k[j][i] = of.k_end[i];
        of.v_at[j][i] = of.v[i] + gain;
        if (i < nq) of.q_at[j][i] = of.q[i] + P(time) * (of.v[i] + P(0.5) * gain);
      }
    }
    Change change;
    {
      constexpr int middle = s / 2;
      Jacobian at;
      const P turning[2] = {of.k[middle][phi], of.k[middle][theta]};
      differentiate(loop, of.reference[middle], of.q_at[middle], of.v_at[middle], turning, at);
      factor(at, w.h, of);
    }
    constexpr double enough = 1e-2, slow = 0.7, rounding = 30 * 2.2e-16;
    const P floor(rounding / w.rtol);
    P last(0.0);
    Mask resting{};
    for (iterations = 1;; ++iterations) {
      are_small(of) ? take_residuals<true>(w, p, of) : take_residuals<false>(w, p, of);
      correct(of);
      integrate(loop, of, w.h, change);
      if (iterations == 1) weigh(w, loop, of);
      const P now = weighted(of, change);
      // What is not finite is at rest: the states tell.
      resting = (Mask)(now.v <= P(enough).v) | (Mask)(now.v <= floor.v) | ~is_finite(now);
      if (iterations > 1) {
        resting |= (Mask)((now * now).v <= (P(enough) * (last - now)).v);
        if (iterations > 2 && simd::any_of<P>(~resting & (Mask)(now.v > (P(slow) * last).v))) {
          return resting;
        }
      }
      if (!simd::any_of<P>(~resting) || iterations >= most_iterations) return resting;
      last = now;
    }
  }

  // The error from the fall of the last Legendre coefficients, as in radau/step.hpp: the first one
  // left out, integrated once for a velocity, twice for a position. Squared, so that no root is
  // taken.
  [[gnu::flatten]] static P estimate(const Workspace& w, int p) {
    const Pack& of = w.of[p];
    const Loop loop(w.loops, p);
    const double once = w.h / (2 * s + 1);
    const double twice = once * once;
    P series[4][nv];
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m) {
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) series[m][i] = P(0.0);
    }
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
#pragma GCC unroll 4
      for (int m = 0; m < 4; ++m) {
        const P part(rows.legendre[j][s - 4 + m]);
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) series[m][i] += part * of.k[j][i];
      }
    }
    P error(0.0);
    const auto add = [&](const P(&at)[4][nv], int i, P weight) __attribute__((always_inline)) {
      const P before = larger_of(size_of(at[0][i]), size_of(at[1][i]));
      const P tail = larger_of(size_of(at[2][i]), size_of(at[3][i]));
      const P fall = simd::smaller_of(P(1.0), tail / (before + P(1e-300)));
      const P part = tail * weight;
      error = larger_of(error, part * part * fall);
    };
#pragma GCC unroll 8
    for (int i = 0; i < nq; ++i) add(series, i, P(twice) * of.q_weight[i]);
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m) without_servos(loop, series[m]);
    Mask finite = ~Mask{};
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      add(series, i, P(once) * of.v_weight[i]);
      finite &= is_finite(of.v_at[s - 1][i]);
      if (i < nq) finite &= is_finite(of.q_at[s - 1][i]);
    }
    return P::of((Vector)((Mask)error.v | ~finite));  // all bits: no number
  }

  static void start(void* workspace, const Loops& loops, const double (*initial)[group],
                    double rtol, double atol) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.loops = loops;
    w.rtol = rtol;
    w.atol = atol;
    w.t = w.h = 0;
    w.courses[places] = w.courses[angles] = false;
    for (int p = 0; p < packs; ++p) {
      Pack& of = w.of[p];
      for (int i = 0; i < nv; ++i) {
        of.v[i] = Loop::lane(initial[motions.of[i].velocity], p);
        of.k_end[i] = P(0.0);
        if (i < nq) of.q[i] = Loop::lane(initial[motions.of[i].position], p);
      }
    }
  }

  [[gnu::flatten]] static void couplings(const void* workspace, double t, Couplings& result) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      const Loop loop(w.loops, p);
      const Pack& of = w.of[p];
      const Reference reference = loop.reference(P(t));
      P turning[2];
      turn(loop, reference, of.q, of.v, turning);
      Jacobian at;
      differentiate(loop, reference, of.q, of.v, turning, at);
      const auto put = [&](const auto& matrix, int row, int column, double(&to)[group])
          __attribute__((always_inline)) {
        P norm(0.0);
        for (int i = row; i < row + 2; ++i) {
          norm = larger_of(norm, size_of(matrix[i][column]) + size_of(matrix[i][column + 1]));
        }
        norm.store(to + p * lanes);
      };
      put(at.by_turning, x, 0, result.ball_by_turning);
      put(at.by_v, x, x, result.ball_by_velocity);
      put(at.by_q, x, x, result.ball_by_place);
      put(at.by_v, x, phi, result.ball_by_rate);
      put(at.by_q, x, phi, result.ball_by_angle);
      put(at.by_v, phi, x, result.servo_by_velocity);
      put(at.by_q, phi, x, result.servo_by_place);
      put(at.by_v, phi, phi, result.servo_by_rate);
      put(at.by_q, phi, phi, result.servo_by_angle);
    }
  }

  static void attempt(void* workspace, double t, double h, Attempt& result) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.t = t;
    w.h = h;
    w.courses[places] = w.courses[angles] = false;
    result.iterations = 0;
    for (int p = 0; p < packs; ++p) {
      int iterations = 0;
      const Mask resting = solve(w, p, iterations);
      if (iterations > result.iterations) result.iterations = iterations;
      estimate(w, p).store(result.error_squared + p * lanes);
      for (int l = 0; l < lanes; ++l) result.converged[p * lanes + l] = resting[l] != 0;
    }
  }

  template <Half half>
  [[gnu::flatten]] static void make_courses(Workspace& w) {
    if (w.courses[half]) return;
    w.courses[half] = true;
    constexpr int first = 2 * half;
    for (int p = 0; p < packs; ++p) {
      Pack& of = w.of[p];
      of.courses[half].make(
          rows.legendre, P(w.h),
          [&](int j, int i) __attribute__((always_inline)) { return P(w.h) * of.k[j][first + i]; },
          [&](int i) __attribute__((always_inline)) { return of.q[first + i]; },
          [&](int i) __attribute__((always_inline)) { return of.v[first + i]; });
    }
  }

  // Rows for as many times as a pack has lanes.
  template <int coordinates>
  BBSIM_INLINE static void put_rows(const Workspace& w, P parts, int used, double* to) {
    alignas(64) double polynomial[s + 2][lanes];
    P(1.0).store(polynomial[0]);
    Courses::polynomials(
        P(2.0) * parts - P(1.0), [&](int m, P value) __attribute__((always_inline)) {
          value.store(polynomial[m]);
        });
    constexpr int together = coordinates == nq ? 1 : lanes < 4 ? lanes : 4;
#pragma GCC unroll 1
    for (int first = 0; first < used; first += together) {
#pragma GCC unroll 1
      for (int p = 0; p < packs; ++p) {
        const Courses* const of = w.of[p].courses;
        P q[together][coordinates], v[together][coordinates];
#pragma GCC unroll 4
        for (int l = 0; l < together; ++l) {
#pragma GCC unroll 4
          for (int i = 0; i < coordinates; ++i) q[l][i] = v[l][i] = P(0.0);
        }
#pragma GCC unroll 2
        for (int m = 0; m <= s + 1; ++m) {
#pragma GCC unroll 4
          for (int l = 0; l < together; ++l) {
            const P value(polynomial[m][first + l]);
#pragma GCC unroll 4
            for (int i = 0; i < coordinates; ++i) {
              q[l][i] += of[i / 2].q[i % 2][m] * value;
              if (coordinates == nq && m <= s) v[l][i] += of[i / 2].v[i % 2][m] * value;
            }
          }
        }
        for (int l = 0; l < together && first + l < used; ++l) {
          double* const row = to + (first + l) * (n * group) + p * lanes;
#pragma GCC unroll 4
          for (int i = 0; i < coordinates; ++i) {
            q[l][i].store(row + motions.of[i].position * group);
            if (coordinates == nq) v[l][i].store(row + motions.of[i].velocity * group);
          }
          if (coordinates == nq) {
            spin_at(w, p, first + l, polynomial).store(row + motions.of[spin].velocity * group);
          }
        }
      }
    }
  }

  BBSIM_INLINE static P spin_at(const Workspace& w, int p, int l,
                                const double (&polynomial)[s + 2][lanes]) {
    const Pack& of = w.of[p];
    P k[s], v[s + 1];
    for (int m = 0; m < s; ++m) {
      k[m] = P(0.0);
      for (int j = 0; j < s; ++j) k[m] += P(w.h * rows.legendre[j][m]) * of.k[j][spin];
    }
    Courses::template integrate<s>(k, P(0.5), of.v[spin], v);
    P sum(0.0);
    for (int m = 0; m <= s; ++m) sum += v[m] * P(polynomial[m][l]);
    return sum;
  }

  [[gnu::flatten]] static void evaluate(void* workspace, const double* times, std::size_t count,
                                        bool places_only, double* to) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    make_courses<places>(w);
    if (!places_only) make_courses<angles>(w);
    for (std::size_t first = 0; first < count; first += lanes) {
      const int used = count - first < lanes ? static_cast<int>(count - first) : lanes;
      alignas(64) double parts[lanes];
      for (int l = 0; l < lanes; ++l) {
        parts[l] = (times[first + static_cast<std::size_t>(l < used ? l : 0)] - w.t) / w.h;
      }
      double* const rows_of = to + first * (n * group);
      if (places_only) {
        put_rows<2>(w, P::load(parts), used, rows_of);
      } else {
        put_rows<nq>(w, P::load(parts), used, rows_of);
      }
    }
  }

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
    make_courses<half>(w);
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
      make_courses<angles>(w);
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

  static void accept(void* workspace) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      Pack& of = w.of[p];
      for (int i = 0; i < nv; ++i) {
        of.v[i] = of.v_at[s - 1][i];
        of.k_end[i] = of.k[s - 1][i];
        if (i < nq) of.q[i] = of.q_at[s - 1][i];
      }
    }
  }

  static void read(const void* workspace, double (*state)[group]) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      for (int i = 0; i < nv; ++i) {
        w.of[p].v[i].store(state[motions.of[i].velocity] + p * lanes);
        if (i < nq) w.of[p].q[i].store(state[motions.of[i].position] + p * lanes);
      }
    }
  }

  static void twin(void* workspace, int lane, int of) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    double* const loops = reinterpret_cast<double*>(&w.loops);
    constexpr int count = sizeof(Loops) / (group * sizeof(double));
    for (int row = 0; row < count; ++row) loops[row * group + lane] = loops[row * group + of];
    const auto copy = [&](auto member) {
      member(w.of[lane / lanes]).v[lane % lanes] = member(w.of[of / lanes]).v[of % lanes];
    };
    for (int i = 0; i < nv; ++i) {
      copy([i](Pack& one) -> P& { return one.v[i]; });
      copy([i](Pack& one) -> P& { return one.k_end[i]; });
      if (i < nq) copy([i](Pack& one) -> P& { return one.q[i]; });
    }
  }

  static constexpr Kernel kernel{
      s, sizeof(Workspace), start, couplings, attempt, evaluate, look, accept, read, twin};
};

template <class Isa>
inline constexpr Kernels kernels_of{
    Isa::lanes,
    {Step<Isa, Drives::acceleration, 8>::kernel, Step<Isa, Drives::acceleration, 12>::kernel},
    {Step<Isa, Drives::angle, 8>::kernel, Step<Isa, Drives::angle, 12>::kernel}};

}  // namespace bbsim::solve::loop
