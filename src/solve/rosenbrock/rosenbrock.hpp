// A Rosenbrock step of a group of closed loops, for one way to drive the gimbal and one instruction
// set.
//
// Another loop in each lane, all with one step size. The method is that of Hairer and Wanner
// (Solving Ordinary Differential Equations II, IV.7): no iterations, so that no lane waits for
// another. For stage i with its increment U_i,
//     (I - g J) U_i = g f(t + node_i h, z + sum_j a_ij U_j) + gamma sum_j c_ij U_j
//                     + gamma d_i h^2 df/dt,                       g = gamma h.
// As q' = v, only the velocities' part is solved for:
//     (I - g Jv - g^2 Jq) U_v = S_v + g Jq S_q,   U_q = S_q + g U_v,   S the right-hand side.
//
// The reference's sinusoid is no function of the time here but an oscillator, two more states that
// begin each step with their exact values. A stiff servo would pass what the stages miss of a
// function of time on to the ball; a linear system it solves as exactly as one that is not stiff,
// with steps four times as long.
#pragma once

#include <utility>

#include "model/systems/system.hpp"
#include "simd/dual.hpp"
#include "solve/rosenbrock/kernel.hpp"
#include "solve/rosenbrock/rodas5p.hpp"

namespace bbsim::solve::rosenbrock {

using simd::Pack;

template <class Isa, Drives drives, class Table = Rodas5P<Isa>>
struct Rosenbrock {
  static constexpr int lanes = Isa::lanes;
  static constexpr int packs = group / lanes;
  static constexpr int stages = Table::stages;
  using P = Pack<Isa, lanes>;
  using Vector = typename P::Vector;
  using Mask = typename P::Mask;
  struct NoSignals {};  // the reference stands in Loop
  using System = model::ClosedLoop<model::Shape::full, drives, NoSignals, model::Equation27, P>;
  static constexpr int n = System::size;
  static constexpr auto motions = System::motions;
  static constexpr int nv = System::motions.count;
  static constexpr int nq = n - nv;  // velocities with a position come first
  static_assert(n == states);
  static constexpr int x_velocity = motions.of[0].velocity, y_velocity = motions.of[1].velocity;
  static constexpr int phi_rate = motions.of[2].velocity, theta_rate = motions.of[3].velocity;

  // What is looked at, and how fast it changes.
  struct Sizes {
    P size[looks], rate[looks];
  };

  struct Stepped {
    P z[n], next[n], u[stages][n + 2];
    Sizes sizes;  // at the end of the last step that was looked at
  };

  struct alignas(64) Workspace {
    Loops loops;
    double rtol, atol;
    double t, h;  // of the last attempt
    bool looked;  // at any step
    Stepped of[packs];
  };

  BBSIM_INLINE static P magnitude(P a) {
    const Mask sign_bit = (1LL << 63) - Mask{};
    return P::of((Vector)((Mask)a.v & ~sign_bit));
  }
  BBSIM_INLINE static P larger(P a, P b) {
    const Mask less = a.v < b.v;
    return P::of((Vector)(((Mask)b.v & less) | ((Mask)a.v & ~less)));
  }
  // The bits tell, since comparisons are compiled as if all numbers were finite.
  BBSIM_INLINE static Mask is_finite(P a) {
    const Mask exponent = (0x7ffLL << 52) - Mask{};
    return ((Mask)a.v & exponent) != exponent;
  }

  // The loops of one pack.
  struct Loop {
    P start[2], rate[2], frequency, sine[2], cosine[2];
    System system;

    BBSIM_INLINE Loop(const Loops& from, int p)
        : start{lane(from.start[0], p), lane(from.start[1], p)},
          rate{lane(from.rate[0], p), lane(from.rate[1], p)},
          frequency(lane(from.frequency, p)),
          sine{lane(from.sine[0], p), lane(from.sine[1], p)},
          cosine{lane(from.cosine[0], p), lane(from.cosine[1], p)},
          system(lane(from.radius, p), lane(from.gravity, p),
                 {{{lane(from.kv[0][0], p), lane(from.kv[0][1], p)},
                   {lane(from.kv[1][0], p), lane(from.kv[1][1], p)}},
                  {{lane(from.kp[0][0], p), lane(from.kp[0][1], p)},
                   {lane(from.kp[1][0], p), lane(from.kp[1][1], p)}}},
                 {lane(from.omega_n, p), lane(from.zeta, p)}, {}) {}

    BBSIM_INLINE static P lane(const double* values, int p) { return P::load(values + p * lanes); }

    // The reference at t, with its oscillator there: sin(frequency t) and cos(frequency t).
    template <class Real>
    BBSIM_INLINE std::array<model::Jet<Real>, 2> reference(const Real& t, const Real& sin,
                                                           const Real& cos) const {
      std::array<model::Jet<Real>, 2> jets;
#pragma GCC unroll 2
      for (std::size_t i = 0; i < 2; ++i) {
        jets[i].value = start[i] + rate[i] * t + (sine[i] * sin + cosine[i] * cos);
        jets[i].rate = rate[i] + frequency * (sine[i] * cos - cosine[i] * sin);
        jets[i].acceleration = Real(0.0);  // no part of the loop
      }
      return jets;
    }
  };

  // Accelerations and their derivatives at one state: by velocities, positions, the oscillator, and
  // the time in the reference's ramp.
  struct Linear {
    P f[nv], jv[nv][nv], jq[nv][nq], jo[nv][2], f_t[nv];
  };

  // Derivatives by one state: of the n + 2, or by the time if it is none of them.
  template <int state>
  BBSIM_INLINE static void differentiate_by(const Loop& loop, double t, const P* z, P* value,
                                            P* slope, int stride) {
    using D = simd::Dual<P, simd::Angles::moderate>;
    D moving[n + 2], rates[n];
#pragma GCC unroll 16
    for (int i = 0; i < n + 2; ++i) moving[i] = D(z[i], P(i == state ? 1.0 : 0.0));
    const D time(P(t), P(state == n + 2 ? 1.0 : 0.0));
    loop.system.derivative_of(loop.reference(time, moving[n], moving[n + 1]), moving, rates);
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      value[i] = rates[motions.of[i].velocity].value;
      slope[i * stride] = rates[motions.of[i].velocity].slope;
    }
  }

  template <int... j, int... k>
  BBSIM_INLINE static void differentiate(const Loop& loop, double t, const P* z, Linear& at,
                                         std::integer_sequence<int, j...>,
                                         std::integer_sequence<int, k...>) {
    (differentiate_by<motions.of[j].velocity>(loop, t, z, at.f, &at.jv[0][j], nv), ...);
    (differentiate_by<motions.of[k].position>(loop, t, z, at.f, &at.jq[0][k], nq), ...);
    differentiate_by<n>(loop, t, z, at.f, &at.jo[0][0], 2);
    differentiate_by<n + 1>(loop, t, z, at.f, &at.jo[0][1], 2);
    differentiate_by<n + 2>(loop, t, z, at.f, at.f_t, 1);
  }

  BBSIM_INLINE static void differentiate(const Loop& loop, double t, const P* z, Linear& at) {
    differentiate(loop, t, z, at, std::make_integer_sequence<int, nv>(),
                  std::make_integer_sequence<int, nq>());
  }

  // The present states with the oscillator's.
  BBSIM_INLINE static void extend(const Loop& loop, double t, const Stepped& s, P* z) {
#pragma GCC unroll 16
    for (int i = 0; i < n; ++i) z[i] = s.z[i];
    const SinCos<P> wave = sin_cos(loop.frequency * P(t));
    z[n] = wave.sin;
    z[n + 1] = wave.cos;
  }

  // Elimination begins with the servo's axes, the stiffest; without pivoting.
  static constexpr int order[nv] = {2, 3, 0, 1, 4};

  // LU factors in place, rows and columns in that order; the diagonal holds its own inverse.
  BBSIM_INLINE static void factor(P (&m)[nv][nv]) {
#pragma GCC unroll 8
    for (int k = 0; k < nv; ++k) {
      m[k][k] = P(1.0) / m[k][k];
#pragma GCC unroll 8
      for (int i = k + 1; i < nv; ++i) {
        m[i][k] = m[i][k] * m[k][k];
#pragma GCC unroll 8
        for (int j = k + 1; j < nv; ++j) m[i][j] -= m[i][k] * m[k][j];
      }
    }
  }

  BBSIM_INLINE static void substitute(const P (&m)[nv][nv], P (&x)[nv]) {
#pragma GCC unroll 8
    for (int i = 1; i < nv; ++i) {
#pragma GCC unroll 8
      for (int j = 0; j < i; ++j) x[i] -= m[i][j] * x[j];
    }
#pragma GCC unroll 8
    for (int i = nv - 1; i >= 0; --i) {
#pragma GCC unroll 8
      for (int j = i + 1; j < nv; ++j) x[i] -= m[i][j] * x[j];
      x[i] = x[i] * m[i][i];
    }
  }

  // One pack over one step; returns its errors.
  [[gnu::flatten]] static P advance(Workspace& w, int p) {
    const Loop loop(w.loops, p);
    Stepped& s = w.of[p];
    const double t = w.t, h = w.h, g = Table::gamma * h;
    P z[n + 2];
    extend(loop, t, s, z);
    Linear at;
    differentiate(loop, t, z, at);
    P m[nv][nv], gjq[nv][nq];
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
#pragma GCC unroll 8
      for (int j = 0; j < nq; ++j) gjq[i][j] = g * at.jq[order[i]][j];
#pragma GCC unroll 8
      for (int j = 0; j < nv; ++j) {
        m[i][j] = P(i == j ? 1.0 : 0.0) - g * at.jv[order[i]][order[j]];
        if (order[j] < nq) m[i][j] -= g * gjq[i][order[j]];
      }
    }
    factor(m);
    const P turn = g * loop.frequency, shrink = P(1.0) / (P(1.0) + turn * turn);

    P point[n + 2], f[nv];
#pragma GCC unroll 16
    for (int i = 0; i < n + 2; ++i) point[i] = z[i];
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) f[i] = at.f[i];
#pragma GCC unroll 1
    for (int stage = 0; stage < stages; ++stage) {
      if (stage > 0) {
        if (stage < stages - 2) {
#pragma GCC unroll 16
          for (int i = 0; i < n + 2; ++i) point[i] = z[i];
#pragma GCC unroll 1
          for (int j = 0; j < stage; ++j) {
#pragma GCC unroll 16
            for (int i = 0; i < n + 2; ++i) point[i] += P(Table::a[stage][j]) * s.u[j][i];
          }
        } else {
#pragma GCC unroll 16
          for (int i = 0; i < n + 2; ++i) point[i] += s.u[stage - 1][i];
        }
        P rates[n];
        loop.system.derivative_of(
            loop.reference(P(t + Table::node[stage] * h), point[n], point[n + 1]), point, rates);
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) f[i] = rates[motions.of[i].velocity];
      }
      P sum[n + 2];
#pragma GCC unroll 16
      for (int i = 0; i < n + 2; ++i) sum[i] = P(0.0);
#pragma GCC unroll 1
      for (int j = 0; j < stage; ++j) {
#pragma GCC unroll 16
        for (int i = 0; i < n + 2; ++i) sum[i] += P(Table::c[stage][j]) * s.u[j][i];
      }
      const P sin = turn * point[n + 1] + Table::gamma * sum[n];
      const P cos = Table::gamma * sum[n + 1] - turn * point[n];
      s.u[stage][n] = shrink * (sin + turn * cos);
      s.u[stage][n + 1] = shrink * (cos - turn * sin);
      P sq[nq], x[nv];
#pragma GCC unroll 8
      for (int i = 0; i < nq; ++i) {
        sq[i] = g * point[motions.of[i].velocity] + Table::gamma * sum[motions.of[i].position];
      }
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        const int v = order[i];
        x[i] = g * (f[v] + (h * Table::d[stage]) * at.f_t[v] + at.jo[v][0] * s.u[stage][n] +
                    at.jo[v][1] * s.u[stage][n + 1]) +
               Table::gamma * sum[motions.of[v].velocity];
#pragma GCC unroll 8
        for (int j = 0; j < nq; ++j) x[i] += gjq[i][j] * sq[j];
      }
      substitute(m, x);
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        const int v = order[i];
        s.u[stage][motions.of[v].velocity] = x[i];
        if (v < nq) s.u[stage][motions.of[v].position] = sq[v] + g * x[i];
      }
    }

#pragma GCC unroll 16
    for (int i = 0; i < n; ++i) s.next[i] = point[i] + s.u[stages - 1][i];
    return measure(w, p);
  }

  // The last stage's increment in the weights of the tolerance; NaN where a state is not finite.
  //
  // A servo's start would take dozens of steps for motions that no angle shows and no row of the
  // ball's place. So a servo's rate counts as omega_n times an angle, and the ball's velocity is
  // taken without what the servos' accelerations give it at once: -r phi'' and r theta'', by (27)
  // near home.
  BBSIM_INLINE static P measure(const Workspace& w, int p) {
    const Stepped& s = w.of[p];
    const P* const last = s.u[stages - 1];
    P error(0.0);
    Mask finite = ~Mask{};
#pragma GCC unroll 16
    for (int i = 0; i < n; ++i) {
      P estimate = last[i], smallest(w.atol);
      if constexpr (drives == Drives::angle) {
        const P r = Loop::lane(w.loops.radius, p), omega_n = Loop::lane(w.loops.omega_n, p);
        if (i == x_velocity) estimate += r * last[phi_rate];
        if (i == y_velocity) estimate -= r * last[theta_rate];
        if (i == phi_rate || i == theta_rate) smallest = w.atol * larger(P(1.0), omega_n);
      }
      const P weight = smallest + w.rtol * larger(magnitude(s.z[i]), magnitude(s.next[i]));
      error = larger(error, magnitude(estimate) / weight);
      finite &= is_finite(s.next[i]);
    }
    return P::of((Vector)((Mask)error.v | ~finite));  // all bits: NaN
  }

  static void start(void* workspace, const Loops& loops, const double (*initial)[group],
                    double rtol, double atol) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.loops = loops;
    w.rtol = rtol;
    w.atol = atol;
    w.t = w.h = 0;
    w.looked = false;
    for (int p = 0; p < packs; ++p) {
      for (int i = 0; i < n; ++i) w.of[p].z[i] = P::load(&initial[i][p * lanes]);
    }
  }

  [[gnu::flatten]] static void rate(void* workspace, double t, double* rates) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      const Loop loop(w.loops, p);
      P z[n + 2];
      extend(loop, t, w.of[p], z);
      Linear at;
      differentiate(loop, t, z, at);
      P jv(0.0), jq(0.0);
      for (int i = 0; i < nv; ++i) {
        P row_v(0.0), row_q(0.0);
        for (int j = 0; j < nv; ++j) row_v += magnitude(at.jv[i][j]);
        for (int j = 0; j < nq; ++j) row_q += magnitude(at.jq[i][j]);
        jv = larger(jv, row_v);
        jq = larger(jq, row_q);
      }
      for (int l = 0; l < lanes; ++l) {
        const double root = __builtin_sqrt(jq[l]);
        rates[p * lanes + l] = jv[l] < root ? root : jv[l];
      }
    }
  }

  static void attempt(void* workspace, double t, double h, double* errors) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.t = t;
    w.h = h;
    for (int p = 0; p < packs; ++p) {
      const P error = advance(w, p);
      for (int l = 0; l < lanes; ++l) errors[p * lanes + l] = error[l];
    }
  }

  static void evaluate(void* workspace, const double* times, std::size_t count, double* rows) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      const Stepped& s = w.of[p];
      P k[3][n];
      for (int m = 0; m < 3; ++m) {
#pragma GCC unroll 16
        for (int i = 0; i < n; ++i) k[m][i] = P(0.0);
        for (int j = 0; j < stages; ++j) {
#pragma GCC unroll 16
          for (int i = 0; i < n; ++i) k[m][i] += P(Table::dense[m][j]) * s.u[j][i];
        }
      }
      for (std::size_t row = 0; row < count; ++row) {
        const double x = (times[row] - w.t) / w.h, left = 1 - x;
        double* const to = rows + row * (n * group) + p * lanes;
#pragma GCC unroll 16
        for (int i = 0; i < n; ++i) {
          const P bend = k[0][i] + x * (k[1][i] + x * k[2][i]);
          const P value = left * s.z[i] + x * (s.next[i] + left * bend);
          value.store(to + i * group);
        }
      }
    }
  }

  // All looks at a time, and their rates; the angles' accelerations are given.
  BBSIM_INLINE static void look_at(const Loop& loop, double t, const P* z, const P (&turning)[2],
                                   Sizes& at) {
    constexpr int phi = motions.of[2].position, theta = motions.of[3].position;
    // Beyond 10^5 rad, in which nobody is interested, without the last digits.
    const SinCos<P> half_phi = sin_cos_of_moderate(P(0.5) * z[phi]);
    const SinCos<P> half_theta = sin_cos_of_moderate(P(0.5) * z[theta]);
    const P a = half_phi.sin * half_phi.sin, b = half_theta.sin * half_theta.sin;
    const P cos_phi = P(1.0) - P(2.0) * a, cos_theta = P(1.0) - P(2.0) * b;
    at.size[versine] = P(2.0) * (a + b) - P(4.0) * (a * b);
    at.rate[versine] = P(2.0) * (z[phi_rate] * (half_phi.sin * half_phi.cos) * cos_theta +
                                 z[theta_rate] * (half_theta.sin * half_theta.cos) * cos_phi);
    at.size[rate_squared] = z[phi_rate] * z[phi_rate] + z[theta_rate] * z[theta_rate];
    at.rate[rate_squared] = P(2.0) * (z[phi_rate] * turning[0] + z[theta_rate] * turning[1]);
    at.size[distance_squared] = z[0] * z[0] + z[1] * z[1];
    at.rate[distance_squared] = P(2.0) * (z[0] * z[x_velocity] + z[1] * z[y_velocity]);
    const SinCos<P> wave = sin_cos(loop.frequency * P(t));
    const auto reference = loop.reference(P(t), wave.sin, wave.cos);
    const P dx = z[0] - reference[0].value, dy = z[1] - reference[1].value;
    at.size[error_squared] = dx * dx + dy * dy;
    at.rate[error_squared] = P(2.0) * (dx * (z[x_velocity] - reference[0].rate) +
                                       dy * (z[y_velocity] - reference[1].rate));
  }

  // Whether any lane is set.
  BBSIM_INLINE static bool any(Mask mask) {
    long long all = mask[0];
    for (int i = 1; i < lanes; ++i) all |= mask[i];
    return all != 0;
  }

  // Each size is judged by the cubic through values and rates at both ends. Where both rates go the
  // way that the values do, and neither is more than three times as steep, it goes one way (Fritsch
  // and Carlson, SIAM Journal on Numerical Analysis 17:238, 1980). Otherwise it is above the ends
  // by no more than 4/27 of the change that its rates there would give; what is of a higher degree
  // is allowed for.
  [[gnu::flatten]] static bool look(void* workspace, Looks* result) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    constexpr double beyond = 0.25, worth = 1 + 1e-9;
    bool promising = false;
    for (int p = 0; p < packs; ++p) {
      const Loop loop(w.loops, p);
      Stepped& s = w.of[p];
      // Slopes of the polynomial of evaluate() at its ends.
      P starting[2], ending[2];
#pragma GCC unroll 2
      for (int axis = 0; axis < 2; ++axis) {
        const int v = axis == 0 ? phi_rate : theta_rate;
        P at_start(0.0), at_end(0.0);
#pragma GCC unroll 8
        for (int j = 0; j < stages; ++j) {
          at_start += P(Table::dense[0][j]) * s.u[j][v];
          at_end += P(Table::dense[0][j] + Table::dense[1][j] + Table::dense[2][j]) * s.u[j][v];
        }
        const P change = s.next[v] - s.z[v];
        starting[axis] = (change + at_start) * P(1 / w.h);
        ending[axis] = (change - at_end) * P(1 / w.h);
      }
      Sizes now;
      if (!w.looked) look_at(loop, w.t, s.z, starting, s.sizes);
      look_at(loop, w.t + w.h, s.next, ending, now);
      s.sizes.rate[rate_squared] =
          P(2.0) * (s.z[phi_rate] * starting[0] + s.z[theta_rate] * starting[1]);
#pragma GCC unroll 4
      for (int l = 0; l < looks; ++l) {
        const P v0 = s.sizes.size[l], v1 = now.size[l];
        const P change = v1 - v0, s0 = w.h * s.sizes.rate[l], s1 = w.h * now.rate[l];
        const P up = larger(s0, P(0.0)), down = larger(-s1, P(0.0));
        const P steepest = P(3.0) * magnitude(change);
        const Mask one_way = (Mask)(s0.v * change.v >= 0) & (Mask)(s1.v * change.v >= 0) &
                             (Mask)(magnitude(s0).v <= steepest.v) &
                             (Mask)(magnitude(s1).v <= steepest.v);
        const P more = P::of((Vector)((Mask)(beyond * (up + down)).v & ~one_way));
        const P ends = larger(v0, v1), promise = ends + more;
        double* const greatest = &result->greatest[l][p * lanes];
        const P most = larger(P::load(greatest), ends);
        most.store(greatest);
        promise.store(&result->promise[l][p * lanes]);
        promising = promising || any((Mask)(promise.v > worth * most.v));
      }
      s.sizes = now;
    }
    w.looked = true;
    return promising;
  }

  static void accept(void* workspace) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      for (int i = 0; i < n; ++i) w.of[p].z[i] = w.of[p].next[i];
    }
  }

  static void twin(void* workspace, int lane, int of) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    double* const loops = reinterpret_cast<double*>(&w.loops);
    constexpr int rows = sizeof(Loops) / (group * sizeof(double));
    for (int row = 0; row < rows; ++row) loops[row * group + lane] = loops[row * group + of];
    for (int i = 0; i < n; ++i) {
      w.of[lane / lanes].z[i].v[lane % lanes] = w.of[of / lanes].z[i][of % lanes];
    }
  }

  static constexpr Kernel kernel{sizeof(Workspace), start, rate,   attempt,
                                 evaluate,          look,  accept, twin};
};

}  // namespace bbsim::solve::rosenbrock
