// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/start_process.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>

#include "file/leftovers.hpp"

namespace bbsim::file {
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

// Blocks all signals while an object exists.
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

pid_t start_process(const NewProcess& process, int& error) {
  Spawning spawning;
  posix_spawn_file_actions_adddup2(&spawning.actions, process.input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&spawning.actions, process.output, STDOUT_FILENO);
  if (process.error >= 0) {
    posix_spawn_file_actions_adddup2(&spawning.actions, process.error, STDERR_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&spawning.actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  posix_spawn_file_actions_addclosefrom_np(&spawning.actions, STDERR_FILENO + 1);
  if (!process.folder.empty()) {
    posix_spawn_file_actions_addchdir_np(&spawning.actions, process.folder.c_str());
  }
  sigset_t all, none;
  sigfillset(&all);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&spawning.attributes, &all);
  posix_spawnattr_setsigmask(&spawning.attributes, &none);
  posix_spawnattr_setpgroup(&spawning.attributes, 0);
  int flags = POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK;
  if (process.leads_group) flags |= POSIX_SPAWN_SETPGROUP;
  posix_spawnattr_setflags(&spawning.attributes, static_cast<short>(flags));

  std::vector<std::string> words = process.words;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // A signal that ended this program here would leave the new process running.
  const SignalsWait until_it_is_remembered;
  pid_t id = 0;
  error = posix_spawnp(&id, arguments[0], &spawning.actions, &spawning.attributes, arguments.data(),
                       environ);
  if (error != 0) return 0;
  remember_child(id);
  return id;
}

}  // namespace bbsim::file
