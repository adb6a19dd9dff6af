// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// File descriptors that close themselves, and calls of the system that do all they are asked for.
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
  // Returns the errno of what only closing brings to light, or 0; once is enough.
  int close();

 private:
  int number_ = -1;
};

// What a new file is opened with: the umask takes away what it should.
inline constexpr mode_t any_permissions = 0666;

// 0 to 2 are where messages go: a file that got one of them, because the program was started with
// it closed, would be written into by accident. Takes the descriptor, and keeps errno.
[[nodiscard]] Descriptor above_standard_streams(int number);

// Writes all bytes, to a pipe that does not block too. Returns an errno, or 0.
[[nodiscard]] int write_all(int descriptor, std::string_view bytes);

// Reads at `place` until the buffer is full or the file ends; the bytes read, or -1 and errno.
[[nodiscard]] ssize_t read_at(int descriptor, char* to, std::size_t size, off_t place);

// What has been written survives a power cut afterwards. Returns an errno, or 0.
[[nodiscard]] int sync_content(int descriptor);
// Does the same for the names in a folder.
[[nodiscard]] int sync_folder(const std::string& folder);

// "no space left on device": the system's text for an errno, to stand within a sentence.
[[nodiscard]] std::string error_text(int error_number);

}  // namespace bbsim::file
