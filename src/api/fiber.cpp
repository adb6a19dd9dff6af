// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/fiber.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <new>
#include <utility>

#if defined(__SANITIZE_ADDRESS__)
#define BBSIM_FIBERS_SANITIZED
#elif defined(__SANITIZE_THREAD__)
#define BBSIM_FIBERS_WATCHED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BBSIM_FIBERS_SANITIZED
#elif __has_feature(thread_sanitizer)
#define BBSIM_FIBERS_WATCHED
#endif
#endif
#ifdef BBSIM_FIBERS_SANITIZED
#include <sanitizer/common_interface_defs.h>
#endif
#ifdef BBSIM_FIBERS_WATCHED
#include <sanitizer/tsan_interface.h>
#endif

namespace bbsim::api {
namespace {

constexpr std::size_t stack_bytes = std::size_t{512} * 1024;

void start_switch([[maybe_unused]] void** fake, [[maybe_unused]] const void* bottom,
                  [[maybe_unused]] std::size_t size) {
#ifdef BBSIM_FIBERS_SANITIZED
  __sanitizer_start_switch_fiber(fake, bottom, size);
#endif
}

void finish_switch([[maybe_unused]] void* fake, [[maybe_unused]] const void** bottom,
                   [[maybe_unused]] std::size_t* size) {
#ifdef BBSIM_FIBERS_SANITIZED
  __sanitizer_finish_switch_fiber(fake, bottom, size);
#endif
}

// The thread sanitizer has a clock for each fiber. Tell it of a switch just before the switch.
void* new_clock() {
#ifdef BBSIM_FIBERS_WATCHED
  return __tsan_create_fiber(0);
#else
  return nullptr;
#endif
}

void end_clock([[maybe_unused]] void* clock) {
#ifdef BBSIM_FIBERS_WATCHED
  __tsan_destroy_fiber(clock);
#endif
}

void* present_clock() {
#ifdef BBSIM_FIBERS_WATCHED
  return __tsan_get_current_fiber();
#else
  return nullptr;
#endif
}

void switch_clock([[maybe_unused]] void* clock) {
#ifdef BBSIM_FIBERS_WATCHED
  __tsan_switch_to_fiber(clock, 0);
#endif
}

}  // namespace

Fiber::Fiber(std::function<void()> body) : body_(std::move(body)) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  size_ = stack_bytes + page;
  memory_ = mmap(nullptr, size_, PROT_READ | PROT_WRITE,
                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
  if (memory_ == MAP_FAILED) throw std::bad_alloc();
  mprotect(memory_, page, PROT_NONE);
  own_clock_ = new_clock();
  getcontext(&own_);
  own_.uc_stack.ss_sp = static_cast<char*>(memory_) + page;
  own_.uc_stack.ss_size = stack_bytes;
  own_.uc_link = nullptr;
  // makecontext() passes only ints.
  const auto self = reinterpret_cast<std::uintptr_t>(this);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as POSIX has it
  makecontext(&own_, reinterpret_cast<void (*)()>(&Fiber::enter), 2,
              static_cast<unsigned>(self >> 32U), static_cast<unsigned>(self));
}

Fiber::~Fiber() {
  end_clock(own_clock_);
  munmap(memory_, size_);
}

void Fiber::enter(unsigned high, unsigned low) {
  const auto self = (static_cast<std::uintptr_t>(high) << 32U) | low;
  reinterpret_cast<Fiber*>(self)->run();
}

void Fiber::run() {
  finish_switch(nullptr, &caller_bottom_, &caller_size_);
  try {
    body_();
  } catch (...) {
    thrown_ = std::current_exception();
  }
  ended_ = true;
  start_switch(nullptr, caller_bottom_, caller_size_);
  switch_clock(caller_clock_);
  setcontext(&caller_);
}

void Fiber::resume() {
  running_ = true;
  start_switch(&fake_caller_, own_.uc_stack.ss_sp, own_.uc_stack.ss_size);
  caller_clock_ = present_clock();
  switch_clock(own_clock_);
  swapcontext(&caller_, &own_);
  finish_switch(fake_caller_, nullptr, nullptr);
  running_ = false;
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void Fiber::wait() {
  start_switch(&fake_own_, caller_bottom_, caller_size_);
  switch_clock(caller_clock_);
  swapcontext(&own_, &caller_);
  finish_switch(fake_own_, &caller_bottom_, &caller_size_);
}

}  // namespace bbsim::api
