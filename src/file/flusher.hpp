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
  // The first `size` bytes are already on the disk.
  explicit Flusher(off_t size = 0) : sent_(size) {}

  // Call it when the file has this size (bytes). Returns whether a sync is due.
  bool send(int descriptor, off_t size);
  // Returns an errno, or 0.
  [[nodiscard]] int sync(int descriptor);

 private:
  using Clock = std::chrono::steady_clock;

  off_t sent_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace bbsim::file
