// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/outputs.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "base/error.hpp"
#include "file/target.hpp"

namespace bbsim::file {

std::optional<Outputs::Place> Outputs::place_of(const std::string& file, int standard_stream) {
  struct stat status {};
  if ((file == "-" ? fstat(standard_stream, &status) : stat(file.c_str(), &status)) == 0) {
    if (!S_ISREG(status.st_mode)) return {};
    return Place{status.st_dev, status.st_ino, ""};
  }
  if (file == "-" || errno != ENOENT) return {};
  const std::optional<std::string> path = follow_links(file);
  if (!path || stat(folder_of(*path).c_str(), &status) != 0) return {};
  return Place{status.st_dev, status.st_ino, std::filesystem::path(*path).filename()};
}

void Outputs::reads(const std::string& file, const std::string& what) {
  if (const auto place = place_of(file, STDIN_FILENO)) files_.push_back({file, what, true, *place});
}

void Outputs::writes(const std::string& file, const std::string& what) {
  auto place = place_of(file, STDOUT_FILENO);
  if (!place && file == "-") place = Place{0, 0, file};  // a pipe cannot hold two tables
  if (!place) return;
  const auto shown = [](const std::string& name, const char* stream) {
    return name == "-" ? std::string(stream) : name;
  };
  for (const File& earlier : files_) {
    if (earlier.place != *place) continue;
    throw InputError("cannot write " + shown(file, "standard output") + " (" + what +
                     "): it is the same file as " +
                     shown(earlier.name, earlier.read ? "standard input" : "standard output") +
                     " (" + earlier.what + "), which is " +
                     (earlier.read ? "read here" : "written here, too") +
                     "; allowed: a file of its own");
  }
  files_.push_back({file, what, false, *place});
}

}  // namespace bbsim::file
