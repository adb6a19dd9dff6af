// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/children.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <utility>

namespace bbsim::file {
namespace {

std::array<std::atomic<pid_t>, 1100> remembered;
std::atomic<pid_t> owner_of_children{0};
static_assert(std::atomic<pid_t>::is_always_lock_free, "a signal handler reads them");

bool is_remembered(pid_t process) {
  return std::ranges::any_of(remembered,
                             [=](const auto& place) { return place.load() == process; });
}

// The variable that holds the mark. Its value is this process's id, a dot, and a number.
constexpr const char* marks = "BBSIM_CONTROLLER=";

// All functions from here to bury_children() are safe in a signal handler.

char* put_text(char* to, const char* text) {
  while (*text != '\0') *to++ = *text++;
  return to;
}

char* put_number(char* to, pid_t number) {
  std::array<char, 12> digits;
  char* first = digits.data() + digits.size();
  do {
    *--first = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number > 0);
  for (; first != digits.data() + digits.size(); ++first) *to++ = *first;
  return to;
}

// Calls use(number) for each number in a text that arrives in pieces.
class Numbers {
 public:
  template <class Use>
  void take(const char* text, std::size_t size, Use use) {
    for (const char* at = text; at != text + size; ++at) {
      if (*at >= '0' && *at <= '9') {
        number_ = 10 * number_ + (*at - '0');
      } else if (number_ > 0) {
        use(number_);
        number_ = 0;
      }
    }
  }

 private:
  pid_t number_ = 0;
};

// Calls use(part, size) for each piece of a file in /proc.
template <class Use>
void read_pieces(const char* path, Use use) {
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  std::array<char, 4096> part;
  for (;;) {
    const ssize_t got = read(file, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    use(part.data(), static_cast<std::size_t>(got));
  }
  close(file);
}

// Whether /proc shows the same process ids as this process sees (not those of another namespace).
bool proc_is_ours() {
  std::array<char, 16> link{}, expected{};
  put_number(expected.data(), getpid());
  return readlink("/proc/self", link.data(), link.size() - 1) > 0 &&
         std::strcmp(link.data(), expected.data()) == 0;
}

// Calls use(child) for each child of the process, including zombies.
template <class Use>
void for_each_child(pid_t process, Use use) {
  std::array<char, 80> path{};
  char* const threads = put_text(put_number(put_text(path.data(), "/proc/"), process), "/task");
  if (!proc_is_ours()) return;
  const int folder = open(path.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  alignas(8) std::array<char, 4096> entries;
  for (;;) {
    const long got = syscall(SYS_getdents64, folder, entries.data(), entries.size());
    if (got <= 0) break;
    for (long at = 0; at < got;) {
      // linux_dirent64: ino64_t, off64_t, then the entry's length, its type and its name.
      const char* const entry = &entries[static_cast<std::size_t>(at)];
      unsigned short length = 0;
      std::memcpy(&length, entry + 16, sizeof length);
      at += length;
      const char* const name = entry + 19;
      if (*name == '.') continue;
      char* const end = put_text(put_text(put_text(threads, "/"), name), "/children");
      *end = '\0';
      Numbers numbers;
      read_pieces(path.data(),
                  [&](const char* text, std::size_t size) { numbers.take(text, size, use); });
    }
  }
  close(folder);
}

// Whether the environment of the process has the entry `wanted` (`whole`), or one that begins with
// it.
bool has_entry(pid_t process, const char* wanted, bool whole) {
  std::array<char, 40> path{};
  put_text(put_number(put_text(path.data(), "/proc/"), process), "/environ");
  bool found = false, alike = true;
  const char* at = wanted;  // in an entry that matches so far
  read_pieces(path.data(), [&](const char* text, std::size_t size) {
    for (const char* c = text; c != text + size; ++c) {
      if (*c == '\0') {
        found = found || (alike && *at == '\0');
        alike = true;
        at = wanted;
      } else if (alike && *at == *c) {
        ++at;
      } else if (!(alike && *at == '\0' && !whole)) {
        alike = false;
      }
    }
  });
  return found;
}

void wait_a_little() {
  const timespec millisecond{0, 1'000'000};
  nanosleep(&millisecond, nullptr);
}

// Kills the children of this process that `is_to_end` selects, except remembered ones, and collects
// their status. Repeats until none are left or the time is over. Collects all other dead children
// too.
template <class IsToEnd>
void bury_children(int milliseconds, IsToEnd is_to_end) {
  for (int i = 0; i < milliseconds; ++i) {
    bool any = false;
    for_each_child(getpid(), [&](pid_t child) {
      if (is_remembered(child) || waitpid(child, nullptr, WNOHANG) != 0 || !is_to_end(child))
        return;
      kill(child, SIGKILL);
      any = true;
    });
    if (!any) return;
    wait_a_little();
  }
}

}  // namespace

void remember_child(pid_t process) {
  owner_of_children.store(getpid());
  for (auto& place : remembered) {
    pid_t free = 0;
    if (place.compare_exchange_strong(free, process)) return;
  }
}

void forget_child(pid_t process) {
  for (auto& place : remembered) {
    pid_t found = process;
    if (place.compare_exchange_strong(found, 0)) return;
  }
}

std::unique_lock<ForkMutex> while_starting_child() {
  static ForkMutex starting;
  return std::unique_lock(starting);
}

std::optional<int> wait_for_child(pid_t process) {
  siginfo_t ended{};
  while (waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOWAIT) != 0 &&
         errno == EINTR) {
  }
  forget_child(process);
  int status = 0;
  return waitpid(process, &status, WNOHANG) == process ? std::optional(status) : std::nullopt;
}

std::string new_mark() {
  static std::atomic<unsigned long> number{0};
  return marks + std::to_string(getpid()) + '.' + std::to_string(++number);
}

void adopt_orphans() {
  prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0);  // on failure, orphans go to the system as usual
}

Family::Family(pid_t head, std::string mark) : head_(head), mark_(std::move(mark)) {
  constexpr std::size_t most = 10000;
  const auto add = [this](pid_t child) {
    if (members_.size() < most) members_.push_back(child);
  };
  for_each_child(head, add);
  for (std::size_t i = 0; i < members_.size(); ++i) for_each_child(pid_t{members_[i]}, add);
}

bool Family::has(pid_t process) const {
  return std::ranges::find(members_, process) != members_.end() || getpgid(process) == head_ ||
         has_entry(process, mark_.c_str(), true);
}

void Family::end() const {
  // The head was not waited for yet, so its id is not reused.
  kill(-head_, SIGKILL);
  kill(head_, SIGKILL);  // in case it left its group
  for (const pid_t member : members_) kill(member, SIGKILL);
}

void Family::bury() const {
  constexpr int most = 1000;  // ms
  const auto lock = while_starting_child();
  bury_children(most, [this](pid_t child) { return has(child); });
}

void end_children() {
  if (owner_of_children.load() != getpid()) return;
  for (auto& place : remembered) {
    if (const pid_t process = place.load()) {
      kill(-process, SIGKILL);
      kill(process, SIGKILL);
    }
  }
  std::array<char, 40> ours{};
  put_text(put_number(put_text(ours.data(), marks), getpid()), ".");
  constexpr int most = 200;  // ms
  bury_children(most, [&ours](pid_t child) { return has_entry(child, ours.data(), false); });
}

}  // namespace bbsim::file
