// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/external.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/error.hpp"
#include "file/leftovers.hpp"
#include "file/start_process.hpp"

namespace bbsim::file {
namespace {

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
