// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Function with a stack of its own, which can pause and return control to its caller.
#pragma once

#include <ucontext.h>

#include <cstddef>
#include <exception>
#include <functional>

namespace bbsim::api {

class Fiber {
 public:
  // `body` begins at the first resume().
  explicit Fiber(std::function<void()> body);
  // The body must have ended, or not begun.
  ~Fiber();
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  // Continues the body until it waits or ends. Rethrows what the body throws, which ends it.
  void resume();
  // Called by the body: returns to the caller of resume() until the next resume(). Not while an
  // exception is handled, since it belongs to the thread.
  void wait();

  [[nodiscard]] bool has_ended() const { return ended_; }
  // Whether the body runs now, so that resume() would call itself.
  [[nodiscard]] bool is_running() const { return running_; }

 private:
  static void enter(unsigned high, unsigned low);
  void run();

  std::function<void()> body_;
  ucontext_t caller_{}, own_{};
  void* memory_ = nullptr;
  std::size_t size_ = 0;  // of the memory, including the guard page at the stack's end
  bool running_ = false, ended_ = false;
  std::exception_ptr thrown_;
  // State of the two stacks for the address sanitizer.
  void* fake_caller_ = nullptr;
  void* fake_own_ = nullptr;
  const void* caller_bottom_ = nullptr;
  std::size_t caller_size_ = 0;
  // Handles of the two stacks for the thread sanitizer.
  void* caller_clock_ = nullptr;
  void* own_clock_ = nullptr;
};

}  // namespace bbsim::api
