// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/default_name.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file/descriptor.hpp"
#include "file/target.hpp"

namespace bbsim::file {
namespace {

constexpr std::size_t looked_at = 4096;  // bytes read at each end

constexpr const char* remedy = ". Name another file with -o, or replace this one with --force";

[[noreturn]] void refuse(const std::string& target, const std::string& found,
                         const Likeness& likeness) {
  throw InputError(target + ": already exists, " + found + "; allowed without -o: to replace " +
                   likeness.what + remedy);
}

// Whether the target is a regular file, which would be replaced.
bool is_file(const std::string& target, struct stat& status) {
  return !is_written_directly(target) && stat(target.c_str(), &status) == 0 &&
         S_ISREG(status.st_mode);
}

Descriptor opened(const std::string& target) {
  return Descriptor(open(target.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
}

// Reads up to `size` bytes.
std::string bytes_at(const Descriptor& file, off_t place, std::size_t size) {
  std::string bytes(size, '\0');
  bytes.resize(static_cast<std::size_t>(
      std::max<ssize_t>(read_at(file.get(), bytes.data(), size, place), 0)));
  return bytes;
}

std::string first_line(const std::string& start) {
  return "and begins with " + quoted(std::string_view(start).substr(0, start.find('\n')));
}

}  // namespace

Likeness table_with(const std::string& header) {
  return {"a table with the header " + shown(header, longest_saying), header + '\n'};
}

void require_like(const std::string& target, const Likeness& likeness) {
  struct stat status {};
  if (!is_file(target, status)) return;
  const Descriptor file = opened(target);
  if (!file.is_open()) {
    refuse(target, "and cannot be read: " + error_text(errno), likeness);
  }
  if (status.st_size == 0) refuse(target, "and is empty", likeness);
  const std::size_t size = std::max(looked_at, likeness.start.size());
  const std::string start = bytes_at(file, 0, size);
  const off_t tail = std::max<off_t>(status.st_size - static_cast<off_t>(looked_at), 0);
  const std::string end = bytes_at(file, tail, looked_at);
  if (!likeness.start.empty()) {
    if (!start.starts_with(likeness.start)) refuse(target, first_line(start), likeness);
    if (!end.ends_with('\n')) refuse(target, "and breaks off within its last row", likeness);
    return;
  }
  if (start.find(likeness.mark) == std::string::npos &&
      end.find(likeness.mark) == std::string::npos) {
    refuse(target, first_line(start), likeness);
  }
}

void require_new(const std::string& target, const std::string_view* content) {
  struct stat status {};
  if (!is_file(target, status)) return;
  if (content != nullptr) {
    const Descriptor file = opened(target);
    if (file.is_open() && bytes_at(file, 0, content->size() + 1) == *content) return;
  }
  throw InputError(target + ": already exists; allowed: to write a new file" + remedy);
}

}  // namespace bbsim::file
