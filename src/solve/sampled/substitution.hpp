// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The ball over a piece whose plate's motion is given: the method, for both layouts of a register.
//
// The ball's equation is then linear in its five states. At the nodes of Radau IIA it is
//
//     k = f + A (x, y, x', y', u)
//
// The coefficients are computed once. Substitution solves the remaining equations:
//
//     v = v(0) + h A1 k,    q = q(0) + c h v(0) + h^2 A2 k
//
// Pieces are so short that each iteration contracts the error by factors of hundreds or thousands.
// The decay of the Legendre coefficients of k gives the error estimate, as in
// radau/collocation.hpp. This is the special case without a Jacobian, a linear system or servo
// states.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/compare.hpp"
#include "solve/collocation/error_estimate.hpp"
#include "solve/collocation/given_ball.hpp"
#include "solve/collocation/radau_table.hpp"
#include "solve/sampled/lane_kernel.hpp"

namespace bbsim::solve::sampled {

using simd::is_finite, simd::larger_of, simd::size_of, simd::smaller_of;

// A number known at compile time.
template <int i>
struct Index {
  // NOLINTNEXTLINE(google-explicit-constructor): it is that number
  [[gnu::always_inline]] constexpr operator int() const { return i; }
};

// Calls f(0), f(1), ... with compile-time numbers.
template <int count, int from = 0, class F>
BBSIM_INLINE void for_each(F f) {
  if constexpr (from < count) {
    f(Index<from>{});
    for_each<count, from + 1>(f);
  }
}

// One rig, with the nodes of its piece in the lanes. A `part` is a register of nodes. A Number
// belongs to the rig.
template <class Isa>
struct NodesInLanes {
  static constexpr int lanes = Isa::lanes;
  static constexpr int parts = nodes / lanes;
  using P = simd::Pack<Isa, lanes>;
  using Number = double;
  using Truth = bool;
  // Parts do not wait for each other: an iteration uses the values of the one before.
  static constexpr bool at_once = true;

  template <class F>
  BBSIM_INLINE static void each(F f) {
    for_each<parts>(f);
  }
  // Column j of a table, and a value per node, at the nodes of a part.
  BBSIM_INLINE static P column(const double (&of)[nodes][nodes], int j, int part) {
    return P::load(of[j] + part * lanes);
  }
  BBSIM_INLINE static P column(const double (&of)[nodes], int part) {
    return P::load(of + part * lanes);
  }
  BBSIM_INLINE static double* place(double (&of)[nodes], int part, int /*first*/) {
    return of + part * lanes;
  }
  BBSIM_INLINE static double number(double of, int /*first*/) { return of; }
  BBSIM_INLINE static void put(double value, double& into, int /*first*/) { into = value; }

  struct Values {
    alignas(64) double of[3][nodes];
    BBSIM_INLINE P at(int node, int i) const { return P(of[i][node]); }
    BBSIM_INLINE P own(int part, int i) const { return P::load(of[i] + part * lanes); }
    BBSIM_INLINE void put(int part, int i, P value) { value.store(of[i] + part * lanes); }
  };

  // Reduces the lanes to one number by halves, with `choose` for each pair.
  template <class Choose>
  BBSIM_INLINE static double reduced(P a, Choose choose) {
    if constexpr (lanes == 8) {
      using Half = simd::Pack<Isa, 4>;
      const Half low = Half::of(__builtin_shufflevector(a.v, a.v, 0, 1, 2, 3));
      const Half high = Half::of(__builtin_shufflevector(a.v, a.v, 4, 5, 6, 7));
      return reduced_four(choose(low, high), choose);
    } else if constexpr (lanes == 4) {
      return reduced_four(a, choose);
    } else {
      const double first = a.v[0], second = a.v[1];
      return choose(first, second);
    }
  }
  template <class Four, class Choose>
  BBSIM_INLINE static double reduced_four(Four a, Choose choose) {
    using Half = simd::Pack<Isa, 2>;
    const Half two = choose(Half::of(__builtin_shufflevector(a.v, a.v, 0, 1)),
                            Half::of(__builtin_shufflevector(a.v, a.v, 2, 3)));
    const double first = two.v[0], second = two.v[1];
    return choose(first, second);
  }
  struct Larger {
    template <class N>
    BBSIM_INLINE N operator()(N a, N b) const {
      return larger_of(a, b);
    }
  };
  struct Smaller {
    template <class N>
    BBSIM_INLINE N operator()(N a, N b) const {
      return smaller_of(a, b);
    }
  };
  BBSIM_INLINE static double greatest(P of) { return reduced(of, Larger{}); }
  BBSIM_INLINE static bool every(bool truth) { return truth; }

  BBSIM_INLINE static const model::GeneralRolling& rolling(const Scene& scene, int /*first*/) {
    return scene.rolling;
  }
  BBSIM_INLINE static const PieceAxis& axis(const Piece& piece, int i) {
    return piece.plate.axis[i];
  }
  BBSIM_INLINE static const MotionTable& motion(const PieceAxis& axis) { return *axis.table; }
  BBSIM_INLINE static double end_sine(const Piece& piece, int i, int /*first*/) {
    return piece.plate.plane[i].sin[nodes - 1];
  }
  BBSIM_INLINE static double start_sine(const Piece& piece, int i, int /*first*/) {
    return piece.plate.plane_start[i].sin;
  }
  BBSIM_INLINE static double gain(const Piece& piece, int /*first*/) { return piece.plate.gain; }
};

// A rig in each lane, from lane `first` of the group on. A `part` is a node. A Number belongs to
// each rig. Every lane has work, and sums over nodes need no shuffles.
template <class Isa>
struct RigsInLanes {
  static constexpr int lanes = Isa::lanes;
  static constexpr int parts = nodes;
  using P = simd::Pack<Isa, lanes>;
  using Number = P;
  using Truth = typename P::Mask;
  // New values are used immediately: an integral mostly depends on earlier nodes.
  static constexpr bool at_once = false;

  template <class F>
  BBSIM_INLINE static void each(F f) {
#pragma GCC unroll 1
    for (int part = 0; part < parts; ++part) f(part);
  }
  BBSIM_INLINE static P column(const double (&of)[nodes][nodes], int j, int part) {
    return P(of[j][part]);
  }
  BBSIM_INLINE static P column(const double (&of)[nodes], int part) {
    return P(of[part]);
  }
  BBSIM_INLINE static double* place(double (&of)[nodes][group], int part, int first) {
    return of[part] + first;
  }
  BBSIM_INLINE static P number(const double (&of)[group], int first) {
    return P::load(of + first);
  }
  BBSIM_INLINE static void put(P value, double (&into)[group], int first) {
    value.store(into + first);
  }

  struct Values {
    P of[nodes][3];
    BBSIM_INLINE P at(int node, int i) const { return of[node][i]; }
    BBSIM_INLINE P own(int part, int i) const { return of[part][i]; }
    BBSIM_INLINE void put(int part, int i, P value) { of[part][i] = value; }
  };

  BBSIM_INLINE static P greatest(P of) {
    return of;
  }
  BBSIM_INLINE static bool every(Truth truth) {
    return simd::all_of<P>(truth);
  }

  BBSIM_INLINE static model::GeneralRollingOf<P> rolling(const LaneScene& scene, int first) {
    const auto of = [&](int i) __attribute__((always_inline)) {
      return P::load(scene.rolling[i] + first);
    };
    return {of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)};
  }
  BBSIM_INLINE static const LaneAxis& axis(const LanePieces& pieces, int i) {
    return pieces.axis[i];
  }
  BBSIM_INLINE static const LaneAxis& motion(const LaneAxis& axis) {
    return axis;
  }
  BBSIM_INLINE static P end_sine(const LanePieces& pieces, int i, int first) {
    return P::load(pieces.plane[i].sin[nodes - 1] + first);
  }
  BBSIM_INLINE static P start_sine(const LanePieces& pieces, int i, int first) {
    return P::load(pieces.plane[i].sin_start + first);
  }
  BBSIM_INLINE static P gain(const LanePieces& pieces, int first) {
    return P::load(pieces.gain + first);
  }
};

template <class Isa, class Layout>
struct Substitution {
  using P = typename Layout::P;
  using Number = typename Layout::Number;
  using Truth = typename Layout::Truth;
  static constexpr const auto& table = radau::radau_table<Isa, nodes>;

  // At the nodes of a part, times h.
  using Rates = GivenBall<P>;

  struct Solved {
    Truth solved;
    int iterations;
  };

  // Solves for the ball from the start of the piece. Each rig has its own contraction, and is done
  // once its error is small enough or will not get there. A rig that diverges does not affect the
  // others.
  template <class Of>
  BBSIM_INLINE static Solved solve(Of& of, const Rates (&rates)[Layout::parts], double rtol,
                                   double atol, int first) {
    const auto number = [first](const auto& value) __attribute__((always_inline)) {
      return Layout::number(value, first);
    };
    const Number h = number(of.length);
    Number velocity[3], position[2], guess[3], weight[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      velocity[i] = number(of.velocity[i]);
      guess[i] = number(of.guess[i]);
      if (i < 2) position[i] = number(of.position[i]);
      weight[i] = larger_of(Number(1.0), h) / (Number(rtol) * size_of(velocity[i]) + Number(atol));
    }
    // Accelerations times h at the nodes. First guess: the accelerations at the end of the last
    // piece stay constant.
    typename Layout::Values k;
    P next[Layout::parts][3];
    Layout::each([&](auto part) __attribute__((always_inline)) {
      const P time = P(h) * Layout::column(table.c, part);
      P q[2], v[3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        v[i] = P(velocity[i]) + time * P(guess[i]);
        if (i < 2) {
          q[i] = P(position[i]) + time * (P(velocity[i]) + P(0.5) * time * P(guess[i]));
        }
      }
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) k.put(part, i, rates[part].at(i, q, v));
    });

    constexpr int most_iterations = 25;
    // Two half sums make shorter chains of dependent additions where parts are few.
    constexpr int sums = Layout::at_once ? 2 : 1;
    const StopTest stop(1e-3, rtol);
    const Number before = number(of.contraction);
    Number contraction = before, last(0.0);
    Solved result{};
    for (;;) {
      P changes[3] = {P(0.0), P(0.0), P(0.0)};
      Layout::each([&](auto part) __attribute__((always_inline)) {
        P sum_v[sums][3], sum_q[sums][2], q[2], v[3];
#pragma GCC unroll 8
        for (int j = 0; j < nodes; ++j) {
          const P once = Layout::column(table.a, j, part);
          const P twice = Layout::column(table.a_squared, j, part);
#pragma GCC unroll 3
          for (int i = 0; i < 3; ++i) {
            P& sum = sum_v[j % sums][i];
            sum = j < sums ? once * k.at(j, i) : sum + once * k.at(j, i);
            if (i == 2) continue;
            P& twice_sum = sum_q[j % sums][i];
            twice_sum = j < sums ? twice * k.at(j, i) : twice_sum + twice * k.at(j, i);
          }
        }
        const P time = P(h) * Layout::column(table.c, part);
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
          v[i] = P(velocity[i]) + (sums == 2 ? sum_v[0][i] + sum_v[sums - 1][i] : sum_v[0][i]);
          v[i].store(Layout::place(of.velocity_at[i], part, first));
          if (i == 2) continue;
          const P moved = sums == 2 ? sum_q[0][i] + sum_q[sums - 1][i] : sum_q[0][i];
          q[i] = P(position[i]) + (time * P(velocity[i]) + P(h) * moved);
          q[i].store(Layout::place(of.position_at[i], part, first));
        }
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
          const P value = rates[part].at(i, q, v);
          changes[i] = larger_of(changes[i], size_of(value - k.own(part, i)));
          if constexpr (Layout::at_once) {
            next[part][i] = value;
          } else {
            k.put(part, i, value);
          }
        }
      });
      if constexpr (Layout::at_once) {
        Layout::each([&](auto part) __attribute__((always_inline)) {
#pragma GCC unroll 3
          for (int i = 0; i < 3; ++i) k.put(part, i, next[part][i]);
        });
      }
      ++result.iterations;
      const P weighted = larger_of(larger_of(changes[0] * P(weight[0]), changes[1] * P(weight[1])),
                                   changes[2] * P(weight[2]));
      const Number change = Layout::greatest(weighted);
      if (result.iterations > 1) {
        contraction = change / simd::choose(simd::exceeds(last, Number(0.0)), last, Number(1.0));
      }
      const Truth finite = is_finite(change);
      result.solved = stop.passes(change, contraction) & finite;
      Truth settled = result.solved | (finite == Truth{});
      if (result.iterations > 2) settled |= simd::exceeds(contraction, Number(0.3));
      if (Layout::every(settled) || result.iterations >= most_iterations) break;
      last = change;
    }
    // A plate that stood still within backlash gives a contraction of zero, but this says nothing
    // about the next piece.
    constexpr double least_contraction = 1e-2, most_contraction = 0.1;
    if (result.iterations > 1) contraction = larger_of(Number(0.3) * before, contraction);
    contraction = simd::choose(is_finite(contraction), contraction, Number(1.0));
    Layout::put(
        smaller_of(larger_of(contraction, Number(least_contraction)), Number(most_contraction)),
        of.contraction, first);

    const Number whole = simd::choose(simd::exceeds(h, Number(0.0)), h, Number(1.0));
    const Number inverse = Number(1.0) / whole;
    Layout::each([&](auto part) __attribute__((always_inline)) {
      P sum[3] = {P(0.0), P(0.0), P(0.0)};
#pragma GCC unroll 8
      for (int j = 0; j < nodes; ++j) {
        const P share = Layout::column(table.legendre, j, part);
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) sum[i] += share * k.at(j, i);
      }
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        sum[i].store(Layout::place(of.series[i], part, first));
        (k.own(part, i) * P(inverse)).store(Layout::place(of.acceleration_at[i], part, first));
      }
    });
    Number ends(0.0);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const Number mean = number(of.series[i][0]), slope = number(of.series[i][1]);
      const Number end = velocity[i] + mean;
      Layout::put(end, of.velocity_end[i], first);
      ends += end;
      if constexpr (!Layout::at_once) {
        if (i == 2) continue;  // lanes have no gamma
      }
      const Number from = number(of.position[i]);
      const Number reached =
          from + h * (velocity[i] + Number(0.5) * (mean - slope * Number(1.0 / 3)));
      Layout::put(reached, of.position_end[i], first);
      ends += reached;
    }
    result.solved = result.solved & is_finite(ends);
    return result;
  }

  // An upper bound of the ball's error from servo motions that are too fast for the nodes. A gimbal
  // acceleration acts on the ball at its height above the axes, and at its distance times the sine
  // of the tilt. A jump that is over by the first node has on average half of its initial value.
  template <class Of, class OfScene>
  BBSIM_INLINE static Number unseen(const Of& of, const OfScene& scene, int servos, bool direct,
                                    int first) {
    const auto number = [first](const auto& value) __attribute__((always_inline)) {
      return Layout::number(value, first);
    };
    Number acceleration(0.0), lost(0.0), tilt(0.0);
    for (int i = 0; i < servos; ++i) {
      const auto& axis = Layout::axis(of, i);
      const auto& motion = Layout::motion(axis);
      const Number ratio = size_of(number(axis.ratio));
      const Number rate = number(axis.rate), acting = number(axis.acceleration);
      acceleration += ratio * size_of(number(motion.missed_by_rate) * rate +
                                      number(motion.missed_by_acceleration) * acting);
      if (!motion.lost) continue;
      lost += ratio * (size_of(number(motion.lost_rate_by_rate) * rate +
                               number(motion.lost_rate_by_acceleration) * acting) +
                       size_of(number(motion.lost_angle_by_rate) * rate +
                               number(motion.lost_angle_by_acceleration) * acting));
    }
    // The larger tilt of start and end: a motion that is over by the first node may start far away.
    for (int i = 0; i < 2; ++i) {
      const auto& axis = Layout::axis(of, i);
      const Number start = direct ? number(axis.ratio) * number(axis.angle) + number(axis.offset)
                                  : Layout::start_sine(of, i, first);
      tilt += larger_of(size_of(Layout::end_sine(of, i, first)),
                        smaller_of(size_of(start), Number(1.0)));
    }
    const auto rolling = Layout::rolling(scene, first);
    tilt += size_of(rolling.sin_skew) + size_of(rolling.sin_base);
    const Number distance = size_of(number(of.position[0])) + size_of(number(of.position[1]));
    return (Number(table.c[0] / 2) * number(of.length) * acceleration + lost) *
           Layout::gain(of, first) *
           (number(scene.radius) + size_of(rolling.height) + tilt * distance);
  }

  // Error estimates relative to the tolerance, of x, y, x', y', u and the integral of u.
  struct Errors {
    Number of[6]{Number(0.0), Number(0.0), Number(0.0), Number(0.0), Number(0.0), Number(0.0)};

    BBSIM_INLINE Number greatest() const {
      Number most = of[0];
      for (int i = 1; i < 6; ++i) most = larger_of(most, of[i]);
      return most;
    }
  };

  // From the decay of the last Legendre coefficients, as in radau/collocation.hpp: the first
  // coefficient left out, integrated once for a velocity and twice for a position.
  template <class Of, class OfScene>
  BBSIM_INLINE static Errors estimate(const Of& of, const OfScene& scene, int servos, bool direct,
                                      bool gamma, int first) {
    const auto number = [first](const auto& value) __attribute__((always_inline)) {
      return Layout::number(value, first);
    };
    const auto scale = [&](const auto& from, const auto& to) __attribute__((always_inline)) {
      return Number(scene.rtol) * larger_of(size_of(number(from)), size_of(number(to))) +
             Number(scene.atol);
    };
    constexpr double once = 1.0 / (2 * nodes + 1);
    const Number h = number(of.length);
    const auto last = [&](int i, int m) __attribute__((always_inline)) {
      return size_of(number(of.series[i][nodes - m]));
    };
    const Number overlooked = unseen(of, scene, servos, direct, first);
    const Number of_position = larger_of(Number(1.0), Number(once) * h);
    Number tail[3], most = overlooked;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      tail[i] = Number(once) * larger_of(last(i, 1), last(i, 2));
      most = larger_of(most, i < 2 || gamma ? tail[i] * of_position : tail[i]);
    }
    Errors errors;
    // Usually this bound is far below the tolerance and decides alone.
    if (Layout::every(simd::exceeds(Number(1e-3 * scene.atol), most))) {
      errors.of[4] = most * Number(1 / scene.atol);
      return errors;
    }
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const Number before = Number(once) * larger_of(last(i, 3), last(i, 4));
      const Number fall = smaller_of(tail[i] / (before + Number(1e-300)), Number(1.0));
      const Number left_out = tail[i] * simd::root_of(fall);
      errors.of[2 + i] = left_out / scale(of.velocity[i], of.velocity_end[i]);
      if (i < 2) {
        errors.of[i] = Number(once) * h * left_out / scale(of.position[i], of.position_end[i]);
      } else if (gamma) {
        errors.of[5] = Number(once) * h * left_out / Number(scene.atol);
      }
    }
    const Number slower =
        smaller_of(size_of(number(of.velocity[0])), size_of(number(of.velocity[1])));
    errors.of[4] =
        larger_of(errors.of[4], overlooked / (Number(scene.rtol) * slower + Number(scene.atol)));
    return errors;
  }
};

}  // namespace bbsim::solve::sampled
