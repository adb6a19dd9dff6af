// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/share_folders.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace bbsim::file {

namespace {

// PREFIX/NAME/bbsim of the program, and the same with the folder's name when it was built.
std::vector<std::string> folders_of_prefix(const char* name, const char* installed) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path prefix = program.parent_path().parent_path();
  std::vector<std::string> folders{prefix / name / "bbsim"};
  const std::string other = prefix / installed / "bbsim";
  if (other != folders.front()) folders.push_back(other);
  return folders;
}

}  // namespace

std::vector<std::string> share_folders() {
  if (const char* folder = std::getenv("BBSIM_SHARE_PATH"); folder != nullptr && *folder != '\0') {
    return {folder};
  }
  return folders_of_prefix("share", BBSIM_INSTALL_DATADIR);
}

std::vector<std::string> libexec_folders() {
  return folders_of_prefix("libexec", BBSIM_INSTALL_LIBEXECDIR);
}

}  // namespace bbsim::file
