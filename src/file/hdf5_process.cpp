// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5_process.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>

#include "base/shown.hpp"
#include "file/children.hpp"
#include "file/hdf5_module.hpp"
#include "file/start_process.hpp"

namespace bbsim::file {
namespace {

using hdf5::Head;
using hdf5::Message;

constexpr int pipe_bytes = 1 << 20;  // as much as the system lets any user have
constexpr int no_program = 127;      // the exit code of what could not be started

// The one that there is, under its mutex.
std::mutex current_mutex;
std::shared_ptr<Hdf5Process>& current() {
  static std::shared_ptr<Hdf5Process> process;
  return process;
}

[[noreturn]] void no_process(int error) {
  throw Hdf5Trouble("no process can be had to read it in: " + error_text(error));
}

std::shared_ptr<Hdf5Process> start_reader() {
  const ModuleFile program = find_hdf5_reader(hdf5_module_folders());
  if (program.path.empty()) throw Hdf5Trouble(program.trouble);
  std::array<int, 2> ends{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) no_process(errno);
  // Above those of standard input, output and error, which the child gets others for.
  Descriptor requests = above_standard_streams(ends[0]);
  const Descriptor its_requests = above_standard_streams(ends[1]);
  if (pipe2(ends.data(), O_CLOEXEC) != 0) no_process(errno);
  Descriptor answers = above_standard_streams(ends[0]);
  const Descriptor its_answers = above_standard_streams(ends[1]);
  fcntl(answers.get(), F_SETPIPE_SZ, pipe_bytes);  // it does with less

  int error = 0;
  const pid_t process =
      start_process({{program.path}, its_requests.get(), its_answers.get()}, error);
  if (process == 0) no_process(error);
  return std::make_shared<Hdf5Process>(process, std::move(requests), std::move(answers));
}

constexpr const char* damaged = ": the file is damaged, or not valid HDF5";

std::string signal_text(int number) {
  // What the reader's own timer sends.
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

}  // namespace

std::shared_ptr<Hdf5Process> Hdf5Process::running() {
  const std::lock_guard lock(current_mutex);
  std::shared_ptr<Hdf5Process>& process = current();
  if (!process || process->process_ == 0 || process->owner_ != getpid()) {
    auto started = start_reader();
    started->expect_ready();  // only now: our copies of its ends of the lines are closed
    process = std::move(started);
  }
  return process;
}

void Hdf5Process::retire() {
  const std::lock_guard lock(current_mutex);
  if (current().get() == this) current().reset();
}

Hdf5Process::Hdf5Process(pid_t process, Descriptor requests, Descriptor answers)
    : process_(process),
      requests_(std::move(requests)),
      answers_(std::move(answers)),
      owner_(getpid()) {}

Hdf5Process::~Hdf5Process() {
  hang_up();
  if (process_ != 0 && owner_ == getpid()) wait_for_child(process_);
}

void Hdf5Process::expect_ready() {
  Head head;
  receive(&head, sizeof head);
  std::uint64_t number = 0;
  if (head.what == Message::ready && head.bytes == sizeof number) receive(&number, sizeof number);
  if (number == hdf5::protocol) return;
  end();
  throw Hdf5Trouble(
      "the HDF5 reader belongs to another version of bbsim; install the two together");
}

void Hdf5Process::send(const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t put = ::send(requests_.get(), from, size, MSG_NOSIGNAL);
    if (put < 0 && errno != EINTR) fail(errno);
    if (put <= 0) continue;
    from += put;
    size -= static_cast<std::size_t>(put);
  }
}

void Hdf5Process::receive(void* bytes, std::size_t size) {
  char* to = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = ::read(answers_.get(), to, size);
    if (got == 0) fail_by_end();
    if (got < 0 && errno != EINTR) fail(errno);
    if (got < 0) continue;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
}

void Hdf5Process::end() {
  if (process_ == 0) return;
  kill(process_, SIGKILL);
  wait_for_child(process_.exchange(0));
}

void Hdf5Process::hang_up() {
  requests_.close();
  answers_.close();
}

void Hdf5Process::fail(int error) {
  if (error == EPIPE || error == ECONNRESET) fail_by_end();
  end();
  throw Hdf5Trouble("talking with the HDF5 reader failed: " + error_text(error));
}

void Hdf5Process::fail_by_end() {
  hang_up();
  const std::optional<int> status = wait_for_child(process_.exchange(0));
  ended_idle_ = !status || (WIFEXITED(*status) && WEXITSTATUS(*status) == 0);
  if (!status) throw Hdf5Trouble(std::string("the HDF5 reader ended over it") + damaged);
  if (WIFSIGNALED(*status)) throw Hdf5Trouble(signal_text(WTERMSIG(*status)));
  throw Hdf5Trouble(exit_text(WEXITSTATUS(*status)));
}

Hdf5Talk::Hdf5Talk(Hdf5Process& process, Message what, std::string_view request)
    : process_(process), lock_(process.mutex_) {
  if (process.process_ == 0) throw Hdf5Trouble("the HDF5 reader ended on another file");
  if (request.size() > hdf5::most_bytes) throw Hdf5Trouble("it has too many datasets");
  const Head head{what, static_cast<std::uint32_t>(request.size())};
  process_.send(&head, sizeof head);
  process_.send(request.data(), request.size());
}

Hdf5Talk::~Hdf5Talk() {
  if (!over_) process_.end();
}

Head Hdf5Talk::next() {
  Head head;
  process_.receive(&head, sizeof head);
  if (head.bytes > hdf5::most_bytes) throw Hdf5Trouble("the HDF5 reader sent too much at once");
  if (head.what != Message::failed) return head;
  const std::string why = bytes(head);
  // What it met may have left its mark on the library.
  process_.retire();
  over();
  throw Hdf5Trouble(shown(why, uncut));
}

std::string Hdf5Talk::bytes(const Head& head) {
  std::string text(head.bytes, '\0');
  bytes(head, text.data());
  return text;
}

void Hdf5Talk::bytes(const Head& head, void* to) {
  process_.receive(to, head.bytes);
}

}  // namespace bbsim::file
