// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/servo/held_motion.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

namespace bbsim::model {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Sums the series of the response at t, where term(n) gives c_n in order.
template <class Term>
ImpulseAnswer sum_of(double t, Term term) {
  double value = 1, slope = 1, integral = 0.5, before = 1;
  for (int n = 1; n <= most_terms; ++n) {
    const double next = term(n);
    value += next;
    slope += (n + 1) * next;
    integral += next * term_parts<double>.of[n + 2];
    if (std::abs(next) + std::abs(before) < 1e-18) break;
    before = next;
  }
  return {t * t * integral, t * value, slope};
}

// The series needs no sine or exponential and has no cancellation. It suits times that are short
// for the law.
ImpulseAnswer by_series(const HeldLaw& law, double t) {
  const double d = law.damping * t, k = law.stiffness * t * t;
  double last = 1, before = 0;
  return sum_of(t, [&](int n) {
    before = std::exchange(last, next_term(d, k, last, before, n));
    return last;
  });
}

// The law's eigenvalues: -decay +- the square root of the discriminant.
struct Spectrum {
  explicit Spectrum(const HeldLaw& law)
      : decay(law.damping / 2), discriminant(decay * decay - law.stiffness) {}
  double decay, discriminant;
};

}  // namespace

ImpulseAnswer answer(const HeldLaw& law, double t) {
  if (suits_series(law, t)) return by_series(law, t);
  const Spectrum of(law);
  double value = 0, slope = 0;
  if (of.discriminant < 0) {
    const double turn = std::sqrt(-of.discriminant), left = std::exp(-of.decay * t);
    const double small = turn * t;
    value = left * t * (small < 1e-4 ? 1 - small * small / 6 : std::sin(small) / small);
    slope = left * std::cos(small) - of.decay * value;
  } else {
    const double part = std::sqrt(of.discriminant), fast = of.decay + part;
    const double slow = law.stiffness / fast;
    const double left = std::exp(-slow * t), gone = std::exp(-2 * part * t);
    value = left * (part * t < 1e-8 ? t : -std::expm1(-2 * part * t) / (2 * part));
    slope = part * t > 0.5 ? left * (fast * gone - slow) / (2 * part)
                           : left * (1 + gone) / 2 - of.decay * value;
  }
  const double integral = law.stiffness * t * t > 1
                              ? (1 - slope - law.damping * value) / law.stiffness
                          : law.stiffness == 0 ? (t - value) / law.damping
                                               : never;
  const bool is_soft = law.stiffness * t * t <= 1;  // false for NaN
  if (integral < never || !is_soft) return {integral, value, slope};
  // With low stiffness and strong damping, the series does not converge and both quotients lose
  // digits. Doubles the response at half the time by the addition formulas for h and its integral.
  const ImpulseAnswer half = answer(law, t / 2);
  const double turned = half.slope + law.damping * half.value;
  return {half.integral + turned * half.integral + half.value * half.value, value, slope};
}

ImpulseAnswer KnownAnswers::at(const HeldLaw& law, double t) {
  if (law == HeldLaw{}) return {t * t / 2, t, 1};
  if (!suits_series(law, t)) return answer(law, t);
  if (!(law == law_)) {
    law_ = law;
    known_ = 0;
  }
  double power = 1;
  const ImpulseAnswer sum = sum_of(t, [&](int n) {
    if (n > known_) {
      const double before = n > 1 ? coefficients_[n - 2] : 0;
      coefficients_[n] = next_term(law.damping, law.stiffness, coefficients_[n - 1], before, n);
      known_ = n;
    }
    power *= t;
    return coefficients_[n] * power;
  });
  return std::isfinite(sum.slope) ? sum : answer(law, t);
}

namespace {

HeldMotion ringing_motion(const ServoResponse& servo, const StepperDriver& driver, double angle,
                          double rate, double t) {
  const Jet<double> counted = driver.counted(t);
  const double k = servo.from_angle, c = servo.from_rate;
  const double field = driver.ratio * counted.value + driver.offset;
  HeldMotion motion{{k, c}, angle, 0, 0};
  motion.drift_acceleration = driver.ratio * counted.acceleration;
  motion.drift_rate = driver.ratio * counted.rate - c / k * motion.drift_acceleration;
  motion.rate = rate - motion.drift_rate;
  motion.acceleration = k * (field - angle) - c * rate - motion.drift_acceleration;
  return motion;
}

}  // namespace

HeldMotion held_motion(const ServoResponse& servo, const RigMode& of, std::size_t i, double angle,
                       double rate, double t) {
  if (of.rings && of.driver[i].rings) return ringing_motion(servo, of.driver[i], angle, rate, t);
  const AxisMode& mode = of.axis[i];
  const double free = mode.demand_factor, command = of.command[i];
  HeldMotion motion{{free * servo.from_angle, free * servo.from_rate}, angle, rate, 0};
  motion.acceleration =
      free * (servo.from_command * command - servo.from_angle * angle - servo.from_rate * rate) +
      mode.set_acceleration;
  return motion;
}

// The energy of an oscillator does not grow. Without stiffness, the rate changes by at most the
// first acceleration times the time.
MotionReach reach(const HeldMotion& motion, double end) {
  const double k = motion.law.stiffness;
  if (k > 0) {
    const double spring = (motion.acceleration + motion.law.damping * motion.rate) / k;
    const double rate_most = std::sqrt(spring * spring * k + motion.rate * motion.rate);
    const double turned = std::abs(motion.drift_acceleration) * end;
    const double drift = std::abs(motion.drift_rate) + turned;
    return {motion.angle + spring, rate_most / std::sqrt(k) + end * drift, rate_most + drift};
  }
  const double rate_most = std::abs(motion.rate) + std::abs(motion.acceleration) * end;
  return {motion.angle, end * rate_most, rate_most};
}

namespace {

// The successive times at which the line's slope, a h'(t) + b h(t), is zero.
class Turns {
 public:
  Turns(const MotionLine& line, const HeldMotion& motion) {
    const HeldLaw& law = motion.law;
    const Spectrum of(law);
    const double a = line.by_angle * motion.rate + line.by_rate * motion.acceleration;
    const double b = line.by_angle * (motion.acceleration + law.damping * motion.rate) -
                     line.by_rate * law.stiffness * motion.rate;
    const double with = a * of.decay - b;  // at a turn: a (h'/h + decay) = with
    if (of.discriminant < 0) {
      const double turn = std::sqrt(-of.discriminant);
      if (a == 0 && b == 0) return;
      double phase = std::atan2(a * turn, with);  // turn t, by its tangent
      if (phase <= 0) phase += std::numbers::pi;
      next_ = phase / turn;
      period_ = std::numbers::pi / turn;
      return;
    }
    const double when = a / with;  // the limit for a zero discriminant
    if (!(when > 0)) return;
    const double part = std::sqrt(of.discriminant) * when;
    next_ = part < 1e-5 ? when * (1 + part * part / 3)
            : part < 1  ? std::atanh(part) / part * when
                        : never;
  }

  [[nodiscard]] double next() const { return next_; }
  void pass() { next_ = next_ + period_; }

 private:
  double next_ = never, period_ = never;
};

// A value and its slope.
struct LineValue {
  double value, slope;
};

// An approximate root of the cubic with these values and slopes at 0 and 1.
double guess(const LineValue& first, const LineValue& last) {
  const double rise = last.value - first.value;
  const double square = 3 * rise - 2 * first.slope - last.slope;
  const double cube = first.slope + last.slope - 2 * rise;
  double s = first.value / -rise;
  for (int k = 0; k < 3; ++k) {
    const double value = first.value + s * (first.slope + s * (square + s * cube));
    const double slope = first.slope + s * (2 * square + 3 * s * cube);
    if (!(slope < 0)) break;
    s = std::clamp(s - value / slope, 0.0, 1.0);
  }
  return s;
}

// A value and its first three derivatives.
struct Local {
  double value, slope, curve, third;
};

// The distance to the root by the series of the inverse function, and a bound on its error. The
// terms left out are less than a quarter of the parts of the last term. Both parts vanish together
// only for a straight line.
struct Way {
  double step, doubt;
};
Way way_to_root(const Local& at) {
  const double newton = -at.value / at.slope;
  const double bend = at.curve / (2 * at.slope) * newton;
  if (!(std::abs(bend) < 1.0 / 16)) return {newton, std::abs(newton) / 64};
  const double twist = at.third / (6 * at.slope) * newton * newton;
  const double bent = 2 * bend * bend;
  return {newton * (1 - bend + bent - twist), std::abs(newton) * (bent + std::abs(twist)) / 4};
}

// The first time in (from, to], up to rounding, at which a falling function is not positive. It is
// positive at `from` and not at `to`, with `first` and `last` there. A step with a doubtful error
// goes beyond the estimate by the error, so that it encloses the root. Bisects after two steps that
// do not halve the bracket.
template <class Function>
double root(Function function, double start, double from, LineValue first, double to,
            LineValue last) {
  const double length = to - from;
  first.slope *= length;
  last.slope *= length;
  double t = from + length * guess(first, last);
  int slow = 0;
  for (int k = 0; k < 200; ++k) {
    const double width = to - from;
    const double rounding = std::numeric_limits<double>::epsilon() * (start + to);
    if (width <= rounding) break;
    if (!(t > from && t < to)) t = from + width / 2;
    if (t <= from || t >= to) break;
    const Local at = function(t);
    (at.value > 0 ? from : to) = t;
    slow = to - from > width / 2 ? slow + 1 : 0;
    const Way way = way_to_root(at);
    if (at.slope < 0 && way.doubt <= rounding / 2) {
      return std::clamp(t + way.step + rounding / 2, from, to);
    }
    const double beyond = std::copysign(rounding / 2 + way.doubt, at.value);
    t = slow < 2 && at.slope < 0 ? t + way.step + beyond : from;
  }
  return to;
}

// Whether the line turns at most once within the time: turns are half a period apart.
bool turns_once(const HeldLaw& law, double time) {
  constexpr double pi = std::numbers::pi;
  return -Spectrum(law).discriminant * time * time < pi * pi;
}

// Whether the line's slope is negative by more than the rounding of its terms. A motion that has
// decayed to nearly the smallest double has no reliable slope.
bool falls_clearly(const MotionLine& line, const HeldMotion& motion, const ImpulseAnswer& at,
                   double slope) {
  constexpr double rounding = 1e-12, nothing = 1e-280;
  const HeldLaw& law = motion.law;
  const double rate = std::abs((at.slope + law.damping * at.value) * motion.rate) +
                      std::abs(at.value * motion.acceleration);
  const double acceleration =
      std::abs(at.slope * motion.acceleration) + std::abs(law.stiffness * at.value * motion.rate);
  const double terms = std::abs(line.by_angle) * rate + std::abs(line.by_rate) * acceleration;
  return terms > nothing && slope < -rounding * terms;
}

}  // namespace

double first_crossing(const MotionLine& line, const HeldMotion& motion, double clearly,
                      double start, double end, KnownAnswers& answers) {
  double threshold = 0;
  const auto value_at = [&](const HeldMotion::ServoState& at) {
    return LineValue{line.at(at.angle, at.rate) - threshold,
                     line.by_angle * at.rate + line.by_rate * at.acceleration};
  };
  const auto local = [&](double t) {
    const HeldMotion::ServoState at = motion.after(answers.at(motion.law, t), t);
    const double third = -motion.law.damping * at.acceleration - motion.law.stiffness * at.rate;
    const double fourth = -motion.law.damping * third - motion.law.stiffness * at.acceleration;
    return Local{line.at(at.angle, at.rate) - threshold,
                 line.by_angle * at.rate + line.by_rate * at.acceleration,
                 line.by_angle * at.acceleration + line.by_rate * third,
                 line.by_angle * third + line.by_rate * fourth};
  };
  double from = 0;
  LineValue now = value_at({motion.angle, motion.rate, motion.acceleration});
  if (!(now.value > clearly)) {
    threshold = std::min(0.0, now.value) - clearly;
    now.value -= threshold;
  } else if (turns_once(motion.law, end)) {
    // The common case: by the slopes at its ends, the line has no dip in between.
    const ImpulseAnswer& at_end = answers.at_end(motion.law, end);
    const LineValue last = value_at(motion.after(at_end, end));
    if (last.value > 0 && (now.slope >= 0 || falls_clearly(line, motion, at_end, last.slope))) {
      return never;
    }
    if (!(last.value > 0) && std::isfinite(last.value) && now.slope < 0 && last.slope < 0) {
      return root(local, start, 0, now, end, last);
    }
  }
  if (reach(motion, end).least(line) > clearly) return never;
  Turns turns(line, motion);
  // Between two turns the line is monotonic.
  while (from < end) {
    const double to = std::min(turns.next(), end);
    turns.pass();
    if (to <= from) continue;
    const HeldMotion::ServoState at = motion.after(answers.at(motion.law, to), to);
    const LineValue reached = value_at(at);
    if (!(reached.value > 0)) {
      if (!std::isfinite(reached.value)) return never;
      return root(local, start, from, now, to, reached);
    }
    from = to;
    now = reached;
    if (now.value + threshold > clearly) {
      now.value += threshold;
      threshold = 0;
    }
    const HeldMotion goes_on{motion.law, at.angle, at.rate, at.acceleration};
    if (from < end && reach(goes_on, end - from).least(line) > clearly) return never;
  }
  return never;
}

}  // namespace bbsim::model
