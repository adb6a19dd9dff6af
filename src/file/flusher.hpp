// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Syncs a growing file to the disk during a long run.
#pragma once

#include <sys/types.h>

#include <chrono>

namespace bbsim::file {

// A power cut loses at most the last few seconds of work. The disk starts to write in the
// background once enough data has accumulated, so that the syncs every few seconds and at the end
// are short.
class Flusher {
 public:
  using Clock = std::chrono::steady_clock;

  // The first `size` bytes are already on the disk.
  explicit Flusher(off_t size = 0) : sent_(size), last_(Clock::now()) {}

  // The action that is due when the file has this size (bytes).
  enum class Due { nothing, send, sync };
  [[nodiscard]] Due due(off_t size) const {
    if (Clock::now() - last_ > std::chrono::seconds(5)) return Due::sync;
    return size - sent_ >= off_t{8} * 1024 * 1024 ? Due::send : Due::nothing;
  }
  // Performs the action. Returns an errno, or 0.
  [[nodiscard]] int perform(Due due, int descriptor, off_t size);

 private:
  off_t sent_;
  Clock::time_point last_;
};

}  // namespace bbsim::file
