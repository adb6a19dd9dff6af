// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "catch.hpp"

namespace bbsim_test {
namespace fs = std::filesystem;

namespace {

void redirect(int target, const std::string& file) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(descriptor, target);
  close(descriptor);
}

bool is_running(pid_t child) {
  siginfo_t ended{};
  return waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         ended.si_pid == 0;
}

}  // namespace

Result bbsim(const Launch& launch) {
  const Folder streams;
  const std::string out = streams / "out", err = streams / "err";
  const auto start = std::chrono::steady_clock::now();
  // An early signal waits for the program and does not reach handlers in this process.
  sigset_t all, before;
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &before);
  const pid_t child = fork();
  if (child != 0) sigprocmask(SIG_SETMASK, &before, nullptr);
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) (void)std::signal(signal, SIG_DFL);
    sigprocmask(SIG_SETMASK, &before, nullptr);
    redirect(STDOUT_FILENO, out);
    redirect(STDERR_FILENO, err);
    close_range(STDERR_FILENO + 1, ~0U, 0);  // descriptors left open by the test environment
    if (!launch.folder.empty() && chdir(launch.folder.c_str()) != 0) _exit(126);
    if (launch.prepare) launch.prepare();
    std::vector<std::string> words{BBSIM_PROGRAM};
    words.insert(words.end(), launch.arguments.begin(), launch.arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv(BBSIM_PROGRAM, pointers.data());
    _exit(127);
  }
  if (launch.signal != 0) {
    if (launch.signal_when) {
      while (!launch.signal_when() && is_running(child)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    } else {
      std::this_thread::sleep_for(launch.signal_after);
    }
    kill(child, launch.signal);
  }
  int status = 0;
  waitpid(child, &status, 0);
  Result result;
  for (const std::string& word : launch.arguments) result.line += word + ' ';
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = content_of(out);
  result.err = content_of(err);
  return result;
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path())) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

std::string config(const std::string& name) {
  return std::string(BBSIM_SOURCE_DIR) + "/configs/" + name;
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  bool quoted = false, begun = false;
  for (const char c : line + ' ') {
    if (c == '\'') {
      quoted = !quoted;
      begun = true;
    } else if (c != ' ' || quoted) {
      word += c;
      begun = true;
    } else if (begun) {
      const char sign = word.empty() ? ' ' : word.front();
      if (sign == '@') word = config(word.substr(1));
      if (sign == '%') word = BBSIM_SOURCE_DIR "/" + word.substr(1);
      words.push_back(word);
      word.clear();
      begun = false;
    }
  }
  return words;
}

Result call_with(const std::string& variable, const std::string& value, const std::string& line,
                 const Folder& folder) {
  return call(line, folder, [&] { setenv(variable.c_str(), value.c_str(), 1); });
}

nlohmann::json summary_of(const Folder& folder, const std::string& name) {
  return nlohmann::json::parse(folder.read(name));
}

Result expect(int exit_code, Result result, const std::vector<std::string>& errors,
              const std::vector<std::string>& output) {
  CAPTURE(result.line, result.out, result.err);
  REQUIRE(result.exit_code == exit_code);
  const auto check = [](const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
      CAPTURE(part);
      const bool absent = part.starts_with('!');
      CHECK(contains(text, part.substr(absent ? 1 : 0)) != absent);
    }
  };
  check(result.err, errors);
  check(result.out, output);
  return result;
}

}  // namespace bbsim_test
