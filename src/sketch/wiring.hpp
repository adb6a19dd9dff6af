// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the wiring of a sketch's board from YAML (docs/reference/wiring.md).
#pragma once

#include <bbsim/wiring.h>

#include <optional>
#include <string>
#include <vector>

namespace bbsim::sketch {

// "7" or "A0".
[[nodiscard]] std::string pin_name(int pin);

// Holds the data that the C structure points to. Cannot be copied or moved.
class Wiring {
 public:
  // Which of the lines that the sketch prints are shown.
  enum class Print { off, first, all };

  // Reads the file. Throws InputError with every problem found, "file:line:column: key: found ...,
  // allowed ...".
  explicit Wiring(const std::string& file);
  Wiring(const Wiring&) = delete;
  Wiring& operator=(const Wiring&) = delete;

  // Its `print` is null.
  [[nodiscard]] const bbsim_wiring* get() const { return &content_.c; }
  [[nodiscard]] bool has_steppers() const {
    return content_.c.steppers[0].step >= 0 || content_.c.steppers[1].step >= 0;
  }
  [[nodiscard]] Print print() const { return content_.print; }
  // The files that were read.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

  // What the file has. The pointers in `c` are set once all of it is read.
  struct Content {
    bbsim_wiring c{};
    Print print = Print::first;
    std::string frame, lost, eeprom_file, eeprom;
    std::optional<int> eeprom_size;
    std::vector<bbsim_wired_input> inputs;
    std::vector<int> ignored;
  };

 private:
  Content content_;
  std::vector<std::string> files_;
};

}  // namespace bbsim::sketch
