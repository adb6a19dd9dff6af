// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Serial ports: the text that the sketch prints, the frames of a camera, and a program on the line.
#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

// Numbers that output.columns asks for.
struct Watched {
  char name[64];
  double value;
  bool printed;
};
Watched* watched = nullptr;
size_t watched_count = 0;

// Whether the text has a number: also "nan" and "inf", as whole words, and "ovf", which print()
// writes for large numbers. The run then ends.
bool read_number(const char* text, double& number) {
  while (*text == ' ') ++text;
  char* end = nullptr;
  number = strtod(text, &end);
  if (strncmp(text, "ovf", 3) == 0) {
    number = HUGE_VAL;
    end = const_cast<char*>(text) + 3;
  }
  return end != text && (isfinite(number) || strchr(", \t", *end) != nullptr);
}

// Reads "name:value" pairs, separated by commas, tabs or blanks, as the plotter of the IDE does.
void read_numbers(const char* line) {
  for (const char* at = line; (at = strchr(at, ':')) != nullptr; ++at) {
    for (size_t i = 0; i < watched_count; ++i) {
      Watched& variable = watched[i];
      const auto length = static_cast<ptrdiff_t>(strlen(variable.name));
      if (at - line < length) continue;
      const char* const start = at - length;
      if (strncmp(start, variable.name, static_cast<size_t>(length)) != 0) continue;
      if (start > line && strchr(", \t", start[-1]) == nullptr) continue;
      double number = 0;
      if (!read_number(at + 1, number)) continue;
      variable.value = number;
      variable.printed = true;
    }
  }
}

// Bytes under way in one direction, with their times of arrival.
constexpr int most_bytes = 4096;
struct Bytes {
  struct {
    Nanoseconds arrives;
    char value;
  } bytes[most_bytes];
  int first, count;

  // False: there is no room.
  bool put(char value, Nanoseconds arrives) {
    if (count == most_bytes) return false;
    bytes[(first + count++) % most_bytes] = {arrives, value};
    return true;
  }
  // The next byte that has arrived by this time; false: there is none.
  bool take(Nanoseconds time, char& value) {
    if (count == 0 || bytes[first].arrives > time) return false;
    value = bytes[first].value;
    first = (first + 1) % most_bytes;
    --count;
    return true;
  }
};
Bytes to_board, from_board;
Nanoseconds line_is_free = 0;  // to the board
long long next_frame = 0;

// What a program sends to Serial, which begins at the next sample.
bool has_program = false;
char pending[most_bytes];
size_t pending_size = 0;
Nanoseconds pending_delay = 0;
bbsim_line counted = {};

void send(char value, Nanoseconds earliest, Nanoseconds per_byte) {
  const Nanoseconds from = earliest > line_is_free ? earliest : line_is_free;
  if (to_board.put(value, from + per_byte)) {
    line_is_free = from + per_byte;
  } else {
    ++counted.overrun;  // the sketch does not read
  }
}

void send_frame(const char* frame, Nanoseconds from, Nanoseconds per_byte) {
  const bbsim_wired_camera& camera = board.wiring.camera;
  char number[48];
  for (const char* c = frame; *c != '\0'; ++c) {
    const bool x = strncmp(c, "{x}", 3) == 0;
    if (!x && strncmp(c, "{y}", 3) != 0) {
      send(*c, from, per_byte);
      continue;
    }
    const double counts =
        x ? counts_at(camera.x, board.sample.ball[0]) : counts_at(camera.y, board.sample.ball[1]);
    snprintf(number, sizeof number, "%.*f", static_cast<int>(camera.decimals), counts);
    // No minus before a zero.
    const char* digits = strtod(number, nullptr) == 0 && number[0] == '-' ? number + 1 : number;
    for (; *digits != '\0'; ++digits) send(*digits, from, per_byte);
    c += 2;
  }
}

HardwareSerial* const ports[] = {&Serial, &Serial1, &Serial2, &Serial3, &SerialUSB};

HardwareSerial* camera_port() {
  const int port = board.wiring.camera.port;
  return port < 0 ? nullptr : ports[port];
}

// The port at which bytes arrive. A board has a camera or a program, not both.
HardwareSerial* receiving_port() {
  return has_program ? &Serial : camera_port();
}

// The time of the next frame.
Nanoseconds frame_time() {
  return next_frame * nanoseconds(board.wiring.camera.period);
}

}  // namespace

void send_frames() {
  HardwareSerial* const port = camera_port();
  if (port == nullptr) return;
  const bbsim_wired_camera& camera = board.wiring.camera;
  for (; frame_time() <= board.now; ++next_frame) {
    if (!*port) continue;  // before begin()
    const char* const frame = board.sample.seen != 0 ? camera.frame : camera.lost;
    send_frame(frame, frame_time() + nanoseconds(camera.delay), port->per_byte());
  }
}

void keep_for_program(const char* bytes, size_t size, double delay) {
  has_program = true;
  const size_t room = sizeof pending - pending_size, kept = size < room ? size : room;
  memcpy(pending + pending_size, bytes, kept);
  pending_size += kept;
  counted.overrun += size - kept;
  pending_delay = nanoseconds(delay);
}

void send_pending(Nanoseconds sample) {
  const bool begun = static_cast<bool>(Serial);
  if (!begun) counted.unbegun += pending_size;
  for (size_t i = 0; begun && i < pending_size; ++i) {
    send(pending[i], sample + pending_delay, Serial.per_byte());
  }
  pending_size = 0;
}

size_t take_printed(char* bytes, size_t room) {
  size_t size = 0;
  while (size < room && from_board.take(board.horizon, bytes[size])) ++size;
  return size;
}

bbsim_line line_counts() {
  counted.baud = Serial ? 1e10 / static_cast<double>(Serial.per_byte()) : 0;
  return counted;
}

void watch_columns(const char* const* names, size_t count) {
  watched = keep<Watched>(nullptr, count);
  watched_count = count;
  for (size_t i = 0; i < count; ++i) {
    snprintf(watched[i].name, sizeof watched[i].name, "%s", names[i]);
  }
}

double column(size_t index) {
  return watched[index].printed ? watched[index].value : NAN;
}

bool was_printed(size_t index) {
  return watched[index].printed;
}

}  // namespace bbsim_board

using namespace bbsim_board;

HardwareSerial Serial, Serial1, Serial2, Serial3, SerialUSB;

void HardwareSerial::begin(unsigned long baud) {
  if (baud == 0) fail("Serial.begin(0): allowed: bits per second, such as 115200");
  per_byte_ = 10 * 1000000000LL / static_cast<long long>(baud);
  if (this == &SerialUSB) per_byte_ = 1000;
  begun_ = true;
}

void HardwareSerial::end() {
  flush();
  begun_ = false;
}

// Moves bytes that have arrived into the buffer. Bytes that do not fit are lost.
void HardwareSerial::receive() {
  if (receiving_port() != this) return;
  send_frames();
  for (char value = 0; to_board.take(board.now, value);) {
    if (count_ < static_cast<int>(sizeof buffer_)) {
      buffer_[(first_ + count_++) % static_cast<int>(sizeof buffer_)] = value;
    } else {
      ++counted.overrun;
    }
  }
}

int HardwareSerial::available() {
  spend(board.costs.clock);
  receive();
  return count_;
}

int HardwareSerial::peek() {
  spend(board.costs.clock);
  receive();
  return count_ == 0 ? -1 : static_cast<unsigned char>(buffer_[first_]);
}

int HardwareSerial::read() {
  const int letter = peek();
  if (letter < 0) return letter;
  first_ = (first_ + 1) % static_cast<int>(sizeof buffer_);
  --count_;
  ++counted.read;
  return letter;
}

// Handles output one line at a time.
void HardwareSerial::add_to_line(char c) {
  if (c == '\n' || line_length_ == static_cast<int>(sizeof line_) - 1) {
    line_[line_length_] = '\0';
    line_length_ = 0;
    read_numbers(line_);
    if (board.wiring.print != nullptr) board.wiring.print(board.wiring.reader, line_);
  }
  if (c != '\n' && c != '\r') line_[line_length_++] = c;
}

// The sketch continues while at most 64 bytes wait to be sent.
size_t HardwareSerial::write(uint8_t letter) {
  spend(board.costs.serial);
  if (!begun_) return 0;
  add_to_line(static_cast<char>(letter));
  if (line_is_free_ < board.now) line_is_free_ = board.now;
  line_is_free_ += per_byte_;
  if (has_program && this == &Serial) from_board.put(static_cast<char>(letter), line_is_free_);
  const long long wait = line_is_free_ - board.now - 64 * per_byte_;
  if (wait > 0) spend(wait);
  return 1;
}

int HardwareSerial::availableForWrite() {
  const long long waiting =
      line_is_free_ > board.now ? (line_is_free_ - board.now + per_byte_ - 1) / per_byte_ : 0;
  return static_cast<int>(64 - waiting);
}

void HardwareSerial::flush() {
  if (line_is_free_ > board.now) spend(line_is_free_ - board.now);
}
