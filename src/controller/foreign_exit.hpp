// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Handles functions of a library that end the process instead of returning. This program replaces
// exit() and similar functions (foreign_exit.cpp); if possible, they end only the call.
#pragma once

#include <exception>
#include <string>
#include <tuple>
#include <type_traits>

namespace bbsim::controller {

// The function that a foreign function called instead of returning.
class ExitCalled : public std::exception {
 public:
  ExitCalled(const char* function, int status) : function_(function), status_(status) {}
  // "it called exit(0), which would have ended bbsim"
  [[nodiscard]] std::string text() const;

 private:
  const char* function_;
  int status_;
};

// From now on, if a library's own thread or other code outside a call ends the process, it ends
// with exit code 1 and a message that names the library.
void expect_foreign_exits(const std::string& path);

// While one exists, this thread runs code of a library that cannot be left, because the library is
// being opened. If that code ends the process, the message is printed.
class CannotReturn {
 public:
  CannotReturn();
  ~CannotReturn();
  CannotReturn(const CannotReturn&) = delete;
  CannotReturn& operator=(const CannotReturn&) = delete;
};

// Calls function(data). Throws ExitCalled if it tries to end the process in this thread. No object
// on its stack is then destroyed.
void call_foreign(void (*function)(void*), void* data);

// The same for any function with trivially destructible arguments. Returns the function's result.
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
