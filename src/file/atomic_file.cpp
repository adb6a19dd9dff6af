// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "base/error.hpp"
#include "file/leftovers.hpp"

namespace bbsim::file {
namespace {

// The length does not depend on the target's name, so it never exceeds the longest allowed name.
std::string temporary_name() {
  static std::atomic<unsigned> number{0};
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  char text[64];
  const int size = std::snprintf(text, sizeof text, ".bbsim-%lx-%llx-%x.tmp",
                                 static_cast<unsigned long>(getpid()),
                                 static_cast<unsigned long long>(now), ++number);
  return {text, static_cast<std::size_t>(size)};
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
  remove_temporary();
}

void AtomicFile::remove_temporary() {
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  forget_temporary(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::open_temporary() {
  temporary_ = std::filesystem::path(target_.folder()) / temporary_name();
  // Before the file exists, so that a signal in between leaves no file.
  remember_temporary(temporary_.c_str());
  descriptor_ = above_standard_streams(
      open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, any_permissions));
  const int error = descriptor_.is_open() ? 0 : errno;
  const int mode_error =
      error == 0 && target_.found ? take_after(descriptor_.get(), *target_.found) : 0;
  if (error == 0 && mode_error == 0) return;
  remove_temporary();  // no destructor runs for a constructor that throws
  if (error == ENOENT) {
    throw OutputError("cannot write " + target_.name + ": there is no folder " + target_.folder() +
                      "; create it, or write to another place");
  }
  if (error == EACCES || error == EPERM || error == EROFS) {
    throw OutputError("cannot write " + target_.name + ": " + error_text(error) + " in folder " +
                      target_.folder() +
                      "; write to another folder, or change the permissions of this one");
  }
  fail(error != 0 ? error : mode_error);
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
  if (durable_ == Durable::no || target_.written_directly()) return;
  flusher_.send(descriptor_.get(), size_ += static_cast<off_t>(bytes.size()));
}

void AtomicFile::commit() {
  flush();
  if (durable_ == Durable::yes && !target_.written_directly()) {
    if (const int error = sync_content(descriptor_.get())) fail(error);
  }
  // Reveals the last errors, which must be known before the file gets its name.
  if (const int error = descriptor_.close()) fail(error);
  if (target_.written_directly()) return;
  if (std::rename(temporary_.c_str(), target_.path.c_str()) != 0) fail(errno);
  forget_temporary(temporary_.c_str());
  temporary_.clear();
  if (durable_ == Durable::yes) {
    if (const int error = sync_folder(target_.folder())) fail(error);
  }
}

void write_file(const std::string& target, std::string_view content) {
  AtomicFile file(target);
  file.write(content);
  file.commit();
}

}  // namespace bbsim::file
