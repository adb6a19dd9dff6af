// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "base/error.hpp"
#include "file/descriptor.hpp"
#include "file/temporaries.hpp"

namespace bbsim::file {
namespace {

constexpr unsigned most_attempts = 100;  // to find an unused name

// The length does not depend on the target's name, so it never exceeds the longest allowed name.
std::string temporary_name(unsigned attempt) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  char text[64];
  const int size = std::snprintf(text, sizeof text, ".bbsim-%lx-%llx-%x.tmp",
                                 static_cast<unsigned long>(getpid()),
                                 static_cast<unsigned long long>(now), attempt);
  return {text, static_cast<std::size_t>(size)};
}

// Gives an unnamed file a name. On failure, returns false with errno.
bool name_file(int descriptor, const char* name) {
  // Linux 6.10 allows this to the process that opened the file; older kernels need privileges and
  // return ENOENT. The way through /proc works for everyone but is slower, because the kernel
  // creates entries there for the process.
  if (linkat(descriptor, "", AT_FDCWD, name, AT_EMPTY_PATH) == 0) return true;
  if (errno != ENOENT) return false;
  char self[40];
  std::snprintf(self, sizeof self, "/proc/self/fd/%d", descriptor);
  return linkat(AT_FDCWD, self, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
}

// Tries a name that always exists, and expects EEXIST.
bool can_be_named(int descriptor) {
  return !name_file(descriptor, "/") && errno == EEXIST;
}

// Exchanges the names of two files in one step, as safe as a rename. When ext4 renames over a file,
// it starts to write to the disk at once, which takes longer than a typical run of the program.
// Returns false if `path` is not a regular file or the system does not support the exchange.
bool exchange_names(const std::string& temporary, const std::string& path) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
         renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, path.c_str(), RENAME_EXCHANGE) == 0;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& target, Durable durable)
    : target_(find_target(target)),
      durable_(durable),
      // Uninitialized on purpose: untouched pages cost nothing.
      buffer_(new char[buffer_size]),
      end_(buffer_.get()) {
  if (target_.descriptor) {
    // A duplicate can be closed, which reveals errors that only closing reports.
    descriptor_ = Descriptor(fcntl(*target_.descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
    if (!descriptor_.is_open()) fail(errno);
  } else if (target_.written_directly()) {
    descriptor_ = above_standard_streams(open(target.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    if (!descriptor_.is_open()) fail(errno);
  } else {
    open_temporary();
  }
}

AtomicFile::~AtomicFile() {
  forget_name();
}

void AtomicFile::open_temporary() {
  if (!open_unnamed()) open_named();
  if (!target_.found) return;
  if (const int error = take_after(descriptor_.get(), *target_.found)) {
    forget_name();  // no destructor runs for a constructor that throws
    fail(error);
  }
}

bool AtomicFile::open_unnamed() {
  descriptor_ = above_standard_streams(
      open(target_.folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, any_permissions));
  if (descriptor_.is_open() && can_be_named(descriptor_.get())) return true;
  descriptor_.close();
  return false;
}

// Remembers the name before the file exists, so that a signal in between leaves no file.
bool AtomicFile::choose_temporary_name(unsigned attempt) {
  if (attempt >= most_attempts) return false;
  temporary_ = std::filesystem::path(target_.folder()) / temporary_name(attempt);
  remember_temporary(temporary_.c_str());
  return true;
}

void AtomicFile::forget_name() {
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  forget_temporary(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::open_named() {
  int error = EEXIST;
  for (unsigned attempt = 0; error == EEXIST && choose_temporary_name(attempt); ++attempt) {
    descriptor_ = above_standard_streams(
        open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, any_permissions));
    if (descriptor_.is_open()) return;
    error = errno;
    forget_temporary(temporary_.c_str());
    temporary_.clear();
  }
  if (error == ENOENT) {
    throw OutputError("cannot write " + target_.name + ": there is no folder " + target_.folder() +
                      "; create it, or write to another place");
  }
  if (error == EACCES || error == EPERM || error == EROFS) {
    throw OutputError("cannot write " + target_.name + ": " + error_text(error) + " in folder " +
                      target_.folder() +
                      "; write to another folder, or change the permissions of this one");
  }
  fail(error);
}

void AtomicFile::write(std::string_view bytes) {
  if (bytes.size() > static_cast<std::size_t>(buffer_end() - end_)) flush();
  if (bytes.size() > buffer_size) {
    write_through(bytes);
    return;
  }
  end_ += bytes.copy(end_, bytes.size());
}

void AtomicFile::flush() {
  const std::string_view content(buffer_.get(), static_cast<std::size_t>(end_ - buffer_.get()));
  end_ = buffer_.get();  // before writing, so that a failed write is not repeated
  write_through(content);
}

void AtomicFile::write_through(std::string_view bytes) {
  if (const int error = write_all(descriptor_.get(), bytes)) fail(error);
}

void AtomicFile::commit() {
  flush();
  if (target_.written_directly()) {
    if (const int error = descriptor_.close()) fail(error);
    return;
  }
  if (durable_ == Durable::yes) {
    if (const int error = sync_content(descriptor_.get())) fail(error);
  }
  // Errors that only closing reveals must be known before the file gets its name. Closing an
  // unnamed file would delete it, so this closes a duplicate descriptor.
  Descriptor second(fcntl(descriptor_.get(), F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  if (const int error = second.is_open() ? second.close() : errno) fail(error);
  replace_target();
  descriptor_.close();
  if (durable_ == Durable::yes) {
    if (const int error = sync_folder(target_.folder())) fail(error);
  }
}

void AtomicFile::replace_target() {
  if (temporary_.empty()) {
    if (name_file(descriptor_.get(), target_.path.c_str())) return;
    // Only a file with a name can replace an existing file.
    int error = errno;
    for (unsigned attempt = 0; error == EEXIST && choose_temporary_name(attempt); ++attempt) {
      if (name_file(descriptor_.get(), temporary_.c_str())) break;
      error = errno;
      forget_temporary(temporary_.c_str());
      temporary_.clear();
    }
    if (temporary_.empty()) fail(error);
  }
  if (!exchange_names(temporary_, target_.path)) {
    if (std::rename(temporary_.c_str(), target_.path.c_str()) != 0) fail(errno);
  }
  forget_name();  // after an exchange, this removes the old file
}

void write_file(const std::string& target, std::string_view content) {
  AtomicFile file(target);
  file.write(content);
  file.commit();
}

}  // namespace bbsim::file
