// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Gets a file that grows over a long run to the disk while it does.
#pragma once

#include <sys/types.h>

#include <chrono>

namespace bbsim::file {

// What a power cut takes is the work of the last seconds. The disk begins to write, without being
// waited for, once there is enough to do, so that the waits every few seconds and at the end are
// short.
class Flusher {
 public:
  using Clock = std::chrono::steady_clock;

  // The first `size` bytes of the file need no care.
  explicit Flusher(off_t size = 0) : sent_(size), last_(Clock::now()) {}

  // What is to be done once the file has that size.
  enum class Due { nothing, send, sync };
  [[nodiscard]] Due due(off_t size) const {
    if (Clock::now() - last_ > std::chrono::seconds(5)) return Due::sync;
    return size - sent_ >= off_t{8} * 1024 * 1024 ? Due::send : Due::nothing;
  }
  // Does it. Returns an errno, or 0.
  [[nodiscard]] int perform(Due due, int descriptor, off_t size);

 private:
  off_t sent_;
  Clock::time_point last_;
};

}  // namespace bbsim::file
