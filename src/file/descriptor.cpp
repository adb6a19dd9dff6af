// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/descriptor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace bbsim::file {
namespace {

int synced(int descriptor, int (*sync)(int)) {
  while (sync(descriptor) != 0) {
    if (errno == EINTR) continue;
    // Some file systems do not support syncing.
    return errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP || errno == EROFS ? 0 : errno;
  }
  return 0;
}

}  // namespace

int Descriptor::close() {
  const int number = std::exchange(number_, -1);
  if (number < 0 || ::close(number) == 0 || errno == EINTR) return 0;  // Linux closes on EINTR too
  return errno;
}

Descriptor above_standard_streams(int number) {
  if (number < 0 || number > STDERR_FILENO) return Descriptor(number);
  Descriptor higher(fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  const int error = errno;
  ::close(number);
  errno = error;
  return higher;
}

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (written == 0) {
      return EIO;
    } else if (errno == EAGAIN) {  // another process may have made the pipe non-blocking
      pollfd wait{descriptor, POLLOUT, 0};
      poll(&wait, 1, -1);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

ssize_t read_at(int descriptor, char* to, std::size_t size, off_t place) {
  std::size_t got = 0;
  while (got < size) {
    const ssize_t part = pread(descriptor, to + got, size - got, place + static_cast<off_t>(got));
    if (part == 0) break;
    if (part > 0) got += static_cast<std::size_t>(part);
    if (part < 0 && errno != EINTR) return -1;
  }
  return static_cast<ssize_t>(got);
}

int sync_content(int descriptor) {
  return synced(descriptor, fdatasync);
}

int sync_folder(const std::string& folder) {
  const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.is_open()) return errno == EACCES ? 0 : errno;  // it may still be writable
  return synced(opened.get(), fsync);
}

std::string error_text(int error_number) {
  std::string text = std::generic_category().message(error_number);
  if (!text.empty() && text[0] >= 'A' && text[0] <= 'Z') {
    text[0] = static_cast<char>(text[0] - 'A' + 'a');
  }
  return text;
}

}  // namespace bbsim::file
