// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// File descriptors that close themselves; complete reads and writes, and syncs to the disk.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace bbsim::file {

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  // Returns an errno that only closing reveals, or 0. A second call does nothing.
  int close();

 private:
  int number_ = -1;
};

// Permissions for a new file; the umask restricts them.
inline constexpr mode_t any_permissions = 0666;

// Moves a descriptor above 2. If the program starts with a standard stream closed, a new file may
// get its number, and messages would go into the file. Takes ownership and keeps errno.
[[nodiscard]] Descriptor above_standard_streams(int number);

// Writes all bytes, also to a non-blocking pipe. Returns an errno, or 0.
[[nodiscard]] int write_all(int descriptor, std::string_view bytes);

// Reads at `place` until the buffer is full or the file ends. Returns the number of bytes, or -1
// with errno.
[[nodiscard]] ssize_t read_at(int descriptor, char* to, std::size_t size, off_t place);

// Makes the content survive a power cut. Returns an errno, or 0.
[[nodiscard]] int sync_content(int descriptor);
// Makes the names in a folder survive a power cut. Returns an errno, or 0.
[[nodiscard]] int sync_folder(const std::string& folder);

// The system's text for an errno, for use in a sentence: "no space left on device".
[[nodiscard]] std::string error_text(int error_number);

// Reads a file, a pipe or a device to its end. Stops early if the content does not begin with
// `start`, and returns the bytes read so far. Throws InputError, "cannot read FILE: why", also for
// a folder and for more than `most` bytes.
[[nodiscard]] std::string read_whole(const std::string& file, std::string_view start = {},
                                     std::size_t most = std::size_t{1} << 30U);

// Syncs a growing file to the disk during a long run.
//
// A power cut loses at most the last few seconds of work. The disk starts to write in the
// background once enough data has accumulated, so that the syncs every few seconds and at the end
// are short.
class Flusher {
 public:
  // The first `size` bytes are already on the disk.
  explicit Flusher(off_t size = 0) : sent_(size) {}

  // Call it when the file has this size (bytes). Returns whether a sync is due.
  bool send(int descriptor, off_t size);
  // Returns an errno, or 0.
  [[nodiscard]] int sync(int descriptor);

 private:
  using Clock = std::chrono::steady_clock;

  off_t sent_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace bbsim::file
