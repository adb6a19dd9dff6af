// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/temporaries.hpp"

#include <unistd.h>

#include <atomic>

namespace bbsim::file {
namespace {

constexpr int most = 64;
std::atomic<const char*> names[most];
std::atomic<pid_t> owner{0};
static_assert(std::atomic<const char*>::is_always_lock_free, "a signal handler reads them");
static_assert(std::atomic<pid_t>::is_always_lock_free, "a signal handler reads it");

}  // namespace

void remember_temporary(const char* name) {
  owner.store(getpid());
  for (auto& place : names) {
    const char* free = nullptr;
    if (place.compare_exchange_strong(free, name)) return;
  }
}

void forget_temporary(const char* name) {
  for (auto& place : names) {
    const char* found = name;
    if (place.compare_exchange_strong(found, nullptr)) return;
  }
}

void remove_temporaries() {
  if (owner.load() != getpid()) return;
  for (auto& place : names) {
    if (const char* const name = place.load()) unlink(name);
  }
}

}  // namespace bbsim::file
