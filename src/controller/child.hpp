// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A child process that answers each line with a line.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "file/descriptor.hpp"

namespace bbsim::controller {

// Shows a line to the user at the terminal.
using Report = std::function<void(std::string_view line)>;

// Why there is no answer: "it did not answer within 1 s; it was still running, and has been ended".
class ChildFault : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Thrown while waiting for the child if `stop` is true.
class ChildInterrupted : public std::exception {};

// The child runs in its own process group. The destructor ends it and the group.
class Child {
 public:
  // Starts the program. `tell` receives the lines of its standard error. `stop`, which may be null,
  // ends all waiting once it is true. Throws std::system_error if the program cannot be started.
  Child(const std::vector<std::string>& words, const std::string& folder, Report report,
        const std::atomic<bool>* stop);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Sends a line. Returns the answer without its line break, which is valid until the next call.
  // Throws ChildFault if there is no proper answer within `timeout` (s), after which the child is
  // gone, and ChildInterrupted.
  std::string_view ask(std::string_view line, double timeout);

  // Ends the child because of its answer. The fault says `why`, and how the child ended.
  [[nodiscard]] ChildFault refuse(const std::string& why);

  // Closes the child's input, and gives it at most a second to end by itself.
  void finish();

 private:
  void send(std::string_view line);
  void receive();
  void wait(short for_output);
  void listen();
  void say_lines(bool all);
  void refuse_early_words();
  [[noreturn]] void fail(const std::string& why);
  [[noreturn]] void fail_by_silence();
  [[nodiscard]] bool has_ended(int milliseconds) const;
  [[nodiscard]] std::optional<int> end();
  [[nodiscard]] std::string_view received() const { return {buffer_.data(), size_}; }

  Report report_;
  const std::atomic<bool>* stop_;
  pid_t process_ = 0;  // 0 once reaped
  file::Descriptor input_, output_, error_, ended_;
  std::vector<char> buffer_;           // output of the child; as long as the longest line
  std::size_t size_ = 0, answer_ = 0;  // of the output in it; of the last answer with its break
  std::string complaint_;              // from the standard error, not yet told
  double timeout_ = 0, deadline_ = 0;  // s
  int patience_ = 0;                   // attempts to read an answer before waiting
  std::size_t asked_ = 0;
};

}  // namespace bbsim::controller
