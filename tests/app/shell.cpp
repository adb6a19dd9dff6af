// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "shell.hpp"

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace bbsim_test {
namespace {

[[noreturn]] void execute(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp(pointers[0], pointers.data());
  _exit(127);
}

}  // namespace

Result shell(const std::string& line, const Folder& folder) {
  const Folder streams;
  const std::string out = streams / "out", err = streams / "err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    setenv("BBSIM", BBSIM_PROGRAM, 1);
    if (chdir(folder.path().c_str()) != 0) _exit(126);
    execute({"bash", "-o", "pipefail", "-c", "{ " + line + "\n} > '" + out + "' 2> '" + err + "'"});
  }
  int status = 0;
  waitpid(child, &status, 0);
  Result result;
  result.line = line;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = streams.read("out");
  result.err = streams.read("err");
  return result;
}

std::string on_terminal(const std::string& command, unsigned short columns, const Folder& folder,
                        double seconds, const std::string& awaited, const std::string& kind,
                        const std::string& typed) {
  const winsize size{24, columns, 0, 0};
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child < 0) throw std::runtime_error("cannot open a terminal");
  if (child == 0) {
    if (chdir(folder.path().c_str()) != 0) _exit(126);
    setenv("TERM", kind.c_str(), 1);
    std::vector<std::string> words{BBSIM_PROGRAM};
    for (const std::string& word : words_of(command)) words.push_back(word);
    execute(words);
  }
  if (write(terminal, typed.data(), typed.size()) != static_cast<ssize_t>(typed.size())) {
    throw std::runtime_error("cannot type");
  }
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  bool ended = false;
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {  // read() fails at the end, when the terminal is gone
    pollfd drawn{terminal, POLLIN, 0};
    if (poll(&drawn, 1, 50) > 0) {
      const ssize_t got = read(terminal, part.data(), part.size());
      if (got <= 0) break;
      text.append(part.data(), static_cast<std::size_t>(got));
    }
    const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    const bool seen = !awaited.empty() && text.find(awaited) != std::string::npos;
    if (!ended && (seen || elapsed > seconds)) {
      kill(child, SIGINT);
      ended = true;
    }
  }
  close(terminal);
  waitpid(child, nullptr, 0);
  return text;
}

}  // namespace bbsim_test
