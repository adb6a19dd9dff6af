// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the program as a user does and captures what a user sees.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/sanitizers.hpp"

namespace bbsim_test {

struct Result {
  int exit_code = -1;  // 128 + n if signal n ended it
  std::string out, err;
  double seconds = 0;  // wall clock
};

struct Launch {
  std::vector<std::string> arguments;  // without the program's name
  std::filesystem::path folder{};      // working folder; empty: current one
  int signal = 0;                      // sent after `signal_after`; 0: none
  std::chrono::milliseconds signal_after{300};
  std::function<bool()> signal_when{};  // instead: sent once this is true
  std::function<void()> prepare{};      // called in the child before exec
};

Result bbsim(const Launch& launch);
inline Result bbsim(std::vector<std::string> arguments, std::filesystem::path folder = {}) {
  return bbsim(Launch{std::move(arguments), std::move(folder), 0, {}, {}, {}});
}

// A test's own folder, removed when the object is destroyed.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ / name; }

  // Writes a file into the folder and returns its path.
  std::string write(const std::string& name,
                    const std::string& text) const;  // NOLINT(modernize-use-nodiscard)
  [[nodiscard]] std::string read(const std::string& name) const;
  // Sorted names of all files in the folder, including hidden ones.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  std::filesystem::path path_;
};

// Path of a scenario in configs/.
std::string config(const std::string& name);

}  // namespace bbsim_test
