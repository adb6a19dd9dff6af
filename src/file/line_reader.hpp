// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Lines of text, one after the other, of a file, a pipe or a device.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim::file {

// Holds no more than a line and some of what follows it: a device that never ends, such as
// /dev/zero, ends in an error and not with the memory.
class LineReader {
 public:
  static constexpr std::size_t longest_line = std::size_t{1} << 20U;  // bytes, its end not counted

  // "-" is standard input. Throws InputError, as all here.
  explicit LineReader(const std::string& file);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  // The next line without its end, "\n" or "\r\n", good until the next call; nothing at the end.
  std::optional<std::string_view> next();

  // The number of the line that next() gave, from 1.
  [[nodiscard]] std::size_t number() const { return number_; }
  // The file as messages call it.
  [[nodiscard]] const std::string& name() const { return name_; }
  // Bytes in all of a regular file; nothing of what may go on for ever.
  [[nodiscard]] std::optional<std::size_t> size() const { return size_; }

 private:
  // Reads more after what is there; false at the end.
  bool read_more();

  std::string file_, name_;
  int descriptor_ = -1;
  std::optional<std::size_t> size_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of what was read and not yet given
  std::size_t number_ = 0;
  bool at_end_ = false;
};

}  // namespace bbsim::file
