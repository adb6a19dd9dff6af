// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "controller/foreign_code.hpp"
#include "controller/protocol.hpp"
#include "file/leftovers.hpp"

namespace bbsim::controller {
namespace {

constexpr std::size_t longest_line = 65536, longest_complaint = 4096;
// Attempts to read an answer before waiting, about 50 us in all: waking up takes longer than many
// programs need to answer. ask() continues this while it succeeds, and retries it now and then.
constexpr int most_patience = 200;
constexpr int slice = 100;      // ms: longest time until `stop` is noticed
constexpr int parting = 300;    // ms: time to end, for a child that closed a stream
constexpr int farewell = 1000;  // ms: time for the child to end by itself

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Pipe {
  file::Descriptor ours, its;
};

// Our end does not block. A new process gets only its own end.
Pipe make_pipe(bool it_reads) {
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category());
  }
  file::Descriptor reading = file::above_standard_streams(ends[0]);
  file::Descriptor writing = file::above_standard_streams(ends[1]);
  Pipe pipe = it_reads ? Pipe{std::move(writing), std::move(reading)}
                       : Pipe{std::move(reading), std::move(writing)};
  if (!pipe.ours.is_open() || !pipe.its.is_open() ||
      fcntl(pipe.ours.get(), F_SETFL, O_NONBLOCK) != 0) {
    throw std::system_error(errno, std::generic_category());
  }
  return pipe;
}

// A descriptor that is readable once the process has ended; not open if the system has none.
file::Descriptor end_of(pid_t process) {
  return file::Descriptor(static_cast<int>(syscall(SYS_pidfd_open, process, 0)));
}

std::string how_it_ended(int status) {
  if (WIFEXITED(status)) {
    return "it ended with exit code " + std::to_string(WEXITSTATUS(status));
  }
  const int signal = WTERMSIG(status);
  return "it was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ')';
}

}  // namespace

Child::Child(const std::vector<std::string>& words, const std::string& folder, Report report,
             const std::atomic<bool>* stop)
    : report_(std::move(report)), stop_(stop), buffer_(longest_line) {
  Pipe input = make_pipe(true), output = make_pipe(false), error = make_pipe(false);
  int fault = 0;
  process_ = start_program(
      {words, input.its.get(), output.its.get(), error.its.get(), folder, true}, fault);
  if (process_ == 0) throw std::system_error(fault, std::generic_category());
  input_ = std::move(input.ours);
  output_ = std::move(output.ours);
  error_ = std::move(error.ours);
  ended_ = end_of(process_);
}

Child::~Child() {
  try {
    static_cast<void>(end());
  } catch (...) {  // nobody is left to be told
  }
}

std::string_view Child::ask(std::string_view line, double timeout) {
  refuse_early_words();
  timeout_ = timeout;
  deadline_ = now() + timeout;
  send(line);
  if (asked_++ % 64 == 0) patience_ = most_patience;
  for (int looks = 0;; ++looks) {
    receive();
    if (answer_ > 0) {
      patience_ = looks < patience_ ? most_patience : 0;
      return {buffer_.data(), answer_ - 1};
    }
    if (looks >= patience_) wait(0);
  }
}

// After an answer that comes before its request, all later answers would belong to other requests.
void Child::refuse_early_words() {
  std::memmove(buffer_.data(), buffer_.data() + answer_, size_ - answer_);
  size_ -= answer_;
  answer_ = 0;
  if (size_ == 0) {
    const ssize_t got = read(output_.get(), buffer_.data(), buffer_.size());
    if (got <= 0) return;  // receive() finds a closed stream
    size_ = static_cast<std::size_t>(got);
  }
  const std::string_view words = received(), line = words.substr(0, words.find('\n'));
  fail("it said " + bbsim::quoted(line, longest_saying) + " before it was asked; " +
       advice_on_text(line) + "allowed: one line for each request");
}

void Child::send(std::string_view line) {
  while (!line.empty()) {
    const ssize_t put = write(input_.get(), line.data(), line.size());
    if (put >= 0) {
      line.remove_prefix(static_cast<std::size_t>(put));
    } else if (errno == EAGAIN) {
      wait(POLLOUT);
    } else if (errno == EPIPE) {
      if (!has_ended(parting)) fail("it closed its standard input");
      fail("");
    } else if (errno != EINTR) {
      fail("it cannot be written to: " + file::error_text(errno));
    }
  }
}

// Reads what is available of an answer.
void Child::receive() {
  while (answer_ == 0) {
    if (size_ == buffer_.size()) {
      fail("its answer does not end within " + std::to_string(longest_line) +
           " bytes: " + bbsim::quoted(received(), longest_saying));
    }
    const ssize_t got = read(output_.get(), buffer_.data() + size_, buffer_.size() - size_);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) return;
    if (got < 0) fail("it cannot be read from: " + file::error_text(errno));
    if (got == 0) {
      if (!has_ended(parting)) fail("it closed its standard output");
      fail(size_ == 0 ? "" : "its answer breaks off: " + bbsim::quoted(received(), longest_saying));
    }
    char* const start = buffer_.data() + size_;
    char* const end = start + got;
    char* const line_break = std::find(start, end, '\n');
    if (line_break != end) answer_ = static_cast<std::size_t>(line_break - buffer_.data()) + 1;
    size_ += static_cast<std::size_t>(got);
  }
}

// Waits until there is output to read (or room to write, on request), the child ends, or a slice of
// time has passed.
void Child::wait(short for_output) {
  const double time = now(), left = deadline_ - time;
  // Waits for a prompt child even if stopped, because bbsim may still ask for its state.
  if (stop_ != nullptr && stop_->load(std::memory_order_relaxed) &&
      time - (deadline_ - timeout_) > slice / 1e3) {
    throw ChildInterrupted();
  }
  if (left <= 0) fail_by_silence();
  std::array<pollfd, 4> events{{{output_.get(), POLLIN, 0},
                                {error_.get(), POLLIN, 0},
                                {ended_.get(), POLLIN, 0},
                                {for_output != 0 ? input_.get() : -1, for_output, 0}}};
  const int ready = poll(events.data(), events.size(),
                         static_cast<int>(std::min<double>(slice, std::ceil(1e3 * left))));
  if (events[1].revents != 0) listen();
  const bool ended = ready > 0 && events[2].revents != 0;
  const bool may_have = ready == 0 && !ended_.is_open();
  if ((ended || (may_have && has_ended(0))) && events[0].revents == 0) {
    receive();  // its last output
    if (answer_ == 0)
      fail(size_ == 0 ? "" : "its answer breaks off: " + bbsim::quoted(received(), longest_saying));
  }
}

// Passes the child's standard error to report_.
void Child::listen() {
  std::array<char, 4096> part;
  for (int i = 0; i < 16; ++i) {  // the output may be endless
    const ssize_t got = read(error_.get(), part.data(), part.size());
    if (got == 0) error_.close();
    if (got <= 0) break;
    complaint_.append(part.data(), static_cast<std::size_t>(got));
    say_lines(false);
  }
}

void Child::say_lines(bool all) {
  std::size_t start = 0;
  for (;;) {
    const std::size_t end = complaint_.find('\n', start);
    if (end == std::string::npos) break;
    report_(std::string_view(complaint_).substr(start, end - start));
    start = end + 1;
  }
  complaint_.erase(0, start);
  if (!complaint_.empty() && (all || complaint_.size() > longest_complaint)) {
    report_(complaint_);
    complaint_.clear();
  }
}

void Child::fail_by_silence() {
  std::string why = "it did not answer within " + number_text(timeout_) + " s";
  if (size_ > 0) {
    why += ": it sent " + bbsim::quoted(received(), longest_saying) + ", without a line break";
  } else {
    why += " (flush buffered output after each answer: print(..., flush=True) in Python)";
  }
  fail(why);
}

void Child::fail(const std::string& why) {
  throw refuse(why);
}

ChildFault Child::refuse(const std::string& why) {
  // The child may already be about to end.
  const bool by_itself = has_ended(why.empty() ? 0 : slice / 2);
  const std::optional<int> status = end();
  const std::string how =
      by_itself && status ? how_it_ended(*status) : "it was still running, and has been ended";
  return ChildFault(why.empty() ? how : why + "; " + how);
}

// Whether the child has ended, or ends within so many milliseconds.
bool Child::has_ended(int milliseconds) const {
  if (process_ == 0) return true;
  const double until = now() + milliseconds / 1e3;
  for (;;) {
    siginfo_t info{};
    if (waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
        info.si_pid == process_) {
      return true;
    }
    const int left = static_cast<int>(std::ceil(1e3 * (until - now())));
    if (left <= 0) return false;
    pollfd ended{ended_.get(), POLLIN, 0};
    poll(&ended, 1, ended_.is_open() ? left : std::min(left, 5));
  }
}

// Ends the child and its group. Waits for a limited time, because the system may hold
// the child. Returns its status, unless it is still there or something else reaped it.
std::optional<int> Child::end() {
  if (process_ == 0) return {};
  input_.close();
  file::end_child(process_);
  static_cast<void>(has_ended(farewell));
  file::forget_child(process_);
  int status = 0;
  const pid_t found = waitpid(process_, &status, WNOHANG);
  process_ = 0;
  if (error_.is_open()) listen();
  say_lines(true);
  return found > 0 ? std::optional(status) : std::nullopt;
}

void Child::finish() {
  if (process_ == 0) return;
  input_.close();
  const double until = now() + farewell / 1e3;
  bool ended = has_ended(0);
  while (!ended && now() < until) {
    std::array<pollfd, 3> events{
        {{output_.get(), POLLIN, 0}, {error_.get(), POLLIN, 0}, {ended_.get(), POLLIN, 0}}};
    poll(events.data(), events.size(), ended_.is_open() ? slice : 5);
    if (events[0].revents != 0 && read(output_.get(), buffer_.data(), buffer_.size()) == 0) {
      output_.close();  // nobody reads its last output
    }
    if (events[1].revents != 0) listen();
    ended = has_ended(0);
  }
  if (!ended) report_("it kept running after the end of its input, and has been ended");
  static_cast<void>(end());
}

}  // namespace bbsim::controller
