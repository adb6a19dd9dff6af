// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Functions of a library that end the process in place of returning: exit() and its like are this
// program's own (foreign_exit.cpp), and end the call where they can.
#pragma once

#include <exception>
#include <string>
#include <tuple>
#include <type_traits>

namespace bbsim::controller {

// What a function called in place of returning.
class ExitCalled : public std::exception {
 public:
  ExitCalled(const char* function, int status) : function_(function), status_(status) {}
  // "it called exit(0), which would have ended bbsim"
  [[nodiscard]] std::string text() const;

 private:
  const char* function_;
  int status_;
};

// From here on a thread of a library's own that ends the process, and whatever else does so behind
// bbsim's back, ends it with exit code 1 and a message that names the library.
void expect_foreign_exits(const std::string& path);

// While there is one, code of a library runs in this thread that cannot be left: it is being
// opened. If it ends the process, the message is said.
class CannotReturn {
 public:
  CannotReturn();
  ~CannotReturn();
  CannotReturn(const CannotReturn&) = delete;
  CannotReturn& operator=(const CannotReturn&) = delete;
};

// Calls function(data). Throws ExitCalled if it ends the process, in this thread; nothing of what
// it had on its stack is then destroyed.
void call_foreign(void (*function)(void*), void* data);

// The same of any function and its arguments, which are plain; returns what it does.
template <class Result, class... Parameters, class... Arguments>
Result foreign(Result (*function)(Parameters...), Arguments... arguments) {
  static_assert((std::is_trivially_destructible_v<Arguments> && ...));
  if constexpr (std::is_void_v<Result>) {
    struct Call {
      void (*function)(Parameters...);
      std::tuple<Arguments...> arguments;
    } call{function, {arguments...}};
    call_foreign(
        [](void* data) {
          Call& one = *static_cast<Call*>(data);
          std::apply(one.function, one.arguments);
        },
        &call);
  } else {
    struct Call {
      Result (*function)(Parameters...);
      std::tuple<Arguments...> arguments;
      Result result;
    } call{function, {arguments...}, {}};
    call_foreign(
        [](void* data) {
          Call& one = *static_cast<Call*>(data);
          one.result = std::apply(one.function, one.arguments);
        },
        &call);
    return call.result;
  }
}

}  // namespace bbsim::controller
