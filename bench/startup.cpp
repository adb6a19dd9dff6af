// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Times whole processes from posix_spawn() to their end: `bbsim run` of a scenario, and a program
// that links the same libraries and does nothing.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX declares it nowhere

namespace {

// Wall time of the program, s. Throws std::runtime_error if it cannot start or fails.
double time_process(std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  pid_t child = 0;
  const int error = posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ);
  if (error != 0) throw std::runtime_error(words[0] + ": " + std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (status != 0) throw std::runtime_error(words[0] + ": ended with an error");
  return seconds;
}

struct Times {
  std::vector<double> seconds;

  [[nodiscard]] double median() {
    std::sort(seconds.begin(), seconds.end());
    const std::size_t half = seconds.size() / 2;
    return (seconds[half] + seconds[seconds.size() - 1 - half]) / 2;
  }
  [[nodiscard]] double least() const { return *std::min_element(seconds.begin(), seconds.end()); }
};

void compare(const std::string& bbsim, const std::string& nothing, const std::string& scenario) {
  constexpr int rounds = 50;
  const std::string out =
      (std::filesystem::temp_directory_path() / ("startup-" + std::to_string(getpid()) + ".csv"))
          .string();
  Times run, bare;
  for (int i = 0; i <= rounds; ++i) {
    // Take turns, so that other load on the machine affects both alike; the first turn warms the
    // caches.
    const double run_seconds = time_process({bbsim, "run", scenario, "-q", "-o", out});
    const double bare_seconds = time_process({nothing});
    if (i == 0) continue;
    run.seconds.push_back(run_seconds);
    bare.seconds.push_back(bare_seconds);
  }
  std::filesystem::remove(out);
  std::printf("whole process, wall time, %d times in turns   median    least\n", rounds);
  std::printf("bbsim run %-32s %6.2f ms %5.2f ms\n",
              (std::filesystem::path(scenario).filename().string() + " -q -o FILE").c_str(),
              1e3 * run.median(), 1e3 * run.least());
  std::printf("%-42s %6.2f ms %5.2f ms\n", "a program that does nothing", 1e3 * bare.median(),
              1e3 * bare.least());
  std::printf("%-42s %6.2f    %5.2f\n", "ratio", run.median() / bare.median(),
              run.least() / bare.least());
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::fprintf(stderr, "usage: %s BBSIM NOTHING SCENARIO\n", words[0]);
    return 2;
  }
  try {
    compare(words[1], words[2], words[3]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
