// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/program.hpp"

#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"

namespace bbsim::controller {
namespace {

std::string shown_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return shown(text);
}

const ControllerProgram& program_of(const OwnController& own) {
  const SerialProgram* const serial = serial_program(own);
  return serial != nullptr ? serial->program : std::get<ControllerProgram>(own.by);
}

std::string at_sample(const model::ControllerSample& sample) {
  return "at sample " + std::to_string(sample.number) + " (t = " + number_text(sample.t) + " s)";
}

}  // namespace

const SerialProgram* serial_program(const OwnController& own) {
  const auto* const library = std::get_if<ControllerLibrary>(&own.by);
  return library != nullptr && library->serial ? &*library->serial : nullptr;
}

Program::Program(const OwnController& own, const Setup& setup, Report report,
                 const std::atomic<bool>* stop)
    : program_(program_of(own)),
      folder_(own.folder),
      setup_(setup),
      report_(std::move(report)),
      stop_(stop) {
  start();
}

bool Program::is(const OwnController& own) const {
  const ControllerProgram& other = program_of(own);
  return other.command == program_.command && own.folder == folder_ &&
         other.timeout == program_.timeout && other.start_timeout == program_.start_timeout;
}

model::ControllerFault Program::fault_of(const std::string& when, const ChildFault& fault) const {
  return model::ControllerFault(
      (setup_.serial ? "the program at the serial line (" : "the controller (") +
      shown_words(program_.command) + ") failed " + when + ": " + fault.what());
}

void Program::start() {
  try {
    child_.reset();
    child_ = std::make_unique<Child>(program_.command, folder_, report_, stop_);
  } catch (const std::system_error& error) {
    throw KeyError(
        setup_.serial ? "controller.library.serial.command" : "controller.program.command",
        "found " + bbsim::quoted(program_.command[0], uncut) +
            ", which cannot be started: " + file::error_text(error.code().value()) +
            "; allowed: a program, by its name or its path");
  }
  say_hello();
}

// Keeps a fault for begin().
void Program::say_hello() {
  fault_.reset();
  ready_ = {};
  try {
    ready_ = read_ready(child_->ask(hello_line(setup_), program_.start_timeout));
    if (!ready_.fault.empty()) throw child_->refuse(ready_.fault);
  } catch (const ChildFault& fault) {
    fault_ = fault_of("to start", fault);
  } catch (const ChildInterrupted&) {
    fault_.emplace("interrupted", true);
  }
  if (fault_) child_.reset();
  fresh_ = true;
}

void Program::renew(const Setup& setup) {
  setup_ = setup;
  if (child_ && ready_.reset) {
    say_hello();
  } else {
    if (child_) child_->finish();
    start();
  }
}

void Program::begin() {
  if (!fresh_) renew(setup_);
  fresh_ = false;
  if (fault_) throw model::ControllerFault(*fault_);
}

// Sends the line of a sample. `read` reads the answer and returns what is wrong with it.
template <class Read>
void Program::ask(std::string_view line, const model::ControllerSample& sample, Read read) {
  if (!child_) throw model::ControllerFault("the controller has already ended");
  try {
    const std::string wrong = read(child_->ask(line, program_.timeout));
    if (!wrong.empty()) throw child_->refuse(wrong);
  } catch (const ChildFault& fault) {
    child_.reset();
    throw fault_of(at_sample(sample), fault);
  } catch (const ChildInterrupted&) {
    child_.reset();
    throw model::ControllerFault("interrupted", true);
  }
}

model::Commands Program::command(const model::ControllerSample& sample, double* own) {
  char line[longest_sample];
  const std::size_t size = write_sample(sample, ready_.fields, line);
  model::Commands command{};
  ask({line, size}, sample, [&](std::string_view answer) {
    return read_answer(answer, setup_.columns, {command.data(), setup_.commands()}, own,
                       sample.number == 0);
  });
  return command;
}

SerialAnswer Program::exchange(const model::ControllerSample& sample, std::string_view arrived,
                               std::span<const std::string> names, double* own) {
  char line[longest_sample];
  const std::size_t size = write_sample(sample, ready_.fields, line);
  SerialAnswer result;
  ask(with_serial({line, size}, arrived), sample, [&](std::string_view answer) {
    result = read_serial_answer(answer, names, own);
    return result.fault;
  });
  return result;
}

model::ControllerFault Program::refuse(const model::ControllerSample& sample,
                                       const std::string& why) {
  const model::ControllerFault fault = fault_of(at_sample(sample), child_->refuse(why));
  child_.reset();
  return fault;
}

void Program::finish() {
  if (child_) child_->finish();
  child_.reset();
}

}  // namespace bbsim::controller
