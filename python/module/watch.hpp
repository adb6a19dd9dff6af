// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Handles Ctrl-C and messages during long work.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/watch.hpp"

namespace bbsim::python {

namespace py = pybind11;

// Create, query and destroy it with the interpreter's lock. The work runs without the lock.
class Watch : public api::Watch {
 public:
  void update(double /*fraction*/, const std::string& /*detail*/) override {
    if (!in_caller_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < every) return;
    last_ = now;
    look();
  }

  // Notes are in the results or meant for a terminal.
  void note(const std::string& /*text*/) override {}
  void controller_says(std::string_view line) override {
    const py::gil_scoped_acquire lock;
    try {
      py::print("controller:", line, py::arg("file") = py::module_::import("sys").attr("stderr"));
    } catch (const py::error_already_set&) {  // nobody can read it
    }
  }

  [[nodiscard]] const std::atomic<bool>* stop() override { return &stop_; }
  void end_soon() { stop_ = true; }

  // Does the work on this thread, which checks for Ctrl-C whenever the work calls update().
  template <class Work>
  auto here(const Work& work) {
    const py::gil_scoped_release unlocked;
    return work();
  }

  // Does the work on another thread, for work that calls update() rarely or from several threads.
  template <class Work>
  auto beside(const Work& work) {
    in_caller_ = false;
    const py::gil_scoped_release unlocked;
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

  void look() {
    const py::gil_scoped_acquire lock;
    if (raised_ || PyErr_CheckSignals() == 0) return;
    raised_.emplace();  // takes the exception
    stop_ = true;
  }

  std::atomic<bool> stop_{false};
  bool in_caller_ = true;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::optional<py::error_already_set> raised_;
};

}  // namespace bbsim::python
