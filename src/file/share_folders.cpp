// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/share_folders.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace bbsim::file {

std::vector<std::string> share_folders() {
  if (const char* folder = std::getenv("BBSIM_SHARE_PATH"); folder != nullptr && *folder != '\0') {
    return {folder};
  }
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path prefix = program.parent_path().parent_path();
  std::vector<std::string> folders{prefix / "share" / "bbsim"};
  const std::string installed = prefix / BBSIM_INSTALL_DATADIR / "bbsim";
  if (installed != folders.front()) folders.push_back(installed);
  return folders;
}

}  // namespace bbsim::file
