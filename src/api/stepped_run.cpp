// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/stepped_run.hpp"

#include <optional>
#include <utility>

namespace bbsim::api {

// The run, and the controller in it, which has an answer once the caller of step() gives one.
struct SteppedRun::State : model::ExternalController {
  explicit State(RunRequest of) : request(std::move(of)) {}

  void begin() override {}
  bool has_answer(const model::ControllerSample& at) override {
    if (!answer && !given_up) sample = copy_of(at);
    return answer || given_up;
  }
  model::Commands command(const model::ControllerSample& /*sample*/, double* /*own*/) override {
    if (given_up) throw ControllerFault("the run was abandoned", true);
    const Pair given = *std::exchange(answer, std::nullopt);
    return {given[0], given[1], 0};
  }

  void advance() {
    running = true;
    try {
      over = run->advance();
      if (over) result = run->finish();
    } catch (...) {
      over = true;
      running = false;
      throw;
    }
    running = false;
  }

  RunRequest request;
  Watch watch;
  Sample sample;
  std::optional<Pair> answer;
  bool given_up = false, running = false, over = false;
  RunResult result;
  std::optional<PausingRun> run;
};

SteppedRun::SteppedRun(const Scenario& scenario, RunRequest request) {
  if (scenario.solver.error) {
    throw InputError(
        "solver.error: found with commands from outside; allowed: solver.rtol, since a bound on "
        "the error needs several runs with the same commands");
  }
  request.scenario = with_outside_commands(scenario);
  state_ = std::make_unique<State>(std::move(request));
  state_->request.scenario.controller->own->by =
      ControllerFactory{"commands from outside", [state = state_.get()](const Scenario&) {
                          // Without ownership: the state holds the run.
                          return std::shared_ptr<State>(std::shared_ptr<void>(), state);
                        }};
  state_->run.emplace(state_->request, state_->watch);
  state_->advance();
}

SteppedRun::~SteppedRun() {
  if (!state_ || is_over()) return;
  state_->given_up = true;
  try {
    state_->advance();
  } catch (...) {  // the run was given up
  }
}

bool SteppedRun::is_over() const {
  return state_->over;
}

const Sample& SteppedRun::sample() const {
  return state_->sample;
}

void SteppedRun::step(Pair command) {
  if (state_->running) {
    throw InputError("step: found within the run's own step, as in its sink; allowed: after it");
  }
  require_finite(command);
  state_->answer = command;
  state_->advance();
}

const RunResult& SteppedRun::result() const {
  return state_->result;
}

}  // namespace bbsim::api
