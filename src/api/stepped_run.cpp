// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/stepped_run.hpp"

#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
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

// Function with a stack of its own, which can pause and return control to its caller.
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

// The run, and the controller in it, which waits at each sample for the caller of step().
struct SteppedRun::State : model::ExternalController {
  explicit State(RunRequest of) : request(std::move(of)), fiber([this] { run(); }) {}

  void run() { result = api::run(request, watch); }

  void begin() override {}
  model::Commands command(const model::ControllerSample& at, double* /*own*/) override {
    sample = copy_of(at);
    fiber.wait();
    if (given_up) throw ControllerFault("the run was abandoned", true);
    return {given[0], given[1], 0};
  }

  RunRequest request;
  Watch watch;
  Sample sample;
  Pair given{};
  bool given_up = false;
  RunResult result;
  Fiber fiber;
};

SteppedRun::SteppedRun(const Scenario& scenario, RunRequest request) {
  request.scenario = with_outside_commands(scenario);
  state_ = std::make_unique<State>(std::move(request));
  state_->request.scenario.controller->own->by =
      ControllerFactory{"commands from outside", [state = state_.get()](const Scenario&) {
                          // Without ownership: the state holds the run.
                          return std::shared_ptr<State>(std::shared_ptr<void>(), state);
                        }};
  state_->fiber.resume();
}

SteppedRun::~SteppedRun() {
  if (!state_ || is_over()) return;
  state_->given_up = true;
  try {
    state_->fiber.resume();
  } catch (...) {  // the run was given up
  }
}

bool SteppedRun::is_over() const {
  return state_->fiber.has_ended();
}

const Sample& SteppedRun::sample() const {
  return state_->sample;
}

void SteppedRun::step(Pair command) {
  if (state_->fiber.is_running()) {
    throw InputError("step: found within the run's own step, as in its sink; allowed: after it");
  }
  require_finite(command);
  state_->given = command;
  state_->fiber.resume();
}

const RunResult& SteppedRun::result() const {
  return state_->result;
}

}  // namespace bbsim::api
