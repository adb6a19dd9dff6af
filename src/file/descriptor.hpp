// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// File descriptors that close themselves, and complete reads and writes.
#pragma once

#include <sys/types.h>

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

}  // namespace bbsim::file
