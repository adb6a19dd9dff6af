// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim-hdf5-reader: reads HDF5 files for bbsim, in a process of its own, which may die of what a
// damaged file does to the HDF5 library. Standard input is a socket with requests, standard output
// a pipe for the answers: messages.hpp.
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "file/hdf5/messages.hpp"
#include "file/hdf5/reader.hpp"

namespace bbsim::hdf5 {
namespace {

// Processor time without an answer after which we are taken to go in circles: so much, and a second
// for so many bytes of a file that is open. What is spent waiting for a disk does not count.
constexpr rlim_t patience = 2;  // s
constexpr rlim_t bytes_a_second = rlim_t{1} << 27U;
// Memory that HDF5 may take for a file, beside four times the file's size.
constexpr rlim_t most_memory = rlim_t{1} << 30U;
// Whoever has no file open for so long does not come back soon.
constexpr int idle_time = 1000;  // ms

constexpr std::size_t numbers_at_once = 32768;  // 256 KiB
constexpr std::size_t texts_at_once = 1024;

// The program is gone, or wants nothing more.
class End {};

// Ends the process unless it is set again in time, or stopped.
class Timer {
 public:
  void allow_for(rlim_t bytes) {
    seconds_ = std::max(seconds_, static_cast<time_t>(patience + bytes / bytes_a_second));
  }
  void set() const { set_to(seconds_); }
  static void stop() { set_to(0); }

 private:
  static void set_to(time_t seconds) {
    const itimerval timer{{0, 0}, {seconds, 0}};
    setitimer(ITIMER_PROF, &timer, nullptr);
  }

  time_t seconds_ = patience;
};
Timer timer;

void prepare() {
  // Where we die there is nothing to look into: the file is what is wrong.
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  prctl(PR_SET_DUMPABLE, 0);
  // Ctrl-C goes to all of a terminal's processes; the program decides what comes of it, and we end
  // with it.
  for (const int one : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(one, SIG_IGN);
  keep_errors_to_ourselves();
}

rlim_t memory_in_use() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

rlim_t size_of(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? static_cast<rlim_t>(status.st_size) : 0;
}

// What a damaged file makes HDF5 ask for beyond this fails.
void limit_memory(rlim_t file_size) {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  const rlim_t wanted = memory_in_use() + most_memory + 4 * std::min(file_size, RLIM_INFINITY / 8);
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  setrlimit(RLIMIT_AS, &limit);
}

void write_all(const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t put = ::write(STDOUT_FILENO, from, size);
    if (put < 0 && errno != EINTR) throw End();
    if (put <= 0) continue;
    from += put;
    size -= static_cast<std::size_t>(put);
  }
}

void read_all(void* bytes, std::size_t size) {
  char* to = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = ::read(STDIN_FILENO, to, size);
    if (got == 0 || (got < 0 && errno != EINTR)) throw End();
    if (got < 0) continue;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
}

// An answer, which shows that we get on.
void say(Message what, std::string_view bytes) {
  if (bytes.size() > most_bytes) {
    throw Failure("it holds a text of " + std::to_string(bytes.size()) +
                  " bytes; allowed: " + std::to_string(most_bytes));
  }
  const Head head{what, static_cast<std::uint32_t>(bytes.size())};
  write_all(&head, sizeof head);
  write_all(bytes.data(), bytes.size());
  timer.set();
}

void say_numbers(const std::vector<double>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); i += numbers_at_once) {
    const std::size_t count = std::min(numbers_at_once, numbers.size() - i);
    say(Message::numbers, {reinterpret_cast<const char*>(&numbers[i]), count * sizeof(double)});
  }
}

void say_texts(const std::vector<std::string>& texts) {
  constexpr std::size_t enough = std::size_t{1} << 18U;  // bytes
  Packer message;
  for (const std::string& text : texts) {
    message.text(text);
    if (message.bytes().size() < enough) continue;
    say(Message::texts, message.bytes());
    message = {};
  }
  if (!message.bytes().empty()) say(Message::texts, message.bytes());
}

void say_attribute(const std::string& name, const Value& value) {
  Packer message;
  message.text(name).number(value.index());
  if (const auto* text = std::get_if<std::string>(&value)) {
    message.text(*text);
  } else if (const auto* number = std::get_if<double>(&value)) {
    message.number(std::bit_cast<std::uint64_t>(*number));
  } else {
    message.number(static_cast<std::uint64_t>(std::get<std::int64_t>(value)));
  }
  say(Message::attribute, message.bytes());
}

class Server {
 public:
  // Throws End when there is nothing more to do.
  [[noreturn]] void serve() {
    say(Message::ready, Packer().number(protocol).bytes());
    for (;;) {
      Timer::stop();
      wait();
      Head head;
      read_all(&head, sizeof head);
      if (head.bytes > most_bytes) throw End();
      std::string bytes(head.bytes, '\0');
      read_all(bytes.data(), bytes.size());
      timer.set();
      answer(head.what, Unpacker(bytes));
    }
  }

 private:
  void wait() const {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (files_.empty() && poll(&input, 1, idle_time) == 0) throw End();
  }

  void answer(Message what, Unpacker request) {
    try {
      if (what == Message::open) open(std::string(request.text()));
      if (what == Message::read) read(request);
      if (what == Message::close) files_.erase(request.number());
    } catch (const std::bad_alloc&) {
      say(Message::failed, "there is not enough memory for the size that it declares");
    } catch (const std::length_error&) {
      say(Message::failed, "there is not enough memory for the size that it declares");
    } catch (const std::exception& failure) {
      say(Message::failed, failure.what());
    }
  }

  void open(const std::string& path) {
    const rlim_t bytes = size_of(path);
    limit_memory(bytes);
    timer.allow_for(bytes);
    Contents contents;
    contents.dataset = [](const DatasetInfo& info) {
      say(Message::dataset, Packer()
                                .number(info.kind)
                                .number(info.width)
                                .number(info.rows)
                                .text(info.name)
                                .text(info.unit)
                                .text(info.description)
                                .bytes());
    };
    contents.attribute = say_attribute;
    contents.input = [](const std::string& file) { say(Message::input, file); };
    auto reader = std::make_unique<Reader>(path.c_str(), contents);
    files_.emplace(next_, std::move(reader));
    say(Message::opened, Packer().number(next_++).bytes());
  }

  void read(Unpacker request) {
    const Reader& reader = *files_.at(request.number());
    const std::size_t first = request.number();
    const std::size_t rows = request.number();
    while (!request.empty()) {
      const std::size_t dataset = request.number();
      const DatasetInfo& info = reader.info(dataset);
      if (info.kind == BBSIM_HDF5_TEXT) {
        for (std::size_t done = 0; done < rows; done += texts_at_once) {
          say_texts(reader.read_texts(dataset, first + done, std::min(texts_at_once, rows - done)));
        }
        continue;
      }
      const std::size_t width = info.kind == BBSIM_HDF5_SERIES ? info.width : 1;
      if (width == 0) continue;
      const std::size_t at_once = std::max<std::size_t>(1, numbers_at_once / width);
      for (std::size_t done = 0; done < rows; done += at_once) {
        const std::size_t now = std::min(at_once, rows - done);
        numbers_.resize(now * width);
        reader.read_numbers(dataset, first + done, now, numbers_.data());
        say_numbers(numbers_);
      }
    }
    say(Message::done, "");
  }

  std::map<std::uint64_t, std::unique_ptr<Reader>> files_;
  std::uint64_t next_ = 0;
  std::vector<double> numbers_;
};

}  // namespace
}  // namespace bbsim::hdf5

int main() {
  using namespace bbsim::hdf5;
  prepare();
  try {
    Server().serve();
  } catch (const End&) {
  }
  _exit(0);  // not by way of what HDF5 does at exit, after files that may be damaged
}
