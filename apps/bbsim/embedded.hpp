// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Files of the repository that are embedded in the program (cmake/embed.cmake), its licenses among
// them, and its version.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace bbsim::app {

struct EmbeddedFile {
  std::string_view name, text;
};

// configs/: scenarios and their tables.
[[nodiscard]] std::span<const EmbeddedFile> example_files();
// examples/templates/: controllers to start from.
[[nodiscard]] std::span<const EmbeddedFile> template_files();
// The options of commands that live beside the program.
[[nodiscard]] std::span<const EmbeddedFile> command_tables();

// Text of the file of that name, which must exist.
[[nodiscard]] std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name);

// Lines: the version, the chosen instruction set, the commit of the source, the libraries of the
// build.
[[nodiscard]] std::string version();

[[nodiscard]] std::string licenses();

}  // namespace bbsim::app
