// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/flusher.hpp"

#include <fcntl.h>

#include "file/descriptor.hpp"

namespace bbsim::file {

int Flusher::perform(Due due, int descriptor, off_t size) {
  if (due == Due::nothing) return 0;
  const off_t sent = sent_;
  sent_ = size;
  if (due == Due::send) {
    // A hint only: if the system does not support it, the next sync writes everything.
    [[maybe_unused]] const int ignored =
        sync_file_range(descriptor, sent, size - sent, SYNC_FILE_RANGE_WRITE);
    return 0;
  }
  const int error = sync_content(descriptor);
  last_ = Clock::now();
  return error;
}

}  // namespace bbsim::file
