// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a name that is to be written to stands for.
#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>

namespace bbsim::file {

struct Target {
  std::string name;  // as messages call it
  std::string path;  // behind the symbolic links; what it ends in may not be there yet
  // The descriptor of this process that "-", /dev/stdout and the like stand for. Opening such a
  // name again would lose the position of what the shell has redirected to a file.
  std::optional<int> descriptor{};
  std::optional<struct stat> found{};  // what is there; not looked at behind a descriptor

  // To what is no regular file (a device, a FIFO, a descriptor) bytes go as they come: renaming a
  // file over it would destroy it.
  [[nodiscard]] bool written_directly() const {
    return descriptor || (found && !S_ISREG(found->st_mode));
  }
  [[nodiscard]] std::string folder() const;
};

// Throws OutputError where nothing can be written: a folder, a circle of links, a name that is too
// long, a file that is write-protected (replacing it would be no less of a change).
[[nodiscard]] Target find_target(const std::string& name);

// True if the name stands for a device, a pipe or an open descriptor, or is "-".
[[nodiscard]] bool is_written_directly(const std::string& name);

// The name behind the symbolic links, which may not exist yet; stops at a descriptor's name
// (/dev/stdout is a link to one). Sets errno and returns nothing if it cannot be told.
[[nodiscard]] std::optional<std::string> follow_links(const std::string& name);

[[nodiscard]] std::string folder_of(const std::string& path);

// Gives a file that is to replace another one its owner, where the system allows it, and its
// permissions. Returns an errno, or 0.
[[nodiscard]] int take_after(int descriptor, const struct stat& replaced);

// Throws the OutputError for an errno: the name, the reason, and what to do about it.
[[noreturn]] void fail_to_write(const std::string& name, int error_number);

}  // namespace bbsim::file
