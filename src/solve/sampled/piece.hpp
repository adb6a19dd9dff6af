// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A piece of one rig between two instants, with its nodes in the lanes, for one instruction set.
//
// Under a held command the servos move in closed form (model/servo/held_motion.hpp), so the plate's
// motion is given. substitution.hpp has the method for the ball.
#pragma once

#include "model/servo/impulse_series.hpp"
#include "solve/sampled/substitution.hpp"

namespace bbsim::solve::sampled {

template <class Isa>
struct Kernel {
  static constexpr int lanes = Isa::lanes;
  static constexpr int packs = nodes / lanes;
  using Layout = NodesInLanes<Isa>;
  using Method = Substitution<Isa, Layout>;
  using P = typename Layout::P;
  using Vector = typename P::Vector;
  using Mask = typename P::Mask;
  using Larger = typename Layout::Larger;
  using Smaller = typename Layout::Smaller;
  static constexpr const auto& table = Method::table;

  // Interpolates from the start and all nodes but the first to the Chebyshev points. `highest`
  // gives the last Chebyshev coefficient.
  struct alignas(64) CloseTable {
    double share[nodes][close_points]{};
    double highest[nodes]{};
    consteval CloseTable() {
      // (1 - cos((2 k + 1) pi / 64)) / 2
      constexpr double first_half[close_points / 2] = {
          0.0006022718974137975, 0.005411745017609493, 0.014984373402728013, 0.029227967408489597,
          0.04800535343827833,   0.07113569499986394,  0.09839623425967753,  0.12952443732252045,
          0.16422052257649083,   0.20215034775378327,  0.24294862790338917,  0.2862224532848589,
          0.33155507330389,      0.378509910048368,    0.42663476277231915,  0.47546616283629095};
      for (int k = 0; k < close_points; ++k) {
        const double s =
            k < close_points / 2 ? first_half[k] : 1 - first_half[close_points - 1 - k];
        for (int j = 0; j < nodes; ++j) {
          share[j][k] = 1;
          for (int i = 0; i < nodes; ++i) {
            if (i != j) share[j][k] *= (s - point(i)) / (point(j) - point(i));
          }
        }
      }
      for (int j = 0; j < nodes; ++j) {
        highest[j] = 1.0 / (1 << (2 * nodes - 3));
        for (int i = 0; i < nodes; ++i) {
          if (i != j) highest[j] /= point(j) - point(i);
        }
      }
    }
    static consteval double point(int i) { return i == 0 ? 0.0 : table.c[i]; }
  };
  static constexpr CloseTable close_table{};

  BBSIM_INLINE static Mask first_lane() {
    Mask mask{};
    mask[0] = -1;
    return mask;
  }

  // How far a servo's angle has moved since the start, its rate or its acceleration, at the nodes
  // of a pack.
  BBSIM_INLINE static P motion_at(const PieceAxis& axis, MotionTable::Row row, int p) {
    return P::load(axis.table->by_rate[row] + p * lanes) * P(axis.rate) +
           P::load(axis.table->by_acceleration[row] + p * lanes) * P(axis.acceleration);
  }

  // The plate's axis at the nodes of a pack.
  BBSIM_INLINE static model::GimbalAngle<P> plane_axis(const PieceAxis& axis, int p, bool small) {
    const P ratio(axis.ratio);
    const P angle =
        P(axis.ratio * axis.angle + axis.offset) + ratio * motion_at(axis, MotionTable::angle, p);
    const SinCos<P> wave = small ? simd::sin_cos_of_small(angle) : sin_cos(angle);
    return {wave.sin, wave.cos, ratio * motion_at(axis, MotionTable::rate, p),
            ratio * motion_at(axis, MotionTable::acceleration, p)};
  }

  // Whether the angle of the plate or of the horn stays within pi/4.
  BBSIM_INLINE static bool is_small(const PieceAxis& axis) {
    return size_of(axis.ratio * axis.angle + axis.offset) + motion_of(axis) < 0.785;
  }
  // A bound of how far the plate or the horn turns from its start to any node, rad.
  BBSIM_INLINE static double motion_of(const PieceAxis& axis) {
    return size_of(axis.ratio) * (axis.table->most_by_rate * size_of(axis.rate) +
                                  axis.table->most_by_acceleration * size_of(axis.acceleration));
  }

  // A pose near that for these angles of the horns, which move by less than 0.25 rad in a part.
  BBSIM_INLINE static model::ThreeServos::Pose<P> pose_towards(const PlateMotion& plate,
                                                               const P (&horn)[3], int parts) {
    double from[3];
    for (int i = 0; i < 3; ++i) {
      from[i] = plate.axis[i].ratio * plate.axis[i].angle + plate.axis[i].offset;
    }
    const auto& start = plate.legs_start.pose;
    if (parts > 1) return plate.three->follow(start, from, horn, parts);
    P at[3] = {P(start.p), P(start.q), P(start.z)};
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i)
        at[k] += P(plate.legs_start.slopes[k][i]) * (horn[i] - P(from[i]));
    }
    return {at[0], at[1], at[2]};
  }
  BBSIM_INLINE static double last_of(P values) {
    const double last = values.v[lanes - 1];
    return last;
  }

  // Computes the plate's motion at the nodes from that of the horns.
  template <class Link>
  static void move_plate(PlateMotion& plate, const Link& link) {
    constexpr int servos = Link::servos;
    [[maybe_unused]] double motion = 0;
    [[maybe_unused]] bool small = true;
    for (int i = 0; i < servos; ++i) {
      motion = larger_of(motion, motion_of(plate.axis[i]));
      small = small && is_small(plate.axis[i]);
    }
    for (int p = 0; p < packs; ++p) {
      P horn[servos], rate[servos], acting[servos];
      for (int i = 0; i < servos; ++i) {
        const PieceAxis& of = plate.axis[i];
        const P ratio(of.ratio);
        horn[i] = P(of.ratio * of.angle + of.offset) + ratio * motion_at(of, MotionTable::angle, p);
        rate[i] = ratio * motion_at(of, MotionTable::rate, p);
        acting[i] = ratio * motion_at(of, MotionTable::acceleration, p);
      }
      model::GimbalAngle<P> axis[2];
      if constexpr (servos == 3) {
        P sine[3], cosine[3], edges[Link::edge_count];
        link.directions(
            horn, sine, cosine, [small](const P& angle) __attribute__((always_inline)) {
              return small ? simd::sin_cos_of_small(angle) : sin_cos(angle);
            });
        const auto near = pose_towards(plate, horn, Link::parts_for(motion));
        typename Link::template Jacobian<P> there;
        const auto pose = link.pose_near(near, sine, cosine, there);
        link.planes_in(pose, there, sine, cosine, rate, acting, axis);
        link.edges(there, edges);
        for (int k = 0; k < Link::edge_count; ++k) edges[k].store(plate.edges[k] + p * lanes);
        if (p == packs - 1) {
          P by[3][3];
          link.pose_slopes(there, by);
          plate.legs_end.pose = {last_of(pose.p), last_of(pose.q), last_of(pose.z)};
          for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 3; ++i) plate.legs_end.slopes[k][i] = last_of(by[k][i]);
          }
        }
      } else {
        link.planes(horn, rate, acting, axis);
      }
      for (int i = 0; i < 2; ++i) store_axis(axis[i], plate.plane[i], p);
    }
  }
  // The same for either mechanism.
  [[gnu::flatten]] static void move_plate(PlateMotion& plate) {
    if (plate.three != nullptr) {
      move_plate(plate, *plate.three);
    } else {
      move_plate(plate, *plate.linkages);
    }
  }
  BBSIM_INLINE static void store_axis(const model::GimbalAngle<P>& axis, PlateMotion::Plane& into,
                                      int p) {
    axis.sin.store(into.sin + p * lanes);
    axis.cos.store(into.cos + p * lanes);
    axis.rate.store(into.rate + p * lanes);
    axis.acceleration.store(into.acceleration + p * lanes);
  }

  // With everything inlined the compiler sees which coefficients are zero.
  template <bool papers, class Link>
  [[gnu::flatten]] static void attempt(Piece& piece, const Scene& scene, Attempt& result) {
    bool small = false;
    if constexpr (Link::direct) {
      small = is_small(piece.plate.axis[0]) && is_small(piece.plate.axis[1]);
    } else if constexpr (Link::servos == 3) {
      move_plate(piece.plate, *piece.plate.three);
    } else {
      move_plate(piece.plate, *piece.plate.linkages);
    }
    typename Method::Rates rates[packs];
    for_each<packs>([&](auto p) __attribute__((always_inline)) {
      model::GimbalAngle<P> axis[2];
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        PlateMotion::Plane& at = piece.plate.plane[i];
        if constexpr (Link::direct) {
          axis[i] = plane_axis(piece.plate.axis[i], p, small);
          store_axis(axis[i], at, p);
        } else {
          axis[i] = {P::load(at.sin + p * lanes), P::load(at.cos + p * lanes),
                     P::load(at.rate + p * lanes), P::load(at.acceleration + p * lanes)};
        }
      }
      rates[p].template take<papers>(axis[0], axis[1], scene.rolling, scene.radius, scene.gravity,
                                     P(piece.length));
    });
    const auto [solved, iterations] = Method::solve(piece, rates, scene.rtol, scene.atol, 0);
    const auto errors = Method::estimate(piece, scene, Link::servos, Link::direct, scene.gamma, 0);
    result = {solved, 0, 0, iterations};
    for (int i = 0; i < 6; ++i) {
      if (errors.of[i] <= result.error) continue;
      result.error = errors.of[i];
      result.worst_state = i < 5 ? i : 4;
    }
    if (!is_finite(result.error)) result.converged = false;
  }

  template <bool papers, class Link>
  [[gnu::flatten]] static void evaluate_quantities(const Piece& piece, const Scene& scene,
                                                   Range* ranges, QuantityValues& values) {
    P least[quantity_count], most[quantity_count];
#pragma GCC unroll 16
    for (int i = 0; i < quantity_count; ++i) least[i] = most[i] = P(0.0);
    const bool force = scene.force || scene.loads, keep = scene.sizes || scene.loads;
    // Values at the start, from the polynomial of the accelerations and from the servos.
    double started[2];
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      const double* const k = piece.series[i];
      started[i] = ((k[0] - k[1]) + (k[2] - k[3]) + ((k[4] - k[5]) + (k[6] - k[7]))) / piece.length;
    }
    model::GimbalAngle<double> plane_start[2];
    if constexpr (Link::direct) {
      Vector angles{};
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        angles[i] =
            piece.plate.axis[i].ratio * piece.plate.axis[i].angle + piece.plate.axis[i].offset;
      }
      const SinCos<P> waves = is_small(piece.plate.axis[0]) && is_small(piece.plate.axis[1])
                                  ? simd::sin_cos_of_small(P::of(angles))
                                  : sin_cos(P::of(angles));
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        const PieceAxis& of = piece.plate.axis[i];
        plane_start[i] = {waves.sin[i], waves.cos[i], of.ratio * of.start_rate,
                          of.ratio * of.start_acceleration};
      }
    } else {
      plane_start[0] = piece.plate.plane_start[0];
      plane_start[1] = piece.plate.plane_start[1];
    }
    const model::GeneralRolling papers_rig{};
    const model::GeneralRolling& rolling = papers ? papers_rig : scene.rolling;
    for_each<packs>([&](auto p) __attribute__((always_inline)) {
      const auto take = [&](int i, P value) __attribute__((always_inline)) {
        least[i] = p == 0 ? value : smaller_of(least[i], value);
        most[i] = p == 0 ? value : larger_of(most[i], value);
        if (keep) value.store(values.at[i] + p * lanes);
      };
      // The start replaces the first node.
      const auto at = [&](const double* values, double start) __attribute__((always_inline)) {
        const P all = P::load(values + p * lanes);
        return p == 0 ? P::of(first_lane() ? P(start).v : all.v) : all;
      };
      const model::RollingState<P, P, P> ball{
          at(piece.position_at[0], piece.position[0]), at(piece.position_at[1], piece.position[1]),
          at(piece.velocity_at[0], piece.velocity[0]), at(piece.velocity_at[1], piece.velocity[1]),
          at(piece.velocity_at[2], piece.velocity[2])};
      take(Quantity::x, ball.x);
      take(Quantity::y, ball.y);
      take(Quantity::distance_squared, ball.x * ball.x + ball.y * ball.y);
      model::GimbalAngle<P> axis[2];
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        const PlateMotion::Plane& of = piece.plate.plane[i];
        const model::GimbalAngle<double>& start = plane_start[i];
        axis[i] = {at(of.sin, start.sin), at(of.cos, start.cos), at(of.rate, start.rate),
                   at(of.acceleration, start.acceleration)};
      }
      const model::MovingPlane<P> plane = model::moving_plane(rolling, axis[0], axis[1]);
      take(Quantity::up, plane.up.z);
      if (scene.sizes) {
        take(Quantity::vx, ball.x_dot);
        take(Quantity::vy, ball.y_dot);
        const auto& turn = plane.omega;
        take(Quantity::rate_squared, turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
        const P x = ball.x - P::load(piece.reference_at[0] + p * lanes);
        const P y = ball.y - P::load(piece.reference_at[1] + p * lanes);
        take(Quantity::error_squared, x * x + y * y);
      }
      if (!force) return;
      const model::Vector3<P> by_mass = model::force_by_mass(
          plane, ball, at(piece.acceleration_at[0], started[0]),
          at(piece.acceleration_at[1], started[1]), rolling.height, scene.radius, scene.gravity);
      take(Quantity::normal, by_mass.z);
      const P held = P(scene.friction) * by_mass.z;
      take(Quantity::grip, held * held - (by_mass.x * by_mass.x + by_mass.y * by_mass.y));
      if (!scene.loads) return;
      const model::Vector3<P> contact{ball.x, ball.y, P(rolling.height)};
      const auto of_ball = model::about_axes(plane, model::cross(contact, by_mass));
      const auto of_plate =
          model::plate_torques(plane, axis[0], axis[1], scene.body, scene.gravity);
      const P phi = P(scene.mass) * of_ball.phi + of_plate.phi;
      const P theta = P(scene.mass) * of_ball.theta + of_plate.theta;
      take(Quantity::torque_phi, phi);
      take(Quantity::torque_theta, theta);
      take(Quantity::power, phi * axis[0].rate + theta * axis[1].rate);
    });
    const int asked = scene.loads   ? quantity_count
                      : scene.sizes ? Quantity::error_squared + 1
                      : force       ? Quantity::grip + 1
                                    : Quantity::up + 1;
#pragma GCC unroll 16
    for (int i = 0; i < quantity_count; ++i) {
      if (i >= asked) break;
      ranges[i] = {Layout::reduced(least[i], Smaller{}), Layout::reduced(most[i], Larger{})};
    }
  }

  // The range over the Chebyshev points of a quantity with the values at(j), and its trend.
  template <class At>
  BBSIM_INLINE static Range close_range(At at) {
    P least, most;
    alignas(64) double points[close_points];
    for (int k = 0; k < close_points; k += lanes) {
      P value(0.0);
#pragma GCC unroll 8
      for (int j = 0; j < nodes; ++j) value += P::load(close_table.share[j] + k) * P(at(j));
      least = k == 0 ? value : smaller_of(least, value);
      most = k == 0 ? value : larger_of(most, value);
      value.store(points + k);
    }
    Range range{Layout::reduced(least, Smaller{}), Layout::reduced(most, Larger{})};
    range.trend = trend_of(at, points);
    return range;
  }
  // The trend of a quantity with the values at(j), and with these at the Chebyshev points.
  template <class At>
  BBSIM_INLINE static int trend_of(At at, const double (&points)[close_points]) {
    const double start = at(0), end = at(nodes - 1);
    const int trend = end > start ? 1 : -1;
    for (int k = 1; k < close_points; ++k) {
      if (!(trend * (points[k] - points[k - 1]) > 0)) return 0;
    }
    // The first and the last interval are an eighth as long as their neighbors. Within them, a
    // quantity that turns there changes by at most an 80th of its change in the neighbor.
    constexpr double least_change = 1.0 / 16;
    constexpr int last = close_points - 1;
    const double first_change = trend * (points[0] - start),
                 last_change = trend * (end - points[last]);
    if (!(first_change > least_change * trend * (points[1] - points[0])) ||
        !(last_change > least_change * trend * (points[last] - points[last - 1]))) {
      return 0;
    }
    // The nodes must resolve the quantity.
    constexpr double resolved = 1e-4;
    double highest = 0;
    for (int j = 0; j < nodes; ++j) highest += close_table.highest[j] * at(j);
    return size_of(highest) <= resolved * size_of(end - start) ? trend : 0;
  }

  static Range narrow(const double (&values)[nodes]) {
    return close_range([&](int j) __attribute__((always_inline)) { return values[j]; });
  }

  // The series of model::answer(), for all nodes together.
  static void answers(double damping, double stiffness, double length, NodeAnswers& answers) {
    for_each<packs>([&](auto p) __attribute__((always_inline)) {
      const P t = P(length) * P::load(table.c + p * lanes);
      const P d = P(damping) * t, k = P(stiffness) * t * t;
      P last(1.0), before(0.0), value(1.0), slope(1.0), integral(0.5);
      for (int n = 1; n <= model::most_terms; ++n) {
        const P next = model::next_term(d, k, last, before, n);
        before = last;
        last = next;
        value += next;
        slope += P(n + 1.0) * next;
        integral += next * P(model::term_parts<P>.of[n + 2]);
        // Terms grow with the time. The last lane has the longest.
        const double largest = next.v[lanes - 1], largest_before = before.v[lanes - 1];
        if (size_of(largest) + size_of(largest_before) < 1e-18) break;
      }
      (t * t * integral).store(answers.integral + p * lanes);
      (t * value).store(answers.value + p * lanes);
      slope.store(answers.slope + p * lanes);
    });
  }

  // 1, 1/3, 1/5, ...: products are cheaper than quotients.
  struct OddParts {
    double of[nodes + 3]{};
    consteval OddParts() {
      for (int m = 0; m < nodes + 3; ++m) of[m] = 1.0 / (2 * m + 1);
    }
  };
  static constexpr OddParts odd_parts{};

  // `half` times the integral from -1 of a Legendre series of `length` terms, plus `from`.
  template <int length>
  BBSIM_INLINE static void integrate(const double* k, double half, double from, double* out) {
    out[0] = from + half * (k[0] - k[1] * odd_parts.of[1]);
#pragma GCC unroll 16
    for (int m = 1; m <= length; ++m) {
      const double next = m + 1 < length ? k[m + 1] * odd_parts.of[m + 1] : 0.0;
      out[m] = half * (k[m - 1] * odd_parts.of[m - 1] - next);
    }
  }

  // Times lie in the lanes. A row does not depend on the other times.
  static void evaluate(const Piece& piece, const double* times, std::size_t count,
                       double (*ball)[6]) {
    double velocity[3][nodes + 1], position[3][nodes + 2];
    for (int i = 0; i < 3; ++i) {
      // The series are those of the accelerations times the length.
      integrate<nodes>(piece.series[i], 0.5, piece.velocity[i], velocity[i]);
      integrate<nodes + 1>(velocity[i], 0.5 * piece.length, piece.position[i], position[i]);
    }
    for (std::size_t first = 0; first < count; first += lanes) {
      const int used = count - first < lanes ? static_cast<int>(count - first) : lanes;
      alignas(64) double at[lanes];
      for (int l = 0; l < lanes; ++l)
        at[l] = times[first + static_cast<std::size_t>(l < used ? l : 0)];
      const P s = P(2 / piece.length) * P::load(at) - P(1.0);
      P before(1.0), now = s, v[3], q[3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        v[i] = P(velocity[i][0]) + P(velocity[i][1]) * s;
        q[i] = P(position[i][0]) + P(position[i][1]) * s;
      }
#pragma GCC unroll 16
      for (int m = 1; m <= nodes; ++m) {
        // P_(m+1) = ((2 m + 1) s P_m - m P_(m-1)) / (m + 1)
        const P next =
            P((2.0 * m + 1) / (m + 1)) * s * now - rounded(P(double(m) / (m + 1)) * before);
        before = now;
        now = next;
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
          if (m < nodes) v[i] += P(velocity[i][m + 1]) * now;
          q[i] += P(position[i][m + 1]) * now;
        }
      }
      for (int l = 0; l < used; ++l) {
        double* const row = ball[first + static_cast<std::size_t>(l)];
        row[0] = q[0][l];
        row[1] = q[1][l];
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) row[2 + i] = v[i][l];
        row[5] = q[2][l];
      }
    }
  }

  template <bool papers, class Link>
  static constexpr Kernels::Of of{&attempt<papers, Link>, &evaluate_quantities<papers, Link>};
  static constexpr Kernels kernels{of<true, model::Direct>,
                                   of<false, model::Direct>,
                                   of<false, model::Linkages>,
                                   of<false, model::ThreeServos>,
                                   &answers,
                                   &narrow,
                                   &evaluate};
};

}  // namespace bbsim::solve::sampled
