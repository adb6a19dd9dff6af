// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Touch screens. A resistive screen is a network of resistors, so a sketch may drive and read its
// electrodes in any order. There is also a chip that reads a screen by itself.
#include "Adafruit_STMPE610.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

constexpr double pull_up = 35000;  // ohm, of an AVR

bool touched() {
  return board.sample.seen != 0;
}

double limited(double value, double most) {
  return value < 0 ? 0 : value > most ? most : value;
}

// The ball's place on the screen, from 0 at the minus electrode to 1 at the plus electrode.
double share(const bbsim_count_map& map, int axis) {
  return limited(counts_at(map, board.sample.ball[axis]) / full_scale(), 1);
}

// A plate with an electrode at each end, seen from the touched place.
struct Plate {
  int plus, minus;                      // pins
  double to_plus, to_minus;             // ohm
  double conductance = 0, current = 0;  // of the pins that drive it, at 1 V

  void add(int pin, double resistance) {
    const Drive drive = drive_of(pin);
    if (drive == Drive::none) return;
    const double g = 1 / (resistance + (drive == Drive::pull_up ? pull_up : 1e-6));
    conductance += g;
    if (drive != Drive::low) current += g;
  }
  Plate(int plus_pin, int minus_pin, double resistance, double at)
      : plus(plus_pin),
        minus(minus_pin),
        to_plus(resistance * (1 - at)),
        to_minus(resistance * at) {
    add(plus, to_plus);
    add(minus, to_minus);
  }
};

double four_wires(const bbsim_wired_screen& screen, int pin) {
  const bool touch = touched();
  const double at_x = touch ? share(screen.x, 0) : 0.5, at_y = touch ? share(screen.y, 1) : 0.5;
  const Plate plates[2] = {{screen.pins[0], screen.pins[1], screen.resistance[0], at_x},
                           {screen.pins[2], screen.pins[3], screen.resistance[1], at_y}};
  const int own = pin == plates[0].plus || pin == plates[0].minus ? 0 : 1;
  const Plate& plate = plates[own];
  const Plate& other = plates[1 - own];
  // The touch connects the other plate.
  double conductance = plate.conductance, current = plate.current;
  if (touch && other.conductance > 0) {
    const double joint = 1 / (1 / other.conductance + screen.contact);
    conductance += joint;
    current += joint * other.current / other.conductance;
  }
  if (!(conductance > 0)) return screen.untouched / full_scale();
  const double there = current / conductance;
  if (drive_of(pin) != Drive::pull_up) return there;
  const double resistance = pin == plate.plus ? plate.to_plus : plate.to_minus;
  return 1 - (1 - there) * pull_up / (pull_up + resistance);
}

double five_wires(const bbsim_wired_screen& screen, int pin) {
  if (pin != screen.pins[4]) {
    fail("pin %s reads a corner of a screen of five wires; allowed: its sense electrode",
         pin_name(pin));
  }
  if (!touched()) return drive_of(pin) == Drive::pull_up ? 1 : screen.untouched / full_scale();
  double corner[4];
  for (int i = 0; i < 4; ++i) {
    const Drive drive = drive_of(screen.pins[i]);
    if (drive == Drive::none || drive == Drive::pull_up) {
      fail(
          "a screen of five wires is read while pin %s drives nothing; allowed: all corners at "
          "HIGH "
          "or LOW",
          pin_name(screen.pins[i]));
    }
    corner[i] = drive == Drive::high ? 1 : 0;
  }
  const double right = share(screen.x, 0), up = share(screen.y, 1);
  return up * ((1 - right) * corner[0] + right * corner[1]) +
         (1 - up) * ((1 - right) * corner[2] + right * corner[3]);
}

}  // namespace

void require_plate(int plus, int minus) {
  const bbsim_wired_screen& screen = board.wiring.screen;
  if (screen.kind != bbsim_four_wires) return;
  int plates[2] = {-1, -1};  // of the two pins
  for (int i = 0; i < 4; ++i) {
    if (screen.pins[i] == plus) plates[0] = i / 2;
    if (screen.pins[i] == minus) plates[1] = i / 2;
  }
  if (plates[0] == plates[1] || plates[0] < 0 || plates[1] < 0) return;
  board.misfit = true;
  char first[16] = "";
  snprintf(first, sizeof first, "%s", pin_name(plus));
  fail(
      "screen.four_wire: TouchScreen takes pins %s and %s for one plate of the screen, and the "
      "wiring connects them to both; allowed: TouchScreen(x_plus, y_plus, x_minus, y_minus), in "
      "this order",
      first, pin_name(minus));
}

double counts_at(const bbsim_count_map& map, double position) {
  return map.counts[0] + (position - map.position[0]) * (map.counts[1] - map.counts[0]) /
                             (map.position[1] - map.position[0]);
}

// The place of a pin among the screen's; -1 for other pins.
static int place_of(int pin) {
  const bbsim_wired_screen& screen = board.wiring.screen;
  const int count = screen.kind == bbsim_four_wires   ? 4
                    : screen.kind == bbsim_five_wires ? 5
                    : screen.kind == bbsim_voltages   ? 2
                                                      : 0;
  int at = 0;
  while (at < count && screen.pins[at] != pin) ++at;
  return at < count ? at : -1;
}

bool is_of_screen(int pin) {
  return place_of(pin) >= 0;
}

bool screen_reads(int pin, double& level) {
  const bbsim_wired_screen& screen = board.wiring.screen;
  const int at = place_of(pin);
  if (at < 0) return false;
  if (screen.kind == bbsim_four_wires) {
    level = four_wires(screen, pin);
  } else if (screen.kind == bbsim_five_wires) {
    level = five_wires(screen, pin);
  } else if (!touched()) {
    level = screen.untouched / full_scale();
  } else {
    level = counts_at(at == 0 ? screen.x : screen.y, board.sample.ball[at]) / full_scale();
  }
  return true;
}

}  // namespace bbsim_board

using namespace bbsim_board;

// Reading a register takes a byte for its address, and one or two for its value.
void Adafruit_STMPE610::access(int registers) const {
  for (int i = 0; i < registers; ++i) {
    if (!over_wire_) {
      over_spi(3);
      continue;
    }
    over_wire(1);
    over_wire(2);
  }
}

void Adafruit_STMPE610::require_chip() const {
  if (board.wiring.screen.kind == bbsim_stmpe610) return;
  fail(
      "Adafruit_STMPE610: the wiring has no such chip; add screen: {chip: stmpe610, "
      "...}");
}

bool Adafruit_STMPE610::begin(uint8_t) {
  require_chip();
  access(20);
  read_ = now();
  return true;
}

bool Adafruit_STMPE610::touched() {
  require_chip();
  access(1);
  return ::bbsim_board::touched();
}

uint8_t Adafruit_STMPE610::bufferSize() {
  require_chip();
  access(1);
  const long long interval = nanoseconds(board.wiring.screen.interval);
  // A screen that is not touched gives no points.
  if (!::bbsim_board::touched()) return 0;
  const long long points = now() / interval - read_ / interval;
  return static_cast<uint8_t>(points > 128 ? 128 : points);
}

void Adafruit_STMPE610::readData(uint16_t* x, uint16_t* y, uint8_t* z) {
  const long long interval = nanoseconds(board.wiring.screen.interval);
  const long long left = now() / interval - 128;
  read_ = (read_ / interval > left ? read_ / interval + 1 : left + 1) * interval;
  access(4);
  if (!::bbsim_board::touched()) {
    *x = *y = 0;
    *z = 0;
    return;
  }
  const bbsim_wired_screen& screen = board.wiring.screen;
  *x = static_cast<uint16_t>(lround(limited(counts_at(screen.x, board.sample.ball[0]), 4095)));
  *y = static_cast<uint16_t>(lround(limited(counts_at(screen.y, board.sample.ball[1]), 4095)));
  *z = 64;
}

void Adafruit_STMPE610::writeRegister8(uint8_t address, uint8_t value) {
  require_chip();
  access(1);
  if (address == STMPE_FIFO_STA && (value & STMPE_FIFO_STA_RESET) != 0) read_ = now();
}

TS_Point Adafruit_STMPE610::getPoint() {
  // Reads all waiting points and returns the last.
  do {
    uint16_t x = 0, y = 0;
    uint8_t z = 0;
    readData(&x, &y, &z);
    last_ = TS_Point(static_cast<int16_t>(x), static_cast<int16_t>(y), z);
  } while (bufferSize() > 0);
  return last_;
}
