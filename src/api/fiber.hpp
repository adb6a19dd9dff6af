// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A function that can pause and give control back to its caller: it runs on its own stack.
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

  // Goes on with the body until it waits or ends. Throws what the body throws, which has then
  // ended.
  void resume();
  // For the body: back to who called resume(), until it does so again. Not while an exception is
  // handled, which belongs to the thread.
  void wait();

  [[nodiscard]] bool has_ended() const { return ended_; }

 private:
  static void enter(unsigned high, unsigned low);
  void run();

  std::function<void()> body_;
  ucontext_t caller_{}, own_{};
  void* memory_ = nullptr;
  std::size_t size_ = 0;  // of the memory, with the page that guards the stack's end
  bool ended_ = false;
  std::exception_ptr thrown_;
  // What the address sanitizer knows of the two stacks.
  void* fake_caller_ = nullptr;
  void* fake_own_ = nullptr;
  const void* caller_bottom_ = nullptr;
  std::size_t caller_size_ = 0;
  // What the thread sanitizer knows them by.
  void* caller_clock_ = nullptr;
  void* own_clock_ = nullptr;
};

}  // namespace bbsim::api
