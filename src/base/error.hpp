// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The errors that reach the person at the terminal, one type for each exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace bbsim {

// What a process of bbsim returns. Scripts rely on the numbers.
enum class ExitCode : int {
  done = 0,
  ended_early = 1,  // also: compared files differ
  input_at_fault = 2,
  output_failed = 3,
  interrupted = 130,
};

// One fault of a scenario. `where` is "file:line:column" or "--set key=value".
struct Problem {
  std::string where;
  std::string message;  // key path, what was found, what is allowed
};

// The scenario or the command line is at fault. what() has one line a problem.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(const std::string& message) : InputError({Problem{"", message}}) {}

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// A key of the scenario is at fault, as only its model can tell, which does not know where the key
// stands. what() begins with the key.
class KeyError : public InputError {
 public:
  KeyError(const std::string& key, const std::string& message)
      : InputError(key + ": " + message), key_(key) {}

  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  std::string key_;
};

// The output could not be written: a full disk, a folder without permission.
class OutputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Nobody reads the pipe any more that the output goes to: `bbsim ... | head` has seen enough.
class ReaderGone : public OutputError {
  using OutputError::OutputError;
};

}  // namespace bbsim
