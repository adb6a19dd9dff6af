// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/player.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.hpp"
#include "base/short_number.hpp"

namespace bbsim::design {
namespace {

constexpr double radians_per_degree = 0.017453292519943295;
// avr-gcc refuses an array of more bytes than 32767.
constexpr std::size_t most_rows = 32767 / 4;

constexpr const char* heading =
    R"(// Plays a motion of the plate that `bbsim design` has chosen, and prints a log of it for
// `bbsim fit`. The motion begins after WAIT, with the ball at rest at
)";

constexpr const char* above_table = R"(//
// Set the constants for your rig: pins, pulses, and the scale of the touch screen.
#include <Servo.h>
#include <avr/pgmspace.h>

const int PIN_PHI = 9, PIN_THETA = 10;                  // of the servos
const float LEVEL_PHI = 1500, LEVEL_THETA = 1500;       // us: the pulse at which the plate is level
const float US_PER_DEG_PHI = 10, US_PER_DEG_THETA = 10; // negative if the servo turns the other way
const int PIN_X = A0, PIN_Y = A1;                       // of the touch screen
const float MIDDLE_X = 512, MIDDLE_Y = 512;             // counts at the center of the plate
const float MM_PER_COUNT_X = 0.32, MM_PER_COUNT_Y = 0.32;
const unsigned long WAIT = 5000;                        // ms

)";

constexpr const char* below_table = R"(
Servo servoPhi, servoTheta;
unsigned long start;     // us
unsigned int row = 0;

float angleOf(unsigned int i, byte axis) {
  return (int16_t)pgm_read_word(&TABLE[i][axis]) * DEG_PER_UNIT;
}

void tilt(float phi, float theta) {
  servoPhi.writeMicroseconds(lround(LEVEL_PHI + phi * US_PER_DEG_PHI));
  servoTheta.writeMicroseconds(lround(LEVEL_THETA + theta * US_PER_DEG_THETA));
}

void setup() {
  Serial.begin(115200);
  servoPhi.attach(PIN_PHI);
  servoTheta.attach(PIN_THETA);
  tilt(angleOf(0, 0), angleOf(0, 1));
  delay(WAIT);
  Serial.println("t_ms,phi_deg,theta_deg,x_mm,y_mm");
  start = micros();
}

void loop() {
  if (row >= ROWS || micros() - start < row * PERIOD) return;
  const float phi = angleOf(row, 0), theta = angleOf(row, 1);
  tilt(phi, theta);
  const unsigned long now = micros() - start;
  const float x = (analogRead(PIN_X) - MIDDLE_X) * MM_PER_COUNT_X;
  const float y = (analogRead(PIN_Y) - MIDDLE_Y) * MM_PER_COUNT_Y;
  Serial.print(now / 1000.0, 1);
  Serial.print(',');
  Serial.print(phi, 3);
  Serial.print(',');
  Serial.print(theta, 3);
  Serial.print(',');
  Serial.print(x, 2);
  Serial.print(',');
  Serial.println(y, 2);
  ++row;
}
)";

}  // namespace

std::string player_sketch(const Player& player) {
  const std::size_t rows = player.phi.size();
  if (rows > most_rows) {
    throw InputError("--sketch: found " + std::to_string(rows) + " rows; allowed: at most " +
                     std::to_string(most_rows) +
                     ", which a board's flash holds; use a lower --rate or a shorter --length");
  }
  double largest = 0;
  for (const auto* const angles : {&player.phi, &player.theta}) {
    for (const double angle : *angles)
      largest = std::max(largest, std::abs(angle) / radians_per_degree);
  }
  const bool fine = largest < 32;
  const double per_unit = fine ? 0.001 : 0.01;
  const auto in_units = [&](double angle) {
    return std::to_string(std::lround(angle / radians_per_degree / per_unit));
  };
  std::string text = heading;
  text += "// x = " + short_number(100 * player.ball[0]) +
          " cm, y = " + short_number(100 * player.ball[1]) + " cm.\n";
  text += above_table;
  text += "const unsigned long PERIOD = " + std::to_string(std::lround(1e6 / player.rate)) +
          ";  // us\n";
  text += "const unsigned int ROWS = " + std::to_string(rows) + ";\n";
  text += std::string("const float DEG_PER_UNIT = ") + (fine ? "0.001" : "0.01") + ";\n";
  text += "const int16_t TABLE[ROWS][2] PROGMEM = {  // phi, theta\n";
  constexpr std::size_t pairs_in_a_line = 6;
  for (std::size_t i = 0; i < rows; ++i) {
    text += i % pairs_in_a_line == 0 ? "  {" : " {";
    text += in_units(player.phi[i]) + ", " + in_units(player.theta[i]) + "},";
    if (i % pairs_in_a_line == pairs_in_a_line - 1 || i + 1 == rows) text += "\n";
  }
  return text + "};\n" + below_table;
}

}  // namespace bbsim::design
