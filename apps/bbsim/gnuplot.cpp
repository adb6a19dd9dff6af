#include "gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "base/error.hpp"

namespace bbsim::app {
namespace {

// Files without a name, which go when they are closed: with them on both sides of the process
// nobody waits for a full pipe.
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& what, int error) {
  throw OutputError("cannot draw the plot: " + what + ": " + std::strerror(error));
}

File temporary() {
  File file(std::tmpfile(), &std::fclose);
  if (!file) fail("no temporary file", errno);
  return file;
}

std::string content(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char part[4096];
  while (const std::size_t size = std::fread(part, 1, sizeof part, file)) text.append(part, size);
  if (std::ferror(file) != 0) fail("cannot read a temporary file", errno);
  return text;
}

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

struct Finished {
  int status;  // as of waitpid
  std::string output, complaint;
};

Finished run(const std::string& script) {
  const File input = temporary(), output = temporary(), complaint = temporary();
  if (std::fwrite(script.data(), 1, script.size(), input.get()) != script.size() ||
      std::fflush(input.get()) != 0) {
    fail("cannot write a temporary file", errno);
  }
  std::rewind(input.get());
  FileActions files;
  files.replace(STDIN_FILENO, input.get());
  files.replace(STDOUT_FILENO, output.get());
  files.replace(STDERR_FILENO, complaint.get());
  char program[] = "gnuplot", from_input[] = "-";
  char* const arguments[] = {program, from_input, nullptr};
  pid_t process = 0;
  const int error = posix_spawnp(&process, program, &files.actions, nullptr, arguments, environ);
  if (error == ENOENT) {
    throw OutputError(
        "cannot draw the plot: there is no gnuplot on the PATH; install it (Debian: apt install "
        "gnuplot-nox), or leave out --plot");
  }
  if (error != 0) fail("cannot start gnuplot", error);
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) fail("cannot wait for gnuplot", errno);
  }
  return {status, content(output.get()), content(complaint.get())};
}

}  // namespace

void require_gnuplot() {
  static_cast<void>(run_gnuplot(""));
}

std::string run_gnuplot(const std::string& script) {
  Finished finished = run(script);
  if (WIFEXITED(finished.status) && WEXITSTATUS(finished.status) == 0) {
    return std::move(finished.output);
  }
  const std::size_t start = finished.complaint.find_first_not_of(" \n\t");
  const std::string_view all = finished.complaint;
  const std::string_view rest = start == std::string::npos ? "" : all.substr(start);
  throw OutputError("cannot draw the plot: gnuplot failed: " +
                    std::string(rest.substr(0, rest.find('\n'))));
}

}  // namespace bbsim::app
