// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/descriptor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/error.hpp"
#include "base/text.hpp"

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

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError("cannot read " + shown(file, uncut) + ": " + why);
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

bool Flusher::send(int descriptor, off_t size) {
  constexpr off_t enough = off_t{8} * 1024 * 1024;
  if (size - sent_ >= enough) {
    // A hint only: if the system does not support it, the next sync writes everything.
    [[maybe_unused]] const int ignored =
        sync_file_range(descriptor, sent_, size - sent_, SYNC_FILE_RANGE_WRITE);
    sent_ = size;
  }
  return Clock::now() - last_ > std::chrono::seconds(5);
}

int Flusher::sync(int descriptor) {
  const int error = sync_content(descriptor);
  last_ = Clock::now();
  return error;
}

}  // namespace bbsim::file
