// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Serial lines: what the sketch prints, and the frames that a camera sends.
#include <stdarg.h>
#include <unistd.h>

#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

// What is printed goes out line by line.
class Lines {
 public:
  void add(char c) {
    if (c == '\n' || length_ == sizeof text_ - 1) end();
    if (c == '\n' || c == '\r') return;
    text_[length_++] = c;
  }
  void watch(const char* const* names, size_t count) {
    free(watched_);
    watched_ = static_cast<Watched*>(calloc(count + 1, sizeof(Watched)));
    if (watched_ == nullptr) return;
    watched_count_ = count;
    for (size_t i = 0; i < count; ++i) {
      snprintf(watched_[i].name, sizeof watched_[i].name, "%s", names[i]);
    }
  }
  double value(size_t index) const { return watched_[index].value; }

 private:
  void end() {
    text_[length_] = '\0';
    length_ = 0;
    read_numbers();
    if (board.wiring.print != 0) say();
  }
  // "name:value", several of them parted by commas, tabs or blanks: as for the plotter of the IDE.
  void read_numbers() {
    for (char* at = text_; (at = strchr(at, ':')) != nullptr; ++at) {
      for (size_t i = 0; i < watched_count_; ++i) {
        const size_t length = strlen(watched_[i].name);
        const char* const start = at - length;
        if (start < text_ || strncmp(start, watched_[i].name, length) != 0) continue;
        if (start > text_ && strchr(", \t", start[-1]) == nullptr) continue;
        char* end = nullptr;
        const double number = strtod(at + 1, &end);
        if (end != at + 1 && isfinite(number)) watched_[i].value = number;
      }
    }
  }
  // One call, so that lines of threads do not mix; and nothing that a terminal would obey.
  void say() const {
    char line[4 * sizeof text_ + 16];
    int used = snprintf(line, sizeof line, "controller: ");
    for (const char* c = text_; *c != '\0'; ++c) {
      const auto byte = static_cast<unsigned char>(*c);
      const bool plain = byte >= 0x20 && byte != 0x7F;
      used += snprintf(line + used, sizeof line - static_cast<size_t>(used),
                       plain || byte == '\t' ? "%c" : "\\x%02x", byte);
    }
    line[used++] = '\n';
    const ssize_t written = write(STDERR_FILENO, line, static_cast<size_t>(used));
    static_cast<void>(written);
  }

  struct Watched {
    char name[64];
    double value;
  };
  char text_[256] = {};
  size_t length_ = 0;
  Watched* watched_ = nullptr;
  size_t watched_count_ = 0;
} lines;

// Bytes on their way to the board, each with the time when it is there.
struct Byte {
  Nanoseconds arrives;
  char value;
};
constexpr int most_bytes = 4096;
Byte sent[most_bytes];
int first_sent = 0, sent_count = 0;
Nanoseconds line_is_free = 0;
long long next_frame = 0;

void send(char value, Nanoseconds earliest, Nanoseconds per_byte) {
  if (sent_count == most_bytes) return;  // nobody reads
  line_is_free = (earliest > line_is_free ? earliest : line_is_free) + per_byte;
  sent[(first_sent + sent_count++) % most_bytes] = {line_is_free, value};
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

HardwareSerial* camera_port() {
  HardwareSerial* const ports[] = {&Serial, &Serial1, &Serial2, &Serial3, &SerialUSB};
  const int port = board.wiring.camera.port;
  return port < 0 ? nullptr : ports[port];
}

}  // namespace

void send_frames() {
  HardwareSerial* const port = camera_port();
  if (port == nullptr) return;
  const bbsim_wired_camera& camera = board.wiring.camera;
  const Nanoseconds period = nanoseconds(camera.period);
  for (; next_frame * period <= board.now; ++next_frame) {
    if (!*port) continue;  // nobody listens yet
    const char* const frame = board.sample.seen != 0 ? camera.frame : camera.lost;
    send_frame(frame, next_frame * period + nanoseconds(camera.delay), port->per_byte());
  }
}

void watch_columns(const char* const* names, size_t count) {
  lines.watch(names, count);
}

double column(size_t index) {
  return lines.value(index);
}

}  // namespace bbsim_board

using namespace bbsim_board;

HardwareSerial Serial, Serial1, Serial2, Serial3, SerialUSB;

void HardwareSerial::begin(unsigned long baud) {
  if (baud == 0) fail("Serial.begin(0): allowed: bits in a second, such as 115200");
  per_byte_ = 10 * 1000000000LL / static_cast<long long>(baud);
  if (this == &SerialUSB) per_byte_ = 1000;
  begun_ = true;
}

void HardwareSerial::end() {
  flush();
  begun_ = false;
}

// What has arrived by now goes into the buffer, or is lost.
void HardwareSerial::receive() {
  if (camera_port() != this) return;
  send_frames();
  while (sent_count > 0 && sent[first_sent].arrives <= board.now) {
    if (count_ < static_cast<int>(sizeof buffer_)) {
      buffer_[(first_ + count_++) % static_cast<int>(sizeof buffer_)] = sent[first_sent].value;
    }
    first_sent = (first_sent + 1) % most_bytes;
    --sent_count;
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
  const int byte = peek();
  if (byte < 0) return byte;
  first_ = (first_ + 1) % static_cast<int>(sizeof buffer_);
  --count_;
  return byte;
}

// 64 bytes wait for the line without holding up the sketch.
size_t HardwareSerial::write(uint8_t byte) {
  spend(board.costs.serial);
  lines.add(static_cast<char>(byte));
  if (!begun_) return 0;
  if (line_is_free_ < board.now) line_is_free_ = board.now;
  line_is_free_ += per_byte_;
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
