// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A controller that is a program.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "controller/child.hpp"
#include "controller/protocol.hpp"

namespace bbsim::controller {

// The program at a sketch's serial line; null without one.
[[nodiscard]] const SerialProgram* serial_program(const OwnController& own);

class Program : public model::ExternalController {
 public:
  // Starts the program and reads its answer to the hello. begin() throws any fault of the answer,
  // as a fault of the run. Throws KeyError if the program cannot be started.
  Program(const OwnController& own, const Setup& setup, Report report,
          const std::atomic<bool>* stop);

  void begin() override;
  model::Commands command(const model::ControllerSample& sample, double* own) override;
  // For a program at a sketch's serial line: gives it a sample with the bytes that arrived.
  // Throws ControllerFault.
  SerialAnswer exchange(const model::ControllerSample& sample, std::string_view arrived,
                        std::span<const std::string> names, double* own);
  // A fault at a sample. Ends the program.
  [[nodiscard]] model::ControllerFault refuse(const model::ControllerSample& sample,
                                              const std::string& why);

  // Prepares for a run with this setup, in a new process unless this one can reset.
  void renew(const Setup& setup);

  // The fault that begin() would throw.
  [[nodiscard]] const std::optional<model::ControllerFault>& fault() const { return fault_; }
  [[nodiscard]] const Ready& ready() const { return ready_; }
  // Whether `own` has the same command, folder and timeouts.
  [[nodiscard]] bool is(const OwnController& own) const;

  // Lets the program end by itself.
  void finish();

 private:
  void start();
  void say_hello();
  template <class Read>
  void ask(std::string_view line, const model::ControllerSample& sample, Read read);
  [[nodiscard]] model::ControllerFault fault_of(const std::string& when,
                                                const ChildFault& fault) const;

  ControllerProgram program_;
  std::string folder_;
  Setup setup_;
  Report report_;
  const std::atomic<bool>* stop_;
  std::unique_ptr<Child> child_;
  Ready ready_;
  bool fresh_ = false;  // it has answered the hello, but no sample yet
  std::optional<model::ControllerFault> fault_;
};

}  // namespace bbsim::controller
