// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The errors that reach the user, one type for each exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim {

// The exit codes of bbsim. Scripts rely on the numbers.
enum class ExitCode : int {
  done = 0,
  ended_early = 1,  // also: compared files differ
  input_at_fault = 2,
  output_failed = 3,
  interrupted = 130,
};

// A fault in a scenario. `where` is "file:line:column" or "--set key=value".
struct Problem {
  std::string where;
  std::string message;  // the key's path, then the value found and the values allowed
};

// The scenario or the command line is wrong. what() has one line for each problem.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(const std::string& message) : InputError({Problem{"", message}}) {}

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// A key of the scenario is wrong in a way that only the model detects. The model does not know the
// key's place in the file; the caller adds it. what() begins with the key.
class KeyError : public InputError {
 public:
  KeyError(const std::string& key, const std::string& message)
      : InputError(key + ": " + message), key_(key) {}

  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  std::string key_;
};

// The output cannot be written: the disk is full, or permission is missing.
class OutputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The reader closed the pipe that takes the output, as `head` does in `bbsim ... | head`.
class ReaderGone : public OutputError {
  using OutputError::OutputError;
};

// Parts of a message about a key: "ball.radius: found -1; allowed: a length greater than 0".
struct KeyAndHint {
  std::string key;   // ball.radius; empty if the message begins with no key
  std::string hint;  // "did you mean radius?", "allowed: ..."; may be empty
};

[[nodiscard]] KeyAndHint key_and_hint(std::string_view message);

}  // namespace bbsim
