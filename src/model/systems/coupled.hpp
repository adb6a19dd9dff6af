// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Systems for scenes with couples on the ball, sliding, pushes, linkages, or a gimbal moved by
// torques (docs/explanation/losses-and-torques.md). Each system has all states of its kind; unused
// states stay zero.
#pragma once

#include <algorithm>
#include <cstring>

#include "model/ball/newton_euler.hpp"
#include "model/servo/three_servos.hpp"
#include "model/systems/rig_loop.hpp"

namespace bbsim::model {

// The mode of one motor between two switches. Its torque is factor * (torque asked) + set + by_rate
// * rate.
struct MotorMode {
  double factor = 1, set = 0, by_rate = 0;
  double opposed = 0;    // sign of the rate that dry friction opposes
  double free = 1;       // 0: dry friction holds the axis
  double integrate = 1;  // 0: the position loop's integral waits at a limit
  double side = 0;       // 1 or -1: the torque asked is above or below the torque given
  double along = 0;      // 1: the torque asked moves along a limit (control/law.hpp)
};

// The torque asked of a motor, N m: from_command u - from_angle q - from_rate q' + from_integral
// times the integral of u - q. (M49), (M50).
struct MotorLaw {
  double from_command = 0, from_angle = 0, from_rate = 0, from_integral = 0;
  double viscous = 0, friction = 0;  // N m s, N m
};

// All quantities of a coupled scene at an instant.
template <class Real>
struct Balance {
  Real acceleration[most_servos];  // of the axes or servos, rad/s^2
  GimbalAngle<Real> axis[2];       // of the plane
  Answer<Real> answer;
  Real p[2], slip[2];           // velocities, m/s
  Real asked[2], given[2];      // motor torques, N m; for prescribed motion, those that it takes
  Real needed[2];               // torque that friction must supply to hold each axis, N m
  Real lost_power, work_power;  // W
};

// The part of an output row that depends on the mode.
struct CoupledExtras {
  RigExtras rig;
  CoupledMotion motion;

  static constexpr int size = sizeof(RigExtras) / sizeof(double) + CoupledMotion::size;
  [[nodiscard]] static CoupledExtras unpack(const double* numbers) {
    CoupledExtras extras;
    std::memcpy(static_cast<void*>(&extras), numbers, sizeof extras);
    return extras;
  }
  void pack(double* numbers) const { std::memcpy(numbers, this, sizeof *this); }
};
static_assert(sizeof(CoupledExtras) == CoupledExtras::size * sizeof(double));

// The common parts of both systems.
struct CoupledParts {
  CoupledBall ball{};
  ContactMode contact{};
};

template <class Real>
[[nodiscard]] CoupledMotion coupled_motion(const Balance<Real>& now, const CoupledParts& parts,
                                           double lost, double work) {
  const double m = parts.ball.m, r = parts.ball.r;
  const Answer<double>& of = now.answer;
  CoupledMotion motion;
  motion.x_ddot = of.x;
  motion.y_ddot = of.y;
  motion.couple[0] = -(m * r * of.couple[1]);
  motion.couple[1] = m * r * of.couple[0];
  motion.couple[2] = m * r * of.couple[2];
  std::copy(now.slip, now.slip + 2, motion.slip);
  std::copy(now.asked, now.asked + 2, motion.asked);
  std::copy(now.given, now.given + 2, motion.given);
  motion.lost_power = now.lost_power;
  if (parts.contact.slides) motion.sliding = parts.ball.law.sliding;
  motion.lost = lost;
  motion.work = work;
  return motion;
}

// The velocities at the contact and the directions of dry friction.
template <class Real, class Ball>
void look_at_contact(const ContactMode& mode, const Ball& ball, const Real* slip, Real (&p)[2],
                     Real (&s)[2], Directions<Real>& along) {
  s[0] = slip[0];
  s[1] = slip[1];
  p[0] = ball.x_dot - s[0];
  p[1] = ball.y_dot - s[1];
  direction(mode.roll, p[0], p[1], along.roll);
  direction(mode.slip, s[0], s[1], along.slip);
}

// Writes the derivatives that both systems share: the ball, its slip, and the energies.
template <class Layout, class Real>
void put_rates(const Balance<Real>& now, const Real* z, Real* dz) {
  dz[0] = z[2];
  dz[1] = z[3];
  dz[2] = now.answer.x;
  dz[3] = now.answer.y;
  dz[4] = now.answer.u;
  dz[Layout::slip] = now.answer.slip[0];
  dz[Layout::slip + 1] = now.answer.slip[1];
  dz[Layout::lost] = now.lost_power;
  dz[Layout::work] = now.work_power;
}

// The gimbal's inputs, and the push on the ball, N.
template <class Time>
struct PushedInputs {
  std::array<Jet<Time>, 2> of;
  Time push[2];
};

template <class Time>
[[nodiscard]] const std::array<Jet<Time>, 2>& of_gimbal(const std::array<Jet<Time>, 2>& in) {
  return in;
}
template <class Time>
[[nodiscard]] const std::array<Jet<Time>, 2>& of_gimbal(const PushedInputs<Time>& in) {
  return in.of;
}

template <class Signals>
struct Push {
  Signals on{};  // along the plane's axes, N

  template <class Time>
  [[nodiscard]] PushedInputs<Time> with(const std::array<Jet<Time>, 2>& of, const Time& t) const {
    const auto now = on.at(t);
    return {of, {now[0].value, now[1].value}};
  }
  [[nodiscard]] Pair at(double t) const {
    const auto now = on.at(t);
    return {now[0].value, now[1].value};
  }
  [[nodiscard]] Push<SignalView> view() const { return {on.view()}; }
};
// No push, at no cost.
struct NoPush {
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> with(const std::array<Jet<Time>, 2>& of,
                                              const Time& /*t*/) const {
    return of;
  }
  [[nodiscard]] Pair at(double /*t*/) const { return {0, 0}; }
  [[nodiscard]] NoPush view() const { return {}; }
};

// A push on the ball's center acts like gravity: (M62).
template <class Real, class In>
void add_push(const CoupledBall& ball, const In& in, Cause<Real>& cause) {
  if constexpr (requires { in.push; }) {
    for (int i = 0; i < 2; ++i) {
      cause.rest[i] = cause.rest[i] - Real((1 / ball.m) * in.push[i]);
    }
  }
}

struct CoupledGivenLayout : BallLayout<Shape::full> {
  static constexpr int slip = BallLayout<Shape::full>::size, lost = slip + 2, work = lost + 1;
  static constexpr int states = work + 1;
};

// A coupled scene with a prescribed gimbal motion.
template <class Signals = SignalPair, bool pushes = false>
class CoupledGiven {
  template <class Of>
  using PushOf = std::conditional_t<pushes, Push<Of>, NoPush>;

 public:
  using Layout = CoupledGivenLayout;
  static constexpr Shape moves = Shape::full;
  static constexpr int size = Layout::states;
  static constexpr bool open_loop = false;  // dry couples are nonlinear
  static constexpr bool papers_rig = false;
  static constexpr bool steep = true;  // near rest, where directions turn fast
  static constexpr auto motions =
      Motions<7>{{{0, 2}, {1, 3}, {-1, 4}, {-1, 5}, {-1, 6}, {-1, 7}, {-1, 8}}};

  CoupledGiven(const CoupledParts& of, Signals motion, PushOf<Signals> pushed = {})
      : parts(of), push(std::move(pushed)), motion_(std::move(motion)) {}

  CoupledParts parts;
  [[no_unique_address]] PushOf<Signals> push;

  template <class Time>
  [[nodiscard]] auto inputs(const Time& t) const {
    return push.with(motion_.at(t), t);
  }

  [[nodiscard]] CoupledGiven<SignalView, pushes> view() const {
    return {parts, motion_.view(), push.view()};
  }

  template <class In, class Real>
  void derivative_of(const In& in, const Real* z, Real* dz) const {
    put_rates<Layout>(balance(in, z), z, dz);
  }

  template <class In, class Real>
  [[nodiscard]] Balance<Real> balance(const In& inputs, const Real* z) const {
    const auto& in = of_gimbal(inputs);
    using Time = std::decay_t<decltype(in[0].value)>;
    const CoupledBall& of = parts.ball;
    const auto ball = Layout::unpack(z);
    Balance<Real> now;
    auto& axis = now.axis;
    for (std::size_t i = 0; i < 2; ++i) {
      const SinCos<Time> wave = sin_cos(in[i].value);
      axis[i] = {Real(wave.sin), Real(wave.cos), Real(in[i].rate), Real(in[i].acceleration)};
    }
    const PlaneMotion<Real> plane = of.plane(axis[0], axis[1]);
    Directions<Real> along;
    look_at_contact(parts.contact, ball, z + Layout::slip, now.p, now.slip, along);
    Cause<Real> cause = of.cause(plane, ball, now.p);
    add_push(of, inputs, cause);
    for (int i = 0; i < 3; ++i) {
      cause.omega_dot[i] = cause.omega_dot[i] + plane.axis[0][i] * axis[0].acceleration +
                           plane.axis[1][i] * axis[1].acceleration;
    }
    now.answer = of.answer(parts.contact, along, ball, cause);
    now.lost_power = of.lost_power(parts.contact, now.answer, ball, now.p, now.slip);
    now.work_power = Real(0.0);
    for (int i = 0; i < 2; ++i) {
      now.acceleration[i] = axis[i].acceleration;
      now.asked[i] = now.needed[i] = Real(0.0);
      now.given[i] =
          of.moment(plane.axis[i], cause, now.answer, ball) + of.own_moment(plane.axis[i], plane);
      now.work_power = now.work_power + now.given[i] * axis[i].rate;
    }
    return now;
  }

  [[nodiscard]] CoupledExtras extras(double t, const double* z) const {
    const auto in = motion_.at(t);
    CoupledExtras extras{};
    for (std::size_t i = 0; i < 2; ++i) {
      extras.rig.angle[i] = in[i].value;
      extras.rig.rate[i] = in[i].rate;
      extras.rig.acceleration[i] = in[i].acceleration;
    }
    extras.motion = coupled_motion(balance(inputs(t), z), parts, z[Layout::lost], z[Layout::work]);
    return extras;
  }

  [[nodiscard]] Sample sample(double t, const double* z, const CoupledExtras& with) const {
    const RigExtras& rig = with.rig;
    Sample sample;
    sample.t = t;
    sample.push = push.at(t);
    sample.ball = ball_motion<Shape::full>(Layout::unpack(z), parts.ball.r);
    sample.gimbal = {rig.angle[0], rig.angle[1],        rig.rate[0],
                     rig.rate[1],  rig.acceleration[0], rig.acceleration[1]};
    sample.coupled = with.motion;
    return sample;
  }
  [[nodiscard]] Sample sample(double t, const double* z, Detail = Detail::all) const {
    return sample(t, z, extras(t, z));
  }

  [[nodiscard]] const Signals& reference() const { return motion_; }

 private:
  Signals motion_;
};

template <int servos>
struct CoupledLayout : ServoLayout<servos> {
  static constexpr int motor = ServoLayout<servos>::integral + 2, slip = motor + 2, lost = slip + 2,
                       work = lost + 1;
  static constexpr int states = work + 1;
};

// The drive of a CoupledLoop's gimbal.
enum class GimbalBy {
  servos,        // servos, as in RigLoop
  torques,       // motors under a controller's commands
  given_torques  // prescribed motor torques
};

// A coupled scene whose gimbal is moved by a controller or by torques. Variants with a linkage also
// have a push.
template <class Signals = SignalPair, class Link = Direct>
class CoupledLoop {
 public:
  static constexpr bool pushes = !Link::direct;
  static constexpr int servos = Link::servos;
  using Layout = CoupledLayout<servos>;
  template <class Of>
  using PushOf = std::conditional_t<pushes, Push<Of>, NoPush>;
  static constexpr Shape moves = Shape::full;
  static constexpr int size = Layout::states;
  static constexpr bool open_loop = false;
  static constexpr bool papers_rig = false;
  static constexpr bool steep = true;  // near rest, where directions turn fast
  static constexpr auto motions = Layout::template motions_of<size>();

  CoupledLoop(const CoupledParts& of, GimbalBy moved_by, const MotorLaw& law,
              const RigLoop<true, Signals, Link>& control, PushOf<Signals> pushed = {})
      : parts(of), by(moved_by), motor(law), loop(control), push(std::move(pushed)) {}

  CoupledParts parts;
  GimbalBy by;
  MotorLaw motor;
  MotorMode motors[2]{};
  RigLoop<true, Signals, Link> loop;  // law and servos; its reference holds prescribed torques
  [[no_unique_address]] PushOf<Signals> push;

  template <class Time>
  [[nodiscard]] auto inputs(const Time& t) const {
    return push.with(by == GimbalBy::given_torques ? loop.reference().at(t) : loop.inputs(t), t);
  }

  [[nodiscard]] CoupledLoop<SignalView, Link> view() const {
    CoupledLoop<SignalView, Link> view{parts, by, motor, loop.view(), push.view()};
    view.motors[0] = motors[0];
    view.motors[1] = motors[1];
    view.integrates_ = integrates_;
    return view;
  }

  template <class In, class Real>
  void derivative_of(const In& inputs, const Real* z, Real* dz) const {
    const auto& in = of_gimbal(inputs);
    Real command[2];
    const Balance<Real> now = balance(inputs, z, command);
    put_rates<Layout>(now, z, dz);
    for (int i = 0; i < servos; ++i) {
      dz[Layout::angle + i] = z[Layout::rate + i];
      dz[Layout::rate + i] = now.acceleration[i];
    }
    for (int i = 0; i < 2; ++i) {
      const AxisMode& of = loop.mode.axis[i];
      dz[Layout::integral + i] = (of.integrate * integrates_) *
                                 integral_rate(loop.law(), static_cast<std::size_t>(i), z, in);
      // The tilt of three commanded servos may be NaN, so no product with it where no motor
      // listens.
      dz[Layout::motor + i] = motor.from_integral != 0
                                  ? motors[i].integrate * (command[i] - z[Layout::angle + i])
                                  : Real(0.0);
    }
  }

  template <class In, class Real>
  [[nodiscard]] Balance<Real> balance(const In& in, const Real* z) const {
    Real command[2];
    return balance(in, z, command);
  }

  // The inertia matrix H of (M47) that the motors feel in the present mode, kg m^2.
  [[nodiscard]] std::array<std::array<double, 2>, 2> inertia(const double* z) const {
    const double none[servos] = {};
    GimbalAngle<double> axes[2];
    loop.planes(z, none, axes);
    const PlaneMotion<double> plane = parts.ball.plane(axes[0], axes[1]);
    const auto ball = Layout::unpack(z);
    double p[2], s[2];
    Directions<double> along;
    look_at_contact(parts.contact, ball, z + Layout::slip, p, s, along);
    std::array<std::array<double, 2>, 2> h{};
    felt(plane, ball, along, [&](int i, int j, double value) {
      h[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = value;
    });
    return h;
  }

  [[nodiscard]] CoupledExtras extras(double t, const double* z) const {
    double command[2];
    const Balance<double> now = balance(inputs(t), z, command);
    CoupledExtras extras{};
    loop.put(z, now.axis, extras.rig);
    loop.put_lags(t, z, extras.rig);
    for (int i = 0; i < 2; ++i) {
      extras.rig.command[i] = by == GimbalBy::given_torques ? 0 : command[i];
    }
    extras.motion = coupled_motion(now, parts, z[Layout::lost], z[Layout::work]);
    for (int i = 0; i < 2; ++i) {
      // A torque that moves along a limit equals the limit. Its integral is then not a state.
      if (motors[i].along != 0) extras.motion.asked[i] = now.given[i];
    }
    return extras;
  }

  [[nodiscard]] Sample sample(double t, const double* z, const CoupledExtras& with) const {
    Sample sample = loop.sample(t, z, with.rig);
    if (by == GimbalBy::given_torques) sample.reference = {0, 0};
    sample.coupled = with.motion;
    sample.push = push.at(t);
    return sample;
  }
  // The sample in the present mode, for monitors: with the distance from a dead point.
  [[nodiscard]] Sample sample(double t, const double* z, Detail = Detail::all) const {
    Sample sample = this->sample(t, z, extras(t, z));
    if constexpr (!Link::direct) {
      double horn[servos];
      loop.horns(z, horn);
      sample.to_dead_point = loop.link.margin(horn);
    }
    return sample;
  }

  [[nodiscard]] const Signals& reference() const { return loop.reference(); }
  [[nodiscard]] const ControlLaw& law() const { return loop.law(); }
  void integrate_error(bool yes) { integrates_ = yes ? 1 : 0; }

 private:
  // The columns of H: the moments for a unit acceleration of one axis alone.
  template <class Real, class Ball, class Put>
  void felt(const PlaneMotion<Real>& plane, const Ball& ball, const Directions<Real>& along,
            const Put& put) const {
    const CoupledBall& of = parts.ball;
    for (int j = 0; j < 2; ++j) {
      const Cause<Real> cause = CoupledBall::of_axis(plane.axis[j]);
      const Answer<Real> answer = of.answer(parts.contact, along, ball, cause);
      for (int i = 0; i < 2; ++i) {
        const double own = i != j ? 0.0 : of.body.rotor + (i == 0 ? of.body.ring : 0.0);
        put(i, j, of.moment(plane.axis[i], cause, answer, ball) + Real(own));
      }
    }
  }

  template <class In, class Real>
  [[nodiscard]] Balance<Real> balance(const In& inputs, const Real* z, Real (&command)[2]) const {
    const auto& in = of_gimbal(inputs);
    const CoupledBall& of = parts.ball;
    const auto ball = Layout::unpack(z);
    Balance<Real> now;
    Directions<Real> along;
    look_at_contact(parts.contact, ball, z + Layout::slip, now.p, now.slip, along);

    Real demand[servos];
    if (by == GimbalBy::given_torques) {
      for (std::size_t i = 0; i < 2; ++i) command[i] = Real(in[i].value);
    } else {
      const RigAxes<Real, servos> wanted = loop.axes(in, z);
      for (int i = 0; i < servos; ++i) {
        const AxisMode& mode = loop.mode.axis[i];
        demand[i] = mode.demand_factor * wanted.demand[i] + Real(mode.set_acceleration);
      }
      for (int i = 0; i < 2; ++i) command[i] = loop.shown(wanted, i);
    }
    const bool driven = by != GimbalBy::servos;
    if (driven) {
      for (Real& acceleration : demand) acceleration = Real(0.0);
    }

    auto& axes = now.axis;
    loop.planes(z, demand, axes);
    const PlaneMotion<Real> plane = of.plane(axes[0], axes[1]);
    Cause<Real> cause = of.cause(plane, ball, now.p);
    add_push(of, inputs, cause);
    Real own[2];
    for (int i = 0; i < 2; ++i) own[i] = of.own_moment(plane.axis[i], plane);
    Real friction[2] = {Real(0.0), Real(0.0)};
    if (driven) {
      const Answer<Real> rest = of.answer(parts.contact, along, ball, cause);
      Real h[2][2], left[2];
      felt(plane, ball, along, [&](int i, int j, const Real& value) { h[i][j] = value; });
      for (int i = 0; i < 2; ++i) {
        const MotorMode& mode = motors[i];
        const Real& rate = z[Layout::rate + i];
        now.asked[i] = motor.from_command * command[i] - motor.from_angle * z[Layout::angle + i] -
                       motor.from_rate * rate + motor.from_integral * z[Layout::motor + i];
        now.given[i] = mode.factor * now.asked[i] + mode.by_rate * rate + Real(mode.set);
        friction[i] = motor.viscous * rate + Real(motor.friction * mode.opposed);
        left[i] = now.given[i] - friction[i] - of.moment(plane.axis[i], cause, rest, ball) - own[i];
      }
      // An axis that friction holds has the equation phi'' = 0.
      Real row[2][2], right[2];
      for (int i = 0; i < 2; ++i) {
        const double free = motors[i].free;
        for (int j = 0; j < 2; ++j) row[i][j] = free * h[i][j] + Real(i == j ? 1 - free : 0.0);
        right[i] = free * left[i];
      }
      const Real determinant = row[0][0] * row[1][1] - row[0][1] * row[1][0];
      now.acceleration[0] = (right[0] * row[1][1] - row[0][1] * right[1]) / determinant;
      now.acceleration[1] = (row[0][0] * right[1] - row[1][0] * right[0]) / determinant;
      for (int i = 0; i < 2; ++i) {
        now.needed[i] = h[i][0] * now.acceleration[0] + h[i][1] * now.acceleration[1] - left[i];
      }
    } else {
      for (int i = 0; i < servos; ++i) now.acceleration[i] = demand[i];
      for (int i = 0; i < 2; ++i) now.asked[i] = now.needed[i] = Real(0.0);
    }
    if (Link::direct || driven) {
      for (int i = 0; i < 2; ++i) {
        axes[i].acceleration = loop.mode.axis[i].ratio * now.acceleration[i];
      }
    }
    for (int i = 0; i < 3; ++i) {
      cause.omega_dot[i] = cause.omega_dot[i] + plane.axis[0][i] * axes[0].acceleration +
                           plane.axis[1][i] * axes[1].acceleration;
    }
    now.answer = of.answer(parts.contact, along, ball, cause);
    now.lost_power = of.lost_power(parts.contact, now.answer, ball, now.p, now.slip);
    now.work_power = Real(0.0);
    for (int i = 0; i < 2; ++i) {
      if (!driven) now.given[i] = of.moment(plane.axis[i], cause, now.answer, ball) + own[i];
      now.lost_power = now.lost_power + motors[i].free * (friction[i] * z[Layout::rate + i]);
      now.work_power = now.work_power + motors[i].free * (now.given[i] * axes[i].rate);
    }
    return now;
  }

  double integrates_ = 0;
  template <class Other, class Any>
  friend class CoupledLoop;
};

template <class Any>
inline constexpr bool is_coupled = false;
template <class Signals, bool pushes>
inline constexpr bool is_coupled<CoupledGiven<Signals, pushes>> = true;
template <class Signals, class Link>
inline constexpr bool is_coupled<CoupledLoop<Signals, Link>> = true;

template <class Any>
inline constexpr bool is_coupled_loop = false;
template <class Signals, class Link>
inline constexpr bool is_coupled_loop<CoupledLoop<Signals, Link>> = true;

// The RigLoop that a system is or has; null if it has none.
template <class Any>
[[nodiscard]] auto* rig_loop_of(Any& any) {
  using System = std::remove_const_t<Any>;
  if constexpr (is_coupled_loop<System>) {
    return &any.loop;
  } else if constexpr (is_rig<System>) {
    return &any;
  } else {
    return static_cast<RigLoop<>*>(nullptr);
  }
}

}  // namespace bbsim::model
