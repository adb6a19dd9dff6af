// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sketch/libraries.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "file/whole_file.hpp"
#include "sketch/source.hpp"

namespace bbsim::sketch {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// The entries of a folder, sorted, because a file system lists them in arbitrary order.
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

bool is_source(const fs::path& path) {
  const std::string ending = path.extension().string();
  return (ending == ".cpp" || ending == ".cc" || ending == ".c") && is_file(path);
}

class Search {
 public:
  Search(const std::vector<std::string>& own, const std::vector<std::string>& given,
         std::string ours)
      : own_(own), given_(given), ours_(std::move(ours)) {}

  void follow(const std::string& header) {
    if (!seen_.insert(header).second || is_file(fs::path(ours_) / header)) return;
    for (const fs::path folder : own_) {
      if (!is_file(folder / header)) continue;
      read(folder / header);
      for (const char* ending : {".cpp", ".cc", ".c"}) {
        fs::path source = folder / header;
        source.replace_extension(ending);
        if (is_source(source)) add(source);
      }
      return;
    }
    for (const fs::path given : given_) {
      for (const fs::path& folder : candidates(given, header)) {
        if (!is_file(folder / header)) continue;
        add_library(folder);
        return;
      }
    }
  }
  // Adds the sources of a sketch's folder and of src/ in it. Those of which the board has a header
  // are copies of what it replaces.
  void add_whole(const fs::path& folder) {
    for (const fs::path& entry : entries(folder)) {
      fs::path header = entry.filename();
      header.replace_extension(".h");
      if (is_source(entry) && !is_file(fs::path(ours_) / header)) add(entry);
    }
    add_sources(folder / "src", true);
  }
  Libraries found;

 private:
  static std::vector<fs::path> candidates(const fs::path& given, const fs::path& header) {
    std::vector<fs::path> folders{given, given / "src", given / header.stem(),
                                  given / header.stem() / "src"};
    for (const fs::path& entry : entries(given)) {
      folders.push_back(entry);
      folders.push_back(entry / "src");
    }
    return folders;
  }

  void add_library(const fs::path& folder) {
    if (std::ranges::find(found.folders, folder.string()) != found.folders.end()) return;
    found.folders.push_back(folder.string());
    add_sources(folder, folder.filename() == "src");
    add_sources(folder / "utility", true);
    for (const fs::path& entry : entries(folder)) {
      if (entry.extension() == ".h") read(entry);
    }
  }
  void add_sources(const fs::path& folder, bool below) {
    std::error_code error;
    for (const fs::path& entry : entries(folder)) {
      if (is_source(entry)) add(entry);
      if (below && fs::is_directory(entry, error)) add_sources(entry, true);
    }
  }
  void add(const fs::path& source) {
    if (std::ranges::find(found.sources, source.string()) != found.sources.end()) return;
    found.sources.push_back(source.string());
    read(source);
  }
  void read(const fs::path& file) {
    for (const std::string& header : includes_of(file::read_whole(file.string()))) follow(header);
  }

  const std::vector<std::string>& own_;
  const std::vector<std::string>& given_;
  std::string ours_;
  std::set<std::string> seen_;
};

}  // namespace

Libraries find_libraries(const std::vector<std::string>& included,
                         const std::vector<std::string>& own, const std::vector<std::string>& given,
                         const std::string& ours, const std::vector<std::string>& whole) {
  Search search(own, given, ours);
  for (const std::string& folder : whole) search.add_whole(folder);
  for (const std::string& header : included) search.follow(header);
  return std::move(search.found);
}

}  // namespace bbsim::sketch
