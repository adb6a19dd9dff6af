// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The command line, in process: main() with an input's arguments and files, in its own folder.
//
// An input has one argument per line, up to a line "== NAME", followed by the content of a file of
// that name, and so on. Slashes that could lead out of the folder become underscores. After a
// quarter of a second of processor time a run is interrupted, as by Ctrl-C.
#include <fcntl.h>
#include <sanitizer/common_interface_defs.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "controller/foreign_code.hpp"
#include "folder.hpp"
#include "fuzz.hpp"
#include "terminal.hpp"

int bbsim_main(int argc, char** argv);  // main() of apps/bbsim/main.cpp, renamed

namespace {

using namespace bbsim_fuzz;

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

// The program runs with the user's rights and writes wherever it is told, so outputs are confined
// to its own folder.
std::string kept_in(std::string_view word) {
  std::string result(word.substr(0, word.find('\0')));
  const bool option = result.starts_with('-');
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (result[i] != '/') continue;
    const bool within =
        i > 0 && i + 1 < result.size() && is_plain(result[i - 1]) && is_plain(result[i + 1]);
    if (!within || option) result[i] = '_';
  }
  return result;
}

struct Input {
  std::vector<std::string> words;
  std::vector<std::pair<std::string, std::string>> files;
};

Input read_input(std::string_view text) {
  constexpr std::string_view file_mark = "== ";
  Input input;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (line.starts_with(file_mark)) {
      std::string name = kept_in(line.substr(file_mark.size()));
      for (char& c : name) c = c == '/' ? '_' : c;
      input.files.emplace_back(name, "");
    } else if (input.files.empty()) {
      input.words.push_back(kept_in(line));
    } else {
      input.files.back().second.append(line) += '\n';
    }
  }
  return input;
}

std::atomic<bool> time_is_up{false};

void on_time_used(int) {
  time_is_up.store(true, std::memory_order_relaxed);
}

void use_at_most(suseconds_t microseconds) {
  const timeval time{0, microseconds};
  const itimerval timer{time, time};
  setitimer(ITIMER_VIRTUAL, &timer, nullptr);
}

// Receives the program's messages in place of a terminal.
class Messages {
 public:
  Messages()
      : standard_error_(dup(STDERR_FILENO)), messages_(memfd_create("messages", MFD_CLOEXEC)) {
    must(standard_error_ >= 0 && messages_ >= 0);
    // the function's interface
    __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(standard_error_)));
  }

  void begin() const {
    must(ftruncate(messages_, 0) == 0 && lseek(messages_, 0, SEEK_SET) == 0);
    dup2(messages_, STDERR_FILENO);
  }

  [[nodiscard]] std::string end() const {
    std::fflush(stderr);
    dup2(standard_error_, STDERR_FILENO);
    std::string text(static_cast<std::size_t>(lseek(messages_, 0, SEEK_END)), '\0');
    must(pread(messages_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()));
    return text;
  }

 private:
  int standard_error_, messages_;
};

struct Surroundings {
  Surroundings() : before(open(".", O_PATH | O_DIRECTORY | O_CLOEXEC)) {
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    must(nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(nothing, STDOUT_FILENO) >= 0);
    struct sigaction action {};
    action.sa_handler = on_time_used;
    action.sa_flags = SA_RESTART;
    sigaction(SIGVTALRM, &action, nullptr);
  }

  // Enters the program's own folder; libFuzzer's, with the inputs, is where it was started.
  void enter() const {
    must(chdir(folder.path().c_str()) == 0);
    messages.begin();
  }
  [[nodiscard]] std::string leave() const {
    must(fchdir(before) == 0);
    return messages.end();
  }

  int before;
  InputFolder folder;
  Messages messages;
};

const Surroundings& surroundings() {
  static const Surroundings it;
  return it;
}

}  // namespace

// Replaces apps/bbsim/signals.cpp entirely: the time limit ends a run.
void bbsim::app::end_at_signals() {}
const std::atomic<bool>& bbsim::app::watch_signals() {
  return time_is_up;
}

// Replaces src/controller/foreign_code.cpp entirely, because an input could run anything.
pid_t bbsim::controller::start_program(const bbsim::file::NewProcess& /*program*/, int& error) {
  error = EPERM;
  return 0;
}
void* bbsim::controller::open_library(const std::string& /*path*/, std::string& error) {
  error = "not while fuzzing";
  return nullptr;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  setenv("BBSIM_MODULE_PATH", BBSIM_MODULE_FOLDER, 1);
  setenv("PATH", "/nowhere", 1);  // no other program
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Input input = read_input(text_of(data, size));
  const Surroundings& here = surroundings();
  here.folder.clear();
  for (const auto& [name, content] : input.files) here.folder.put(name, content);

  std::vector<std::string> words{"bbsim"};
  words.insert(words.end(), input.words.begin(), input.words.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  here.enter();
  time_is_up.store(false);
  use_at_most(250'000);
  const int code = bbsim_main(static_cast<int>(words.size()), arguments.data());
  use_at_most(0);
  const std::string messages = here.leave();

  must(code == 0 || code == 1 || code == 2 || code == 3 || code == 130);
  // Only at the start of a line; elsewhere it may come from the input.
  const bool internal = ('\n' + messages).find("\ninternal error: ") != std::string::npos;
  must(code != 1 || !internal);
  must(code != 2 || !messages.empty());  // a refusal gives a reason
  return 0;
}
