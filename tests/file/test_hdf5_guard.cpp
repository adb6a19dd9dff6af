// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// If the HDF5 library crashes while writing, the program ends with a message and its exit code.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <string>

#include "catch.hpp"
#include "file/hdf5_guard.hpp"

using bbsim::file::WithinHdf5;

namespace {

struct End {
  int status = 0;
  std::string said;
};

// Uses up the whole stack.
[[gnu::noinline]] int without_end(int depth) {
  volatile char frame[4096]{};
  frame[0] = static_cast<char>(depth);
  return depth == 0 ? 0 : without_end(depth + 1) + frame[0];
}

// Runs an action in a process; returns how it ended and its standard error.
template <class Action>
End end_of(const Action& action) {
  std::array<int, 2> ends{-1, -1};
  REQUIRE(pipe(ends.data()) == 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    action();
    _exit(0);
  }
  close(ends[1]);
  End end;
  std::array<char, 256> buffer;
  for (ssize_t size = 0; (size = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    end.said.append(buffer.data(), static_cast<std::size_t>(size));
  }
  close(ends[0]);
  REQUIRE(waitpid(child, &end.status, 0) == child);
  return end;
}

}  // namespace

TEST_CASE("a crash within HDF5 ends the program with a message and exit code 3") {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) {
    CAPTURE(signal);
    const End end = end_of([&] {
      const char *const message = "cannot write a.h5\n", *const other = "cannot write b.h5\n";
      const WithinHdf5 within(message);
      { const WithinHdf5 again(other); }
      raise(signal);
    });
    CHECK(WIFEXITED(end.status));
    CHECK(WEXITSTATUS(end.status) == 3);
    CHECK(end.said == "cannot write a.h5\n");
  }
}

TEST_CASE("exit() within HDF5 and a stack overflow also end the program with a message") {
  const char* const message = "cannot write a.h5\n";
  const End left = end_of([&] {
    const WithinHdf5 within(message);
    std::exit(-1);
  });
  CHECK(WIFEXITED(left.status));
  CHECK(WEXITSTATUS(left.status) == 3);
  CHECK(left.said == message);
  const End full = end_of([&] {
    const WithinHdf5 within(message);
    static_cast<void>(without_end(1));
  });
  CHECK(WIFEXITED(full.status));
  CHECK(WEXITSTATUS(full.status) == 3);
  CHECK(full.said == message);
}

TEST_CASE("a crash elsewhere remains a crash, before and after HDF5 was used") {
  const End end = end_of([] {
    std::signal(SIGABRT, SIG_DFL);  // Catch2 installs its own handler
    { const WithinHdf5 within("cannot write a.h5\n"); }
    std::abort();
  });
  CHECK(WIFSIGNALED(end.status));
  CHECK(WTERMSIG(end.status) == SIGABRT);
  CHECK(end.said.empty());
}
