// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/flusher.hpp"

#include <fcntl.h>

#include "file/descriptor.hpp"

namespace bbsim::file {

bool Flusher::send(int descriptor, off_t size) {
  constexpr off_t enough = off_t{8} * 1024 * 1024;
  if (size - sent_ >= enough) {
    // A hint only: if the system does not support it, the next sync writes everything.
    [[maybe_unused]] const int ignored =
        sync_file_range(descriptor, sent_, size - sent_, SYNC_FILE_RANGE_WRITE);
    sent_ = size;
  }
  return Clock::now() - last_ > std::chrono::seconds(5);
}

int Flusher::sync(int descriptor) {
  const int error = sync_content(descriptor);
  last_ = Clock::now();
  return error;
}

}  // namespace bbsim::file
