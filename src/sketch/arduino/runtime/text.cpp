// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Print and Stream: numbers as text and back, as on the boards.
#include <stdarg.h>
#include <string.h>

#include "Arduino.h"
#include "runtime/board.hpp"

size_t Print::write(const uint8_t* bytes, size_t size) {
  size_t written = 0;
  while (written < size && write(bytes[written]) == 1) ++written;
  return written;
}

size_t Print::print_unsigned(unsigned long long value, int base) {
  if (base == 0) return write(static_cast<uint8_t>(value));
  char digits[8 * sizeof value + 1];
  return write(bbsim_board::digits_of(value, base < 2 ? 10 : base, 'A', digits + sizeof digits));
}

size_t Print::print_signed(long long value, int base) {
  if (base != 10) return print_unsigned(static_cast<unsigned long long>(value), base);
  if (value >= 0) return print_unsigned(static_cast<unsigned long long>(value), 10);
  return write(static_cast<uint8_t>('-')) +
         print_unsigned(0ULL - static_cast<unsigned long long>(value), 10);
}

size_t Print::print(double value, int digits) {
  if (isnan(value)) return write("nan");
  if (isinf(value)) return write("inf");
  if (value > 4294967040.0 || value < -4294967040.0) return write("ovf");
  size_t written = 0;
  if (value < 0) {
    written += write(static_cast<uint8_t>('-'));
    value = -value;
  }
  double rounding = 0.5;
  for (int i = 0; i < digits; ++i) rounding /= 10;
  value += rounding;
  const auto whole = static_cast<unsigned long>(value);
  double rest = value - static_cast<double>(whole);
  written += print_unsigned(whole, 10);
  if (digits > 0) written += write(static_cast<uint8_t>('.'));
  for (int i = 0; i < digits; ++i) {
    rest *= 10;
    const auto digit = static_cast<unsigned>(rest);
    written += print_unsigned(digit, 10);
    rest -= digit;
  }
  return written;
}

size_t Print::printf(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return write(text);
}

int Stream::timed(int (Stream::*next)()) {
  const unsigned long start = millis();
  do {
    const int letter = (this->*next)();
    if (letter >= 0) return letter;
  } while (millis() - start < timeout_);
  return -1;
}

// The next character that can begin a number, without reading it; -1 after the timeout.
int Stream::start_of_number(bool point) {
  while (true) {
    const int letter = timed(&Stream::peek);
    if (letter < 0 || letter == '-' || (letter >= '0' && letter <= '9') ||
        (point && letter == '.')) {
      return letter;
    }
    read();
  }
}

long Stream::parseInt() {
  int letter = start_of_number(false);
  const bool negative = letter == '-';
  long value = 0;
  if (letter < 0) return 0;
  do {
    if (letter != '-') value = value * 10 + letter - '0';
    read();
    letter = timed(&Stream::peek);
  } while (letter >= '0' && letter <= '9');
  return negative ? -value : value;
}

float Stream::parseFloat() {
  int letter = start_of_number(true);
  const bool negative = letter == '-';
  bool fraction = false;
  double value = 0, place = 1;
  if (letter < 0) return 0;
  do {
    if (letter == '.') {
      fraction = true;
    } else if (letter != '-') {
      value = value * 10 + letter - '0';
      if (fraction) place *= 0.1;
    }
    read();
    letter = timed(&Stream::peek);
  } while ((letter >= '0' && letter <= '9') || (letter == '.' && !fraction));
  return static_cast<float>((negative ? -value : value) * place);
}

size_t Stream::readBytesUntil(int end, char* into, size_t room) {
  size_t count = 0;
  while (count < room) {
    const int letter = timed(&Stream::read);
    if (letter < 0 || letter == end) break;
    into[count++] = static_cast<char>(letter);
  }
  return count;
}

String Stream::read_text(int end) {
  String text;
  for (int letter = timed(&Stream::read); letter >= 0 && letter != end;
       letter = timed(&Stream::read)) {
    text += static_cast<char>(letter);
  }
  return text;
}

bool Stream::find(const char* wanted) {
  // The longest start of `wanted`, shorter than `length`, with which its first `length` letters
  // end.
  const auto restart = [wanted](size_t length) {
    size_t shorter = length - 1;
    while (memcmp(wanted, wanted + length - shorter, shorter) != 0) --shorter;
    return shorter;
  };
  size_t found = 0;
  while (wanted[found] != '\0') {
    const int letter = timed(&Stream::read);
    if (letter < 0) return false;
    while (found > 0 && letter != wanted[found]) found = restart(found);
    if (letter == wanted[found]) ++found;
  }
  return true;
}

String::String(long value, int base) {
  char digits[72];
  text_ = ltoa(value, digits, base);
}

String::String(unsigned long value, int base) {
  char digits[72];
  text_ = ultoa(value, digits, base);
}

String::String(double value, int digits) {
  char text[400];
  snprintf(text, sizeof text, "%.*f", digits < 60 ? digits : 60, value);
  text_ = text;
}

String String::substring(unsigned from, unsigned to) const {
  if (from > to) std::swap(from, to);
  String part;
  if (from < length()) part.text_ = text_.substr(from, to - from);
  return part;
}

void String::replace(const String& wanted, const String& by) {
  if (wanted.isEmpty()) return;
  for (size_t at = 0; (at = text_.find(wanted.text_, at)) != std::string::npos;) {
    text_.replace(at, wanted.length(), by.text_);
    at += by.length();
  }
}

void String::toLowerCase() {
  for (char& c : text_) c = static_cast<char>(tolower(static_cast<unsigned char>(c)));
}

void String::toUpperCase() {
  for (char& c : text_) c = static_cast<char>(toupper(static_cast<unsigned char>(c)));
}

void String::trim() {
  const char* const blanks = " \t\r\n\v\f";
  const size_t first = text_.find_first_not_of(blanks);
  if (first == std::string::npos) return text_.clear();
  text_ = text_.substr(first, text_.find_last_not_of(blanks) - first + 1);
}
