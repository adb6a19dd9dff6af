// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the program as a user does and captures what a user sees.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "support/folder.hpp"
#include "support/rights.hpp"
#include "support/sanitizers.hpp"
#include "support/text.hpp"

namespace bbsim_test {

struct Result {
  std::string line;    // the words of the command
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
class Folder : public ::Folder {
 public:
  [[nodiscard]] std::filesystem::path path() const { return name(); }

  // Writes a file into the folder and returns its path.
  std::string write(const std::string& file,
                    const std::string& text) const {  // NOLINT(modernize-use-nodiscard)
    return put(file, text);
  }
  [[nodiscard]] std::string read(const std::string& file) const {
    return content_of(path() / file);
  }
  // Sorted names of all files in the folder, including hidden ones.
  [[nodiscard]] std::vector<std::string> files() const;
};

// Path of a scenario in configs/.
std::string config(const std::string& name);

// Words of a command as a user types it. Those with blanks stand between '...'. @NAME is in
// configs/, and %NAME in the project.
std::vector<std::string> words_of(const std::string& line);
inline Result call(const std::string& line) {
  return bbsim(words_of(line));
}
inline Result call(const std::string& line, const Folder& folder) {
  return bbsim(words_of(line), folder.path());
}
// `prepare` is called before the program begins.
inline Result call(const std::string& line, const Folder& folder, std::function<void()> prepare) {
  return bbsim(Launch{words_of(line), folder.path(), 0, {}, {}, std::move(prepare)});
}
// With an environment variable.
Result call_with(const std::string& variable, const std::string& value, const std::string& line,
                 const Folder& folder);

// Checks how a command ended, and what its standard error and output contain. A text after "!" must
// not be there.
Result expect(int exit_code, Result result, const std::vector<std::string>& errors = {},
              const std::vector<std::string>& output = {});
inline Result expect(int exit_code, const std::string& line, const Folder& folder,
                     const std::vector<std::string>& errors = {},
                     const std::vector<std::string>& output = {}) {
  return expect(exit_code, call(line, folder), errors, output);
}

// The JSON that a command wrote.
nlohmann::json summary_of(const Folder& folder, const std::string& name);

inline const std::string short_scene =
    "ball: {radius: 0.01}\n"
    "gimbal: {motion: {phi: {sinusoid: {amplitude: 0.01, frequency: 1}}}}\n"
    "time: {end: 1, step: 0.1}\n";
// A scenario that takes minutes: a million seconds of a fast oscillation.
inline const std::string long_scene =
    "ball: {radius: 0.01}\n"
    "gimbal: {motion: {phi: {sinusoid: {amplitude: 1e-5, frequency: 300}}}}\n"
    "time: {end: 1e6, step: 1}\n";

}  // namespace bbsim_test
