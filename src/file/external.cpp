// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/external.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/error.hpp"
#include "file/children.hpp"

namespace bbsim::file {
namespace {

// Files without a name, which go when they are closed: with them on both sides of the process
// nobody waits for a full pipe.
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

struct FileActions {
  FileActions() { posix_spawn_file_actions_init(&actions); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  void replace(int descriptor, std::FILE* by) {
    posix_spawn_file_actions_adddup2(&actions, fileno(by), descriptor);
  }
  posix_spawn_file_actions_t actions{};
};

}  // namespace

bool Finished::well() const {
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::optional<Finished> run_program(std::vector<std::string> words, const std::string& input,
                                    const std::string& purpose) {
  const Purpose to{purpose};
  const File in = to.temporary(), out = to.temporary(), complaint = to.temporary();
  if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() ||
      std::fflush(in.get()) != 0) {
    to.fail("cannot write a temporary file", errno);
  }
  std::rewind(in.get());
  FileActions files;
  files.replace(STDIN_FILENO, in.get());
  files.replace(STDOUT_FILENO, out.get());
  files.replace(STDERR_FILENO, complaint.get());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  int error = 0;
  {
    const auto starting = while_starting_child();
    error =
        posix_spawnp(&process, arguments[0], &files.actions, nullptr, arguments.data(), environ);
    if (error == 0) remember_child(process);
  }
  if (error == ENOENT) return {};
  if (error != 0) to.fail("cannot start " + words[0], error);
  const std::optional<int> status = wait_for_child(process);
  if (!status) to.fail("cannot wait for " + words[0], ECHILD);
  return Finished{*status, to.content(out.get()), to.content(complaint.get())};
}

}  // namespace bbsim::file
