#include "controller/children.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

namespace bbsim::controller {
namespace {

std::array<std::atomic<pid_t>, 1100> groups;
std::atomic<pid_t> owner{0};
static_assert(std::atomic<pid_t>::is_always_lock_free, "a signal handler reads them");

}  // namespace

void remember_child(pid_t group) {
  owner.store(getpid());
  for (auto& place : groups) {
    pid_t free = 0;
    if (place.compare_exchange_strong(free, group)) return;
  }
}

void forget_child(pid_t group) {
  for (auto& place : groups) {
    pid_t found = group;
    if (place.compare_exchange_strong(found, 0)) return;
  }
}

void end_children() {
  if (owner.load() != getpid()) return;
  for (auto& place : groups) {
    if (const pid_t group = place.load()) kill(-group, SIGKILL);
  }
}

}  // namespace bbsim::controller
