// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5_process.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>

#include "base/quoted.hpp"
#include "file/children.hpp"
#include "file/hdf5/table_text.hpp"
#include "file/hdf5_module.hpp"
#include "file/start_process.hpp"

namespace bbsim::file {
namespace {

constexpr int pipe_bytes = 1 << 20;           // the most that the system lets any user have
constexpr std::size_t bytes_at_once = 65536;  // for everything but large arrays

// Exit codes of the reader: it gave a reason; it could not be started.
constexpr int told_why = 1, no_program = 127;
constexpr std::size_t longest_reason = 65536;  // bytes

[[noreturn]] void no_process(int error) {
  throw Hdf5Trouble("cannot start a process to read it: " + error_text(error));
}

constexpr const char* damaged = ": the file is damaged, or not valid HDF5";

std::string signal_text(int number) {
  // The reader's own timer sends this signal.
  if (number == SIGPROF)
    return std::string("the HDF5 library does not finish reading it") + damaged;
  const std::string which = " (signal " + std::to_string(number) + ", " + strsignal(number) + ")";
  if (number == SIGKILL) return "the HDF5 reader was ended from outside" + which;
  return "the HDF5 library failed on it" + which + damaged;
}

std::string exit_text(int code) {
  if (code == no_program) {
    return "the HDF5 reader does not start; install the HDF5 library that it was built with, or "
           "use .csv instead";
  }
  return "the HDF5 reader ended with code " + std::to_string(code) + damaged;
}

// The text that the reader wrote, from its beginning.
std::string content_of(const Descriptor& error) {
  std::string text(longest_reason, '\0');
  const ssize_t size = read_at(error.get(), text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  return shown(text, uncut);
}

}  // namespace

Hdf5Process::Hdf5Process(const std::vector<std::string>& files, const Hdf5Rows& rows) {
  const ModuleFile program = find_hdf5_reader(hdf5_module_folders());
  if (program.path.empty()) throw Hdf5Trouble(program.trouble);
  NewProcess reader{{program.path, std::to_string(rows.a_block), std::to_string(rows.most)}};
  reader.words.insert(reader.words.end(), files.begin(), files.end());
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) no_process(errno);
  // Above the standard streams, because the child replaces those.
  output_ = above_standard_streams(ends[0]);
  const Descriptor its_output = above_standard_streams(ends[1]);
  fcntl(output_.get(), F_SETPIPE_SZ, pipe_bytes);  // on failure, a smaller pipe works too
  // A file in place of a pipe, so that the reader never blocks on its messages.
  error_ = above_standard_streams(memfd_create("bbsim-hdf5-reader", MFD_CLOEXEC));
  const Descriptor nothing(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!error_.is_open() || !nothing.is_open()) no_process(errno);
  reader.input = nothing.get();
  reader.output = its_output.get();
  reader.error = error_.get();
  int error = 0;
  process_ = start_process(reader, error);
  if (process_ == 0) no_process(error);
}

Hdf5Process::Hdf5Process(pid_t process, Descriptor output, Descriptor error)
    : process_(process), output_(std::move(output)), error_(std::move(error)) {}

Hdf5Process::~Hdf5Process() {
  end();
}

std::string Hdf5Process::line() {
  std::string line;
  for (;;) {
    const char* const from = waiting_.data() + next_;
    const char* const to = waiting_.data() + end_;
    const char* const stop = std::find(from, to, '\n');
    line.append(from, stop);
    next_ += static_cast<std::size_t>(stop - from);
    if (stop != to) break;
    if (line.size() > hdf5::longest_text) throw Hdf5Trouble("it has too many datasets");
    fill();
  }
  ++next_;
  return line;
}

void Hdf5Process::take(void* bytes, std::size_t size) {
  char* to = static_cast<char*>(bytes);
  while (size > 0) {
    std::size_t got = std::min(size, end_ - next_);
    if (got > 0) {
      std::memcpy(to, waiting_.data() + next_, got);
      next_ += got;
    } else if (size < bytes_at_once) {
      fill();
    } else {
      got = read(to, size);
    }
    to += got;
    size -= got;
  }
}

std::size_t Hdf5Process::read(char* to, std::size_t most) {
  for (;;) {
    const ssize_t got = ::read(output_.get(), to, most);
    if (got > 0) return static_cast<std::size_t>(got);
    if (got == 0) fail_by_end();
    if (errno == EINTR) continue;
    const int error = errno;
    end();
    throw Hdf5Trouble("communication with the HDF5 reader failed: " + error_text(error));
  }
}

void Hdf5Process::fill() {
  waiting_.resize(bytes_at_once);
  next_ = end_ = 0;
  end_ = read(waiting_.data(), waiting_.size());
}

void Hdf5Process::end() {
  if (process_ == 0) return;
  kill(process_, SIGKILL);
  wait_for_child(std::exchange(process_, 0));
}

void Hdf5Process::fail_by_end() {
  const std::optional<int> status =
      process_ == 0 ? std::nullopt : wait_for_child(std::exchange(process_, 0));
  if (status && WIFSIGNALED(*status)) throw Hdf5Trouble(signal_text(WTERMSIG(*status)));
  const std::string reason = content_of(error_);
  if (!reason.empty() && (!status || WEXITSTATUS(*status) == told_why)) throw Hdf5Trouble(reason);
  if (!status) throw Hdf5Trouble(std::string("the HDF5 reader ended while reading it") + damaged);
  throw Hdf5Trouble(exit_text(WEXITSTATUS(*status)));
}

}  // namespace bbsim::file
