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

namespace bbsim::yaml {
namespace {

constexpr int patience = 5000;  // ms

class File {
 public:
  // Non-blocking, because opening a pipe without a writer would block.
  explicit File(const std::string& name)
      : descriptor_(name == "-" ? STDIN_FILENO
                                : ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~File() {
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

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

void wait_for_data(const File& input, const std::string& file) {
  pollfd event{input.get(), POLLIN, 0};
  const int ready = ::poll(&event, 1, file == "-" ? -1 : patience);
  if (ready == 0) refuse(file, "found nothing within 5 s; allowed: a file, or a pipe in use");
  if (ready < 0 && errno != EINTR) refuse_unreadable(file, errno);
}

}  // namespace

std::string name_in_messages(const std::string& file) {
  return file == "-" ? "standard input" : file;
}

std::string read_text(const std::string& file) {
  const File input(file);
  if (input.get() < 0) refuse_unreadable(file, errno);

  struct stat status {};
  if (::fstat(input.get(), &status) != 0) refuse_unreadable(file, errno);
  if (S_ISDIR(status.st_mode)) refuse(file, "found a folder; allowed: a scenario file");
  const bool regular = S_ISREG(status.st_mode);
  if (regular && status.st_size > static_cast<off_t>(largest_text)) {
    refuse_size(file, std::to_string(status.st_size));
  }

  std::string text;
  std::array<char, 16384> buffer;
  while (true) {
    if (!regular) wait_for_data(input, file);
    const ssize_t count = ::read(input.get(), buffer.data(), buffer.size());
    if (count == 0) return text;
    if (count < 0) {
      if (errno == EINTR || errno == EAGAIN) continue;
      refuse_unreadable(file, errno);
    }
    text.append(buffer.data(), static_cast<std::size_t>(count));
    if (text.size() > largest_text) refuse_size(file, "more than " + std::to_string(largest_text));
  }
}

}  // namespace bbsim::yaml
