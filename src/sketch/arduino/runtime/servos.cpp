// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Pulses of servos: from Servo.h, and from a PCA9685.
#include "Adafruit_PWMServoDriver.h"
#include "Servo.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

void pulse(int axis, double seconds) {
  const bbsim_wired_servo& servo = board.wiring.servos[axis];
  board.command[axis] = servo.scale * (seconds - servo.level);
}

int axis_at_pin(int pin) {
  for (int axis = 0; axis < 3; ++axis) {
    if (board.wiring.servos[axis].pin == pin) return axis;
  }
  for (size_t i = 0; i < board.wiring.ignored_count; ++i) {
    if (board.wiring.ignored[i] == pin) return -1;
  }
  fail(
      "Servo.attach(%s): no servo is wired to pin %s; the wiring's servos name the pins of phi and "
      "theta or of legs, and in `ignored` those of others",
      pin_name(pin), pin_name(pin));
  return -1;
}

constexpr int address_of_driver = 0x40;
constexpr double nominal_oscillator = 25e6;  // Hz

}  // namespace
}  // namespace bbsim_board

using namespace bbsim_board;

// As on the boards, a limit is one byte in steps of 4 us.
uint8_t Servo::attach(int pin, int min, int max) {
  if (pin < 0 || pin >= pins) {
    fail("Servo.attach(%d): there is no such pin; allowed: 0 to 53 and A0 to A15", pin);
  }
  pin_ = pin;
  axis_ = axis_at_pin(pin);
  min_ = static_cast<int8_t>((MIN_PULSE_WIDTH - min) / 4);
  max_ = static_cast<int8_t>((MAX_PULSE_WIDTH - max) / 4);
  send();
  return static_cast<uint8_t>(pin);
}

void Servo::detach() {
  pin_ = -1;  // a servo without pulses keeps its angle
}

void Servo::write(int value) {
  if (value < MIN_PULSE_WIDTH) {
    value = static_cast<int>(map(constrain(value, 0, 180), 0, 180, least(), most()));
  }
  writeMicroseconds(value);
}

void Servo::writeMicroseconds(int us) {
  us_ = constrain(us, least(), most());
  send();
}

int Servo::read() const {
  return static_cast<int>(map(us_ + 1, least(), most(), 0, 180));
}

void Servo::send() {
  spend(board.costs.servo);
  if (pin_ >= 0 && axis_ >= 0) pulse(axis_, us_ * 1e-6);
}

bool Adafruit_PWMServoDriver::begin(uint8_t prescale) {
  if (address_ != address_of_driver) {
    fail("Adafruit_PWMServoDriver: nothing answers at address 0x%02X; allowed: the one at 0x40",
         address_);
  }
  oscillator_ = nominal_oscillator;
  reset();
  if (prescale != 0) {
    setExtClk(prescale);
  } else {
    setPWMFreq(1000);
  }
  return true;
}

void Adafruit_PWMServoDriver::reset() {
  over_wire(2);
  delay(10);
}

void Adafruit_PWMServoDriver::setPWMFreq(float frequency) {
  frequency = frequency < 1 ? 1 : frequency > 3500 ? 3500 : frequency;
  float scale = static_cast<float>(oscillator_ / (frequency * 4096.0) + 0.5 - 1);
  scale = scale < 3 ? 3 : scale > 255 ? 255 : scale;
  prescale_ = static_cast<uint8_t>(scale);
  for (int i = 0; i < 4; ++i) over_wire(2);
  delay(5);
}

uint8_t Adafruit_PWMServoDriver::readPrescale() {
  over_wire(2);
  return prescale_;
}

uint8_t Adafruit_PWMServoDriver::setPWM(uint8_t channel, uint16_t on, uint16_t off) {
  over_wire(5);
  // A channel that is always on or off has no pulse. Otherwise it is on for this many of 4096
  // steps.
  const int steps = (off - on) & 4095;
  if (((on | off) & 4096) != 0 || steps == 0) return 0;
  bool wired = channel < 16 && (board.wiring.ignored_channels >> channel & 1U) != 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (board.wiring.servos[axis].channel != channel) continue;
    pulse(axis, steps * (prescale_ + 1) / board.wiring.oscillator);
    wired = true;
  }
  if (!wired) {
    fail(
        "Adafruit_PWMServoDriver.setPWM(%d, ...): no servo is wired to channel %d; the wiring's "
        "servos name the channels of phi and theta or of legs, and in `ignored_channels` those of "
        "others",
        channel, channel);
  }
  return 0;
}

void Adafruit_PWMServoDriver::setPin(uint8_t channel, uint16_t value, bool invert) {
  value = value > 4095 ? 4095 : value;
  if (invert) value = static_cast<uint16_t>(4095 - value);
  if (value == 4095) {
    setPWM(channel, 4096, 0);
  } else if (value == 0) {
    setPWM(channel, 0, 4096);
  } else {
    setPWM(channel, 0, value);
  }
}

void Adafruit_PWMServoDriver::writeMicroseconds(uint8_t channel, uint16_t us) {
  const double step = 1000000.0 * (readPrescale() + 1) / oscillator_;
  setPWM(channel, 0, static_cast<uint16_t>(us / step));
}
