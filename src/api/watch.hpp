// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Who looks in on long work, and may end it.
#pragma once

#include <atomic>
#include <string>
#include <string_view>

namespace bbsim::api {

// All of it may be left as it is here: then nobody looks.
class Watch {
 public:
  virtual ~Watch() = default;

  // The work begins now, at `fraction` of it, such as what an earlier process has done.
  virtual void start(double /*fraction*/) {}
  // It has come to `fraction`; `detail` is for people. Called often.
  virtual void update(double /*fraction*/, const std::string& /*detail*/) {}
  // The work is over; what follows are files and messages.
  virtual void end() {}

  // What a person should know now, not at the end. A warning is for those, too, who want no notes.
  virtual void note(const std::string& /*text*/) {}
  virtual void warn(const std::string& text) { note(text); }
  // A line that a controller wrote to its standard error; from any thread.
  virtual void controller_says(std::string_view /*line*/) {}

  // Asked for when the work begins, which ends soon after this becomes true; may be null.
  [[nodiscard]] virtual const std::atomic<bool>* stop() { return nullptr; }
};

}  // namespace bbsim::api
