// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The closed loop of a rig: servos with limits, laws beyond equation (31), and sampled controllers.
//
// Everything that switches (a servo at its rate limit, a command that steps) is constant between
// two switches and part of a RigMode. The right-hand side therefore has no branch on the state and
// is as smooth as equation (27). HybridSystem decides when the mode switches.
#pragma once

#include <cmath>
#include <cstring>
#include <type_traits>

#include "model/ball/general_rolling.hpp"
#include "model/control/law.hpp"
#include "model/servo/linkage.hpp"
#include "model/servo/servo.hpp"
#include "model/systems/system.hpp"

namespace bbsim::model {

// The driver of a stepper between two switches: the angle that it counts, and the field that it
// turns. The shaft is at the field's angle, or rings about it.
struct StepperDriver {
  bool rings = false;
  double since = 0;                              // s; for a shaft that rings:
  double angle = 0, rate = 0, acceleration = 0;  // counted, at `since`
  double ratio = 1, offset = 0;                  // of the field's angle to the counted one

  // The counted angle.
  template <class Time>
  [[nodiscard]] Jet<Time> counted(const Time& t) const {
    const Time after = t - Time(since);
    const Time turned = acceleration * after;
    return {Time(angle) + after * (Time(rate) + 0.5 * turned), Time(rate) + turned,
            Time(acceleration)};
  }
};

// The mode of one axis or servo between two switches.
struct AxisMode {
  // Servo acceleration = demand_factor * demand + set_acceleration, rad/s^2.
  double demand_factor = 1, set_acceleration = 0;
  // Angle of the plane, or of the horn that moves it: ratio * servo angle + offset, rad.
  double ratio = 1, offset = 0;
  // Limited command = command_factor * command + set_command.
  double command_factor = 1, set_command = 0;
  double integrate = 1;  // 0: the command's integral part waits at the limit
  double side = 0;       // 1 or -1: the command is at its upper or lower limit
  double along = 0;      // 1: the command moves along the limit (control/law.hpp)
};

struct RigMode {
  AxisMode axis[most_servos];            // phi, theta; or each of three servos
  double command[most_servos]{0, 0, 0};  // held by a sampled controller, rad or rad/s^2
  double wanted[2]{0, 0};  // the command before its conversion for linkages or three servos, rad
  StepperDriver driver[most_servos];
  bool lags = false;   // whether the shaft of any stepper may be behind its driver's count
  bool rings = false;  // whether the shaft of any stepper rings, and moves in time
};

struct ServoResponses {
  ServoResponse of[most_servos];

  ServoResponses() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): all alike
  ServoResponses(const ServoResponse& all) : of{all, all, all} {}
};

template <class Real, int servos = 2>
struct RigAxes {
  Command<Real> command;       // of the law
  Real servo_command[servos];  // to the servos, if they drive a linkage, rad
  Real demand[servos];         // servo acceleration in free motion, rad/s^2
};

// The layout of a rig's states after the ball's five. phi and theta are adjacent.
template <int servos>
struct ServoLayout : BallLayout<Shape::full> {
  static constexpr int angle = BallLayout<Shape::full>::size, rate = angle + servos,
                       integral = rate + servos;

  // All velocities of a system of this size: the states from `integral` on have no velocity.
  template <int size>
  static constexpr auto motions_of() {
    Motions<3 + servos + size - integral> all{};
    int next = 0;
    for (const Motion& motion : {Motion{0, 2}, Motion{1, 3}}) all.of[next++] = motion;
    for (int i = 0; i < servos; ++i) all.of[next++] = {angle + i, rate + i};
    all.of[next++] = {-1, 4};
    for (int i = integral; i < size; ++i) all.of[next++] = {-1, i};
    return all;
  }
};
using RigLayout = ServoLayout<2>;

// The part of an output row that depends on the mode: the plane's motion (phi, theta), the
// commands, in a sampled loop the last measurement of the ball, and the steppers' lags.
struct RigExtras {
  double angle[2], rate[2], acceleration[2], command[2], measured[2];
  double lag[most_servos];  // of a stepper's shaft behind the angle that its driver counts, rad

  static constexpr int size = 10 + most_servos;
  [[nodiscard]] static RigExtras unpack(const double* numbers) {
    RigExtras extras;
    std::memcpy(&extras, numbers, sizeof extras);
    return extras;
  }
  void pack(double* numbers) const { std::memcpy(numbers, this, sizeof *this); }
};
static_assert(sizeof(RigExtras) == RigExtras::size * sizeof(double));

// States: the ball's five, the servos' angles and rates, and with `integrates` the integral parts
// of the commands. Link is the mechanism between servos and plane.
template <bool integrates = false, class Signals = SignalPair, class Link = Direct>
class RigLoop {
 public:
  static constexpr int servos = Link::servos;
  using Layout = ServoLayout<servos>;
  template <class Real>
  using Axes = RigAxes<Real, servos>;
  static constexpr Shape moves = Shape::full;
  static constexpr int size = Layout::integral + (integrates ? 2 : 0);
  static constexpr bool open_loop = false;
  static constexpr bool papers_rig = false;
  static constexpr auto motions = Layout::template motions_of<size>();

  RigLoop(double radius, double gravity, const GeneralRolling& rolling, const ControlLaw& law,
          const ServoResponses& servo, Signals reference, const RigMode& present = {},
          const Link& mechanism = {})
      : mode(present),
        link(mechanism),
        r_(radius),
        g_(gravity),
        rolling_(rolling),
        law_(law),
        servo_(servo),
        reference_(std::move(reference)),
        feeds_servos_back_(law_.feeds_servos_back()) {}

  RigMode mode;
  [[no_unique_address]] Link link;

  // The reference. Zero if the command is held, because the right-hand side does not use it; in its
  // place, shafts that ring need the time.
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> inputs(const Time& t) const {
    const Jet<Time> nothing{Time(0.0), Time(0.0), Time(0.0)};
    if (mode.rings) return {Jet<Time>{t, Time(1.0), Time(0.0)}, nothing};
    if (law_.kind == LawKind::held) return {nothing, nothing};
    return reference_.at(t);
  }

  [[nodiscard]] RigLoop<integrates, SignalView, Link> view() const {
    return {r_, g_, rolling_, law_, servo_, reference_.view(), mode, link};
  }

  template <class Time, class Real>
  void derivative_of(const std::array<Jet<Time>, 2>& reference, const Real* z, Real* dz) const {
    const Axes<Real> loop = axes(reference, z);
    GimbalAngle<Real> plane[2];
    Real acceleration[servos];
    for (int i = 0; i < servos; ++i) {
      const AxisMode& of = mode.axis[i];
      acceleration[i] = of.demand_factor * loop.demand[i] + Real(of.set_acceleration);
      dz[Layout::angle + i] = z[Layout::rate + i];
      dz[Layout::rate + i] = acceleration[i];
    }
    planes(z, acceleration, plane);
    if constexpr (integrates) {
      for (int i = 0; i < 2; ++i) {
        dz[Layout::integral + i] =
            mode.axis[i].integrate * integral_rate(law_, static_cast<std::size_t>(i), z, reference);
      }
    }
    Layout::derivative(rolling_, plane[0], plane[1], Layout::unpack(z), r_, g_, dz);
  }

  // The commands and servo demands at a state.
  template <class Time, class Real>
  [[nodiscard]] Axes<Real> axes(const std::array<Jet<Time>, 2>& reference, const Real* z) const {
    Axes<Real> loop;
    if (law_.kind == LawKind::held) {
      for (int i = 0; i < 2; ++i) {
        loop.command.raw[i] = loop.command.value[i] = Real(mode.command[i]);
      }
      if constexpr (!Link::direct) {
        for (int i = 0; i < servos; ++i) loop.servo_command[i] = Real(mode.command[i]);
      }
    } else {
      if (law_.kind == LawKind::feedback_linearisation) {
        loop.command = linearize(reference, z);
      } else {
        loop.command = model::command(law_, feedback(z), reference,
                                      [this](int i, const Real& raw) { return limited(i, raw); });
      }
      if constexpr (!Link::direct) link.commands_for(loop.command.value, loop.servo_command);
    }
    for (int i = 0; i < servos; ++i) {
      const ServoResponse& servo = servo_.of[i];
      loop.demand[i] = servo.from_command * servo_command(loop, i) -
                       servo.from_angle * z[Layout::angle + i] -
                       servo.from_rate * z[Layout::rate + i];
    }
    if (mode.rings) follow_drivers(reference[0].value, z, loop.demand);
    return loop;
  }

  // The command to servo i.
  template <class Real>
  [[nodiscard]] static const Real& servo_command(const Axes<Real>& loop, int i) {
    if constexpr (Link::direct) {
      return loop.command.value[i];
    } else {
      return loop.servo_command[i];
    }
  }

  // Computes the plane's axes from the servos' accelerations, rad/s^2.
  template <class Real>
  void planes(const Real* z, const Real (&acceleration)[servos],
              GimbalAngle<Real> (&axis)[2]) const {
    if constexpr (Link::direct) {
      for (int i = 0; i < 2; ++i) {
        axis[i] = plane_axis(i, z, mode.axis[i].ratio * acceleration[i]);
      }
    } else {
      Real horn[servos], rate[servos], acting[servos];
      for (int i = 0; i < servos; ++i) {
        const AxisMode& of = mode.axis[i];
        horn[i] = of.ratio * z[Layout::angle + i] + Real(of.offset);
        rate[i] = of.ratio * z[Layout::rate + i];
        acting[i] = of.ratio * acceleration[i];
      }
      link.planes(horn, rate, acting, axis);
    }
  }

  // The angles of the horns, after backlash, rad.
  void horns(const double* z, double (&horn)[servos]) const {
    for (int i = 0; i < servos; ++i) {
      horn[i] = mode.axis[i].ratio * z[Layout::angle + i] + mode.axis[i].offset;
    }
  }

  // The jump of (x', y', u) when the rates of phi and theta jump by (phi, theta), rad/s: (M26).
  template <class Real>
  [[nodiscard]] std::array<Real, 3> impulse(const Real* z, const std::type_identity_t<Real>& phi,
                                            const std::type_identity_t<Real>& theta) const {
    const Inertial<Real> inertial = coefficients(z);
    std::array<Real, 3> jump{};
    for (std::size_t i = 0; i < 3; ++i) {
      jump[i] = inertial.of[i][0] * phi + inertial.of[i][1] * theta;
    }
    return jump;
  }

  // All extras of the present mode except the measurement.
  [[nodiscard]] RigExtras extras(double t, const double* z) const {
    const Axes<double> loop = axes(inputs(t), z);
    RigExtras extras{};
    double acceleration[servos];
    for (int i = 0; i < servos; ++i) {
      const AxisMode& of = mode.axis[i];
      acceleration[i] = of.demand_factor * loop.demand[i] + of.set_acceleration;
    }
    fill(z, acceleration, extras);
    for (int i = 0; i < 2; ++i) extras.command[i] = shown(loop, i);
    put_lags(t, z, extras);
    return extras;
  }

  // Writes how far the steppers' shafts are behind the angles that their drivers count.
  void put_lags(double t, const double* z, RigExtras& extras) const {
    for (int i = 0; mode.lags && i < servos; ++i) {
      const StepperDriver& of = mode.driver[i];
      const double angle = z[Layout::angle + i];
      extras.lag[i] = of.rings ? of.counted(t).value - angle : (1 - of.ratio) * angle - of.offset;
    }
  }

  // The plane's angles and rates.
  [[nodiscard]] RigExtras plane(const double* z) const {
    const double none[servos] = {};
    RigExtras plane{};
    fill(z, none, plane);
    return plane;
  }

  // Computes the plane's motion from the servos' accelerations.
  void fill(const double* z, const double (&acceleration)[servos], RigExtras& extras) const {
    if constexpr (Link::direct) {
      for (int i = 0; i < 2; ++i) {
        const AxisMode& of = mode.axis[i];
        extras.angle[i] = of.ratio * z[Layout::angle + i] + of.offset;
        extras.rate[i] = of.ratio * z[Layout::rate + i];
        extras.acceleration[i] = of.ratio * acceleration[i];
      }
    } else {
      GimbalAngle<double> axis[2];
      planes(z, acceleration, axis);
      put(z, axis, extras);
    }
  }

  // Writes the plane's motion. `axis` must be that of planes().
  void put(const double* z, const GimbalAngle<double> (&axis)[2], RigExtras& extras) const {
    if constexpr (servos == 3) {  // less than half a turn
      for (int i = 0; i < 2; ++i) extras.angle[i] = std::atan2(axis[i].sin, axis[i].cos);
    } else {
      double horn[servos];
      horns(z, horn);
      if constexpr (Link::direct) {
        std::copy_n(horn, 2, extras.angle);
      } else {
        link.angles(horn, extras.angle);
      }
    }
    for (int i = 0; i < 2; ++i) {
      extras.rate[i] = axis[i].rate;
      extras.acceleration[i] = axis[i].acceleration;
    }
  }

  // The command to report for an axis: its servo's or, with three servos, the plane's.
  template <class Real>
  [[nodiscard]] Real shown(const Axes<Real>& loop, int i) const {
    if constexpr (servos == 2) {
      return servo_command(loop, i);
    } else {
      return law_.kind == LawKind::held ? Real(mode.wanted[i]) : loop.command.value[i];
    }
  }

  [[nodiscard]] BallMotion ball(const double* z) const {
    return ball_motion<Shape::full>(Layout::unpack(z), r_);
  }
  [[nodiscard]] Sample sample(double t, const double* z, const RigExtras& with,
                              Detail detail = Detail::all) const {
    Sample sample;
    sample.t = t;
    sample.ball = ball(z);
    if (detail == Detail::ball) return sample;
    if (detail == Detail::path || detail == Detail::all) {
      const auto reference = reference_.at(t);
      sample.reference = {reference[0].value, reference[1].value};
      if (detail == Detail::path) return sample;
    }
    sample.gimbal = {with.angle[0], with.angle[1],        with.rate[0],
                     with.rate[1],  with.acceleration[0], with.acceleration[1]};
    for (int i = 0; i < servos; ++i) {
      const auto place = static_cast<std::size_t>(i);
      const double angle = z[Layout::angle + i];
      const bool rings = mode.driver[i].rings;
      sample.servo[place] = rings ? angle : angle - with.lag[i];
      sample.counted[place] = rings ? angle + with.lag[i] : angle;
    }
    if (detail < Detail::loop) return sample;
    sample.command = {with.command[0], with.command[1]};
    sample.measured = {with.measured[0], with.measured[1]};
    return sample;
  }

  // The sample in the present mode.
  [[nodiscard]] Sample sample(double t, const double* z, Detail detail = Detail::all) const {
    return sample(t, z, detail <= Detail::path ? RigExtras{} : extras(t, z), detail);
  }

  [[nodiscard]] const Signals& reference() const { return reference_; }
  [[nodiscard]] const ControlLaw& law() const { return law_; }
  [[nodiscard]] const ServoResponses& servo() const { return servo_; }
  [[nodiscard]] const GeneralRolling& rolling() const { return rolling_; }
  [[nodiscard]] double radius() const { return r_; }
  [[nodiscard]] double gravity() const { return g_; }

 private:
  // Sets the demands of shafts that ring about their drivers' fields.
  template <class Time, class Real>
  void follow_drivers(const Time& t, const Real* z, Real (&demand)[servos]) const {
    for (int i = 0; i < servos; ++i) {
      const StepperDriver& of = mode.driver[i];
      if (!of.rings) continue;
      const ServoResponse& servo = servo_.of[i];
      const Time field = of.ratio * of.counted(t).value + Time(of.offset);
      demand[i] = servo.from_angle * (Real(field) - z[Layout::angle + i]) -
                  servo.from_rate * z[Layout::rate + i];
    }
  }

  // The ball's accelerations at zero gimbal acceleration, and their derivatives with respect to it.
  template <class Real>
  struct Inertial {
    GeneralRolling::Rates<Real> rest;
    Real of[3][2];  // rows x'', y'', u'; columns phi'', theta''
  };

  template <class Real>
  [[nodiscard]] GimbalAngle<Real> plane_axis(int i, const Real* z, const Real& acceleration) const {
    const AxisMode& of = mode.axis[i];
    const SinCos<Real> direction = sin_cos(Real(of.ratio * z[Layout::angle + i] + Real(of.offset)));
    return {direction.sin, direction.cos, of.ratio * z[Layout::rate + i], acceleration};
  }

  template <class Real>
  [[nodiscard]] Inertial<Real> coefficients(const Real* z) const {
    Real none[servos];
    for (Real& acceleration : none) acceleration = Real(0.0);
    GimbalAngle<Real> axis[2];
    planes(z, none, axis);
    const auto under = [&](double phi, double theta) {
      axis[0].acceleration = Real(phi);
      axis[1].acceleration = Real(theta);
      return rolling_.rates<Real>(axis[0], axis[1], Layout::unpack(z), r_, g_);
    };
    const auto rest = under(0, 0), phi = under(1, 0), theta = under(0, 1);
    return {rest,
            {{phi.x - rest.x, theta.x - rest.x},
             {phi.y - rest.y, theta.y - rest.y},
             {phi.u - rest.u, theta.u - rest.u}}};
  }

  template <class Real>
  [[nodiscard]] Real limited(int i, const Real& raw) const {
    return mode.axis[i].command_factor * raw + Real(mode.axis[i].set_command);
  }

  template <class Real>
  [[nodiscard]] auto feedback(const Real* z) const {
    using Integral = std::conditional_t<integrates, Real, Zero>;
    Feedback<Real, Integral> state;
    for (int i = 0; i < 2; ++i) {
      state.position[i] = z[i];
      state.velocity[i] = z[2 + i];
      state.angle[i] = z[Layout::angle + i];
      state.rate[i] = z[Layout::rate + i];
      if constexpr (integrates) {
        const bool counts = law_.integrates(static_cast<std::size_t>(i));
        state.integral[i] = counts ? z[Layout::integral + i] : Real(0.0);
      }
    }
    if constexpr (!Link::direct) {
      if (feeds_servos_back_) {
        link.believed(z + Layout::angle, z + Layout::rate, state.angle, state.rate);
      }
    }
    return state;
  }

  // Solves (M18) and (M19) for (phi'', theta'') by Cramer's rule: (M30).
  template <class Time, class Real>
  [[nodiscard]] Command<Real> linearize(const std::array<Jet<Time>, 2>& reference,
                                        const Real* z) const {
    const auto state = feedback(z);
    const Inertial<Real> m = coefficients(z);
    const Real x = wanted_acceleration(law_, 0, state, reference) - m.rest.x;
    const Real y = wanted_acceleration(law_, 1, state, reference) - m.rest.y;
    const Real determinant = m.of[0][0] * m.of[1][1] - m.of[0][1] * m.of[1][0];
    Command<Real> u;
    u.raw[0] = (x * m.of[1][1] - m.of[0][1] * y) / determinant;
    u.raw[1] = (m.of[0][0] * y - x * m.of[1][0]) / determinant;
    for (int i = 0; i < 2; ++i) u.value[i] = limited(i, u.raw[i]);
    return u;
  }

  double r_, g_;
  GeneralRolling rolling_;
  ControlLaw law_;
  ServoResponses servo_;
  Signals reference_;
  bool feeds_servos_back_;
};

template <class Any>
inline constexpr bool is_rig = false;
template <bool integrates, class Signals, class Link>
inline constexpr bool is_rig<RigLoop<integrates, Signals, Link>> = true;

}  // namespace bbsim::model
