// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/line_reader.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file/descriptor.hpp"

namespace bbsim::file {
namespace {

constexpr std::size_t read_at_once = 65536;

}  // namespace

std::string name_in_messages(const std::string& file) {
  return file == "-" ? "standard input" : shown(file, uncut);
}

LineReader::LineReader(const std::string& file) : file_(file), name_(name_in_messages(file)) {
  descriptor_ = file == "-" ? STDIN_FILENO : open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw InputError("cannot read " + name_ + ": " + error_text(errno));
  struct stat status {};
  if (fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::size_t>(status.st_size);
  }
  // A small file fits completely, with one byte more to detect its end.
  buffer_.resize(size_ ? std::min(*size_ + 1, read_at_once) : read_at_once);
}

LineReader::~LineReader() {
  if (file_ != "-") close(descriptor_);
}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = begin_;
  for (;;) {
    const void* found = std::memchr(buffer_.data() + searched, '\n', end_ - searched);
    const std::size_t size =
        found != nullptr
            ? static_cast<std::size_t>(static_cast<const char*>(found) - (buffer_.data() + begin_))
            : end_ - begin_;
    if (size > longest_line) {
      throw InputError({Problem{name_ + ":" + std::to_string(number_ + 1) + ":1",
                                "found a line of more than " + std::to_string(longest_line) +
                                    " bytes; allowed: rows of a table, one a line"}});
    }
    if (found == nullptr) {
      const std::size_t before = begin_;
      searched = end_;
      if (read_more()) {
        searched -= before - begin_;
        continue;
      }
      if (begin_ == end_) return {};
    }
    std::string_view line(buffer_.data() + begin_, size);
    begin_ += found != nullptr ? size + 1 : size;
    whole_ = found != nullptr && !line.ends_with('\r');
    if (line.ends_with('\r')) line.remove_suffix(1);
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (++number_ == 1 && line.starts_with(byte_order_mark)) {
      line.remove_prefix(byte_order_mark.size());
    }
    return line;
  }
}

bool LineReader::read_more() {
  if (at_end_) return false;
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
  end_ -= begin_;
  begin_ = 0;
  if (end_ == buffer_.size()) buffer_.resize(std::max(2 * end_, read_at_once));
  for (;;) {
    const ssize_t got = read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw InputError("cannot read " + name_ + ": " + error_text(errno));
    end_ += static_cast<std::size_t>(got);
    at_end_ = got == 0;
    return !at_end_;
  }
}

}  // namespace bbsim::file
