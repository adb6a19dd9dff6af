// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/foreign_code.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <spawn.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>

#include "file/children.hpp"

namespace bbsim::controller {
namespace {

struct Spawning {
  Spawning() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  ~Spawning() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  Spawning(const Spawning&) = delete;
  Spawning& operator=(const Spawning&) = delete;

  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
};

// Signals wait while there is one.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsWait() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

pid_t start_program(const std::vector<std::string>& words, const std::string& folder,
                    const Streams& streams, const std::string& mark, int& error) {
  Spawning spawning;
  posix_spawn_file_actions_adddup2(&spawning.actions, streams.input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&spawning.actions, streams.output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&spawning.actions, streams.error, STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&spawning.actions, STDERR_FILENO + 1);
  if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&spawning.actions, folder.c_str());
  sigset_t all, none;
  sigfillset(&all);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&spawning.attributes, &all);
  posix_spawnattr_setsigmask(&spawning.attributes, &none);
  posix_spawnattr_setpgroup(&spawning.attributes, 0);
  posix_spawnattr_setflags(&spawning.attributes,
                           POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // Its own environment is this one's, but for the mark.
  std::string entry = mark;
  const std::string_view name = std::string_view(entry).substr(0, entry.find('=') + 1);
  std::vector<char*> environment{entry.data()};
  for (char** each = environ; *each != nullptr; ++each) {
    if (!std::string_view(*each).starts_with(name)) environment.push_back(*each);
  }
  environment.push_back(nullptr);
  // One that ended this program here would leave the new process running.
  const SignalsWait until_it_is_remembered;
  const auto starting = file::while_starting_child();
  file::adopt_orphans();
  pid_t process = 0;
  error = posix_spawnp(&process, arguments[0], &spawning.actions, &spawning.attributes,
                       arguments.data(), environment.data());
  if (error != 0) return 0;
  file::remember_child(process);
  return process;
}

void* open_library(const std::string& path, std::string& error) {
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const why = dlerror();
    error = why == nullptr ? "it cannot be opened" : why;
  }
  return library;
}

}  // namespace bbsim::controller
