// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/text_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "base/error.hpp"
#include "file/descriptor.hpp"

namespace bbsim::yaml {
namespace {

constexpr int patience = 5000;  // ms

[[noreturn]] void refuse(const std::string& file, const std::string& message) {
  throw InputError({Problem{name_in_messages(file), message}});
}

[[noreturn]] void refuse_unreadable(const std::string& file, int error) {
  refuse(file, "cannot be read: " + std::generic_category().message(error));
}

[[noreturn]] void refuse_size(const std::string& file, const std::string& found) {
  refuse(file, "found " + found + " bytes; allowed: a scenario of at most " +
                   std::to_string(largest_text) + " bytes");
}

void wait_for_data(int input, const std::string& file) {
  pollfd event{input, POLLIN, 0};
  const int ready = ::poll(&event, 1, file == "-" ? -1 : patience);
  if (ready == 0) refuse(file, "found nothing within 5 s; allowed: a file, or a pipe in use");
  if (ready < 0 && errno != EINTR) refuse_unreadable(file, errno);
}

}  // namespace

std::string name_in_messages(const std::string& file) {
  return file == "-" ? "standard input" : file;
}

std::string read_text(const std::string& name) {
  // Non-blocking, because opening a pipe without a writer would block.
  const file::Descriptor opened(
      name == "-" ? -1 : ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  const int input = name == "-" ? STDIN_FILENO : opened.get();
  if (input < 0) refuse_unreadable(name, errno);

  struct stat status {};
  if (::fstat(input, &status) != 0) refuse_unreadable(name, errno);
  if (S_ISDIR(status.st_mode)) refuse(name, "found a folder; allowed: a scenario file");
  const bool regular = S_ISREG(status.st_mode);
  if (regular && status.st_size > static_cast<off_t>(largest_text)) {
    refuse_size(name, std::to_string(status.st_size));
  }

  std::string text;
  std::array<char, 16384> buffer;
  while (true) {
    if (!regular) wait_for_data(input, name);
    const ssize_t count = ::read(input, buffer.data(), buffer.size());
    if (count == 0) return text;
    if (count < 0) {
      if (errno == EINTR || errno == EAGAIN) continue;
      refuse_unreadable(name, errno);
    }
    text.append(buffer.data(), static_cast<std::size_t>(count));
    if (text.size() > largest_text) refuse_size(name, "more than " + std::to_string(largest_text));
  }
}

}  // namespace bbsim::yaml
