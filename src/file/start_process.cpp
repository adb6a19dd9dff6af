// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/start_process.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/error.hpp"
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

// Unnamed temporary files, which vanish when they are closed. With files in place of pipes, neither
// process can block on a full pipe.
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

struct Purpose {
  const std::string& text;

  [[noreturn]] void fail(const std::string& what, int error) const {
    throw OutputError("cannot " + text + ": " + what + ": " + std::strerror(error));
  }

  [[nodiscard]] File temporary() const {
    File file(std::tmpfile(), &std::fclose);
    if (!file) fail("no temporary file", errno);
    return file;
  }

  std::string content(std::FILE* file) const {
    std::rewind(file);
    std::string text_read;
    char part[4096];
    while (const std::size_t size = std::fread(part, 1, sizeof part, file)) {
      text_read.append(part, size);
    }
    if (std::ferror(file) != 0) fail("cannot read a temporary file", errno);
    return text_read;
  }
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

bool Finished::well() const {
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::optional<Finished> run_program(const std::vector<std::string>& words, const std::string& input,
                                    const std::string& purpose) {
  const Purpose to{purpose};
  const File in = to.temporary(), out = to.temporary(), complaint = to.temporary();
  if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() ||
      std::fflush(in.get()) != 0) {
    to.fail("cannot write a temporary file", errno);
  }
  std::rewind(in.get());
  int error = 0;
  const pid_t process = file::start_process(
      {words, fileno(in.get()), fileno(out.get()), fileno(complaint.get())}, error);
  if (error == ENOENT) return {};
  if (error != 0) to.fail("cannot start " + words[0], error);
  const std::optional<int> status = wait_for_child(process);
  if (!status) to.fail("cannot wait for " + words[0], ECHILD);
  return Finished{*status, to.content(out.get()), to.content(complaint.get())};
}

}  // namespace bbsim::file
