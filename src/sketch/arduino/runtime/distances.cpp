// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Distance sensors: ultrasonic ones with a trigger and an echo pin, such as the HC-SR04, and the
// time-of-flight chip VL53L0X.
#include <math.h>

#include "NewPing.h"
#include "VL53L0X.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

constexpr double speed_of_sound = 343;         // m/s, at 20 degrees C
constexpr Nanoseconds burst = 450 * 1000;      // from the end of the trigger to the echo pin's rise
constexpr Nanoseconds no_echo = 38 * 1000000;  // how long the pin stays high without an echo

struct Echo {
  bool high;  // the trigger
  Nanoseconds begins, ends;
} echoes[2];

// A standard normal number. Runs with the same seed draw the same ones.
double normal() {
  static unsigned long long state = 0x9E3779B97F4A7C15ULL * board.wiring.seed;
  const auto uniform = [] {  // SplitMix64
    unsigned long long z = state += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  };
  const double size = sqrt(-2 * log(1 - uniform()));
  return size * cos(TWO_PI * uniform());
}

// What a sensor measures now, m; below 0 if it does not see the ball.
double measure(int axis) {
  const bbsim_wired_distance& sensor = board.wiring.distances[axis];
  const double noise = sensor.noise > 0 ? sensor.noise * normal() : 0;
  const double measured = sensor.offset + board.sample.ball[axis] + noise;
  const double distance = measured < sensor.blind ? sensor.blind : measured;
  return board.sample.seen != 0 && distance <= sensor.range ? distance : -1;
}

void send_burst(int axis) {
  Echo& echo = echoes[axis];
  if (board.now < echo.ends) return;  // still busy
  echo.begins = board.now + burst;
  const double distance = measure(axis);
  echo.ends = echo.begins + (distance >= 0 ? nanoseconds(2 * distance / speed_of_sound) : no_echo);
}

// The axis whose sensor has this echo pin; -1: none.
int axis_of_echo(int pin) {
  for (int axis = 0; axis < 2; ++axis) {
    if (pin >= 0 && board.wiring.distances[axis].echo == pin) return axis;
  }
  return -1;
}

}  // namespace

void trigger_distance(int pin, bool high) {
  for (int axis = 0; axis < 2; ++axis) {
    if (board.wiring.distances[axis].trigger != pin) continue;
    if (echoes[axis].high && !high) send_burst(axis);
    echoes[axis].high = high;
  }
}

bool distance_reads(int pin, double& level) {
  const int axis = axis_of_echo(pin);
  if (axis < 0) return false;
  level = board.now >= echoes[axis].begins && board.now < echoes[axis].ends ? 1 : 0;
  return true;
}

bool is_trigger(int pin) {
  return board.wiring.distances[0].trigger == pin || board.wiring.distances[1].trigger == pin;
}

}  // namespace bbsim_board

using namespace bbsim_board;

unsigned long pulseIn(int pin, int level, unsigned long timeout) {
  const int axis = axis_of_echo(pin);
  if (axis < 0) {
    fail(
        "pulseIn(%s): no distance sensor is wired to pin %s; add it to the wiring: distances: {x: "
        "{trigger: PIN, echo: %s, offset: LENGTH}}",
        pin_name(pin), pin_name(pin), pin_name(pin));
    return 0;  // to a global variable's constructor
  }
  if (level == LOW) {
    fail("pulseIn(%s, LOW): allowed: HIGH, the echo", pin_name(pin));
    return 0;
  }
  const Echo& echo = echoes[axis];
  const Nanoseconds until = board.now + static_cast<Nanoseconds>(timeout) * 1000;
  if (board.now > echo.begins || echo.ends > until) {
    spend(until - board.now);
    return 0;
  }
  const Nanoseconds length = echo.ends - echo.begins;
  spend(echo.ends - board.now);
  return static_cast<unsigned long>(length / 1000);
}

unsigned NewPing::ping(unsigned most_cm) {
  pinMode(trigger_, OUTPUT);
  digitalWrite(trigger_, LOW);
  delayMicroseconds(4);
  digitalWrite(trigger_, HIGH);
  delayMicroseconds(10);
  digitalWrite(trigger_, LOW);
  const unsigned most = (most_cm == 0 ? most_cm_ : most_cm) * US_ROUNDTRIP_CM;
  const unsigned long us = pulseIn(echo_, HIGH, most + 1000UL);
  return us > most ? NO_ECHO : static_cast<unsigned>(us);
}

unsigned long NewPing::ping_median(uint8_t count, unsigned most_cm) {
  unsigned found[256];
  int heard = 0;
  for (int i = 0; i < count; ++i) {
    if (i > 0) delay(29);  // for earlier echoes to fade
    const unsigned us = ping(most_cm);
    if (us != NO_ECHO) found[heard++] = us;
  }
  std::sort(found, found + heard);
  return heard == 0 ? NO_ECHO : found[heard / 2];
}

bool VL53L0X::init(bool) {
  if (board.wiring.distances[0].chip == 0 && board.wiring.distances[1].chip == 0) {
    fail(
        "VL53L0X: nothing answers at address 0x29; allowed: a wiring with distances: {x: {chip: "
        "vl53l0x, offset: LENGTH}}");
  }
  delay(40);
  return true;
}

bool VL53L0X::setMeasurementTimingBudget(uint32_t us) {
  if (us < 20000) return false;
  budget_us_ = us;
  return true;
}

void VL53L0X::startContinuous(uint32_t period_ms) {
  const uint32_t period_us = 1000 * period_ms;
  period_us_ = period_us > budget_us_ ? period_us : budget_us_;
  next_ = now() + 1000LL * budget_us_;
}

uint16_t VL53L0X::readRangeSingleMillimeters() {
  startContinuous(0);
  return readRangeContinuousMillimeters();
}

uint16_t VL53L0X::readRangeContinuousMillimeters() {
  if (next_ == 0) init();  // which fails without the chip
  if (next_ > now()) spend(next_ - now());
  over_wire(4);
  const long long period = 1000LL * period_us_;
  while (next_ <= now()) next_ += period;
  const double distance = measure(board.wiring.distances[0].chip != 0 ? 0 : 1);
  return distance < 0 ? 8190 : static_cast<uint16_t>(lround(1000 * distance));
}
