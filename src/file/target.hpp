// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds out where output under a given name goes.
#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>

namespace bbsim::file {

struct Target {
  std::string name;  // in messages
  std::string path;  // with symbolic links resolved; the file may not exist yet
  // The descriptor of this process that the name stands for ("-", /dev/stdout and others). Opening
  // the name again would lose the position in a file that the shell redirects to.
  std::optional<int> descriptor{};
  std::optional<struct stat> found{};  // the existing file's status; empty for a descriptor

  // Whether to write directly, because the target is a device, a FIFO or a descriptor. Renaming a
  // file over it would destroy it.
  [[nodiscard]] bool written_directly() const {
    return descriptor || (found && !S_ISREG(found->st_mode));
  }
  [[nodiscard]] std::string folder() const;
};

// Throws OutputError if the name cannot be written: a folder, a cycle of links, a name that is too
// long, or a write-protected file (replacing it would change it all the same).
[[nodiscard]] Target find_target(const std::string& name);

// Whether the name is "-" or stands for a device, a pipe or an open descriptor.
[[nodiscard]] bool is_written_directly(const std::string& name);

// The name with symbolic links resolved; the file may not exist yet. Stops at the name of a
// descriptor (/dev/stdout links to one). On failure, sets errno and returns nothing.
[[nodiscard]] std::optional<std::string> follow_links(const std::string& name);

[[nodiscard]] std::string folder_of(const std::string& path);

// Gives a file the permissions of the file that it will replace, and its owner if the system allows
// it. Returns an errno, or 0.
[[nodiscard]] int take_after(int descriptor, const struct stat& replaced);

// Throws the OutputError for an errno: the name, the reason and the remedy.
[[noreturn]] void fail_to_write(const std::string& name, int error_number);

}  // namespace bbsim::file
