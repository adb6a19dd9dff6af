// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sketches compiled and run by the program.
#pragma once

#include <filesystem>
#include <string>

#include "app/process.hpp"

namespace bbsim_test {

const std::string plain_wiring = "servos: {phi: {pin: 9}, theta: {pin: 10}}\n";

// A sketch that compiles into its own library, unless `compiles` is false.
class Sketch : public Folder {
 public:
  // One of the folder sketches/, with all its .ino files.
  explicit Sketch(const std::string& name)
      : wiring_(BBSIM_SOURCE_DIR "/tests/sketch/sketches/" + name + "/wiring.yaml") {
    const std::filesystem::path source = BBSIM_SOURCE_DIR "/tests/sketch/sketches/" + name;
    std::string line = "sketch " + (source / name).string() + ".ino";
    for (const auto& file : std::filesystem::directory_iterator(source)) {
      if (file.path().extension() == ".ino" && file.path().stem() != name) {
        line += ' ' + file.path().string();
      }
    }
    made = expect(0, line + " -I %tests/sketch/sketches/libraries -o sketch.so", *this);
  }
  Sketch(const std::string& text, const std::string& wiring, bool compiles = true)
      : wiring_(write("wiring.yaml", wiring)) {
    write("own.ino", text);
    made = call("sketch own.ino -o sketch.so", *this);
    if (compiles) expect(0, made);
  }

  // Runs a command on the rig, driven by the sketch.
  [[nodiscard]] Result on_rig(const std::string& command, const std::string& more = "") const {
    return call(command + " %tests/sketch/rig.yaml --set 'controller.library.file=" +
                    (*this / "sketch.so") + "' --set controller.library.wiring=" + wiring_ + more,
                *this);
  }
  // Prints the rows of a run.
  [[nodiscard]] Result run(const std::string& more = "") const {
    return on_rig("run", " -o - " + more);
  }

  Result made;

 private:
  std::string wiring_;
};

}  // namespace bbsim_test
