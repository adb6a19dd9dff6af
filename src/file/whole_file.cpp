// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file/descriptor.hpp"

namespace bbsim::file {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError("cannot read " + shown(file, uncut) + ": " + why);
}

}  // namespace

std::string read_whole(const std::string& file, std::string_view start, std::size_t most) {
  const Descriptor input(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY));
  if (!input.is_open()) refuse(file, error_text(errno));
  struct stat status {};
  if (fstat(input.get(), &status) != 0) refuse(file, error_text(errno));
  const bool regular = S_ISREG(status.st_mode);
  // Room for the whole file, with one byte more to detect its end.
  const std::size_t room =
      regular ? static_cast<std::size_t>(status.st_size) + 1 : std::size_t{65536};
  std::string bytes;
  std::size_t size = 0;
  for (;;) {
    if (size > most || (regular && room - 1 > most)) {
      refuse(file,
             "found more than " + std::to_string(most) + " bytes; allowed: at most that many");
    }
    const bool begins = size >= start.size();
    if (size == bytes.size()) bytes.resize(begins ? std::max(room, 2 * size) : start.size());
    const ssize_t got = read(input.get(), bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(file, error_text(errno));
    size += static_cast<std::size_t>(got);
    const std::size_t compared = std::min(size, start.size());
    const bool alike = bytes.compare(0, compared, start.substr(0, compared)) == 0;
    if (got == 0 || !alike) break;
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace bbsim::file
