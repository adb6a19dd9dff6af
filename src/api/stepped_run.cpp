// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/stepped_run.hpp"

#include <utility>

#include "api/fiber.hpp"

namespace bbsim::api {

// The run, and the controller in it, which waits at each sample for the caller of step().
struct SteppedRun::State : model::ExternalController {
  explicit State(RunRequest of) : request(std::move(of)), fiber([this] { run(); }) {}

  void run() { result = api::run(request, watch); }

  void begin() override {}
  model::Commands command(const model::ControllerSample& at, double* /*own*/) override {
    sample = copy_of(at);
    fiber.wait();
    if (given_up) throw ControllerFault("the run was abandoned", true);
    return {given[0], given[1], 0};
  }

  RunRequest request;
  Watch watch;
  Sample sample;
  Pair given{};
  bool given_up = false;
  RunResult result;
  Fiber fiber;
};

SteppedRun::SteppedRun(const Scenario& scenario, RunRequest request) {
  request.scenario = with_outside_commands(scenario);
  state_ = std::make_unique<State>(std::move(request));
  state_->request.scenario.controller->own->by =
      ControllerFactory{"commands from outside", [state = state_.get()](const Scenario&) {
                          // Without ownership: the state holds the run.
                          return std::shared_ptr<State>(std::shared_ptr<void>(), state);
                        }};
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
  state_->given = command;
  state_->fiber.resume();
}

const RunResult& SteppedRun::result() const {
  return state_->result;
}

}  // namespace bbsim::api
