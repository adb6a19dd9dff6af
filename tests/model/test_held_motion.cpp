// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Servos under a held command in closed form: the motion, and when a linear function of it falls.
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "model/servo/held_motion.hpp"

namespace bbsim_test::test_held_motion {

using namespace bbsim::model;

namespace {

// Springs and dampers from none to stiff; under-, over- and critically damped.
const std::vector<HeldLaw> laws{
    {0, 0},       {0, 1e-7},   {0, 20},     {0, 1e4},      {1e-8, 0},     {1e-8, 10},
    {100, 0},     {100, 10},   {100, 20},   {100, 20.001}, {100, 19.999}, {100, 500},
    {986.96, 50}, {4e6, 4000}, {4e6, 3200}, {4e6, 1e5},    {1e-3, 1000}};

// h, h' and the integral of h at t, in 64 bits: a series over a short time, then doubling.
struct Doubled {
  long double integral, value, slope;
};
Doubled by_doubling(const HeldLaw& law, double time) {
  const long double d = law.damping, k = law.stiffness;
  int doublings = 0;
  long double t = time;
  const auto size = [&] { return std::max(d * t, std::sqrt(k) * t); };
  while (size() > 1) {
    t /= 2;
    ++doublings;
  }
  // h'' = -d h' - k h, term by term.
  Doubled at{0, 0, 0};
  long double before = 0, now = 1;
  for (int n = 1; n < 60; ++n) {
    at.slope += n * now;
    at.value += now * t;
    at.integral += now * t * t / (n + 1);
    const long double next = -(d * t * n * now + k * t * t * before) / ((n + 1.0L) * n);
    before = now;
    now = next;
  }
  for (int i = 0; i < doublings; ++i) {
    const long double whole = at.slope + d * at.value;
    at = {at.integral + whole * at.integral + at.value * at.value, at.value * (at.slope + whole),
          at.slope * at.slope - k * at.value * at.value};
  }
  return at;
}

}  // namespace

TEST_CASE("the impulse response of a held servo, for any spring and damper") {
  const bool known = GENERATE(false, true);
  KnownAnswers answers;
  for (const HeldLaw& law : laws) {
    for (const double t : {1e-9, 1e-5, 1e-3, 0.01, 0.0173, 0.3, 2.0}) {
      INFO(law.stiffness << " " << law.damping << " " << t << ", known: " << known);
      const ImpulseAnswer found = known ? answers.at(law, t) : answer(law, t);
      const Doubled wanted = by_doubling(law, t);
      // Doubling loses some digits if the motion has many periods, of its 64 bits.
      const double turns = 1 + std::sqrt(law.stiffness) * t;
      const double rounding = 20 * 2.2e-16 * turns;
      const double time = std::min({t, law.stiffness > 0 ? 1 / std::sqrt(law.stiffness) : t,
                                    law.damping > 0 ? 1 / law.damping : t});
      CHECK(std::abs(found.slope - double(wanted.slope)) <= rounding);
      CHECK(std::abs(found.value - double(wanted.value)) <=
            rounding * std::max(time, std::abs(found.value)));
      CHECK(std::abs(found.integral - double(wanted.integral)) <=
            rounding * std::max(time * time, 4 * std::abs(found.integral)));
    }
  }
}

TEST_CASE("a held servo follows its equation in every mode") {
  const ServoResponse servo{986.96, 986.96, 50.27};
  const auto in = [](const AxisMode& mode) {
    RigMode all;
    all.axis[0] = mode;
    all.command[0] = 0.2;
    return all;
  };
  AxisMode free, pushed, at_rate;
  pushed.demand_factor = at_rate.demand_factor = 0;
  pushed.set_acceleration = -12;
  for (const AxisMode& mode : {free, pushed, at_rate}) {
    const HeldMotion motion = held_motion(servo, in(mode), 0, 0.05, -1.3, 0);
    for (const double t : {0.0, 0.004, 0.02, 0.11}) {
      const HeldMotion::ServoState at = motion.after(t);
      const double demand = 986.96 * (0.2 - at.angle) - 50.27 * at.rate;
      CHECK(at.acceleration ==
            Approx(mode.demand_factor * demand + mode.set_acceleration).margin(1e-10));
    }
  }
  // A ramp and a parabola.
  CHECK(held_motion(servo, in(at_rate), 0, 0.05, -1.3, 0).after(0.1).angle == Approx(-0.08));
  CHECK(held_motion(servo, in(pushed), 0, 0.05, -1.3, 0).after(0.1).angle == Approx(-0.14));
}

TEST_CASE("a shaft that rings follows its equation about a field in motion") {
  const ServoResponse servo{1600, 1600, 12};
  RigMode mode;
  mode.rings = mode.driver[1].rings = true;
  mode.driver[1] = {true, 0.3, 0.1, -0.4, 7, 1, -0.02};
  const HeldMotion motion = held_motion(servo, mode, 1, 0.05, -1.3, 0.35);
  for (const double t : {0.0, 0.004, 0.02, 0.11, 3.0}) {
    const HeldMotion::ServoState at = motion.after(t);
    const double s = t + 0.05, field = 0.1 - 0.02 + s * (-0.4 + 3.5 * s);
    CHECK(at.acceleration == Approx(1600 * (field - at.angle) - 12 * at.rate).margin(1e-9));
    // The rate is the angle's slope, and the bounds hold.
    const double h = 1e-6,
                 slope = (motion.after(t + h).angle - motion.after(t - h).angle) / (2 * h);
    CHECK(at.rate == Approx(slope).margin(1e-7));
    const MotionReach most = reach(motion, t);
    CHECK(std::abs(at.angle - most.centre) <= most.angle_most * (1 + 1e-12));
    CHECK(std::abs(at.rate) <= most.rate_most * (1 + 1e-12));
  }
}

TEST_CASE("the first fall of a linear function in a held motion is found") {
  const auto value = [](const MotionLine& line, const HeldMotion& motion, double t) {
    const HeldMotion::ServoState at = motion.after(t);
    return line.at(at.angle, at.rate);
  };
  int falls = 0, dips = 0;
  KnownAnswers answers;  // for one law after the other
  for (const HeldLaw& law : laws) {
    for (const double rate : {-2.0, 0.0, 0.7}) {
      for (const double acceleration : {-30.0, 0.0, 8.0}) {
        const HeldMotion motion{law, 0.1, rate, acceleration};
        for (const MotionLine& line :
             {MotionLine{0.14, -1, 0}, MotionLine{0.2, 1, 0}, MotionLine{0.9, 0, -1},
              MotionLine{2.05, 0, 1}, MotionLine{5, -20, -1}, MotionLine{1, 3, 0.2}}) {
          constexpr double end = 0.8;
          const double at = first_crossing(line, motion, 1e-12, 0, end, answers);
          INFO(law.stiffness << " " << law.damping << ": " << rate << " " << acceleration << ": "
                             << line.constant << " " << line.by_angle << " " << line.by_rate);
          // Dense sampling finds no earlier fall.
          const double until = std::min(at, end);
          constexpr int looks = 4000;
          double least = std::numeric_limits<double>::infinity();
          for (int i = 0; i < looks; ++i)
            least = std::min(least, value(line, motion, until * i / looks));
          CHECK(least >= -1e-9);
          if (at > end) continue;
          ++falls;
          CHECK(std::abs(value(line, motion, at)) <= 1e-9);
          // Up to rounding of the time and of the terms of the line.
          const HeldMotion::ServoState there = motion.after(at);
          const double slope = line.by_angle * there.rate + line.by_rate * there.acceleration;
          const double turns = 1 + std::sqrt(law.stiffness) * at;
          const double size =
              std::abs(line.constant) +
              std::abs(line.by_angle) * (0.1 + std::abs(there.angle) + std::abs(rate) * at) +
              std::abs(line.by_rate) * (std::abs(rate) + std::abs(acceleration) * at);
          CHECK(std::abs(value(line, motion, at)) <=
                20 * 2.2e-16 * turns * (size + std::abs(slope) * at));
          CHECK(value(line, motion, at * (1 + 1e-9) + 1e-12) <= 0);
          dips += value(line, motion, end) > 0 ? 1 : 0;
        }
      }
    }
  }
  CHECK(falls > 100);
  CHECK(dips > 10);  // lines that are positive again at the end
}

TEST_CASE("a dip is found even if it has died away completely by the end") {
  KnownAnswers answers;
  const double frequency = GENERATE(100.0, 740.0, 760.0, 2000.0, 1e5);
  const double damping = GENERATE(0.7, 1.0, 1.01, 3.0);
  // A command that jumps by a radian: from rest the rate rises to its limit and beyond.
  const HeldLaw law{frequency * frequency, 2 * damping * frequency};
  const HeldMotion motion{law, 0, 0, law.stiffness};
  const MotionLine below_limit{1, 0, -1};
  for (const double end : {0.05, 0.5, 1.0, 10.0}) {
    CAPTURE(frequency, damping, end);
    const double at = first_crossing(below_limit, motion, 1e-12, 0, end, answers);
    REQUIRE(at < end);
    CHECK(motion.after(at).rate == Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("a line that starts at its fall waits until it was clearly above, or is below") {
  const auto fall = [](const MotionLine& line, const HeldMotion& motion, double start) {
    KnownAnswers answers;
    return first_crossing(line, motion, 1e-12, start, 1, answers);
  };
  // Released from a rate limit, the rate falls immediately.
  const HeldMotion slows{{100, 20}, 0, 1, -3};
  const MotionLine at_limit{1, 0, -1};
  CHECK(std::isinf(fall(at_limit, slows, 0)));
  // A growing rate has clearly fallen.
  const HeldMotion grows{{0, 0}, 0, 1, 3};
  CHECK(fall(at_limit, grows, 0) == Approx(1e-12 / 3).epsilon(1e-3));
  // Up first, then back: it falls when it passes zero again.
  const HeldMotion returns{{0, 0}, 0, 1, -4};
  const MotionLine angle{0, 1, 0};
  CHECK(fall(angle, returns, 0) == Approx(0.5).epsilon(1e-14));
  // Times count from the piece's start, so it is found up to rounding of the time itself.
  CHECK(fall({0.25, -1, 0}, {{0, 0}, 0, 1, 0}, 1e6) == Approx(0.25).epsilon(1e-9));
}

}  // namespace bbsim_test::test_held_motion
