// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sketches compiled and run by the program.
#pragma once

#include <string>
#include <vector>

#include "app/process.hpp"

namespace bbsim_test {

inline std::string sketches(const std::string& name) {
  return std::string(BBSIM_SOURCE_DIR) + "/tests/sketch/sketches/" + name;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A sketch in the folder sketches/, compiled into its own library.
class Sketch {
 public:
  explicit Sketch(const std::string& name, const std::vector<std::string>& more_files = {})
      : wiring_(sketches(name + "/wiring.yaml")) {
    std::vector<std::string> words{"sketch", sketches(name + "/" + name + ".ino")};
    for (const std::string& file : more_files) words.push_back(sketches(name + "/" + file));
    words.insert(words.end(), {"-I", sketches("libraries"), "-o", library()});
    made = bbsim(words);
  }
  // A sketch with the given text and wiring.
  Sketch(const std::string& text, const std::string& wiring)
      : wiring_(folder_.write("wiring.yaml", wiring)) {
    made = bbsim({"sketch", folder_.write("own.ino", text), "-o", library()});
  }

  // The arguments that run a command on the rig, driven by the sketch.
  [[nodiscard]] std::vector<std::string> words(const std::string& command,
                                               std::vector<std::string> more = {}) const {
    std::vector<std::string> words{
        command, std::string(BBSIM_SOURCE_DIR) + "/tests/sketch/rig.yaml",
        "--set", "controller.library.file=" + library(),
        "--set", "controller.library.wiring=" + wiring_};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  [[nodiscard]] std::string library() const { return folder_ / "sketch.so"; }
  [[nodiscard]] const Folder& folder() const { return folder_; }

  Result made;

 private:
  Folder folder_;
  std::string wiring_;
};

}  // namespace bbsim_test
