// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/target.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/descriptor.hpp"

namespace bbsim::file {
namespace {

// The number N for /proc/self/fd/N and /dev/fd/N; 1 for "-".
std::optional<int> own_descriptor(std::string_view path) {
  if (path == "-") return STDOUT_FILENO;
  for (std::string_view folder : {"/proc/self/fd/", "/dev/fd/"}) {
    if (!path.starts_with(folder)) continue;
    const auto number = number_in<int>(path.substr(folder.size()));
    if (number && *number >= 0) return number;
  }
  return std::nullopt;
}

std::string advice(int error_number, const std::string& name) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "; free some, or write to another place";
    case EFBIG:
      return "; the limit is the file system's, or that of ulimit -f";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; write to another folder, or change the permissions of " + name;
    case ENOENT:
      return "; create its folder, or write to another place";
    case ENAMETOOLONG:
      return "; choose a shorter one";
    default:
      return "";
  }
}

}  // namespace

std::optional<std::string> follow_links(const std::string& name) {
  std::filesystem::path path = name;
  constexpr int most_links = 40;  // Linux's limit
  for (int links = 0; links <= most_links; ++links) {
    struct stat status {};
    if (own_descriptor(path.native())) return path;
    if (lstat(path.c_str(), &status) != 0) {
      if (errno == ENOENT) return path;
      return std::nullopt;
    }
    if (!S_ISLNK(status.st_mode)) return path;
    std::error_code error;
    const std::filesystem::path link = std::filesystem::read_symlink(path, error);
    if (error) {
      errno = error.value();
      return std::nullopt;
    }
    path = path.parent_path() / link;  // an absolute link replaces the path
  }
  errno = ELOOP;
  return std::nullopt;
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

std::string Target::folder() const {
  return folder_of(path);
}

Target find_target(const std::string& name) {
  if (name.empty()) throw OutputError("cannot write: the file's name is empty");
  Target target{name == "-" ? "standard output" : name, name, own_descriptor(name)};
  if (target.descriptor) return target;

  // stat() follows the links first, so that the system's own rules apply.
  struct stat status {};
  const bool exists = stat(name.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail_to_write(name, errno);
  if (exists && S_ISDIR(status.st_mode)) fail_to_write(name, EISDIR);
  if (exists) target.found = status;

  const std::optional<std::string> path = follow_links(name);
  if (!path) fail_to_write(name, errno);
  target.path = *path;
  target.descriptor = own_descriptor(*path);
  if (target.written_directly()) return target;
  if (std::filesystem::path(*path).filename().empty()) fail_to_write(name, EISDIR);
  if (exists && faccessat(AT_FDCWD, path->c_str(), W_OK, AT_EACCESS) != 0) {
    fail_to_write(name, errno);
  }
  return target;
}

bool is_written_directly(const std::string& name) {
  if (own_descriptor(name)) return true;
  if (const auto path = follow_links(name); path && own_descriptor(*path)) return true;
  struct stat status {};
  return stat(name.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

int take_after(int descriptor, const struct stat& replaced) {
  if (replaced.st_uid != geteuid() || replaced.st_gid != getegid()) {
    [[maybe_unused]] const int ignored = fchown(descriptor, replaced.st_uid, replaced.st_gid);
  }
  constexpr mode_t all_permissions = 07777;
  // Must follow fchown(), which clears some permission bits.
  return fchmod(descriptor, replaced.st_mode & all_permissions) == 0 ? 0 : errno;
}

void fail_to_write(const std::string& name, int error_number) {
  const std::string message =
      "cannot write " + name + ": " + error_text(error_number) + advice(error_number, name);
  if (error_number == EPIPE) throw ReaderGone(message);
  throw OutputError(message);
}

}  // namespace bbsim::file
