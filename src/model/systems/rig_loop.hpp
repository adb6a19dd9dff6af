// The closed loop of a built rig: servos with limits, laws beyond equation (31), controllers that
// hold their command between samples.
//
// What switches (a servo at its rate limit, a command that a sample changed) is constant between
// two switches, and stands in a RigMode: the right-hand side has no branch on the state, and is as
// smooth as equation (27). HybridSystem says when what switches.
#pragma once

#include <cstring>
#include <type_traits>

#include "model/ball/general_rolling.hpp"
#include "model/control/law.hpp"
#include "model/systems/system.hpp"

namespace bbsim::model {

// What holds for one axis between two switches.
struct AxisMode {
  // Acceleration of the servo = demand_factor * demand + set_acceleration, rad/s^2.
  double demand_factor = 1, set_acceleration = 0;
  // Angle of the plane = ratio * angle of the servo + offset, rad.
  double ratio = 1, offset = 0;
  // Command behind its limit = command_factor * command + set_command.
  double command_factor = 1, set_command = 0;
  double integrate = 1;  // the error; 0 while the command is at its limit
};

struct RigMode {
  AxisMode axis[2];         // phi, theta
  double command[2]{0, 0};  // of a controller that holds it, rad or rad/s^2
};

// A servo's acceleration in free motion: from_command u - from_angle q - from_rate q'.
struct ServoResponse {
  double from_command = 1, from_angle = 0, from_rate = 0;
};

template <class Real>
struct RigAxes {
  Command<Real> command;
  Real demand[2];  // acceleration that the servo would have in free motion, rad/s^2
};

// Where a rig's states are, after the ball's five: of phi, and next to it of theta.
struct RigLayout : BallLayout<Shape::full> {
  static constexpr int angle = BallLayout<Shape::full>::size, rate = angle + 2, integral = rate + 2;
};

// What a row of output needs beside the states, since it changes with the mode: of the plane, phi
// and theta; the commands; and, of a sampled loop, where the ball was seen last.
struct RigExtras {
  double angle[2], rate[2], acceleration[2], command[2], measured[2];

  static constexpr int size = 10;
  [[nodiscard]] static RigExtras unpack(const double* numbers) {
    RigExtras extras;
    std::memcpy(&extras, numbers, sizeof extras);
    return extras;
  }
  void pack(double* numbers) const { std::memcpy(numbers, this, sizeof *this); }
};
static_assert(sizeof(RigExtras) == RigExtras::size * sizeof(double));

// States: the ball's five, the servos' angles and rates; and the integrals of the error, of a law
// in continuous time that has them.
template <bool integrates = false, class Signals = SignalPair>
class RigLoop {
 public:
  using Layout = RigLayout;
  static constexpr Shape moves = Shape::full;
  static constexpr int size = Layout::integral + (integrates ? 2 : 0);
  static constexpr bool open_loop = false;
  static constexpr bool papers_rig = false;
  static constexpr auto motions = [] {
    constexpr int angle = Layout::angle, rate = Layout::rate, integral = Layout::integral;
    if constexpr (integrates) {
      return Motions<7>{{{0, 2},
                         {1, 3},
                         {angle, rate},
                         {angle + 1, rate + 1},
                         {-1, 4},
                         {-1, integral},
                         {-1, integral + 1}}};
    } else {
      return Motions<5>{{{0, 2}, {1, 3}, {angle, rate}, {angle + 1, rate + 1}, {-1, 4}}};
    }
  }();

  RigLoop(double radius, double gravity, const GeneralRolling& rolling, const ControlLaw& law,
          const ServoResponse& servo, Signals reference, const RigMode& present = {})
      : mode(present),
        r_(radius),
        g_(gravity),
        rolling_(rolling),
        law_(law),
        servo_(servo),
        reference_(std::move(reference)) {}

  RigMode mode;

  // The reference, but where the command is held: nothing asks for it then.
  template <class Time>
  [[nodiscard]] std::array<Jet<Time>, 2> inputs(const Time& t) const {
    if constexpr (!integrates) {
      if (law_.kind == LawKind::held) {
        const Jet<Time> nothing{Time(0.0), Time(0.0), Time(0.0)};
        return {nothing, nothing};
      }
    }
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
      dz[Layout::angle + i] = z[Layout::rate + i];
      dz[Layout::rate + i] = acceleration;
      if constexpr (integrates) {
        dz[Layout::integral + i] =
            of.integrate * (reference[static_cast<std::size_t>(i)].value - z[i]);
      }
    }
    Layout::derivative(rolling_, plane[0], plane[1], Layout::unpack(z), r_, g_, dz);
  }

  // What law and servo ask for at a state.
  template <class Time, class Real>
  [[nodiscard]] RigAxes<Real> axes(const std::array<Jet<Time>, 2>& reference, const Real* z) const {
    RigAxes<Real> loop;
    if (law_.kind == LawKind::held) {
      for (int i = 0; i < 2; ++i) {
        loop.command.raw[i] = loop.command.value[i] = Real(mode.command[i]);
      }
    } else if (law_.kind == LawKind::feedback_linearisation) {
      loop.command = linearise(reference, z);
    } else {
      loop.command = model::command(law_, feedback(z), reference,
                                    [this](int i, const Real& raw) { return limited(i, raw); });
    }
    for (int i = 0; i < 2; ++i) {
      loop.demand[i] = servo_.from_command * loop.command.value[i] -
                       servo_.from_angle * z[Layout::angle + i] -
                       servo_.from_rate * z[Layout::rate + i];
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

  // All but what was measured, at the present mode.
  [[nodiscard]] RigExtras extras(double t, const double* z) const {
    const RigAxes<double> loop = axes(inputs(t), z);
    RigExtras extras{};
    for (int i = 0; i < 2; ++i) {
      const AxisMode& of = mode.axis[i];
      extras.angle[i] = of.ratio * z[Layout::angle + i] + of.offset;
      extras.rate[i] = of.ratio * z[Layout::rate + i];
      extras.acceleration[i] = of.ratio * (of.demand_factor * loop.demand[i] + of.set_acceleration);
      extras.command[i] = loop.command.value[i];
    }
    return extras;
  }

  [[nodiscard]] Sample sample(double t, const double* z, const RigExtras& with,
                              Detail detail = Detail::all) const {
    Sample sample;
    sample.t = t;
    sample.ball = ball_motion<Shape::full>(Layout::unpack(z), r_);
    sample.gimbal = {with.angle[0], with.angle[1],        with.rate[0],
                     with.rate[1],  with.acceleration[0], with.acceleration[1]};
    if (detail != Detail::all) return sample;
    const auto reference = reference_.at(t);
    sample.reference = {reference[0].value, reference[1].value};
    sample.command = {with.command[0], with.command[1]};
    sample.measured = {with.measured[0], with.measured[1]};
    return sample;
  }

  // The sample is one of the present mode.
  [[nodiscard]] Sample sample(double t, const double* z, Detail detail = Detail::all) const {
    return sample(t, z, detail == Detail::ball ? RigExtras{} : extras(t, z), detail);
  }

  [[nodiscard]] const Signals& reference() const { return reference_; }
  [[nodiscard]] const ControlLaw& law() const { return law_; }
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
    const SinCos<Real> direction = sin_cos(Real(of.ratio * z[Layout::angle + i] + Real(of.offset)));
    return {direction.sin, direction.cos, of.ratio * z[Layout::rate + i], acceleration};
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

  template <class Real>
  [[nodiscard]] static auto feedback(const Real* z) {
    using Integral = std::conditional_t<integrates, Real, Zero>;
    Feedback<Real, Integral> state;
    for (int i = 0; i < 2; ++i) {
      state.position[i] = z[i];
      state.velocity[i] = z[2 + i];
      state.angle[i] = z[Layout::angle + i];
      state.rate[i] = z[Layout::rate + i];
      if constexpr (integrates) state.integral[i] = z[Layout::integral + i];
    }
    return state;
  }

  // (27) solved for (phi'', theta''), Cramer's rule.
  template <class Time, class Real>
  [[nodiscard]] Command<Real> linearise(const std::array<Jet<Time>, 2>& reference,
                                        const Real* z) const {
    const auto state = feedback(z);
    const auto rest = rates_under(z, 0, 0);
    const Inertial<Real> m = coefficients(z);
    const Real x = wanted_acceleration(law_, 0, state, reference) - rest.x;
    const Real y = wanted_acceleration(law_, 1, state, reference) - rest.y;
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
  ServoResponse servo_;
  Signals reference_;
};

template <class Any>
inline constexpr bool is_rig = false;
template <bool integrates, class Signals>
inline constexpr bool is_rig<RigLoop<integrates, Signals>> = true;

}  // namespace bbsim::model
