// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sketch/compile.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>

#include "base/error.hpp"
#include "file/descriptor.hpp"
#include "file/leftovers.hpp"
#include "file/share_folders.hpp"
#include "file/start_process.hpp"
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

constexpr const char* purpose = "compile the sketch";
constexpr std::size_t most_in_a_file = (std::size_t{16} << 20U) - 1;  // bytes

// The folder of the board's headers and sources.
std::string board_folder() {
  std::string looked_in;
  for (const std::string& share : file::share_folders()) {
    const fs::path folder = fs::path(share) / "arduino";
    std::error_code error;
    if (fs::exists(folder / "runtime.cpp", error)) return folder.string();
    looked_in.append(looked_in.empty() ? "" : " and ").append(folder.string());
  }
  throw OutputError(std::string("cannot ") + purpose + ": the board's sources are not in " +
                    looked_in + "; install all of bbsim, or set BBSIM_SHARE_PATH to share/bbsim");
}

// A folder that is removed at the end, with all files in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    path_ = (fs::temp_directory_path(error) / "bbsim-XXXXXX").string();
    if (error || mkdtemp(path_.data()) == nullptr) {
      throw OutputError(std::string("cannot ") + purpose +
                        ": no temporary folder: " + std::strerror(errno));
    }
    library_ = path_ + "/sketch.so";
    file::remember_temporary(library_.c_str());
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
    file::forget_temporary(library_.c_str());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::string& library() const { return library_; }

 private:
  std::string path_, library_;
};

// $CXX or, if it is not set, the first of c++ and g++ that runs.
class Compiler {
 public:
  Compiler() {
    const char* const chosen = std::getenv("CXX");
    const bool choice = chosen != nullptr && *chosen != '\0';
    for (const char* name : {choice ? chosen : "c++", choice ? "" : "g++"}) {
      std::istringstream words(name);
      words_.clear();
      for (std::string word; words >> word;) words_.push_back(word);
      if (words_.empty()) break;
      const auto version = run({"--version"});
      if (version && version->well()) {
        clang_ = version->output.find("clang") != std::string::npos;
        return;
      }
    }
    throw OutputError(std::string("cannot ") + purpose + ": there is no C++ compiler" +
                      (choice ? " " + std::string(chosen) + " (CXX)" : "") +
                      "; install one (Debian: apt install g++), or set CXX to one");
  }
  [[nodiscard]] std::optional<file::Finished> run(const std::vector<std::string>& arguments,
                                                  const std::string& input = "") const {
    std::vector<std::string> words = words_;
    words.insert(words.end(), arguments.begin(), arguments.end());
    return file::run_program(words, input, purpose);
  }
  // Options for all sources. Symbols are hidden, so that copies of the library share none.
  [[nodiscard]] std::vector<std::string> options(const std::string& board) const {
    std::vector<std::string> options{"-std=gnu++17",
                                     "-O2",
                                     "-fPIC",
                                     "-fvisibility=hidden",
                                     "-fvisibility-inlines-hidden",
                                     "-ffp-contract=off",
                                     "-DARDUINO=10819",
                                     "-DF_CPU=16000000L",
                                     "-I",  // before the sketch's, which may have copies
                                     board};
    if (!clang_) options.emplace_back("-fpermissive");  // as the IDE does
    return options;
  }

 private:
  std::vector<std::string> words_;
  bool clang_ = false;
};

struct Sources {
  std::vector<SketchFile> files;
  std::vector<std::string> own;  // folders
  Libraries libraries;
};

Sources read(const Job& job, const std::string& board) {
  Sources sources;
  std::vector<std::string> included;
  for (const std::string& name : job.files) {
    std::string text = file::read_whole(name, {}, most_in_a_file);
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    for (const std::string& header : includes_of(text)) included.push_back(header);
    sources.files.push_back({name, std::move(text)});
    const std::string folder = fs::path(name).parent_path().string();
    sources.own.push_back(folder.empty() ? "." : folder);
  }
  for (const std::string& folder : job.folders) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
      throw InputError("-I " + folder + ": found no folder; allowed: a folder of libraries");
    }
  }
  // The IDE compiles all of a sketch's folder, which has the sketch's name.
  std::vector<std::string> whole;
  const fs::path sketch = fs::absolute(job.files.front());
  if (sketch.parent_path().filename() == sketch.stem()) whole.push_back(sources.own.front());
  sources.libraries = find_libraries(included, sources.own, job.folders, board, whole);
  return sources;
}

}  // namespace

Libraries find_libraries(const std::vector<std::string>& included,
                         const std::vector<std::string>& own, const std::vector<std::string>& given,
                         const std::string& ours, const std::vector<std::string>& whole) {
  Search search(own, given, ours);
  for (const std::string& folder : whole) search.add_whole(folder);
  for (const std::string& header : included) search.follow(header);
  return std::move(search.found);
}

std::vector<std::string> files_of(const Job& job) {
  std::vector<std::string> files = job.files;
  for (std::string& source : read(job, board_folder()).libraries.sources) {
    files.push_back(std::move(source));
  }
  return files;
}

Compiled compile(const Job& job) {
  const std::string board = board_folder();
  const Sources sources = read(job, board);
  const Compiler compiler;
  const TemporaryFolder folder;

  std::vector<std::string> words = compiler.options(board);
  words.insert(words.end(), {"-Wall", "-shared", "-s", "-Wl,-z,defs", "-fuse-ld=bfd",
                             "-Wl,-T," + board + "/constructors.ld", "-o", folder.library()});
  for (const std::string& own : sources.own) words.insert(words.end(), {"-I", own});
  for (const std::string& own : sources.libraries.folders) words.insert(words.end(), {"-I", own});
  // With "-", compilers would look for quoted headers in the present folder first.
  words.insert(words.end(), {"-x", "c++", "/dev/stdin", board + "/runtime.cpp"});
  for (const std::string& source : sources.libraries.sources) words.push_back(source);
  const auto library = compiler.run(words, joined(sources.files));
  if (!library) throw OutputError(std::string("cannot ") + purpose + ": the compiler is gone");
  Compiled compiled{"", library->complaint};
  if (library->well()) compiled.library = file::read_whole(folder.library()) + library_mark;
  return compiled;
}

}  // namespace bbsim::sketch
