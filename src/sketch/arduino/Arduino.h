// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Arduino.h for bbsim's board (docs/how-to/arduino.md): pins are numbered as on a Mega, int has 32
// bits and double has 64.
#pragma once

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

#include "bbsim_board.h"

// The C library of boards lacks most of these names, and sketches use them for variables.
#define y0 sketch_y0
#define y1 sketch_y1
#define yn sketch_yn
#define j0 sketch_j0
#define j1 sketch_j1
#define jn sketch_jn
#define gamma sketch_gamma
#define index sketch_index
#define time sketch_time
#define clock sketch_clock
#define timezone sketch_timezone
#define daylight sketch_daylight
#define random sketch_random
#define round sketch_round
#define exit sketch_exit

typedef bool boolean;
typedef uint8_t byte;
typedef unsigned int word;

enum : uint8_t { LOW = 0, HIGH = 1 };
enum : uint8_t { INPUT = 0, OUTPUT = 1, INPUT_PULLUP = 2 };
enum : uint8_t { A0 = 54, A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, A13, A14, A15 };
enum : uint8_t { LED_BUILTIN = 13, SDA = 20, SCL = 21, MISO = 50, MOSI = 51, SCK = 52, SS = 53 };
enum { DEFAULT = 1, INTERNAL = 3, EXTERNAL = 0, AR_DEFAULT = 0 };
enum { LSBFIRST = 0, MSBFIRST = 1 };
enum { DEC = 10, HEX = 16, OCT = 8, BIN = 2 };

#define PI 3.1415926535897932384626433832795
#define HALF_PI 1.5707963267948966192313216916398
#define TWO_PI 6.283185307179586476925286766559
#define DEG_TO_RAD 0.017453292519943295769236907684886
#define RAD_TO_DEG 57.295779513082320876798154814105
#define EULER 2.718281828459045235360287471352

#define constrain(value, low, high) \
  ((value) < (low) ? (low) : ((value) > (high) ? (high) : (value)))
#define radians(degrees) ((degrees)*DEG_TO_RAD)
#define degrees(radians) ((radians)*RAD_TO_DEG)
#define sq(x) ((x) * (x))
#define lowByte(w) (static_cast<uint8_t>((w)&0xff))
#define highByte(w) (static_cast<uint8_t>((w) >> 8))
#define bit(b) (1UL << (b))
#define bitRead(value, b) (((value) >> (b)) & 0x01)
#define bitSet(value, b) ((value) |= (1UL << (b)))
#define bitClear(value, b) ((value) &= ~(1UL << (b)))
#define bitToggle(value, b) ((value) ^= (1UL << (b)))
#define bitWrite(value, b, to) ((to) ? bitSet(value, b) : bitClear(value, b))
#define word(...) makeWord(__VA_ARGS__)

// The core's are macros: the result has the common type, and is b unless the comparison holds.
// Without decay, the type of equal ones would be a reference to a parameter.
template <class Left, class Right>
constexpr auto min(Left a, Right b) -> std::decay_t<decltype(a < b ? a : b)> {
  return a < b ? a : b;
}
template <class Left, class Right>
constexpr auto max(Left a, Right b) -> std::decay_t<decltype(a > b ? a : b)> {
  return a > b ? a : b;
}
// The core rounds to whole numbers, which print without decimals.
constexpr long sketch_round(double x) {
  return x >= 0 ? static_cast<long>(x + 0.5) : static_cast<long>(x - 0.5);
}
namespace std {
using ::sketch_round;  // std::round, by the macro
}
using std::abs;
constexpr unsigned abs(unsigned value) {
  return value;
}
constexpr unsigned long abs(unsigned long value) {
  return value;
}
using std::isfinite;
using std::isinf;
using std::isnan;

constexpr word makeWord(word value) {
  return value;
}
constexpr word makeWord(byte high, byte low) {
  return static_cast<word>(high << 8 | low);
}
// Computes with integers, as on the boards.
constexpr long map(long value, long from_low, long from_high, long to_low, long to_high) {
  return (value - from_low) * (to_high - to_low) / (from_high - from_low) + to_low;
}

long random();
long random(long most);
long random(long least, long most);
void randomSeed(unsigned long value);

unsigned long millis();
unsigned long micros();
void delay(unsigned long ms);
void delayMicroseconds(unsigned int us);
void yield();

[[noreturn]] void sketch_exit(int status);

void pinMode(int pin, int mode);
void digitalWrite(int pin, int level);
int digitalRead(int pin);
int analogRead(int pin);
// Of the echo of a distance sensor, us; 0 if it does not end within the timeout (us).
unsigned long pulseIn(int pin, int level, unsigned long timeout = 1000000UL);
inline unsigned long pulseInLong(int pin, int level, unsigned long timeout = 1000000UL) {
  return pulseIn(pin, level, timeout);
}
void analogWrite(int pin, int value);
void analogReadResolution(int bits);
void analogWriteResolution(int bits);
void analogReference(int reference);

// There are no interrupts and no loudspeaker, so these do nothing.
inline void interrupts() {}
inline void noInterrupts() {}
inline void cli() {}
inline void sei() {}
inline void tone(int, unsigned, unsigned long = 0) {}
inline void noTone(int) {}

BBSIM_LACKS(attachInterrupt, "attachInterrupt: no interrupts; call what it would do from loop()")
BBSIM_LACKS(detachInterrupt, "detachInterrupt: no interrupts; call what it would do from loop()")
BBSIM_LACKS(digitalPinToInterrupt, "digitalPinToInterrupt: no interrupts; poll the pin in loop()")
BBSIM_LACKS(shiftIn, "shiftIn: no part of the wiring is read bit by bit")
BBSIM_LACKS(shiftOut, "shiftOut: no part of the wiring is written bit by bit")
#define ISR(...) static_assert(false, "bbsim: ISR: no interrupts; call what it does from loop()");

char* dtostrf(double value, signed char width, unsigned char digits, char* into);
char* ltoa(long value, char* into, int base);
char* ultoa(unsigned long value, char* into, int base);
inline char* itoa(int value, char* into, int base) {
  return base == 10 ? ltoa(value, into, base) : ultoa(static_cast<unsigned>(value), into, base);
}
inline char* utoa(unsigned value, char* into, int base) {
  return ultoa(value, into, base);
}

#define BBSIM_IS(name, of) \
  inline bool name(int c) { \
    return of(c) != 0; \
  }
BBSIM_IS(isAlpha, isalpha)
BBSIM_IS(isAlphaNumeric, isalnum)
BBSIM_IS(isDigit, isdigit)
BBSIM_IS(isHexadecimalDigit, isxdigit)
BBSIM_IS(isLowerCase, islower)
BBSIM_IS(isUpperCase, isupper)
BBSIM_IS(isPrintable, isprint)
BBSIM_IS(isPunct, ispunct)
BBSIM_IS(isSpace, isspace)
BBSIM_IS(isControl, iscntrl)
BBSIM_IS(isGraph, isgraph)
#undef BBSIM_IS
inline bool isAscii(int c) {
  return c >= 0 && c < 128;
}
inline int toAscii(int c) {
  return c & 0x7f;
}
inline int toLowerCase(int c) {
  return tolower(c);
}
inline int toUpperCase(int c) {
  return toupper(c);
}
inline bool isWhitespace(int c) {
  return c == ' ' || c == '\t';
}

#include "HardwareSerial.h"
#include "avr/pgmspace.h"
#include "binary.h"

void setup();
void loop();
