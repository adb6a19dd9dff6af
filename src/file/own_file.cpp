// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/own_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "base/error.hpp"
#include "file/target.hpp"

namespace bbsim::file {
namespace {

constexpr int always = O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;

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

Descriptor open_own_file(const std::string& name) {
  constexpr int most_attempts = 100;  // in case other processes keep creating and removing it
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    Descriptor created = above_standard_streams(
        open(name.c_str(), O_RDWR | O_APPEND | O_CREAT | O_EXCL | always, any_permissions));
    if (created.is_open()) return created;
    if (errno != EEXIST) fail_to_write(name, errno);
    Descriptor found = open_existing(name, O_RDWR | O_APPEND);
    if (found.is_open()) return found;
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

Descriptor find_own_file(const std::string& name) {
  return open_existing(name, O_RDONLY);
}

}  // namespace bbsim::file
