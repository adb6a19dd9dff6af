// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/fork_mutex.hpp"

#include <pthread.h>

#include <array>
#include <cstddef>
#include <cstdlib>

namespace bbsim {
namespace {

std::array<ForkMutex*, 8> all;
std::atomic<std::size_t> count;
// Those that fork() has locked, for the thread that calls it.
thread_local std::array<bool, all.size()> locked;

void lock_all() {
  for (std::size_t i = 0; i < count; ++i) {
    locked[i] = all[i] != nullptr && !all[i]->is_mine();
    if (locked[i]) all[i]->lock();
  }
}

void unlock_all() {
  for (std::size_t i = count; i-- > 0;) {
    if (locked[i]) all[i]->unlock();
    locked[i] = false;
  }
}

}  // namespace

ForkMutex::ForkMutex() {
  [[maybe_unused]] static const int registered = pthread_atfork(lock_all, unlock_all, unlock_all);
  const std::size_t place = count++;
  if (place >= all.size()) std::abort();
  all[place] = this;
}

void ForkMutex::lock() {
  mutex_.lock();
  owner_ = std::this_thread::get_id();
}

void ForkMutex::unlock() {
  owner_ = std::thread::id();
  mutex_.unlock();
}

}  // namespace bbsim
