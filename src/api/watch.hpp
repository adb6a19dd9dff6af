// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Observer of long work, which may end it; and the threads of such work.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <string_view>
#include <thread>

namespace bbsim::api {

// The default functions do nothing, so that nobody observes.
class Watch {
 public:
  virtual ~Watch() = default;

  // Work begins, at `fraction` of the whole, such as the share that an earlier process has done.
  virtual void start(double /*fraction*/) {}
  // Work has reached `fraction`; `detail` is for people. Called often.
  virtual void update(double /*fraction*/, const std::string& /*detail*/) {}
  // Work is over; files and messages follow.
  virtual void end() {}

  // Something a person should know at once. Warnings also reach those who want no notes.
  virtual void note(const std::string& /*text*/) {}
  virtual void warn(const std::string& text) { note(text); }
  // Line that a controller wrote to its standard error. Called from any thread.
  virtual void controller_says(std::string_view /*line*/) {}

  // Requested when work begins; work ends soon after it becomes true. May be null.
  [[nodiscard]] virtual const std::atomic<bool>* stop() { return nullptr; }
};

// The watch's request to stop, or one that never comes.
[[nodiscard]] inline const std::atomic<bool>& stop_of(Watch& watch) {
  static constexpr std::atomic<bool> never{false};
  const std::atomic<bool>* const stop = watch.stop();
  return stop != nullptr ? *stop : never;
}

// A request for threads, or one for each processor if it is 0.
[[nodiscard]] inline std::size_t threads_of(double request) {
  return request > 0 ? static_cast<std::size_t>(request)
                     : std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace bbsim::api
