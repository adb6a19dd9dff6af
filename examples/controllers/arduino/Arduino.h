// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Arduino on the desktop: the calls of a sketch for this rig, over bbsim's lines of text. A sketch
// that includes this file is a program that bbsim runs as a controller. A board uses the IDE's own.
#pragma once
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

// The rig's wiring: a touch screen of 0.32 mm per count on A0 and A1, which gives 0 if nothing
// touches it; servos on pins 9 (phi) and 10 (theta), level at 1500 us, 0.1 degrees per microsecond.
constexpr int A0 = 0, A1 = 1, phi_pin = 9, theta_pin = 10;
constexpr double metres_per_count = 0.00032;
constexpr double radians_per_microsecond = 0.1 * 3.14159265358979323846 / 180;

struct Board {
  double t = 0, ball[2] = {0, 0};
  bool touched = false;
  int microseconds[14] = {};
};
inline Board board;

inline unsigned long millis() { return static_cast<unsigned long>(std::lround(1000 * board.t)); }
inline int analogRead(int pin) {
  return board.touched ? 512 + static_cast<int>(std::lround(board.ball[pin] / metres_per_count)) : 0;
}

struct Servo {
  void attach(int on) { pin = on, writeMicroseconds(1500); }
  void writeMicroseconds(int us) { board.microseconds[pin] = us; }
  void write(int degrees) { writeMicroseconds(1500 + 10 * (degrees - 90)); }
  int pin = 0;
};

struct SerialPort {  // bbsim prints its lines after "controller: "
  void begin(long) {}
  template <class Any> void print(const Any& any) { std::cerr << any; }
  template <class Any> void println(const Any& any) { std::cerr << any << std::endl; }
};
inline SerialPort Serial;

void setup();
void loop();

inline double angle(int pin) { return (board.microseconds[pin] - 1500) * radians_per_microsecond; }

int main() {
  std::cout.precision(17);
  for (std::string line; std::getline(std::cin, line);) {
    if (line.find("\"protocol\"") != std::string::npos) {  // a run begins
      setup();
      std::cout << "{\"protocol\": 1}" << std::endl;
      continue;
    }
    const char* const t = std::strstr(line.c_str(), "\"t\":");
    const char* const ball = std::strstr(line.c_str(), "\"ball\":[");
    char* next = nullptr;
    board.t = std::strtod(t + 4, nullptr);
    board.touched = ball != nullptr;
    if (board.touched) board.ball[0] = std::strtod(ball + 8, &next);
    if (board.touched) board.ball[1] = std::strtod(next + 1, nullptr);
    loop();
    std::cout << "{\"command\": [" << angle(phi_pin) << ", " << angle(theta_pin) << "]}" << std::endl;
  }
}
