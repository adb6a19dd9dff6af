// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Handles Ctrl-C and messages during long work, and the interpreter's lock: work without it, calls
// that need it, and the interpreter's end meanwhile.
//
// Python unwinds a thread that asks for the lock of an interpreter that has ended. Frames of C++
// must not be unwound in this way: it would end the process by SIGABRT. Such a thread therefore
// sleeps until the process ends. So that no thread computes while the process is taken down, the
// interpreter's end first ends all work.
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "api/watch.hpp"

namespace bbsim::python {

namespace py = pybind11;

[[noreturn]] void sleep_until_the_end();

#ifdef __GLIBCXX__
using Unwound = abi::__forced_unwind;
#else
struct Unwound {};  // here, the end of a thread unwinds nothing
#endif

// Does the work with the lock, from a thread that may not have it.
template <class Does>
auto with_lock(const Does& does) {
  try {
    const py::gil_scoped_acquire lock;
    try {
      return does();
    } catch (const Unwound&) {
      sleep_until_the_end();  // before the lock, which this thread has no more, is given back
    }
  } catch (const Unwound&) {
    sleep_until_the_end();
  }
}

// While it exists, the thread computes without the lock. Create it with the lock.
class WithoutLock {
 public:
  WithoutLock();
  ~WithoutLock();
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* state_;
};

// Registers what ends all work at the interpreter's end.
void end_work_with_the_interpreter();

// Create, query and destroy it with the interpreter's lock. The work runs without the lock.
class Watch : public api::Watch {
 public:
  // Raises RecursionError if callables that call bbsim are nested too deeply for the stack.
  Watch() {
    if (nesting_ >= deepest) {
      const std::string text = "bbsim is called within " + std::to_string(deepest) +
                               " callables, each of which runs the next; allowed: fewer";
      PyErr_SetString(PyExc_RecursionError, text.c_str());
      throw py::error_already_set();
    }
    all().insert(this);
  }
  ~Watch() override { all().erase(this); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  // Ends all work soon. Call it with the interpreter's lock.
  static void end_all() {
    for (Watch* const one : all()) one->end_soon();
  }

  void update(double /*fraction*/, const std::string& /*detail*/) override {
    if (!in_caller_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < every) return;
    last_ = now;
    look();
  }

  // What a command would print.
  void note(const std::string& text) override { notes_.push_back(text); }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  void controller_says(std::string_view line) override {
    with_lock([&] {
      try {
        py::print("controller:", line, py::arg("file") = py::module_::import("sys").attr("stderr"));
      } catch (const py::error_already_set&) {  // nobody can read it
      }
    });
  }

  [[nodiscard]] const std::atomic<bool>* stop() override { return &stop_; }
  void end_soon() { stop_ = true; }

  // Marks this thread, while the object exists, as within a callable that the work asks.
  class WithinCallable {
   public:
    explicit WithinCallable(const Watch& watch)
        : before_(std::exchange(nesting, watch.nesting_ + 1)) {}
    ~WithinCallable() { nesting = before_; }
    WithinCallable(const WithinCallable&) = delete;
    WithinCallable& operator=(const WithinCallable&) = delete;

   private:
    int before_;
  };

  // Does the work on this thread, which checks for Ctrl-C whenever the work calls update().
  template <class Work>
  auto here(const Work& work) {
    const WithoutLock unlocked;
    return work();
  }

  // Does the work on another thread, for work that calls update() rarely or from several threads.
  template <class Work>
  auto beside(const Work& work) {
    in_caller_ = false;
    const WithoutLock unlocked;
    auto made = std::async(std::launch::async, work);
    while (made.wait_for(every) != std::future_status::ready) look();
    return made.get();
  }

  // Throws what a signal's handler raised, such as KeyboardInterrupt.
  void throw_if_interrupted() {
    if (raised_) throw py::error_already_set(*std::exchange(raised_, std::nullopt));
  }

 private:
  static constexpr std::chrono::milliseconds every{20};
  static constexpr int deepest = 8;
  static thread_local int nesting;  // callables that this thread is within

  // All that exist, under the interpreter's lock. Never destroyed: threads may outlive it.
  static std::unordered_set<Watch*>& all() {
    static auto& watches = *new std::unordered_set<Watch*>;
    return watches;
  }

  void look() {
    with_lock([this] {
      if (raised_ || PyErr_CheckSignals() == 0) return;
      raised_.emplace();  // takes the exception
      stop_ = true;
    });
  }

  const int nesting_ = nesting;

  std::atomic<bool> stop_{false};
  std::vector<std::string> notes_;
  bool in_caller_ = true;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::optional<py::error_already_set> raised_;
};

inline thread_local int Watch::nesting = 0;

}  // namespace bbsim::python
