// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Files of the repository that the program has in it (cmake/embed.cmake).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim::app {

struct EmbeddedFile {
  std::string_view name, text;
};

// configs/: the scenarios, and the tables that they read.
[[nodiscard]] std::span<const EmbeddedFile> example_files();
// examples/templates/: controllers to begin with.
[[nodiscard]] std::span<const EmbeddedFile> template_files();
// The license of bbsim and those of the libraries in it.
[[nodiscard]] std::span<const EmbeddedFile> license_files();

// The one of that name, which is there.
[[nodiscard]] std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name);

struct Copy {
  std::string file;
  std::string_view text;
};

// Writes the copies. The first one is what -o names, if `named`; it and the others must be new
// files otherwise, or the others as they are there, unless `force`.
void write_copies(const std::vector<Copy>& copies, bool named, bool force);

}  // namespace bbsim::app
