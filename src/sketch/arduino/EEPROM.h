// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// EEPROM.h: cells of one byte. A run starts with the content of the wiring's file and does not save
// its writes.
#pragma once

#include "Arduino.h"

namespace bbsim_board {
unsigned char read_cell(int address);
void write_cell(int address, unsigned char value);
int cells();
}  // namespace bbsim_board

struct EEPROMCell {
  int address;
  operator uint8_t() const { return bbsim_board::read_cell(address); }
  EEPROMCell& operator=(uint8_t value) {
    if (bbsim_board::read_cell(address) != value) bbsim_board::write_cell(address, value);
    return *this;
  }
};

class EEPROMClass {
 public:
  EEPROMCell operator[](int address) { return {address}; }
  uint8_t read(int address) const { return bbsim_board::read_cell(address); }
  void write(int address, uint8_t value) { bbsim_board::write_cell(address, value); }
  void update(int address, uint8_t value) { EEPROMCell{address} = value; }
  int length() const { return bbsim_board::cells(); }

  template <class Any>
  Any& get(int address, Any& into) const {
    auto* const bytes = reinterpret_cast<uint8_t*>(&into);
    for (size_t i = 0; i < sizeof into; ++i) bytes[i] = read(address + static_cast<int>(i));
    return into;
  }
  template <class Any>
  const Any& put(int address, const Any& from) {
    const auto* const bytes = reinterpret_cast<const uint8_t*>(&from);
    for (size_t i = 0; i < sizeof from; ++i) update(address + static_cast<int>(i), bytes[i]);
    return from;
  }

  // For boards that keep their EEPROM in flash memory.
  bool begin(size_t) { return true; }
  bool commit() { return true; }
  void end() {}
};
inline EEPROMClass EEPROM;
