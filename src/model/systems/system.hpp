// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The ordinary differential equations of a scene: equation (27) and the motion of the gimbal.
//
// A system is a value with these members:
//     size                          the number of states, at compile time
//     inputs(t)                     the part of z' = f(t, z) that depends only on time
//     derivative_of(inputs, z, dz)  the rest: f(t, z) = derivative_of(inputs(t), z), for any number
//                                   types of time and state
//     motions                       which states are the velocities of which other states
//     view()                        the system in plain memory, for code of one instruction set
//     sample(t, z, detail)          the instant in the paper's symbols
// A system does not depend on its integrator. assemble() chooses the system of a scene.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "model/ball/general_rolling.hpp"
#include "model/ball/rolling.hpp"
#include "model/control/law.hpp"
#include "model/sample.hpp"
#include "model/signals/signal_pair.hpp"

namespace bbsim::model {

// z' = f(t, z) of a system.
template <class System, class Time, class Real>
void derivative(const System& system, const Time& t, const Real* z, Real* dz) {
  system.derivative_of(system.inputs(t), z, dz);
}

// The freedom of the ball: anywhere on the plane, or along one axis if symmetry keeps the other
// coordinate, the spin and the other gimbal angle at zero.
enum class Shape { full, along_x, along_y };

// Indices of a velocity among the states and of its position; -1 if the position is not a state.
struct Motion {
  int position, velocity;
};

// All velocities of a system, those with a position first. Together with their positions, they are
// the whole state.
template <int velocities>
struct Motions {
  static constexpr int count = velocities;
  Motion of[velocities];
};

// Converts between a solver's state vector and the ball's fields. Here along one axis.
template <Shape shape>
struct BallLayout {
  static constexpr bool along_x = shape == Shape::along_x;
  static constexpr int size = 2;
  static constexpr std::array<std::string_view, 2> names{along_x ? "x" : "y",
                                                         along_x ? "vx" : "vy"};
  static constexpr Motions<1> motions{{{0, 1}}};

  template <class Real>
  static auto unpack(const Real* z) {
    if constexpr (along_x) {
      return RollingState<Real, Zero, Zero>{z[0], {}, z[1], {}, {}};
    } else {
      return RollingState<Zero, Real, Zero>{{}, z[0], {}, z[1], {}};
    }
  }
  template <class Real, class Equation, class Phi, class Theta, class Ball, class Scalar>
  static void derivative(const Equation& equation, const Phi& phi, const Theta& theta,
                         const Ball& ball, const Scalar& r, const Scalar& g, Real* dz) {
    if constexpr (along_x) {
      dz[0] = ball.x_dot;
      dz[1] = equation.template x<Real>(phi, theta, ball, r, g);
    } else {
      dz[0] = ball.y_dot;
      dz[1] = equation.template y<Real>(phi, theta, ball, r, g);
    }
  }
};

template <>
struct BallLayout<Shape::full> {
  static constexpr int size = 5;
  static constexpr std::array<std::string_view, 5> names{"x", "y", "vx", "vy", "r*spin"};
  static constexpr Motions<3> motions{{{0, 2}, {1, 3}, {-1, 4}}};

  template <class Real>
  static RollingState<Real, Real, Real> unpack(const Real* z) {
    return {z[0], z[1], z[2], z[3], z[4]};
  }
  template <class Real, class Equation, class Phi, class Theta, class Ball, class Scalar>
  static void derivative(const Equation& equation, const Phi& phi, const Theta& theta,
                         const Ball& ball, const Scalar& r, const Scalar& g, Real* dz) {
    dz[0] = ball.x_dot;
    dz[1] = ball.y_dot;
    if constexpr (requires { equation.template rates<Real>(phi, theta, ball, r, g); }) {
      const auto rates = equation.template rates<Real>(phi, theta, ball, r, g);
      dz[2] = rates.x;
      dz[3] = rates.y;
      dz[4] = rates.u;
    } else {
      dz[2] = equation.template x<Real>(phi, theta, ball, r, g);
      dz[3] = equation.template y<Real>(phi, theta, ball, r, g);
      dz[4] = equation.template u<Real>(phi, theta, ball, r);
    }
  }
};

inline constexpr bool phi_moves(Shape shape) {
  return shape != Shape::along_y;
}
inline constexpr bool theta_moves(Shape shape) {
  return shape != Shape::along_x;
}

template <Shape shape, class Ball>
[[nodiscard]] BallMotion ball_motion(const Ball& ball, double r) {
  return {ball.x, ball.y, ball.x_dot, ball.y_dot, static_cast<double>(ball.u) / r};
}

// The motion of the gimbal is prescribed: its angles are functions of time, not states.
template <Shape shape, class Signals = SignalPair, class Equation = Equation27>
class OpenLoop {
 public:
  using Layout = BallLayout<shape>;
  static constexpr Shape moves = shape;
  static constexpr int size = Layout::size;
  static constexpr bool open_loop = true;  // z' = A(t) z + b(t)
  static constexpr bool papers_rig = !std::is_same_v<Equation, GeneralRolling>;
  static constexpr auto motions = Layout::motions;

  OpenLoop(double radius, double gravity, Signals motion, Equation equation = {})
      : r_(radius), g_(gravity), motion_(std::move(motion)), equation_(equation) {}

  template <class Time>
  [[nodiscard]] auto inputs(const Time& t) const {
    const auto angles = motion_.at(t);
    return Inputs{axis<phi_moves(shape)>(angles[0]), axis<theta_moves(shape)>(angles[1])};
  }

  template <class Inputs, class Real>
  void derivative_of(const Inputs& in, const Real* z, Real* dz) const {
    Layout::template derivative<Real>(equation_, in.phi, in.theta, Layout::unpack(z), r_, g_, dz);
  }

  [[nodiscard]] OpenLoop<shape, SignalView, Equation> view() const {
    return {r_, g_, motion_.view(), equation_};
  }

  // The same scene with another equation of motion for the ball.
  template <class Other>
  [[nodiscard]] OpenLoop<shape, Signals, Other> with_equation() const {
    return {r_, g_, motion_};
  }

  [[nodiscard]] Sample sample(double t, const double* z, Detail detail = Detail::all) const {
    Sample sample;
    sample.t = t;
    sample.ball = ball_motion<shape>(Layout::unpack(z), r_);
    if (detail <= Detail::path) return sample;
    const auto [phi, theta] = motion_.at(t);
    sample.gimbal = {phi.value,  theta.value,      phi.rate,
                     theta.rate, phi.acceleration, theta.acceleration};
    return sample;
  }

  [[nodiscard]] const Signals& motion() const { return motion_; }
  [[nodiscard]] const Equation& equation() const { return equation_; }
  [[nodiscard]] double radius() const { return r_; }
  [[nodiscard]] double gravity() const { return g_; }

 private:
  template <class Phi, class Theta>
  struct Inputs {
    Phi phi;
    Theta theta;
  };
  template <class Phi, class Theta>
  Inputs(Phi, Theta) -> Inputs<Phi, Theta>;

  template <bool moves_at_all, class Time>
  static auto axis(const Jet<Time>& angle) {
    if constexpr (moves_at_all) {
      const SinCos<Time> direction = sin_cos(angle.value);
      return GimbalAngle<Time>{direction.sin, direction.cos, angle.rate, angle.acceleration};
    } else {
      return LockedAngle{};
    }
  }

  double r_, g_;
  Signals motion_;
  [[no_unique_address]] Equation equation_;
};

// The control of one gimbal axis. Its acceleration is
//     acceleration drive:  u                                         equation (31)
//     angle drive:         omega_n^2 (u - angle) - 2 zeta omega_n angle'   servo, (M11)
template <class Scalar>
struct BasicServoLaw {
  Scalar omega_n, zeta;

  template <Drives drives, class Real>
  [[nodiscard]] Real acceleration(const Real& u, const Real& angle, const Real& rate) const {
    if constexpr (drives == Drives::acceleration) {
      return u;
    } else {
      return omega_n * omega_n * (u - angle) - 2 * zeta * omega_n * rate;
    }
  }
};
using ServoLaw = BasicServoLaw<double>;

// A controller moves the gimbal: angles and rates are states after those of the ball.
template <Shape shape, Drives drives, class Signals = SignalPair, class Equation = Equation27,
          class Scalar = double>
class ClosedLoop {
 public:
  using Layout = BallLayout<shape>;
  static constexpr Shape moves = shape;
  static constexpr int axes = phi_moves(shape) + theta_moves(shape);
  static constexpr int size = Layout::size + 2 * axes;
  static constexpr bool open_loop = false;
  static constexpr bool papers_rig = true;
  static constexpr auto motions = [] {
    Motions<Layout::motions.count + axes> all{};
    int next = 0;
    for (const Motion& m : Layout::motions.of) {
      if (m.position >= 0) all.of[next++] = m;
    }
    for (int i = 0; i < axes; ++i) all.of[next++] = {Layout::size + i, Layout::size + axes + i};
    for (const Motion& m : Layout::motions.of) {
      if (m.position < 0) all.of[next++] = m;
    }
    return all;
  }();
  // The index of the first gimbal axis in `motions`.
  static constexpr int first_axis = [] {
    int first = 0;
    while (motions.of[first].position < Layout::size) ++first;
    return first;
  }();

  ClosedLoop(Scalar radius, Scalar gravity, const BasicGains<Scalar>& gains,
             BasicServoLaw<Scalar> servo, Signals reference)
      : r_(radius), g_(gravity), gains_(gains), servo_(servo), reference_(std::move(reference)) {}

  // The reference with its derivatives.
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> inputs(const Time& t) const {
    return reference_.at(t);
  }

  [[nodiscard]] ClosedLoop<shape, drives, SignalView, Equation> view() const {
    return {r_, g_, gains_, servo_, reference_.view()};
  }

  // The same loop with another equation of motion for the ball.
  template <class Other>
  [[nodiscard]] ClosedLoop<shape, drives, Signals, Other> with_equation() const {
    return {r_, g_, gains_, servo_, reference_};
  }

  template <class Time, class Real>
  void derivative_of(const std::array<Jet<Time>, 2>& reference, const Real* z, Real* dz) const {
    derivative_of(reference, z, nullptr, dz);
  }

  // The same, except that the ball's accelerations use `turning`, the accelerations of the axes
  // (rad/s^2), instead of the servos' own. For integrators in which these are unknowns: computed
  // from a state, a stiff servo's acceleration is a difference of large numbers.
  template <class Time, class Real, class Turning>
  void derivative_of(const std::array<Jet<Time>, 2>& reference, const Real* z,
                     const Turning& turning, Real* dz) const {
    const auto ball = Layout::unpack(z);
    const Real* angles = z + Layout::size;  // [phi, theta,] then their rates
    const auto phi = axis<0, Real>(ball, reference, angles);
    const auto theta = axis<1, Real>(ball, reference, angles);
    Layout::template derivative<Real>(equation_, turned<0>(phi, turning), turned<1>(theta, turning),
                                      ball, r_, g_, dz);
    Real* const angles_dot = dz + Layout::size;
    for (int i = 0; i < axes; ++i) angles_dot[i] = angles[axes + i];
    if constexpr (phi_moves(shape)) angles_dot[axes] = phi.acceleration;
    if constexpr (theta_moves(shape)) angles_dot[2 * axes - 1] = theta.acceleration;
  }

  [[nodiscard]] Sample sample(double t, const double* z, Detail detail = Detail::all) const {
    const auto ball = Layout::unpack(z);
    const double* angles = z + Layout::size;
    Sample sample;
    sample.t = t;
    sample.ball = ball_motion<shape>(ball, r_);
    if (detail == Detail::ball) return sample;
    if (detail == Detail::path) {
      const auto reference = reference_.at(t);
      sample.reference = {reference[0].value, reference[1].value};
      return sample;
    }
    if constexpr (phi_moves(shape)) {
      sample.gimbal.phi = angles[0];
      sample.gimbal.phi_dot = angles[axes];
    }
    if constexpr (theta_moves(shape)) {
      sample.gimbal.theta = angles[axes - 1];
      sample.gimbal.theta_dot = angles[2 * axes - 1];
    }
    sample.servo = {sample.gimbal.phi, sample.gimbal.theta, 0};
    if (detail < Detail::motion) return sample;
    const auto reference = reference_.at(t);
    sample.reference = {reference[0].value, reference[1].value};
    if constexpr (phi_moves(shape)) {
      sample.gimbal.phi_ddot = axis<0, double>(ball, reference, angles).acceleration;
      sample.command[0] = command<double>(gains_, 0, ball, reference);
    }
    if constexpr (theta_moves(shape)) {
      sample.gimbal.theta_ddot = axis<1, double>(ball, reference, angles).acceleration;
      sample.command[1] = command<double>(gains_, 1, ball, reference);
    }
    return sample;
  }

  [[nodiscard]] const Signals& reference() const { return reference_; }
  [[nodiscard]] const BasicGains<Scalar>& gains() const { return gains_; }
  [[nodiscard]] const BasicServoLaw<Scalar>& servo() const { return servo_; }
  [[nodiscard]] Scalar radius() const { return r_; }
  [[nodiscard]] Scalar gravity() const { return g_; }

 private:
  // A gimbal axis with its command and its servo.
  template <std::size_t row, class Real, class Ball, class Time>
  [[nodiscard]] auto axis(const Ball& ball, const std::array<Jet<Time>, 2>& reference,
                          const Real* angles) const {
    if constexpr (row == 0 ? phi_moves(shape) : theta_moves(shape)) {
      const Real& angle = angles[row == 0 ? 0 : axes - 1];
      const Real& rate = angles[row == 0 ? axes : 2 * axes - 1];
      const Real u = command<Real>(gains_, row, ball, reference);
      const SinCos<Real> direction = sin_cos(angle);
      return GimbalAngle<Real>{direction.sin, direction.cos, rate,
                               servo_.template acceleration<drives, Real>(u, angle, rate)};
    } else {
      return LockedAngle{};
    }
  }

  template <std::size_t row, class Axis, class Turning>
  static auto turned(const Axis& of, const Turning& turning) {
    if constexpr (std::is_same_v<Axis, LockedAngle> || std::is_null_pointer_v<Turning>) {
      return of;
    } else {
      return Axis{of.sin, of.cos, of.rate, turning[row == 0 ? 0 : axes - 1]};
    }
  }

  Scalar r_, g_;
  BasicGains<Scalar> gains_;
  BasicServoLaw<Scalar> servo_;
  Signals reference_;
  [[no_unique_address]] Equation equation_{};
};

}  // namespace bbsim::model
