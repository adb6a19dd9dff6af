// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the wiring of a sketch's board from YAML (docs/reference/wiring.md).
#pragma once

#include <bbsim/wiring.h>

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
  [[nodiscard]] const bbsim_wiring* get() const { return &c_; }
  [[nodiscard]] bool has_steppers() const {
    return c_.steppers[0].step >= 0 || c_.steppers[1].step >= 0;
  }
  [[nodiscard]] Print print() const { return print_; }
  // The files that were read.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

 private:
  bbsim_wiring c_{};
  Print print_ = Print::first;
  std::string frame_, lost_, eeprom_;
  std::vector<bbsim_wired_input> inputs_;
  std::vector<int> ignored_;
  std::vector<std::string> files_;
};

}  // namespace bbsim::sketch
