// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A controller that is a program.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "controller/child.hpp"
#include "controller/protocol.hpp"

namespace bbsim::controller {

class Program : public model::ExternalController {
 public:
  // Starts it, and has its answer to the hello, right or wrong: whatever is wrong with it is thrown
  // by begin(), as a fault of the run. Throws KeyError if it cannot be started.
  Program(const OwnController& own, const Setup& setup, Tell tell, const std::atomic<bool>* stop);

  void begin() override;
  model::Commands command(const model::ControllerSample& sample, double* own) override;
  // One that is at fault can, until begin() or restore() says what is wrong.
  [[nodiscard]] bool can_save() const override { return fault_ || ready_.save; }
  [[nodiscard]] std::string save() override;
  void restore(const std::string& memory) override;

  // The next run is of that setup, by a new process unless this one can reset; it begins with that
  // memory, if there is one.
  void renew(const Setup& setup, const std::string& memory = {});

  // What begin() would throw.
  [[nodiscard]] const std::optional<model::ControllerFault>& fault() const { return fault_; }
  [[nodiscard]] const Ready& ready() const { return ready_; }
  // Whether it is run by these words in that folder.
  [[nodiscard]] bool is(const OwnController& own) const;

  // Lets it end by itself.
  void finish();

 private:
  void start(const std::string& memory = {});
  void say_hello(const std::string& memory);
  template <class When, class Read>
  void ask(std::string_view line, When when, Read read);
  [[nodiscard]] model::ControllerFault fault_of(const std::string& when,
                                                const ChildFault& fault) const;

  ControllerProgram program_;
  std::string folder_;
  Setup setup_;
  Tell tell_;
  const std::atomic<bool>* stop_;
  std::unique_ptr<Child> child_;
  Ready ready_;
  bool fresh_ = false;  // it has answered the hello, and no sample yet
  std::optional<model::ControllerFault> fault_;
};

}  // namespace bbsim::controller
