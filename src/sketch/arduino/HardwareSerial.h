// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Print, Stream and the serial ports.
#pragma once

#include "WString.h"
#include "bbsim_board.h"

class Print;
class Printable {
 public:
  virtual size_t printTo(Print& to) const = 0;
};

class Print {
 public:
  virtual ~Print() = default;
  virtual size_t write(uint8_t letter) = 0;
  virtual size_t write(const uint8_t* bytes, size_t size);
  size_t write(const char* text) { return write(text, strlen(text)); }
  size_t write(const char* bytes, size_t size) {
    return write(reinterpret_cast<const uint8_t*>(bytes), size);
  }
  size_t write(int letter) { return write(static_cast<uint8_t>(letter)); }
  virtual void flush() {}
  virtual int availableForWrite() { return 0; }

  size_t print(const char* text) { return write(text); }
  size_t print(const String& text) { return write(text.c_str(), text.length()); }
  size_t print(const __FlashStringHelper* text) {
    return write(reinterpret_cast<const char*>(text));
  }
  size_t print(char c) { return write(static_cast<uint8_t>(c)); }
  size_t print(bool value) { return print_unsigned(value, DEC); }
  size_t print(unsigned char value, int base = DEC) { return print_unsigned(value, base); }
  size_t print(int value, int base = DEC) {
    return base == DEC ? print_signed(value, DEC)
                       : print_unsigned(static_cast<unsigned>(value), base);
  }
  size_t print(unsigned value, int base = DEC) { return print_unsigned(value, base); }
  size_t print(long value, int base = DEC) { return print_signed(value, base); }
  size_t print(unsigned long value, int base = DEC) { return print_unsigned(value, base); }
  size_t print(long long value, int base = DEC) { return print_signed(value, base); }
  size_t print(unsigned long long value, int base = DEC) { return print_unsigned(value, base); }
  size_t print(double value, int digits = 2);
  size_t print(const Printable& value) { return value.printTo(*this); }
  size_t println() { return write("\r\n"); }
  template <class... Arguments>
  size_t println(const Arguments&... arguments) {
    const size_t written = print(arguments...);
    return written + println();
  }
  __attribute__((format(printf, 2, 3))) size_t printf(const char* format, ...);

 private:
  size_t print_signed(long long value, int base);
  size_t print_unsigned(unsigned long long value, int base);
};

class Stream : public Print {
 public:
  virtual int available() = 0;
  virtual int read() = 0;
  virtual int peek() = 0;
  void setTimeout(unsigned long ms) { timeout_ = ms; }
  long parseInt();
  float parseFloat();
  String readString() { return read_text(-2); }
  String readStringUntil(char end) { return read_text(static_cast<unsigned char>(end)); }
  size_t readBytes(char* into, size_t room) { return readBytesUntil(-1, into, room); }
  size_t readBytes(uint8_t* into, size_t room) {
    return readBytes(reinterpret_cast<char*>(into), room);
  }
  size_t readBytesUntil(int end, char* into, size_t room);
  size_t readBytesUntil(int end, uint8_t* into, size_t room) {
    return readBytesUntil(end, reinterpret_cast<char*>(into), room);
  }
  bool find(const char* wanted);
  bool find(char wanted) {
    const char text[] = {wanted, '\0'};
    return find(text);
  }

 private:
  int timed(int (Stream::*next)());
  int start_of_number(bool point);
  String read_text(int end);
  unsigned long timeout_ = 1000;
};

class HardwareSerial : public Stream {
 public:
  void begin(unsigned long baud = 115200);
  template <class Config>
  void begin(unsigned long baud, Config) {
    begin(baud);
  }
  void end();
  explicit operator bool() const { return begun_; }
  int available() override;
  int read() override;
  int peek() override;
  size_t write(uint8_t letter) override;
  using Print::write;
  int availableForWrite() override;
  void flush() override;
  long long per_byte() const { return per_byte_; }  // ns

 private:
  void receive();
  void add_to_line(char c);
  bool begun_ = false;
  long long per_byte_ = 0, line_is_free_ = 0;
  char buffer_[64] = {};
  int first_ = 0, count_ = 0;
  char line_[256] = {};  // not yet printed
  int line_length_ = 0;
};

enum { SERIAL_8N1 = 0x06 };

// A camera's text arrives at the port that the wiring names. All ports print.
extern HardwareSerial Serial, Serial1, Serial2, Serial3, SerialUSB;
