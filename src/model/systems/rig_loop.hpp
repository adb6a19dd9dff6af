// The closed loop of a built rig: servos with limits, laws beyond equation (31), controllers that
// hold their command between samples.
//
// What switches (a servo at its rate limit, a command that a sample changed) is constant between
// two switches, and stands in a RigMode: the right-hand side has no branch on the state, and is as
// smooth as equation (27). model/rig/ says when what switches.
#pragma once

#include "model/ball/general_rolling.hpp"
#include "model/systems/system.hpp"

namespace bbsim::model {

// Of one axis, between two switches.
struct AxisMode {
  double demand_factor = 1,
         set_acceleration =
             0;  // servo acceleration = demand_factor * demand + set_acceleration, rad/s^2
  double ratio = 1, offset = 0;  // angle of the plane = ratio * angle of the servo + held, rad
  double command_factor = 1, set_command = 0;  // the same for the controller's command
  double integrate = 1;                        // of the error; 0 while the command is at its limit
};

struct RigMode {
  AxisMode axis[2];         // phi, theta
  double command[2]{0, 0};  // of a controller that holds it, rad or rad/s^2
};

// A servo's acceleration in free motion: from_command u - from_angle q - from_rate q'.
struct ServoResponse {
  double from_command = 1, from_angle = 0, from_rate = 0;
};

enum class LawKind { held, linear, gravity_compensation, feedback_linearisation };

// How a command u follows from the error e = reference - (x, y), rows phi, theta.
//   linear                  u = gain (e, e', -q, -q') + integral (of e)
//   gravity_compensation    angles on which gravity gives the ball x_d'' + kv e' + kp e
//   feedback_linearisation  accelerations of the gimbal that give the ball the same
struct RigLaw {
  LawKind kind = LawKind::held;
  double gain[2][8] = {};
  double integral[2][2] = {};
  double kv[2][2] = {}, kp[2][2] = {};
};

// asin(s) for |s| below 0.99, of any number type, with its derivatives: Newton's iteration.
template <class Real>
[[nodiscard]] Real arcsine(const Real& s) {
  const Real s2 = s * s;
  Real angle = s * (Real(1.0) + s2 * (Real(1.0 / 6) + s2 * (Real(3.0 / 40) + (15.0 / 336) * s2)));
  // Six suffice up to |s| = 0.99.
  for (int i = 0; i < 6; ++i) {
    const SinCos<Real> at = sin_cos(angle);
    angle = angle - (at.sin - s) / at.cos;
  }
  return angle;
}

template <class Real>
struct RigAxes {
  Real raw[2];      // command before its limit; sine of the angle in gravity compensation
  Real command[2];  // behind its limit, rad, or rad/s^2 where accelerations are driven
  Real demand[2];   // acceleration that the servo would have in free motion, rad/s^2
};

// States: the ball's five, the servos' angles and rates; and the integrals of the error, of a law
// in continuous time that has them.
template <bool integrates = false, class Signals = SignalPair>
class RigLoop {
 public:
  using Layout = BallLayout<Shape::full>;
  static constexpr Shape moves = Shape::full;
  static constexpr int size = integrates ? 11 : 9;
  static constexpr bool open_loop = false;
  static constexpr auto motions = [] {
    if constexpr (integrates) {
      return Motions<7>{{{0, 2}, {1, 3}, {5, 7}, {6, 8}, {-1, 4}, {-1, 9}, {-1, 10}}};
    } else {
      return Motions<5>{{{0, 2}, {1, 3}, {5, 7}, {6, 8}, {-1, 4}}};
    }
  }();
  // What a row of output needs beside the states, since it changes with the mode: the plane's
  // angles, rates and accelerations; the command; and, of a sampled loop, what was measured last.
  static constexpr int extras = 10;

  RigLoop(double radius, double gravity, const GeneralRolling& rolling, const RigLaw& law,
          const ServoResponse& servo, Signals reference, const RigMode& present = {})
      : mode(present),
        r_(radius),
        g_(gravity),
        rolling_(rolling),
        law_(law),
        servo_(servo),
        reference_(std::move(reference)) {}

  RigMode mode;

  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> inputs(const Time& t) const {
    return reference_.at(t);
  }

  template <class Time, class Real>
  void derivative(const Time& t, const Real* z, Real* dz) const {
    derivative_of(inputs(t), z, dz);
  }

  [[nodiscard]] RigLoop<integrates, SignalView> view() const {
    return {r_, g_, rolling_, law_, servo_, reference_.view(), mode};
  }

  template <class Time, class Real>
  void derivative_of(const std::array<Jet<Time>, 2>& reference, const Real* z, Real* dz) const {
    const RigAxes<Real> loop = axes(reference, z);
    Axis<Real> plane[2];
    for (int i = 0; i < 2; ++i) {
      const AxisMode& of = mode.axis[i];
      const Real acceleration = of.demand_factor * loop.demand[i] + Real(of.set_acceleration);
      plane[i] = plane_axis(i, z, of.ratio * acceleration);
      dz[5 + i] = z[7 + i];
      dz[7 + i] = acceleration;
      if constexpr (integrates) {
        dz[9 + i] = of.integrate * (reference[static_cast<std::size_t>(i)].value - z[i]);
      }
    }
    Layout::derivative(rolling_, plane[0], plane[1], Layout::unpack(z), r_, g_, dz);
  }

  // What law and servo ask for at a state.
  template <class Time, class Real>
  [[nodiscard]] RigAxes<Real> axes(const std::array<Jet<Time>, 2>& reference, const Real* z) const {
    RigAxes<Real> loop;
    if (law_.kind == LawKind::held) {
      for (int i = 0; i < 2; ++i) loop.raw[i] = loop.command[i] = Real(mode.command[i]);
    } else if (law_.kind == LawKind::linear) {
      for (int i = 0; i < 2; ++i) {
        Real u = Real(0.0);
        for (int j = 0; j < 2; ++j) {
          const Jet<Time>& wanted = reference[static_cast<std::size_t>(j)];
          u = u + law_.gain[i][j] * (wanted.value - z[j]) +
              law_.gain[i][2 + j] * (wanted.rate - z[2 + j]) - law_.gain[i][4 + j] * z[5 + j] -
              law_.gain[i][6 + j] * z[7 + j];
          if constexpr (integrates) u = u + law_.integral[i][j] * z[9 + j];
        }
        loop.raw[i] = u;
        loop.command[i] = limited(i, u);
      }
    } else {
      Real wanted[2];
      for (int i = 0; i < 2; ++i) {
        wanted[i] = Real(reference[static_cast<std::size_t>(i)].acceleration);
        for (int j = 0; j < 2; ++j) {
          const Jet<Time>& path = reference[static_cast<std::size_t>(j)];
          wanted[i] = wanted[i] + law_.kv[i][j] * (path.rate - z[2 + j]) +
                      law_.kp[i][j] * (path.value - z[j]);
        }
      }
      if (law_.kind == LawKind::gravity_compensation) {
        compensate_gravity(wanted, loop);
      } else {
        linearise(wanted, z, loop);
      }
    }
    for (int i = 0; i < 2; ++i) {
      loop.demand[i] = servo_.from_command * loop.command[i] - servo_.from_angle * z[5 + i] -
                       servo_.from_rate * z[7 + i];
    }
    return loop;
  }

  // The jump of (x', y', u) when the rates of phi and theta jump by (phi, theta), rad/s: what
  // (27) leaves of an instant in which only their accelerations are large.
  [[nodiscard]] std::array<double, 3> impulse(const double* z, double phi, double theta) const {
    const Inertial<double> inertial = coefficients(z);
    std::array<double, 3> jump{};
    for (std::size_t i = 0; i < 3; ++i) {
      jump[i] = inertial.of[i][0] * phi + inertial.of[i][1] * theta;
    }
    return jump;
  }

  // All extras but what was measured, at the present mode.
  void write_extras(double t, const double* z, double* out) const {
    const RigAxes<double> loop = axes(reference_.at(t), z);
    for (int i = 0; i < 2; ++i) {
      const AxisMode& of = mode.axis[i];
      out[i] = of.ratio * z[5 + i] + of.offset;
      out[2 + i] = of.ratio * z[7 + i];
      out[4 + i] = of.ratio * (of.demand_factor * loop.demand[i] + of.set_acceleration);
      out[6 + i] = loop.command[i];
    }
  }

  [[nodiscard]] Sample sample(double t, const double* z, const double* extra) const {
    const auto reference = reference_.at(t);
    Sample sample{t,
                  ball_motion<Shape::full>(Layout::unpack(z), r_),
                  0,
                  {extra[0], extra[1], extra[2], extra[3], extra[4], extra[5]},
                  {reference[0].value, reference[1].value}};
    sample.command = {extra[6], extra[7]};
    sample.measured = {extra[8], extra[9]};
    return sample;
  }

  // At the present mode.
  [[nodiscard]] Sample sample(double t, const double* z) const {
    double extra[extras] = {};
    write_extras(t, z, extra);
    return sample(t, z, extra);
  }

  [[nodiscard]] const Signals& reference() const { return reference_; }
  [[nodiscard]] const RigLaw& law() const { return law_; }
  [[nodiscard]] const ServoResponse& servo() const { return servo_; }
  [[nodiscard]] const GeneralRolling& rolling() const { return rolling_; }
  [[nodiscard]] double radius() const { return r_; }
  [[nodiscard]] double gravity() const { return g_; }

 private:
  template <class Real>
  struct Inertial {
    Real of[3][2];  // rows x'', y'', u'; columns phi'', theta''
  };

  template <class Real>
  [[nodiscard]] Axis<Real> plane_axis(int i, const Real* z, const Real& acceleration) const {
    const AxisMode& of = mode.axis[i];
    const SinCos<Real> direction = sin_cos(Real(of.ratio * z[5 + i] + Real(of.offset)));
    return {direction.sin, direction.cos, of.ratio * z[7 + i], acceleration};
  }

  template <class Real>
  [[nodiscard]] GeneralRolling::Rates<Real> rates_under(const Real* z, double phi,
                                                        double theta) const {
    return rolling_.rates<Real>(plane_axis(0, z, Real(phi)), plane_axis(1, z, Real(theta)),
                                Layout::unpack(z), r_, g_);
  }

  template <class Real>
  [[nodiscard]] Inertial<Real> coefficients(const Real* z) const {
    const auto none = rates_under(z, 0, 0), phi = rates_under(z, 1, 0),
               theta = rates_under(z, 0, 1);
    return {{{phi.x - none.x, theta.x - none.x},
             {phi.y - none.y, theta.y - none.y},
             {phi.u - none.u, theta.u - none.u}}};
  }

  template <class Real>
  [[nodiscard]] Real limited(int i, const Real& raw) const {
    return mode.axis[i].command_factor * raw + Real(mode.axis[i].set_command);
  }

  // The static part of (27): (1 + k) x'' = g sin phi, (1 + k) y'' = -g cos phi sin theta.
  template <class Real>
  void compensate_gravity(const Real (&wanted)[2], RigAxes<Real>& loop) const {
    const double scale = (1 + rolling_.k) / g_;
    loop.raw[0] = scale * wanted[0];
    const Real sine = limited(0, loop.raw[0]);
    loop.command[0] = arcsine(sine);
    loop.raw[1] = -(scale * wanted[1]) / sin_cos(loop.command[0]).cos;
    loop.command[1] = arcsine(limited(1, loop.raw[1]));
  }

  // (27) solved for (phi'', theta''), Cramer's rule.
  template <class Real>
  void linearise(const Real (&wanted)[2], const Real* z, RigAxes<Real>& loop) const {
    const auto rest = rates_under(z, 0, 0);
    const Inertial<Real> m = coefficients(z);
    const Real x = wanted[0] - rest.x, y = wanted[1] - rest.y;
    const Real determinant = m.of[0][0] * m.of[1][1] - m.of[0][1] * m.of[1][0];
    loop.raw[0] = (x * m.of[1][1] - m.of[0][1] * y) / determinant;
    loop.raw[1] = (m.of[0][0] * y - x * m.of[1][0]) / determinant;
    for (int i = 0; i < 2; ++i) loop.command[i] = limited(i, loop.raw[i]);
  }

  double r_, g_;
  GeneralRolling rolling_;
  RigLaw law_;
  ServoResponse servo_;
  Signals reference_;
};

template <class Any>
inline constexpr bool is_rig = false;
template <bool integrates, class Signals>
inline constexpr bool is_rig<RigLoop<integrates, Signals>> = true;

}  // namespace bbsim::model
