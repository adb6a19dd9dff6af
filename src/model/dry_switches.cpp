// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/dry_switches.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/instant.hpp"

namespace bbsim::model {
namespace {

// A held direction is released at this multiple of the speed at which it was taken, so that it is
// not taken again at once.
constexpr double faster = 2;

double dot(const double (&a)[2], const double (&b)[2]) {
  return a[0] * b[0] + a[1] * b[1];
}

double size(const double* a) {
  return std::hypot(a[0], a[1]);
}

// The direction opposite to v; none for zero.
DryDirection against(const double* v) {
  const double length = size(v);
  if (!(length > 0)) return {};
  return {0, {-v[0] / length, -v[1] / length}};
}

}  // namespace

// The parts of either kind of coupled scene. Const types give read-only access.
template <class Contact, class Motor>
struct DrySwitches::BasicScene {
  Contact* contact;
  const CoupledBall* ball;
  Motor* motors = nullptr;  // null if no torques move the gimbal
  MotorLaw law{};
  int slip = 0, angle = 0, rate = 0, integral = 0;  // indices of states; the motors' integrals
  std::function<Balance<double>(double, const double*)> balance{};

  template <class AnyModel, class Use>
  static auto of(AnyModel& model, Use use) {
    using Result = decltype(use(std::declval<BasicScene&>()));
    return std::visit(
        [&](auto& any) -> Result {
          using Any = std::decay_t<decltype(any)>;
          if constexpr (is_coupled<Any>) {
            BasicScene scene{&any.parts.contact, &any.parts.ball};
            scene.slip = Any::Layout::slip;
            if constexpr (is_coupled_loop<Any>) {
              if (any.by != GimbalBy::servos) scene.motors = any.motors;
              scene.law = any.motor;
              scene.angle = Any::Layout::angle;
              scene.rate = Any::Layout::rate;
              scene.integral = Any::Layout::motor;
            }
            scene.balance = [&any](double t, const double* z) {
              return any.balance(any.inputs(t), z);
            };
            return use(scene);
          } else {
            throw std::logic_error("dry switches of a scene without them");
          }
        },
        model.system);
  }
};

// The parts with zero velocity, for which settle() decides whether they start to move.
struct DrySwitches::AtZero {
  bool slip = false, roll = false, spin = false, axis[2] = {false, false};
};

void DrySwitches::append_scales(std::vector<double>& scales) const {
  const double slow = resolution_;
  const double torque = parts_.friction > 0 ? parts_.friction : 1;
  const double limit = parts_.torque_limit < unlimited ? parts_.torque_limit : 1;
  scales.insert(scales.end(), {slow, slow, slow, slow, slow, torque, torque});
  scales.insert(scales.end(), 8, limit);
}

// The largest torque of a motor in a direction (1 or -1) at a rate of its axis, N m.
double DrySwitches::most(double side, double rate) const {
  return std::clamp(parts_.by_voltage(side, rate), -parts_.torque_limit, parts_.torque_limit);
}

// Whether an axis turns so fast that its motor brakes with its full torque at every command,
// because no voltage within the limit reduces it. Both limits of the torque asked of the motor are
// then equal. The voltage's limit is on the side that asks for less braking.
bool DrySwitches::overruns(double rate) const {
  return parts_.by_voltage(1, rate) < -parts_.torque_limit ||
         parts_.by_voltage(-1, rate) > parts_.torque_limit;
}

// The rate at which the integral adds to the torque asked of motor i while it does not wait, N m/s.
template <class AnyScene>
double DrySwitches::push(const AnyScene& scene, int i, const double* z,
                         const Pair& commanded) const {
  return scene.law.from_integral * (commanded[static_cast<std::size_t>(i)] - z[scene.angle + i]);
}

template <class AnyScene>
OutwardRate DrySwitches::outward_rate(const AnyScene& scene, int i, double side, const double* z,
                                      const Balance<double>& now,
                                      const MotorCommands& commands) const {
  const double rate = z[scene.rate + i], acceleration = now.acceleration[i];
  const bool by_voltage = std::abs(parts_.by_voltage(side, rate)) < parts_.torque_limit;
  const double asked = scene.law.from_command * commands.rate[static_cast<std::size_t>(i)] -
                       scene.law.from_angle * rate - scene.law.from_rate * acceleration;
  const double limit = by_voltage ? -parts_.torque_by_rate * acceleration : 0.0;
  return {side * (asked - limit), side * push(scene, i, z, commands.value)};
}

bool DrySwitches::moves_along_limit(const Model& model) const {
  return integrates() && SeenScene::of(model, [](const SeenScene& scene) {
           return scene.motors[0].along != 0 || scene.motors[1].along != 0;
         });
}

void DrySwitches::leave_limits(Model& model, double t, double* z) {
  if (!integrates()) return;
  Scene::of(model, [&](Scene& scene) {
    for (int i = 0; i < 2; ++i) {
      const MotorMode& motor = scene.motors[i];
      reached_[i] = motor.along != 0 ? motor.side : 0;
      if (reached_[i] == 0) continue;
      const double beyond = scene.balance(t, z).asked[i] - most(motor.side, z[scene.rate + i]);
      z[scene.integral + i] -= beyond / scene.law.from_integral;
    }
  });
}

void DrySwitches::note_limit(const Model& model, std::size_t guard) {
  if (!integrates() || guard < motor_guard || guard >= guards) return;
  const std::size_t i = (guard - motor_guard) / 4, which = (guard - motor_guard) % 4;
  SeenScene::of(model, [&](const SeenScene& scene) {
    const MotorMode& motor = scene.motors[i];
    if (motor.along != 0) return;  // leave_limits() has recorded it
    if (motor.side == 0) {
      reached_[i] = which % 2 == 0 ? 1 : -1;
      return;
    }
    // The torque asked of the motor returns to the limit.
    const std::size_t own = motor.by_rate == 0 ? 2 : motor.side > 0 ? 0 : 1;
    if (which == own) reached_[i] = motor.side;
  });
}

void DrySwitches::settle_at_limits(Model& model, double t, const double* z,
                                   const MotorCommands& commands) {
  if (!integrates() || (reached_[0] == 0 && reached_[1] == 0)) return;
  Scene::of(model, [&](Scene& scene) {
    const Balance<double> now = scene.balance(t, z);
    for (int i = 0; i < 2; ++i) {
      double side = std::exchange(reached_[i], 0);
      if (side == 0) continue;
      const double rate = z[scene.rate + i];
      const bool overrun = overruns(rate);
      if (overrun) side = parts_.by_voltage(1, rate) < 0 ? 1 : -1;
      MotorMode& motor = scene.motors[i];
      const OutwardRate outward = outward_rate(scene, i, side, z, now, commands);
      const AtLimit place = outward.at_limit(overrun ? outward.beyond_other() : outward.within());
      const bool by_voltage = std::abs(parts_.by_voltage(side, rate)) < parts_.torque_limit;
      const bool within = place == AtLimit::within && !overrun;
      // Beyond the same value on the other side.
      const bool other = place == AtLimit::within && overrun;
      motor.factor = within ? 1 : 0;
      motor.side = within ? 0 : other ? -side : side;
      motor.by_rate = !within && by_voltage ? -parts_.torque_by_rate : 0;
      motor.set = within ? 0 : by_voltage ? side * parts_.stall_torque : most(side, rate);
      motor.along = place == AtLimit::along ? 1 : 0;
      const double push = other ? -outward.push : outward.push;
      motor.integrate = within || (motor.along == 0 && push < 0) ? 1 : 0;
    }
  });
}

void DrySwitches::settle_limits(Scene& scene, double t, const double* z,
                                const Pair& commanded) const {
  if (scene.motors == nullptr || !parts_.limits_torque()) return;
  const Balance<double> now = scene.balance(t, z);
  for (int i = 0; i < 2; ++i) {
    MotorMode& motor = scene.motors[i];
    const double rate = z[scene.rate + i], asked = now.asked[i];
    const double up = parts_.by_voltage(1, rate), down = parts_.by_voltage(-1, rate);
    const double by_voltage = std::clamp(asked, down, up);
    motor.by_rate = motor.set = motor.factor = motor.along = 0;
    if (std::abs(by_voltage) > parts_.torque_limit) {
      motor.set = std::copysign(parts_.torque_limit, by_voltage);
    } else if (by_voltage != asked) {
      motor.set = std::copysign(parts_.stall_torque, asked - by_voltage);
      motor.by_rate = -parts_.torque_by_rate;
    } else {
      motor.factor = 1;
    }
    const double given = std::clamp(by_voltage, -parts_.torque_limit, parts_.torque_limit);
    motor.side = motor.factor != 0 ? 0 : asked > given ? 1 : -1;
    motor.integrate = motor.factor != 0 || motor.side * push(scene, i, z, commanded) < 0 ? 1 : 0;
  }
}

double DrySwitches::slow(double t, const CoupledBall& ball) const {
  // Integrator steps approach zero velocity by a fraction of the rest each, and the last one needs
  // some roundings of the time. Friction reduces slip by its force, and by the rotation that it
  // causes.
  constexpr double roundings = 64;
  const double turns = parts_.slides ? 1 / ball.rolling.k : 0;
  return std::max(resolution_, roundings * rounding_of(t) * (1 + turns) * ball.g);
}

void DrySwitches::settle_direction(DryDirection& of, double slow, const double (&v)[2],
                                   bool was_still) {
  const double speed = size(v);
  const bool fast = speed > (of.moving != 0 ? slow * (1 + 1e-9) : slow * faster * (1 - 1e-9)) ||
                    (was_still && speed > slow);
  const bool keeps = !fast && of.moving == 0 && size(of.along) > 0 && !was_still;
  of.moving = fast ? 1 : 0;
  if (keeps) return;
  of.along[0] = v[0] / speed;
  of.along[1] = v[1] / speed;
}

// Angles closer than this are equal: rounding is 1e-16 of the accelerations that cancel.
constexpr double enough = 1e-14;

// The angle of a motion from rest that is parallel to its acceleration, rad. `turned` gives the
// angle from a motion to its acceleration; it is `f_last` at the angle `last`.
template <class Turned>
double start_angle(const Turned& turned, double last, double f_last) {
  constexpr double half_turn = std::numbers::pi;
  const double at = last;
  // The direction of the acceleration is often the solution; the secant method starts there.
  double next = last + f_last;
  for (int i = 0; i < 12 && std::abs(f_last) > enough; ++i) {
    const double f = turned(next), slope = (f - f_last) / (next - last);
    last = std::exchange(next, next - f / slope);
    f_last = f;
    if (!(std::abs(next - last) < half_turn)) break;
  }
  if (std::abs(f_last) <= enough || std::abs(next - last) <= enough) return last;
  // Otherwise searches the whole circle for a sign change that is not a jump by half a turn.
  constexpr int parts = 32;
  double from = at, f_from = turned(from);
  for (int i = 1; i <= parts; ++i) {
    double to = at + 2 * half_turn * i / parts, f_to = turned(to);
    if (f_from * f_to <= 0 && std::abs(f_from - f_to) < half_turn) {
      for (int k = 0; k < 100 && to - from > enough; ++k) {
        const double middle = from + (to - from) / 2, f = turned(middle);
        if (f_from * f > 0) {
          from = middle;
          f_from = f;
        } else {
          to = middle;
        }
      }
      return from;
    }
    from = to;
    f_from = f_to;
  }
  return at;
}

// A motion from rest starts along its acceleration. The acceleration depends on that direction,
// because the plane yields to the contact's force. Sets the directions to match.
void DrySwitches::start(Scene& scene, double t, const double* z, bool slip, bool roll) {
  ContactMode& contact = *scene.contact;
  const auto turn = [&](DryDirection& of, const auto& acceleration) {
    if (!(size(of.along) > 0)) return 0.0;
    const auto present = [&] {
      double a[2];
      acceleration(scene.balance(t, z).answer, a);
      return std::atan2(of.along[0] * a[1] - of.along[1] * a[0], dot(of.along, a));
    };
    const double turned = present();
    if (std::abs(turned) <= enough) return 0.0;  // keep the direction to the bit
    const auto put = [&](double angle) {
      of.along[0] = std::cos(angle);
      of.along[1] = std::sin(angle);
    };
    const double before = std::atan2(of.along[1], of.along[0]);
    const double found = start_angle(
        [&](double angle) {
          put(angle);
          return present();
        },
        before, turned);
    put(found);
    return std::abs(found - before);
  };
  // The two directions depend on each other. The second round usually finds no change.
  for (int round = 0; round < 20; ++round) {
    double turned = 0;
    if (slip) {
      turned += turn(contact.slip, [](const Answer<double>& of, double(&a)[2]) {
        a[0] = of.slip[0];
        a[1] = of.slip[1];
      });
    }
    if (roll) {
      turned += turn(contact.roll, [](const Answer<double>& of, double(&a)[2]) {
        a[0] = of.x - of.slip[0];
        a[1] = of.y - of.slip[1];
      });
    }
    if (!(turned > 1e-13) || !(slip && roll)) return;
  }
}

// The number of violated conditions if the parts at zero continue in this mode.
int DrySwitches::faults(Scene& scene, double t, const double* z, const AtZero& zero, bool slide,
                        bool rest) const {
  ContactMode& contact = *scene.contact;
  if (zero.slip) contact.slides = false;
  if (zero.roll) {
    contact.rests = true;
    contact.roll = {};
  }
  Balance<double> now = scene.balance(t, z);
  if (zero.slip && slide) {
    contact.slip = against(now.answer.force);
    contact.slides = true;
    now = scene.balance(t, z);
  }
  if (zero.roll && !rest) {
    contact.roll = against(now.answer.couple);
    contact.rests = false;
  }
  start(scene, t, z, zero.slip && slide, zero.roll && !rest);
  now = scene.balance(t, z);
  const Answer<double>& of = now.answer;
  const double n = of.force[2];
  int faults = 0;
  if (zero.slip) {
    faults += slide ? !(dot(of.slip, contact.slip.along) >= 0)
                    : !(size(of.force) <= parts_.static_friction * n);
  }
  if (zero.roll) {
    const double p_dot[2] = {of.x - of.slip[0], of.y - of.slip[1]};
    faults += rest ? !(size(of.couple) <= scene.ball->law.rolling * n)
                   : !(dot(p_dot, contact.roll.along) >= 0);
  }
  if (zero.spin) {
    faults += contact.held ? !(std::abs(of.couple[2]) <= scene.ball->law.pivoting * n)
                           : !(of.u * contact.turns >= 0);
  }
  for (int i = 0; i < 2; ++i) {
    if (!zero.axis[i]) continue;
    faults += scene.motors[i].free == 0 ? !(std::abs(now.needed[i]) <= parts_.friction)
                                        : !(now.acceleration[i] * scene.motors[i].opposed >= 0);
  }
  return faults;
}

void DrySwitches::settle(Model& model, double t, double* z, const Pair& commanded) const {
  Scene::of(model, [&](Scene& scene) {
    settle_limits(scene, t, z, commanded);
    ContactMode& contact = *scene.contact;
    AtZero zero;
    const double slow = this->slow(t, *scene.ball);
    double* const slip = z + scene.slip;
    if (parts_.slides) {
      if (contact.slides && contact.slip.moving == 0 &&
          contact.slip.along[0] * slip[0] + contact.slip.along[1] * slip[1] <= 0) {
        slip[0] = slip[1] = 0;
      }
      zero.slip = slip[0] == 0 && slip[1] == 0;
      if (!zero.slip) {
        settle_direction(contact.slip, slow, {slip[0], slip[1]}, !contact.slides);
        contact.slides = true;
      }
    }
    if (scene.ball->law.rolling > 0) {
      double p[2] = {z[2] - slip[0], z[3] - slip[1]};
      if (!contact.rests && contact.roll.moving == 0 && size(contact.roll.along) > 0 &&
          dot(contact.roll.along, p) <= 0) {
        p[0] = p[1] = 0;
        if (zero.slip || !parts_.slides) {
          z[2] = z[3] = 0;
        } else {  // slides on without rotation
          slip[0] = z[2];
          slip[1] = z[3];
        }
      }
      zero.roll = p[0] == 0 && p[1] == 0;
      if (!zero.roll) {
        settle_direction(contact.roll, slow, p, contact.rests || size(contact.roll.along) == 0);
        contact.rests = false;
      }
    }
    if (scene.ball->law.pivoting > 0) {
      if (contact.turns * z[4] < 0) z[4] = 0;
      zero.spin = z[4] == 0;
      if (!zero.spin) {
        contact.held = false;
        contact.turns = std::copysign(1.0, z[4]);
      }
    }
    if (scene.motors != nullptr && parts_.friction > 0) {
      for (int i = 0; i < 2; ++i) {
        MotorMode& motor = scene.motors[i];
        double& rate = z[scene.rate + i];
        if (motor.opposed * rate < 0) rate = 0;
        zero.axis[i] = rate == 0;
        if (!zero.axis[i]) {
          motor.free = 1;
          motor.opposed = std::copysign(1.0, rate);
        }
      }
    }

    // Tries all combinations of modes, those at rest first. Takes the first with the fewest faults.
    struct Choice {
      int faults = std::numeric_limits<int>::max();
      ContactMode contact;
      MotorMode motors[2];
    } best;
    constexpr double sign[3] = {0, 1, -1};
    // A choice is a number with one digit for each part at zero; the last digit varies fastest.
    const int digits[] = {zero.slip ? 2 : 1, zero.roll ? 2 : 1, zero.spin ? 3 : 1,
                          zero.axis[0] ? 3 : 1, zero.axis[1] ? 3 : 1};
    int choices = 1;
    for (const int digit : digits) choices *= digit;
    for (int choice = 0; choice < choices && best.faults > 0; ++choice) {
      int digit[5], rest = choice;
      for (int d = 4; d >= 0; --d) {
        digit[d] = rest % digits[d];
        rest /= digits[d];
      }
      const auto [slides, rolls, turns, phi, theta] = digit;
      if (zero.spin) {
        contact.held = turns == 0;
        contact.turns = sign[turns];
      }
      const int axis[2] = {phi, theta};
      for (int i = 0; i < 2; ++i) {
        if (!zero.axis[i]) continue;
        scene.motors[i].free = axis[i] == 0 ? 0 : 1;
        scene.motors[i].opposed = sign[axis[i]];
      }
      const int wrong = faults(scene, t, z, zero, slides == 1, rolls == 0);
      if (wrong >= best.faults) continue;
      best.faults = wrong;
      best.contact = contact;
      if (scene.motors != nullptr) std::copy_n(scene.motors, 2, best.motors);
    }
    contact = best.contact;
    if (scene.motors != nullptr) std::copy_n(best.motors, 2, scene.motors);
  });
}

void DrySwitches::evaluate(const Model& model, double t, const double* z,
                           const MotorCommands& commands, double* values) const {
  std::fill(values, values + guards, unlimited);
  SeenScene::of(model, [&](const SeenScene& scene) {
    const ContactMode& contact = *scene.contact;
    const Balance<double> now = scene.balance(t, z);
    const double n = now.answer.force[2];
    const double slow = this->slow(t, *scene.ball);
    const auto moving = [slow](const DryDirection& of, const double(&v)[2], double* value) {
      const double forward = dot(of.along, v), speed = size(v);
      value[0] = of.moving != 0 ? forward - slow : forward;
      value[1] = of.moving != 0 ? forward - speed / 2 : faster * slow - speed;
    };
    if (scene.ball->law.rolling > 0) {
      if (contact.rests) {
        values[0] = scene.ball->law.rolling * n - size(now.answer.couple);
      } else {
        moving(contact.roll, now.p, values);
      }
    }
    if (parts_.slides) {
      if (contact.slides) {
        moving(contact.slip, now.slip, values + 2);
      } else {
        values[2] = parts_.static_friction * n - size(now.answer.force);
      }
    }
    if (scene.ball->law.pivoting > 0) {
      values[4] = contact.held ? scene.ball->law.pivoting * n - std::abs(now.answer.couple[2])
                               : contact.turns * z[4];
    }
    if (scene.motors == nullptr) return;
    for (int i = 0; i < 2; ++i) {
      const MotorMode& motor = scene.motors[i];
      const double rate = z[scene.rate + i];
      if (parts_.friction > 0) {
        values[5 + i] =
            motor.free == 0 ? parts_.friction - std::abs(now.needed[i]) : motor.opposed * rate;
      }
      if (!parts_.limits_torque()) continue;
      // Compares the torque asked with the voltage's limits, and the clamped torque with the torque
      // limit.
      double* const limit = values + 7 + 4 * i;
      const double asked = now.asked[i], most = parts_.torque_limit;
      const double up = parts_.by_voltage(1, rate), down = parts_.by_voltage(-1, rate);
      const double left = std::clamp(asked, down, up);
      const bool at_voltage = motor.by_rate != 0, at_limit = motor.factor == 0 && !at_voltage;
      if (motor.along != 0) {
        const OutwardRate outward = outward_rate(scene, i, motor.side, z, now, commands);
        const bool overrun = at_limit && motor.set * motor.side < 0;
        limit[0] = overrun ? outward.beyond_other() : outward.within();
        limit[1] = -outward.beyond();
        // The other kind of limit takes over, or both limits coincide.
        const double given = std::abs(motor.side > 0 ? up : down);
        limit[2] = at_voltage ? most - given : given - most;
        if (at_limit && !overrun) limit[3] = most + (motor.set < 0 ? up : -down);
      } else {
        std::size_t spare = 0;
        if (at_limit) {
          // The torque asked returns to the limit, or the voltage's limit takes over.
          limit[2] = motor.side * (asked - motor.set);
          limit[1] = std::copysign(1.0, motor.set) * (motor.side > 0 ? up : down) - most;
        } else {
          limit[2] = most - left;
          limit[3] = most + left;
          limit[0] = at_voltage && motor.set > 0 ? asked - up : up - asked;
          limit[1] = at_voltage && motor.set < 0 ? down - asked : asked - down;
          spare = motor.set > 0 ? 1 : 0;
          if (at_voltage) limit[spare] = unlimited;
        }
        if (motor.side != 0 && integrates()) {
          const double drives = motor.side * push(scene, i, z, commands.value);
          limit[spare] = motor.integrate != 0 ? -drives : drives;
        }
      }
      for (int k = 0; k < 4; ++k) {
        if (std::isnan(limit[k])) limit[k] = unlimited;
      }
    }
  });
}

DrySwitches::State DrySwitches::state(const Model& model) const {
  return SeenScene::of(model, [](const SeenScene& scene) {
    // A ball that slides without rotation is not at rest.
    State state{scene.contact->slides, scene.contact->rests && !scene.contact->slides, {}};
    for (int i = 0; i < 2 && scene.motors != nullptr; ++i) {
      state.sticks[i] = scene.motors[i].free == 0;
    }
    return state;
  });
}

}  // namespace bbsim::model
