// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/share_folders.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <system_error>

namespace bbsim::file {

std::vector<std::string> folders_of_prefix(const char* name, const char* installed) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const std::filesystem::path prefix = program.parent_path().parent_path();
  std::vector<std::string> folders{prefix / name / "bbsim"};
  const std::string as_built = prefix / installed / "bbsim";
  if (as_built != folders.front()) folders.push_back(as_built);
  return folders;
}

std::vector<std::string> folders_above(const std::filesystem::path& library, int levels,
                                       const std::filesystem::path& name) {
  std::vector<std::string> folders;
  std::filesystem::path folder = library.parent_path();
  for (int up = 0; up < levels && folder != folder.root_path(); ++up) {
    folders.push_back(folder / name);
    folder = folder.parent_path();
  }
  return folders;
}

std::filesystem::path own_library() {
  static constexpr char here = 0;
  Dl_info found{};
  if (dladdr(&here, &found) == 0 || found.dli_fname == nullptr) return {};
  const std::filesystem::path file(found.dli_fname);  // for a program: the name it was called by
  if (file.filename().string().find(".so") == std::string::npos) return {};
  std::error_code error;
  std::filesystem::path whole = std::filesystem::canonical(file, error);
  return error ? std::filesystem::path() : whole;
}

std::vector<std::string> share_folders() {
  if (const char* folder = std::getenv("BBSIM_SHARE_PATH"); folder != nullptr && *folder != '\0') {
    return {folder};
  }
  std::vector<std::string> folders = folders_of_prefix("share", BBSIM_INSTALL_DATADIR);
  // A Python module in PREFIX/lib/python3/dist-packages/bbsim, or in a wheel, which has its own.
  const std::vector<std::string> more = folders_above(own_library(), 6, "share/bbsim");
  folders.insert(folders.end(), more.begin(), more.end());
  return folders;
}

std::vector<std::string> libexec_folders() {
  return folders_of_prefix("libexec", BBSIM_INSTALL_LIBEXECDIR);
}

}  // namespace bbsim::file
