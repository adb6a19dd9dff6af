// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/dry_friction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/instant.hpp"

namespace bbsim::model {
namespace {

// Ratio of the speed at which a held direction is released to the speed at which it is held. The
// gap prevents immediate switching back.
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

// Angles closer than this count as equal: rounding is 1e-16 of the accelerations that cancel.
constexpr double equal_angles = 1e-14;

// Angle of a motion from rest that is parallel to its acceleration, rad; `last` if none is found.
// turned(a) is the angle from a motion at angle a to its acceleration; turned(last) is f_last.
template <class Turned>
double start_angle(const Turned& turned, double last, double f_last) {
  constexpr double half_turn = std::numbers::pi;
  const double at = last;
  // The direction of the acceleration is often the solution; the secant method starts there.
  double next = last + f_last;
  for (int i = 0; i < 12 && std::abs(f_last) > equal_angles; ++i) {
    const double f = turned(next), slope = (f - f_last) / (next - last);
    last = std::exchange(next, next - f / slope);
    f_last = f;
    if (!(std::abs(next - last) < half_turn)) break;
  }
  if (std::abs(f_last) <= equal_angles || std::abs(next - last) <= equal_angles) return last;
  // Otherwise searches the whole circle for a sign change by less than half a turn (no jump).
  constexpr int parts = 32;
  double from = at, f_from = turned(from);
  for (int i = 1; i <= parts; ++i) {
    double to = at + 2 * half_turn * i / parts, f_to = turned(to);
    if (f_from * f_to <= 0 && std::abs(f_from - f_to) < half_turn) {
      for (int k = 0; k < 100 && to - from > equal_angles; ++k) {
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

// Decides whether the direction of a motion follows its velocity v or is held.
void settle_direction(DryDirection& of, double slow, const double (&v)[2], bool was_still) {
  const double speed = size(v);
  const bool fast = speed > (of.moving != 0 ? slow * (1 + 1e-9) : slow * faster * (1 - 1e-9)) ||
                    (was_still && speed > slow);
  const bool keeps = !fast && of.moving == 0 && size(of.along) > 0 && !was_still;
  of.moving = fast ? 1 : 0;
  if (keeps) return;
  of.along[0] = v[0] / speed;
  of.along[1] = v[1] / speed;
}

}  // namespace

void DryFriction::append_scales(std::vector<double>& scales) const {
  const double slow = resolution_;
  const double torque = parts_.friction > 0 ? parts_.friction : 1;
  scales.insert(scales.end(), {slow, slow, slow, slow, slow, torque, torque});
}

double DryFriction::slow(double t) const {
  // Each integrator step removes a fraction of the remaining velocity, and the last step needs some
  // roundings of the time. Friction reduces slip by its force and by the rotation that it causes.
  constexpr double roundings = 64;
  const CoupledBall& ball = *scene_.ball;
  const double turns = parts_.slides ? 1 / ball.rolling.k : 0;
  return std::max(resolution_, roundings * rounding_of(t) * (1 + turns) * ball.g);
}

void DryFriction::evaluate(const GuardContext& at, double* values) const {
  std::fill(values, values + guards(), unlimited);
  const ContactMode& contact = *scene_.contact;
  const Balance<double>& now = at.balance();
  const double n = now.answer.force[2];
  const double slow = this->slow(at.t);
  const auto moving = [slow](const DryDirection& of, const double(&v)[2], double* value) {
    const double forward = dot(of.along, v), speed = size(v);
    value[0] = of.moving != 0 ? forward - slow : forward;
    value[1] = of.moving != 0 ? forward - speed / 2 : faster * slow - speed;
  };
  const auto& law = scene_.ball->law;
  if (law.rolling > 0) {
    if (contact.rests) {
      values[Guard::roll] = law.rolling * n - size(now.answer.couple);
    } else {
      moving(contact.roll, now.p, values + Guard::roll);
    }
  }
  if (parts_.slides) {
    if (contact.slides) {
      moving(contact.slip, now.slip, values + Guard::slip);
    } else {
      values[Guard::slip] = parts_.static_friction * n - size(now.answer.force);
    }
  }
  if (law.pivoting > 0) {
    values[Guard::spin] =
        contact.held ? law.pivoting * n - std::abs(now.answer.couple[2]) : contact.turns * at.z[4];
  }
  if (!(parts_.friction > 0)) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const MotorMode& motor = scene_.motors[i];
    values[Guard::phi + i] = motor.free == 0 ? parts_.friction - std::abs(now.needed[i])
                                             : motor.opposed * at.z[scene_.rate + i];
  }
}

// Makes the directions of motions that start from rest parallel to their accelerations. These
// depend on the directions, because the plane yields to the contact force.
void DryFriction::start(double t, const double* z, bool slip, bool roll) {
  ContactMode& contact = *scene_.contact;
  const auto turn = [&](DryDirection& of, const auto& acceleration) {
    if (!(size(of.along) > 0)) return 0.0;
    const auto present = [&] {
      double a[2];
      acceleration(model_.balance(t, z).answer, a);
      return std::atan2(of.along[0] * a[1] - of.along[1] * a[0], dot(of.along, a));
    };
    const double turned = present();
    if (std::abs(turned) <= equal_angles) return 0.0;  // keep the direction bit for bit
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

// Counts the conditions that are violated if the parts at zero continue in this mode.
int DryFriction::faults(double t, const double* z, const AtZero& zero, bool slide, bool rest) {
  ContactMode& contact = *scene_.contact;
  if (zero.slip) contact.slides = false;
  if (zero.roll) {
    contact.rests = true;
    contact.roll = {};
  }
  Balance<double> now = model_.balance(t, z);
  if (zero.slip && slide) {
    contact.slip = against(now.answer.force);
    contact.slides = true;
    now = model_.balance(t, z);
  }
  if (zero.roll && !rest) {
    contact.roll = against(now.answer.couple);
    contact.rests = false;
  }
  start(t, z, zero.slip && slide, zero.roll && !rest);
  now = model_.balance(t, z);
  const Answer<double>& of = now.answer;
  const auto& law = scene_.ball->law;
  const double n = of.force[2];
  int faults = 0;
  if (zero.slip) {
    faults += slide ? !(dot(of.slip, contact.slip.along) >= 0)
                    : !(size(of.force) <= parts_.static_friction * n);
  }
  if (zero.roll) {
    const double p_dot[2] = {of.x - of.slip[0], of.y - of.slip[1]};
    faults += rest ? !(size(of.couple) <= law.rolling * n) : !(dot(p_dot, contact.roll.along) >= 0);
  }
  if (zero.spin) {
    faults +=
        contact.held ? !(std::abs(of.couple[2]) <= law.pivoting * n) : !(of.u * contact.turns >= 0);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!zero.axis[i]) continue;
    const MotorMode& motor = scene_.motors[i];
    faults += motor.free == 0 ? !(std::abs(now.needed[i]) <= parts_.friction)
                              : !(now.acceleration[i] * motor.opposed >= 0);
  }
  return faults;
}

// Sets velocities that have reached zero to exactly zero. Chooses the modes of moving parts.
DryFriction::AtZero DryFriction::stop_parts(double t, double* z) {
  ContactMode& contact = *scene_.contact;
  AtZero zero;
  const double slow = this->slow(t);
  double* const slip = z + scene_.slip;
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
  if (scene_.ball->law.rolling > 0) {
    double p[2] = {z[2] - slip[0], z[3] - slip[1]};
    if (!contact.rests && contact.roll.moving == 0 && size(contact.roll.along) > 0 &&
        dot(contact.roll.along, p) <= 0) {
      p[0] = p[1] = 0;
      if (zero.slip || !parts_.slides) {
        z[2] = z[3] = 0;
      } else {  // keeps sliding without rotation
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
  if (scene_.ball->law.pivoting > 0) {
    if (contact.turns * z[4] < 0) z[4] = 0;
    zero.spin = z[4] == 0;
    if (!zero.spin) {
      contact.held = false;
      contact.turns = std::copysign(1.0, z[4]);
    }
  }
  for (std::size_t i = 0; i < 2 && parts_.friction > 0; ++i) {
    MotorMode& motor = scene_.motors[i];
    double& rate = z[scene_.rate + i];
    if (motor.opposed * rate < 0) rate = 0;
    zero.axis[i] = rate == 0;
    if (zero.axis[i]) continue;
    motor.free = 1;
    motor.opposed = std::copysign(1.0, rate);
  }
  return zero;
}

// Tries all combinations of modes, those at rest first. Takes the first with the fewest faults.
void DryFriction::choose(double t, const double* z, const AtZero& zero) {
  ContactMode& contact = *scene_.contact;
  MotorMode* const motors = scene_.motors;
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
      motors[i].free = axis[i] == 0 ? 0 : 1;
      motors[i].opposed = sign[axis[i]];
    }
    const int wrong = faults(t, z, zero, slides == 1, rolls == 0);
    if (wrong >= best.faults) continue;
    best.faults = wrong;
    best.contact = contact;
    if (motors != nullptr) std::copy_n(motors, 2, best.motors);
  }
  contact = best.contact;
  if (motors != nullptr) std::copy_n(best.motors, 2, motors);
}

bool DryFriction::reset(double t, double* z) {
  choose(t, z, stop_parts(t, z));
  return false;
}

DryFriction::State DryFriction::state() const {
  // A ball that slides without rotation is not at rest.
  const ContactMode& contact = *scene_.contact;
  State state{contact.slides, contact.rests && !contact.slides, {}};
  for (std::size_t i = 0; i < 2 && scene_.motors != nullptr; ++i) {
    state.sticks[i] = scene_.motors[i].free == 0;
  }
  return state;
}

Effect DryFriction::note_events(double t, const double* z) {
  const State now = state(), before = std::exchange(noted_, now);
  Effect effect = Effect::none;
  const auto note = [&](const char* name, const std::optional<OnEvent>& event) {
    if (event && log_.note(name, *event, t, z) == Effect::stop) effect = Effect::stop;
  };
  if (now.slides != before.slides) note(now.slides ? "slip" : "roll", OnEvent::note);
  if (now.rests && !before.rests) note("rest", parts_.rest);
  if (now.sticks[0] && !before.sticks[0]) note("stick_phi", parts_.stick);
  if (now.sticks[1] && !before.sticks[1]) note("stick_theta", parts_.stick);
  return effect;
}

}  // namespace bbsim::model
