// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Other functions of Arduino.h: random numbers, numbers as text, the EEPROM, the buses.
#include "EEPROM.h"
#include "Wire.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

// The generator of avr-libc: x = 16807 x mod (2^31 - 1).
long seed = 1;

long next_random() {
  seed = static_cast<long>(16807LL * (seed == 0 ? 123459876 : seed) % 2147483647LL);
  return seed;
}

}  // namespace

unsigned char& cell(int address) {
  if (address < 0 || static_cast<size_t>(address) >= board.wiring.eeprom_size) {
    fail("EEPROM: there is no address %d; allowed: 0 to %zu (the wiring's eeprom.size)", address,
         board.wiring.eeprom_size - 1);
    static unsigned char none;  // fail() returns to a global variable's constructor
    return none = 255;
  }
  return const_cast<unsigned char*>(board.wiring.eeprom)[address];
}

unsigned char read_cell(int address) {
  return cell(address);
}

void write_cell(int address, unsigned char value) {
  cell(address) = value;
  spend(board.costs.eeprom_write);
}

void over_wire(int bytes) {
  const long long bits = 9LL * (bytes + 1) + 2;
  spend(board.costs.wire + bits * 1000000000LL / Wire.clock_rate());
}

void over_spi(int bytes) {
  spend(bytes * (board.costs.spi + 8000));  // at 1 MHz
}

int cells() {
  return static_cast<int>(board.wiring.eeprom_size);
}

char* digits_of(unsigned long long value, int base, char ten, char* end) {
  *--end = '\0';
  do {
    const auto digit = static_cast<int>(value % static_cast<unsigned long long>(base));
    *--end = static_cast<char>(digit < 10 ? '0' + digit : ten + digit - 10);
    value /= static_cast<unsigned long long>(base);
  } while (value > 0);
  return end;
}

}  // namespace bbsim_board

using namespace bbsim_board;

long random() {
  return next_random();
}

long random(long most) {
  return most == 0 ? 0 : next_random() % most;
}

long random(long least, long most) {
  return least >= most ? least : random(most - least) + least;
}

void randomSeed(unsigned long value) {
  if (value != 0) seed = static_cast<long>(value % 2147483647UL);
}

char* dtostrf(double value, signed char width, unsigned char digits, char* into) {
  sprintf(into, "%*.*f", width, digits, value);
  return into;
}

char* ultoa(unsigned long value, char* into, int base) {
  char digits[8 * sizeof value + 1];
  return strcpy(into, digits_of(value, base, 'a', digits + sizeof digits));
}

char* ltoa(long value, char* into, int base) {
  if (value >= 0 || base != 10) return ultoa(static_cast<unsigned long>(value), into, base);
  *into = '-';
  ultoa(0UL - static_cast<unsigned long>(value), into + 1, base);
  return into;
}
