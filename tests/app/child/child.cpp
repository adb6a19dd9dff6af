// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A test controller that behaves until sample 5 and then does what its first argument says. Its
// second argument names a file that receives the ids of its processes.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <thread>

namespace {

constexpr const char* answer = "{\"command\": [0.01, -0.02], \"u\": 0.5}";

[[noreturn]] void stay() {
  for (;;) pause();
}

void note_process(const char* file, pid_t process = getpid()) {
  if (std::FILE* const stream = std::fopen(file, "a")) {
    std::fprintf(stream, "%d\n", static_cast<int>(process));
    std::fclose(stream);
  }
}

void say(const std::string& text) {
  std::cout << text << std::flush;
}

void say_line(const std::string& text) {
  say(text + '\n');
}

void ignore_signals() {
  for (const int signal : {SIGHUP, SIGTERM, SIGINT}) (void)std::signal(signal, SIG_IGN);
}

// Leaves a process behind that keeps running and keeps all streams open.
void leave_another(const char* file) {
  if (const pid_t process = fork()) return note_process(file, process);
  ignore_signals();
  stay();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "good";
  const char* const file = argc > 2 ? argv[2] : "/dev/null";
  note_process(file);
  std::cerr << "started" << std::endl;

  const std::map<std::string, std::function<void()>> deeds = {
      {"sleeps",
       [file] {
         note_process((std::string(file) + ".asleep").c_str());
         stay();
       }},
      {"says goodbye",
       [file] {
         note_process((std::string(file) + ".begun").c_str());
         say_line(answer);
       }},
      // Leaves its own process group for that of its parent.
      {"joins",
       [file] {
         ignore_signals();
         setpgid(0, getpgid(getppid()));
         note_process((std::string(file) + ".asleep").c_str());
         stay();
       }},
      {"dies", [] { std::_Exit(3); }},
      {"crashes", [] { (void)std::raise(SIGKILL); }},
      {"garbage", [] { say_line("hello \x1b[31mworld"); }},
      {"floods",
       [] {
         for (;;) say(std::string(4096, 'x'));
       }},
      {"closes",
       [] {
         close(STDOUT_FILENO);
         stay();
       }},
      {"breaks off",
       [] {
         say("{\"comma");
         std::_Exit(0);
       }},
      {"leaves another",
       [file] {
         leave_another(file);
         std::_Exit(0);
       }},
      {"late",
       [] {
         std::this_thread::sleep_for(std::chrono::seconds(2));
         say_line(answer);
       }},
      {"nan", [] { say_line("{\"command\": [NaN, 0]}"); }},
      {"infinite", [] { say_line("{\"command\": [0, 1e999]}"); }},
      {"one", [] { say_line("{\"command\": [1]}"); }},
      {"three", [] { say_line("{\"command\": [1, 2, 3]}"); }},
      {"none", [] { say_line("{\"u\": 0.5}"); }},
      {"trails", [] { say_line(std::string(answer) + " and more"); }},
      {"empty", [] { say_line(""); }},
      {"twice", [] { say_line(std::string(answer) + '\n' + answer); }},
      {"gives up", [] { say_line("{\"error\": \"the plate is gone\"}"); }},
      {"complains",
       [] {
         for (int i = 0; i < 40000; ++i) std::cerr << "this is line " << i << '\n';
         say_line(answer);
       }},
      {"forks",
       [file] {
         leave_another(file);
         say_line(answer);
       }},
  };

  if (mode == "mute") stay();
  if (mode == "dies at once") return 4;
  if (mode == "leaves") {  // a process group that must end with it
    leave_another(file);
    return 0;
  }
  for (std::string line; std::getline(std::cin, line);) {
    if (line.find("\"protocol\":1") != std::string::npos) {
      if (mode == "chatters") say_line("Welcome!");
      if (mode == "another version") {
        say_line("{\"protocol\": 2}");
      } else if (mode == "resets") {
        say_line("{\"protocol\": 1, \"reset\": true, \"columns\": {\"u\": \"rad\"}}");
      } else {
        say_line("{\"protocol\": 1}");
      }
      continue;
    }
    const auto deed = deeds.find(mode);
    if (deed != deeds.end() && line.find("\"sample\":5,") != std::string::npos) {
      deed->second();
    } else {
      say_line(answer);
    }
  }
  if (mode == "goes on") stay();
  if (mode == "says goodbye") note_process((std::string(file) + ".ended").c_str());
  return 0;
}
