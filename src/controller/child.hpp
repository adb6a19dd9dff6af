// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A process that answers lines with lines.
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

// What reaches the person at the terminal, a line at a time.
using Tell = std::function<void(std::string_view line)>;

// Why there is no answer: "it did not answer within 1 s; it was still running, and has been ended".
class ChildFault : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Whoever waits for it was asked to end.
class ChildInterrupted : public std::exception {};

// It runs in a process group of its own. It ends with this object at the latest, and with it all
// that it has started, in whatever group.
class Child {
 public:
  // Starts the program; `tell` gets what it says on its standard error, and `stop`, which may be
  // null, ends all waiting once it is true. Throws std::system_error if it cannot be started.
  Child(const std::vector<std::string>& words, const std::string& folder, Tell tell,
        const std::atomic<bool>* stop);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Sends a line, and returns the line that it answers within so many seconds, without its break;
  // it is there until the next call. Throws ChildFault, after which there is none any more, and
  // ChildInterrupted.
  std::string_view ask(std::string_view line, double timeout);

  // Ends it because of what it answered; the fault is `why`, and how it ended.
  [[nodiscard]] ChildFault refuse(const std::string& why);

  // Lets it come to its end by itself, at the end of its input, for a second at most.
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

  Tell tell_;
  const std::atomic<bool>* stop_;
  std::string mark_;   // of it and of what it starts
  pid_t process_ = 0;  // 0 once it was waited for
  file::Descriptor input_, output_, error_, ended_;
  std::vector<char> buffer_;           // of what it says, as long as a line may be
  std::size_t size_ = 0, answer_ = 0;  // of what is in it; of the last answer and its break
  std::string complaint_;              // on its standard error, not yet told
  double timeout_ = 0, deadline_ = 0;  // s
  int patience_ = 0;                   // looks for an answer before it is waited for
  std::size_t asked_ = 0;
};

}  // namespace bbsim::controller
