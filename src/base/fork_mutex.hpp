// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A mutex that a new process never finds locked by a thread that it does not have.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

namespace bbsim {

// fork() in another thread waits until it is unlocked. At most eight, which exist until the process
// ends.
class ForkMutex {
 public:
  ForkMutex();
  ForkMutex(const ForkMutex&) = delete;
  ForkMutex& operator=(const ForkMutex&) = delete;

  void lock();
  void unlock();
  [[nodiscard]] bool is_mine() const { return owner_ == std::this_thread::get_id(); }

 private:
  std::mutex mutex_;
  std::atomic<std::thread::id> owner_;
};

}  // namespace bbsim
