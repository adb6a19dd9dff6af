// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/own_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "base/error.hpp"
#include "file/descriptor.hpp"
#include "file/target.hpp"

namespace bbsim::file {
namespace {

constexpr int always = O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
constexpr off_t largest_text = off_t{64} * 1024 * 1024;  // bytes; a scenario has at most 1 MiB

[[noreturn]] void refuse_kind(const std::string& name, const std::string& found) {
  throw OutputError(
      "cannot write " + name + ": it is " + found +
      "; allowed: a regular file of your own, with no other name; remove it, or choose "
      "another name with -o");
}

// Returns 0, or ENOENT if another process has just removed the file.
int check(const std::string& name, int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) fail_to_write(name, errno);
  if (!S_ISREG(status.st_mode)) refuse_kind(name, "not a regular file");
  if (status.st_uid != geteuid()) {
    refuse_kind(name, "a file of another user (number " + std::to_string(status.st_uid) + ")");
  }
  if (status.st_nlink > 1) refuse_kind(name, "a file that has another name too (a hard link)");
  return status.st_nlink == 0 ? ENOENT : 0;
}

// Returns a closed descriptor with ENOENT if the file does not exist.
Descriptor open_existing(const std::string& name, int how) {
  Descriptor file = above_standard_streams(open(name.c_str(), how | always));
  if (!file.is_open()) {
    if (errno == ELOOP) refuse_kind(name, "a symbolic link");
    if (errno != ENOENT) fail_to_write(name, errno);
    return file;
  }
  if (check(name, file.get()) == 0) return file;
  errno = ENOENT;
  return {};
}

}  // namespace

OwnFile open_own_file(const std::string& name) {
  constexpr int most_attempts = 100;  // in case other processes keep creating and removing it
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    Descriptor created = above_standard_streams(
        open(name.c_str(), O_RDWR | O_APPEND | O_CREAT | O_EXCL | always, any_permissions));
    if (created.is_open()) return {std::move(created), true};
    if (errno != EEXIST) fail_to_write(name, errno);
    Descriptor found = open_existing(name, O_RDWR | O_APPEND);
    if (found.is_open()) return {std::move(found), false};
  }
  fail_to_write(name, EBUSY);
}

bool is_name_of(const std::string& name, int descriptor) {
  struct stat named {
  }, held{};
  return lstat(name.c_str(), &named) == 0 && fstat(descriptor, &held) == 0 &&
         named.st_dev == held.st_dev && named.st_ino == held.st_ino;
}

void remove_own_file(const std::string& name, int descriptor) {
  if (is_name_of(name, descriptor)) unlink(name.c_str());
}

OwnText read_own_file(const std::string& name) {
  const Descriptor file = open_existing(name, O_RDONLY);
  if (!file.is_open()) return {};
  struct stat status {};
  if (fstat(file.get(), &status) != 0) fail_to_write(name, errno);
  if (status.st_size > largest_text) {
    throw OutputError("cannot read " + name + ": it is larger than any plan of a sweep");
  }
  OwnText read{std::string(static_cast<std::size_t>(status.st_size), '\0'), true};
  const ssize_t size = read_at(file.get(), read.text.data(), read.text.size(), 0);
  if (size < 0) throw OutputError("cannot read " + name + ": " + error_text(errno));
  read.text.resize(static_cast<std::size_t>(size));
  return read;
}

}  // namespace bbsim::file
