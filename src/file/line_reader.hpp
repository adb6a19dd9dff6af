// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads a file, a pipe or a device line by line.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim::file {

// "-" is standard input.
[[nodiscard]] std::string name_in_messages(const std::string& file);

// Holds one line and a buffer. An endless device such as /dev/zero causes an error instead of using
// up the memory.
class LineReader {
 public:
  static constexpr std::size_t longest_line = std::size_t{1} << 20U;  // bytes without the line end

  // "-" is standard input. All functions throw InputError.
  explicit LineReader(const std::string& file);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  // The next line without its end ("\n" or "\r\n") and without a byte order mark, valid until the
  // next call; nothing at the end.
  std::optional<std::string_view> next();

  // Whether that line ended in "\n" alone, as bbsim writes it.
  [[nodiscard]] bool whole() const { return whole_; }
  // The number of the line from the last next(), from 1.
  [[nodiscard]] std::size_t number() const { return number_; }
  // The file's name in messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  // The size of a regular file in bytes; nothing for a pipe or a device, which may be endless.
  [[nodiscard]] std::optional<std::size_t> size() const { return size_; }

 private:
  // Appends data to the buffer. Returns false at the end.
  bool read_more();

  std::string file_, name_;
  int descriptor_ = -1;
  std::optional<std::size_t> size_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // the unread bytes in the buffer
  std::size_t number_ = 0;
  bool at_end_ = false, whole_ = false;
};

}  // namespace bbsim::file
