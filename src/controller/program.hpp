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
  Pair command(const model::ControllerSample& sample, double* own) override;

  // The next run is of that setup, by a new process unless this one can reset.
  void renew(const Setup& setup);

  // What begin() would throw.
  [[nodiscard]] const std::optional<model::ControllerFault>& fault() const { return fault_; }
  [[nodiscard]] const Ready& ready() const { return ready_; }
  // Whether it is run by these words in that folder.
  [[nodiscard]] bool is(const OwnController& own) const;

  // Lets it end by itself.
  void finish();

 private:
  void start();
  void say_hello();
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
