// The ordinary differential equations of a scene: equation (27) with what moves the gimbal.
//
// A system is a plain value with
//     size                          the number of states, at compile time
//     derivative(t, z, dz)          z' = f(t, z), for any number types of time and state
//     sample(t, z)                  the instant in the paper's symbols
// and no knowledge of who integrates it. Which one a scene gets is assemble()'s choice.
#pragma once

#include <array>
#include <string_view>

#include "model/rolling.hpp"
#include "model/sample.hpp"
#include "model/signal_pair.hpp"

namespace bbsim::model {

// What can move: the ball anywhere on the plane, or along one axis of it, where symmetry keeps
// the other coordinate, the spin and the other gimbal angle at zero.
enum class Shape { full, along_x, along_y };

// Fields, not indices: the packing of the ball into a solver's vector, and back.
template <Shape shape>
struct BallLayout;

template <>
struct BallLayout<Shape::full> {
  static constexpr int size = 5;
  static constexpr std::array<std::string_view, 5> names{"x", "y", "vx", "vy", "r*spin"};

  template <class Real>
  static RollingState<Real, Real, Real> unpack(const Real* z) {
    return {z[0], z[1], z[2], z[3], z[4]};
  }
  template <class Real, class Phi, class Theta, class Ball>
  static void derivative(const Phi& phi, const Theta& theta, const Ball& ball, double r, double g,
                         Real* dz) {
    dz[0] = ball.x_dot;
    dz[1] = ball.y_dot;
    dz[2] = x_acceleration<Real>(phi, theta, ball, r, g);
    dz[3] = y_acceleration<Real>(phi, theta, ball, r, g);
    dz[4] = u_acceleration<Real>(phi, theta, ball, r);
  }
};

template <>
struct BallLayout<Shape::along_x> {
  static constexpr int size = 2;
  static constexpr std::array<std::string_view, 2> names{"x", "vx"};

  template <class Real>
  static RollingState<Real, Zero, Zero> unpack(const Real* z) {
    return {z[0], {}, z[1], {}, {}};
  }
  template <class Real, class Phi, class Theta, class Ball>
  static void derivative(const Phi& phi, const Theta& theta, const Ball& ball, double r, double g,
                         Real* dz) {
    dz[0] = ball.x_dot;
    dz[1] = x_acceleration<Real>(phi, theta, ball, r, g);
  }
};

template <>
struct BallLayout<Shape::along_y> {
  static constexpr int size = 2;
  static constexpr std::array<std::string_view, 2> names{"y", "vy"};

  template <class Real>
  static RollingState<Zero, Real, Zero> unpack(const Real* z) {
    return {{}, z[0], {}, z[1], {}};
  }
  template <class Real, class Phi, class Theta, class Ball>
  static void derivative(const Phi& phi, const Theta& theta, const Ball& ball, double r, double g,
                         Real* dz) {
    dz[0] = ball.y_dot;
    dz[1] = y_acceleration<Real>(phi, theta, ball, r, g);
  }
};

inline constexpr bool phi_moves(Shape shape) { return shape != Shape::along_y; }
inline constexpr bool theta_moves(Shape shape) { return shape != Shape::along_x; }

template <Shape shape, class Ball>
[[nodiscard]] BallMotion ball_motion(const Ball& ball, double r) {
  return {ball.x, ball.y, ball.x_dot, ball.y_dot, static_cast<double>(ball.u) / r};
}

// The gimbal follows a given motion: its angles are functions of time, not states.
template <Shape shape>
class OpenLoop {
 public:
  using Layout = BallLayout<shape>;
  static constexpr Shape moves = shape;
  static constexpr int size = Layout::size;
  static constexpr bool linear = true;  // z' = A(t) z + b(t)

  OpenLoop(double radius, double gravity, SignalPair motion)
      : r_(radius), g_(gravity), motion_(std::move(motion)) {}

  template <class Time, class Real>
  void derivative(const Time& t, const Real* z, Real* dz) const {
    const auto angles = motion_.at(t);
    const auto phi = axis<phi_moves(shape)>(angles[0]);
    const auto theta = axis<theta_moves(shape)>(angles[1]);
    Layout::template derivative<Real>(phi, theta, Layout::unpack(z), r_, g_, dz);
  }

  [[nodiscard]] Sample sample(double t, const double* z) const {
    const auto [phi, theta] = motion_.at(t);
    return {t, ball_motion<shape>(Layout::unpack(z), r_), 0,
            {phi.value, theta.value, phi.rate, theta.rate, phi.acceleration, theta.acceleration},
            {0, 0}};
  }

  [[nodiscard]] const SignalPair& motion() const { return motion_; }

 private:
  template <bool moves_at_all, class Time>
  static auto axis(const Jet<Time>& angle) {
    if constexpr (moves_at_all) {
      const SinCos<Time> direction = sin_cos(angle.value);
      return Axis<Time>{direction.sin, direction.cos, angle.rate, angle.acceleration};
    } else {
      return LockedAxis{};
    }
  }

  double r_, g_;
  SignalPair motion_;
};

// Proportional and derivative gains, rows phi, theta; columns x, y: equation (31).
struct Gains {
  Matrix2 kv{}, kp{};
};

// One axis of the gimbal under control. Its acceleration is
//     acceleration drive:  u                                         equation (31)
//     angle drive:         omega_n^2 (u - angle) - 2 zeta omega_n angle'   a position servo
struct ServoLaw {
  double omega_n = 0, zeta = 0;

  template <Drives drives, class Real>
  [[nodiscard]] Real acceleration(const Real& u, const Real& angle, const Real& rate) const {
    if constexpr (drives == Drives::acceleration) {
      return u;
    } else {
      return omega_n * omega_n * (u - angle) - 2 * zeta * omega_n * rate;
    }
  }
};

// A controller moves the gimbal: angles and rates are states, after those of the ball.
template <Shape shape, Drives drives>
class ClosedLoop {
 public:
  using Layout = BallLayout<shape>;
  static constexpr Shape moves = shape;
  static constexpr int axes = phi_moves(shape) + theta_moves(shape);
  static constexpr int size = Layout::size + 2 * axes;
  static constexpr bool linear = false;

  ClosedLoop(double radius, double gravity, Gains gains, ServoLaw servo, SignalPair reference)
      : r_(radius), g_(gravity), gains_(gains), servo_(servo), reference_(std::move(reference)) {}

  template <class Time, class Real>
  void derivative(const Time& t, const Real* z, Real* dz) const {
    const auto ball = Layout::unpack(z);
    const auto reference = reference_.at(t);
    const Real* angles = z + Layout::size;  // [phi, theta,] then their rates
    Real* angles_dot = dz + Layout::size;
    const auto phi = axis<0, Real>(ball, reference, angles);
    const auto theta = axis<1, Real>(ball, reference, angles);
    Layout::template derivative<Real>(phi, theta, ball, r_, g_, dz);
    for (int i = 0; i < axes; ++i) angles_dot[i] = angles[axes + i];
    if constexpr (phi_moves(shape)) angles_dot[axes] = phi.acceleration;
    if constexpr (theta_moves(shape)) angles_dot[2 * axes - 1] = theta.acceleration;
  }

  [[nodiscard]] Sample sample(double t, const double* z) const {
    const auto ball = Layout::unpack(z);
    const auto reference = reference_.at(t);
    const double* angles = z + Layout::size;
    GimbalMotion gimbal;
    if constexpr (phi_moves(shape)) {
      gimbal.phi = angles[0];
      gimbal.phi_dot = angles[axes];
      gimbal.phi_ddot = axis<0, double>(ball, reference, angles).acceleration;
    }
    if constexpr (theta_moves(shape)) {
      gimbal.theta = angles[axes - 1];
      gimbal.theta_dot = angles[2 * axes - 1];
      gimbal.theta_ddot = axis<1, double>(ball, reference, angles).acceleration;
    }
    return {t, ball_motion<shape>(ball, r_), 0, gimbal, {reference[0].value, reference[1].value}};
  }

  [[nodiscard]] const SignalPair& reference() const { return reference_; }

 private:
  // Equation (31) for one row of the gains, and the servo behind it.
  template <std::size_t row, class Real, class Ball, class Time>
  [[nodiscard]] auto axis(const Ball& ball, const std::array<Jet<Time>, 2>& reference,
                          const Real* angles) const {
    if constexpr (row == 0 ? phi_moves(shape) : theta_moves(shape)) {
      const Real& angle = angles[row == 0 ? 0 : axes - 1];
      const Real& rate = angles[row == 0 ? axes : 2 * axes - 1];
      const Real u = gains_.kv[row][0] * (reference[0].rate - ball.x_dot) +
                     gains_.kv[row][1] * (reference[1].rate - ball.y_dot) +
                     gains_.kp[row][0] * (reference[0].value - ball.x) +
                     gains_.kp[row][1] * (reference[1].value - ball.y);
      const SinCos<Real> direction = sin_cos(angle);
      return Axis<Real>{direction.sin, direction.cos, rate,
                        servo_.template acceleration<drives, Real>(u, angle, rate)};
    } else {
      return LockedAxis{};
    }
  }

  double r_, g_;
  Gains gains_;
  ServoLaw servo_;
  SignalPair reference_;
};

}  // namespace bbsim::model
