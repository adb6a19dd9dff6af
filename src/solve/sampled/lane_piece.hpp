// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sampled rigs between two instants, with one rig in each lane, for one instruction set.
#pragma once

#include "solve/collocation/radau_table.hpp"
#include "solve/sampled/lane_control.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/sampled/piece.hpp"

namespace bbsim::solve::sampled {

template <class Isa>
struct LaneKernel {
  using One = Kernel<Isa>;
  using Layout = RigsInLanes<Isa>;
  using Method = Substitution<Isa, Layout>;
  using P = typename Layout::P;
  using Vector = typename P::Vector;
  using Mask = typename P::Mask;
  static constexpr int lanes = Isa::lanes;
  static constexpr const auto& table = Method::table;

  BBSIM_INLINE static bool is_direct(const LanePieces& pieces) { return pieces.plates == nullptr; }

  BBSIM_INLINE static bool all_small(const LanePieces& pieces, int first) {
    bool small = true;
    for (int i = 0; i < 2; ++i) {
      const LaneAxis& axis = pieces.axis[i];
      const auto size = [&](const double* of) __attribute__((always_inline)) {
        return size_of(P::load(of + first));
      };
      const P moves = P::load(axis.most_by_rate + first) * size(axis.rate) +
                      P::load(axis.most_by_acceleration + first) * size(axis.acceleration);
      const P start = size_of(P::load(axis.ratio + first) * P::load(axis.angle + first) +
                              P::load(axis.offset + first));
      small = small && One::Layout::reduced(start + size(axis.ratio) * moves,
                                            typename One::Larger{}) < 0.785;
    }
    return small;
  }

  static void start(LanePieces& pieces, LaneServos& servos) {
    for (int first = 0; first < group; first += lanes) {
      const auto of = [first](const double* values) __attribute__((always_inline)) {
        return P::load(values + first);
      };
      Mask clear = Mask{} - 1;
      for (int i = 0; i < pieces.servos; ++i) {
        const LaneServo& servo = servos.of[i];
        LaneAxis& axis = pieces.axis[i];
        const P angle = of(axis.angle), rate = of(axis.rate), damped = of(servo.damping) * rate;
        const P acceleration = of(servo.push) + (of(servo.by_command) * of(servo.command) -
                                                 of(servo.stiffness) * angle - damped);
        acceleration.store(axis.acceleration + first);
        // As in model::reach_about(), an oscillator's energy does not grow.
        const P inverse = of(servo.inverse_root);
        const P spring = (acceleration + damped) * inverse * inverse;
        const P most = size_of(spring) + size_of(rate) * inverse;
        const P rate_most = most * of(servo.root);
        clear &= simd::exceeds(of(servo.rate_most), rate_most) &
                 simd::exceeds(of(servo.angle_most), size_of(angle + spring) + most) &
                 simd::exceeds(of(servo.acceleration_most),
                               of(servo.stiffness) * most + of(servo.damping) * rate_most);
      }
      simd::choose(clear, P(1.0), P(0.0)).store(servos.clear + first);
    }
  }

  static constexpr radau::StartWeights<nodes> start_weights{};

  [[gnu::flatten]] static void tables(LaneAxis& axis, const LaneServo& servo,
                                      const double* length) {
    using model::most_terms;
    for (int first = 0; first < group; first += lanes) {
      const auto of = [first](const double* values) __attribute__((always_inline)) {
        return P::load(values + first);
      };
      const P t = of(length), damping = of(servo.damping), stiffness = of(servo.stiffness);
      const P d = damping * t, k = stiffness * t * t;
      // The terms of model::answer() at the end of the pieces. At a fraction c of a piece, term n
      // has the factor c^n.
      P value[most_terms + 1], slope[most_terms + 1], integral[most_terms + 1];
      P before(0.0), last(1.0);
      int terms = 0;
      for (;; ++terms) {
        value[terms] = last;
        slope[terms] = P(terms + 1.0) * last;
        integral[terms] = P(model::term_parts<P>.of[terms + 2]) * last;
        const bool small =
            One::Layout::reduced(size_of(last) + size_of(before), typename One::Larger{}) < 1e-18;
        if (small || terms == most_terms) break;
        const P next = model::next_term(d, k, last, before, terms + 1);
        before = last;
        last = next;
      }
      P most_by_rate(0.0), most_by_acceleration(0.0);
      P missed_by_rate(0.0), missed_by_acceleration(-1.0);
#pragma GCC unroll 1
      for (int n = 0; n < nodes; ++n) {
        const P c(table.c[n]);
        P h = value[terms], rate = slope[terms], sum = integral[terms];
        for (int m = terms - 1; m >= 0; --m) {
          h = h * c + value[m];
          rate = rate * c + slope[m];
          sum = sum * c + integral[m];
        }
        const P time = c * t;
        h = h * time;
        sum = sum * time * time;
        const P angle_by_rate = h + damping * sum, acceleration_by_rate = -(stiffness * h);
        const auto put = [&](double(&rows)[MotionTable::rows][nodes][group], P angle, P turn,
                             P acceleration) __attribute__((always_inline)) {
          angle.store(rows[MotionTable::angle][n] + first);
          turn.store(rows[MotionTable::rate][n] + first);
          acceleration.store(rows[MotionTable::acceleration][n] + first);
        };
        put(axis.by_rate, angle_by_rate, rate + damping * h, acceleration_by_rate);
        put(axis.by_acceleration, sum, h, rate);
        most_by_rate = larger_of(most_by_rate, size_of(angle_by_rate));
        most_by_acceleration = larger_of(most_by_acceleration, size_of(sum));
        missed_by_rate += P(start_weights.of[n]) * acceleration_by_rate;
        missed_by_acceleration += P(start_weights.of[n]) * rate;
      }
      most_by_rate.store(axis.most_by_rate + first);
      most_by_acceleration.store(axis.most_by_acceleration + first);
      missed_by_rate.store(axis.missed_by_rate + first);
      missed_by_acceleration.store(axis.missed_by_acceleration + first);
    }
  }

  // The plate's axis at a node, for servos that turn it directly.
  BBSIM_INLINE static model::GimbalAngle<P> move_axis(LaneAxis& axis, LanePlane& plane, int node,
                                                      int first, bool small) {
    const P start_rate = P::load(axis.rate + first);
    const P start_acceleration = P::load(axis.acceleration + first);
    const P ratio = P::load(axis.ratio + first);
    P row[MotionTable::rows];
    if (axis.shared != nullptr) {
      for (int of = 0; of < MotionTable::rows; ++of) {
        row[of] = P(axis.shared->by_rate[of][node]) * start_rate +
                  P(axis.shared->by_acceleration[of][node]) * start_acceleration;
      }
    } else {
      for (int of = 0; of < MotionTable::rows; ++of) {
        row[of] = P::load(axis.by_rate[of][node] + first) * start_rate +
                  P::load(axis.by_acceleration[of][node] + first) * start_acceleration;
      }
    }
    const P servo = P::load(axis.angle + first) + row[MotionTable::angle];
    if (node == nodes - 1) {
      servo.store(axis.angle_end + first);
      row[MotionTable::rate].store(axis.rate_end + first);
    }
    const P angle = ratio * servo + P::load(axis.offset + first);
    const SinCos<P> wave = small ? simd::sin_cos_of_small(angle) : sin_cos(angle);
    const model::GimbalAngle<P> at{wave.sin, wave.cos, ratio * row[MotionTable::rate],
                                   ratio * row[MotionTable::acceleration]};
    at.sin.store(plane.sin[node] + first);
    at.cos.store(plane.cos[node] + first);
    at.rate.store(plane.rate[node] + first);
    at.acceleration.store(plane.acceleration[node] + first);
    return at;
  }

  BBSIM_INLINE static model::GimbalAngle<P> plane_at(const LanePlane& plane, int node, int first) {
    return {P::load(plane.sin[node] + first), P::load(plane.cos[node] + first),
            P::load(plane.rate[node] + first), P::load(plane.acceleration[node] + first)};
  }

  // Computes each plate behind a mechanism, with the nodes in the lanes.
  static void move_plates(LanePieces& pieces) {
    for (int l = 0; l < group; ++l) {
      if (!(pieces.length[l] > 0)) continue;
      PlateMotion& motion = pieces.plates[l];
      One::move_plate(motion);
      pieces.gain[l] = motion.gain;
      for (int i = 0; i < 2; ++i) {
        const PlateMotion::Plane& from = motion.plane[i];
        LanePlane& to = pieces.plane[i];
        for (int n = 0; n < nodes; ++n) {
          to.sin[n][l] = from.sin[n];
          to.cos[n][l] = from.cos[n];
          to.rate[n][l] = from.rate[n];
          to.acceleration[n][l] = from.acceleration[n];
        }
        const model::GimbalAngle<double>& start = motion.plane_start[i];
        to.sin_start[l] = start.sin;
        to.cos_start[l] = start.cos;
        to.rate_start[l] = start.rate;
        to.acceleration_start[l] = start.acceleration;
      }
    }
  }

  template <bool papers>
  [[gnu::flatten]] static void attempt_some(LanePieces& pieces, const LaneScene& scene, int first) {
    const P h = P::load(pieces.length + first);
    const P r = P::load(scene.radius + first), g = P::load(scene.gravity + first);
    const bool direct = is_direct(pieces);
    const bool small = direct && all_small(pieces, first);
    typename Method::Rates rates[nodes];
    Layout::each([&](int n) __attribute__((always_inline)) {
      const auto plane = [&](int i) __attribute__((always_inline)) {
        return direct ? move_axis(pieces.axis[i], pieces.plane[i], n, first, small)
                      : plane_at(pieces.plane[i], n, first);
      };
      const model::GimbalAngle<P> phi = plane(0), theta = plane(1);
      rates[n].template take<papers>(phi, theta, Layout::rolling(scene, first), r, g, h);
    });
    const auto [solved, iterations] = Method::solve(pieces, rates, scene.rtol, scene.atol, first);
    pieces.iterations += iterations;
    const P error = Method::estimate(pieces, scene, pieces.servos, direct, false, first).greatest();
    simd::choose(solved & is_finite(error), error, P(hopeless)).store(pieces.error + first);
  }

  static void attempt(LanePieces& pieces, const LaneScene& scene) {
    pieces.iterations = 0;
    if (!is_direct(pieces)) move_plates(pieces);
    for (int first = 0; first < group; first += lanes) {
      scene.papers ? attempt_some<true>(pieces, scene, first)
                   : attempt_some<false>(pieces, scene, first);
    }
  }

  template <bool papers>
  [[gnu::flatten]] static void evaluate_some(const LanePieces& pieces, const LaneScene& scene,
                                             const LaneReference& reference,
                                             LaneQuantities& quantities, int first) {
    const auto of = [first](const double* values) __attribute__((always_inline)) {
      return P::load(values + first);
    };
    const P h = of(pieces.length);
    const P inverse = P(1.0) / P::of(h.v > Vector{} ? h.v : P(1.0).v);
    const bool direct = is_direct(pieces);
    const bool small = direct && all_small(pieces, first);
    const auto rolling = [&]() __attribute__((always_inline)) {
      if constexpr (papers) {
        return model::GeneralRolling{};
      } else {
        return Layout::rolling(scene, first);
      }
    }
    ();
    P least[lane_quantity_count], most[lane_quantity_count];
#pragma GCC unroll 1
    for (int n = 0; n < nodes; ++n) {
      const bool start = n == 0;
      const auto take = [&](int i, P value) __attribute__((always_inline)) {
        if (scene.sizes) value.store(quantities.at[i][n] + first);
        least[i] = start ? value : smaller_of(least[i], value);
        most[i] = start ? value : larger_of(most[i], value);
      };
      model::RollingState<P, P, P> ball;
      P acceleration[2];
      model::GimbalAngle<P> axis[2];
      if (start) {
        ball = {of(pieces.position[0]), of(pieces.position[1]), of(pieces.velocity[0]),
                of(pieces.velocity[1]), of(pieces.velocity[2])};
        for (int i = 0; i < 2; ++i) {
          P sum = of(pieces.series[i][0]);
          for (int m = 1; m < nodes; ++m) {
            sum += m % 2 == 0 ? of(pieces.series[i][m]) : -of(pieces.series[i][m]);
          }
          acceleration[i] = sum * inverse;
          const LanePlane& plane = pieces.plane[i];
          if (!direct) {
            axis[i] = {of(plane.sin_start), of(plane.cos_start), of(plane.rate_start),
                       of(plane.acceleration_start)};
            continue;
          }
          const LaneAxis& from = pieces.axis[i];
          const P angle = of(from.ratio) * of(from.angle) + of(from.offset);
          const SinCos<P> wave = small ? simd::sin_cos_of_small(angle) : sin_cos(angle);
          axis[i] = {wave.sin, wave.cos, of(from.ratio) * of(from.rate),
                     of(from.ratio) * of(from.acceleration)};
        }
      } else {
        ball = {of(pieces.position_at[0][n]), of(pieces.position_at[1][n]),
                of(pieces.velocity_at[0][n]), of(pieces.velocity_at[1][n]),
                of(pieces.velocity_at[2][n])};
        for (int i = 0; i < 2; ++i) {
          acceleration[i] = of(pieces.acceleration_at[i][n]);
          axis[i] = plane_at(pieces.plane[i], n, first);
        }
      }
      take(Quantity::x, ball.x);
      take(Quantity::y, ball.y);
      take(Quantity::distance_squared, ball.x * ball.x + ball.y * ball.y);
      const auto plane = model::moving_plane(rolling, axis[0], axis[1]);
      take(Quantity::up, plane.up.z);
      if (scene.sizes) {
        take(Quantity::vx, ball.x_dot);
        take(Quantity::vy, ball.y_dot);
        const auto& turn = plane.omega;
        take(Quantity::rate_squared, turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
        P x = ball.x, y = ball.y;
        if (reference.shared) {
          x -= P(reference.common[0][n]);
          y -= P(reference.common[1][n]);
        } else {
          x -= of(reference.at[0][n]);
          y -= of(reference.at[1][n]);
        }
        take(Quantity::error_squared, x * x + y * y);
      }
      if (!scene.force) continue;
      const model::Vector3<P> by_mass =
          model::force_by_mass(plane, ball, acceleration[0], acceleration[1], P(rolling.height),
                               of(scene.radius), of(scene.gravity));
      take(Quantity::normal, by_mass.z);
      const P held = of(scene.friction) * by_mass.z;
      take(Quantity::grip, held * held - (by_mass.x * by_mass.x + by_mass.y * by_mass.y));
    }
    const int monitored = scene.force ? Quantity::grip + 1 : Quantity::up + 1;
    Mask quiet = Mask{} - 1;
    for (int i = 0; i < monitored; ++i) {
      const P beyond = P(overshoot) * (most[i] - least[i]);
      quiet &= simd::exceeds(least[i] - beyond, of(scene.least[i])) &
               simd::exceeds(of(scene.most[i]), most[i] + beyond);
    }
    simd::choose(quiet, P(1.0), P(0.0)).store(quantities.quiet + first);
    if (!scene.sizes) return;
    Mask known = Mask{} - 1;
    for (int i = 0; i < lane_quantity_count; ++i) {
      if (i >= monitored && i <= Quantity::grip) continue;
      least[i].store(quantities.least[i] + first);
      most[i].store(quantities.most[i] + first);
      const P beyond = P(overshoot) * (most[i] - least[i]);
      known &= ~simd::exceeds(of(scene.known_least[i]), least[i] - beyond) &
               ~simd::exceeds(most[i] + beyond, of(scene.known_most[i]));
    }
    simd::choose(known, P(1.0), P(0.0)).store(quantities.known + first);
  }

  static void evaluate_quantities(const LanePieces& pieces, const LaneScene& scene,
                                  const LaneReference& reference, LaneQuantities& quantities) {
    for (int first = 0; first < group; first += lanes) {
      scene.papers ? evaluate_some<true>(pieces, scene, reference, quantities, first)
                   : evaluate_some<false>(pieces, scene, reference, quantities, first);
    }
  }

  static Range narrow(const LaneQuantities& quantities, Quantity quantity, int lane) {
    const auto& at = quantities.at[quantity];
    return One::close_range([&](int j) __attribute__((always_inline)) { return at[j][lane]; });
  }

  static void reference(const model::SignalView& of, double from, double length,
                        double (*at)[nodes]) {
    for (int first = 0; first < nodes; first += lanes) {
      P c = P::load(table.c + first);
      if (first == 0) c = P::of(One::first_lane() ? P(0.0).v : c.v);
      const auto values = of.at(P(from) + P(length) * c);
#pragma GCC unroll 2
      for (std::size_t i = 0; i < 2; ++i) values[i].value.store(at[i] + first);
    }
  }

  [[gnu::flatten]] static void evaluate(const LanePieces& pieces, const double* times,
                                        double (*ball)[group]) {
    for (int first = 0; first < group; first += lanes) {
      const auto of = [first](const double* values) __attribute__((always_inline)) {
        return P::load(values + first);
      };
      const P h = of(pieces.length);
      const P whole = P::of(h.v > Vector{} ? h.v : P(1.0).v);
      const P s = P(2.0) * of(times) / whole - P(1.0);
      // Legendre polynomials at s, up to the degree of the positions.
      P legendre[nodes + 2];
      legendre[0] = P(1.0);
      legendre[1] = s;
#pragma GCC unroll 16
      for (int m = 1; m <= nodes; ++m) {
        legendre[m + 1] =
            P((2.0 * m + 1) / (m + 1)) * s * legendre[m] - P(double(m) / (m + 1)) * legendre[m - 1];
      }
#pragma GCC unroll 1
      for (int i = 0; i < 3; ++i) {
        P k[nodes + 2], v[nodes + 2];
#pragma GCC unroll 16
        for (int m = 0; m < nodes; ++m) k[m] = of(pieces.series[i][m]);
        k[nodes] = k[nodes + 1] = v[nodes + 1] = P(0.0);
        // (1/2) times the integral of k from -1, plus the velocity there.
        v[0] = of(pieces.velocity[i]) + P(0.5) * (k[0] - k[1] * P(One::odd_parts.of[1]));
        P sum = v[0];
#pragma GCC unroll 16
        for (int m = 1; m <= nodes; ++m) {
          v[m] = P(0.5) *
                 (k[m - 1] * P(One::odd_parts.of[m - 1]) - k[m + 1] * P(One::odd_parts.of[m + 1]));
          sum += v[m] * legendre[m];
        }
        sum.store(ball[2 + i] + first);
        if (i == 2) continue;
        const P half = P(0.5) * h;
        P place = of(pieces.position[i]) + half * (v[0] - v[1] * P(One::odd_parts.of[1]));
#pragma GCC unroll 16
        for (int m = 1; m <= nodes + 1; ++m) {
          const P next = m + 1 <= nodes ? v[m + 1] * P(One::odd_parts.of[m + 1]) : P(0.0);
          place += half * (v[m - 1] * P(One::odd_parts.of[m - 1]) - next) * legendre[m];
        }
        place.store(ball[i] + first);
      }
    }
  }

  static constexpr LaneKernels kernels{&tables, &start,     &attempt,          &evaluate_quantities,
                                       &narrow, &reference, &control_lanes<P>, &evaluate};
};

}  // namespace bbsim::solve::sampled
