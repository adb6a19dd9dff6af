// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "watch.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace bbsim::python {
namespace {

// Some work cannot be ended early, such as a call of a library.
constexpr std::chrono::seconds longest_wait{2};

std::atomic<int> computing{0};  // threads without the lock
std::atomic<bool> ending{false};
std::thread::id ends;  // the thread that ends the interpreter

void end_work() {
  ends = std::this_thread::get_id();
  ending = true;
  Watch::end_all();
  const py::gil_scoped_release unlocked;  // the others need it to return
  const auto until = std::chrono::steady_clock::now() + longest_wait;
  while (computing > 0 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

void sleep_until_the_end() {
  for (;;) pause();
}

WithoutLock::WithoutLock() {
  const bool too_late = ending && ends != std::this_thread::get_id();
  if (!too_late) ++computing;
  state_ = PyEval_SaveThread();
  if (too_late) sleep_until_the_end();
}

WithoutLock::~WithoutLock() {
  --computing;
  try {
    PyEval_RestoreThread(state_);
  } catch (const Unwound&) {
    sleep_until_the_end();
  }
}

void end_work_with_the_interpreter() {
  py::module_::import("atexit").attr("register")(py::cpp_function(end_work));
  // A new process has none of the other threads.
  py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                         py::cpp_function([] { computing = 0; }));
}

}  // namespace bbsim::python
