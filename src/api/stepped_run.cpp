// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/stepped_run.hpp"

#include <utility>

#include "api/fiber.hpp"

namespace bbsim::api {

struct SteppedRun::State {
  explicit State(RunRequest of) : request(std::move(of)), fiber([this] { run(); }) {}

  void run() { result = api::run(request, watch); }

  RunRequest request;
  Watch watch;
  Sample sample;
  Pair command{};
  bool given_up = false;
  RunResult result;
  Fiber fiber;
};

namespace {

// Waits at each sample for the caller of step().
template <class State>
class Waiting : public model::ExternalController {
 public:
  explicit Waiting(State& state) : state_(state) {}

  void begin() override {}
  model::Commands command(const model::ControllerSample& sample, double* /*own*/) override {
    state_.sample = copy_of(sample);
    state_.fiber.wait();
    if (state_.given_up) throw ControllerFault("the run was abandoned", true);
    return {state_.command[0], state_.command[1], 0};
  }

 private:
  State& state_;
};

}  // namespace

SteppedRun::SteppedRun(const Scenario& scenario, RunRequest request) {
  request.scenario = with_outside_commands(scenario);
  state_ = std::make_unique<State>(std::move(request));
  state_->request.scenario.controller->own->by = ControllerFactory{
      "commands from outside",
      [state = state_.get()](const Scenario&) { return std::make_shared<Waiting<State>>(*state); }};
  state_->fiber.resume();
}

SteppedRun::~SteppedRun() {
  if (!state_ || is_over()) return;
  state_->given_up = true;
  try {
    state_->fiber.resume();
  } catch (...) {  // the run was given up
  }
}

bool SteppedRun::is_over() const {
  return state_->fiber.has_ended();
}

const Sample& SteppedRun::sample() const {
  return state_->sample;
}

void SteppedRun::step(Pair command) {
  if (state_->fiber.is_running()) {
    throw InputError("step: found within the run's own step, as in its sink; allowed: after it");
  }
  require_finite(command);
  state_->command = command;
  state_->fiber.resume();
}

const RunResult& SteppedRun::result() const {
  return state_->result;
}

}  // namespace bbsim::api
