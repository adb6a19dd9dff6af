// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/environments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/instant.hpp"
#include "model/control/external_controller.hpp"

namespace bbsim::api {
namespace {

constexpr std::array<ObservationColumn, 11> its_columns{{
    {"x_measured", "m", "the ball as the sensor last saw it; 0 before it did"},
    {"y_measured", "m", "the ball as the sensor last saw it; 0 before it did"},
    {"seen", "1", "1 if the sensor sees the ball at this sample, else 0"},
    {"x_reference", "m", "where the ball should be"},
    {"y_reference", "m", "where the ball should be"},
    {"x_reference_rate", "m/s", "the reference's velocity"},
    {"y_reference_rate", "m/s", "the reference's velocity"},
    {"servo_phi", "rad", "angle of phi's servo; without servos, of the gimbal"},
    {"servo_theta", "rad", "angle of theta's servo; without servos, of the gimbal"},
    {"servo_phi_rate", "rad/s", "its rate"},
    {"servo_theta_rate", "rad/s", "its rate"},
}};

// Whether anything in the scene draws random numbers from controller.sensor.seed.
bool draws(const Scenario& scenario) {
  const Controller& controller = *scenario.controller;
  return (controller.sensor && controller.sensor->is_random()) ||
         (controller.sampling && controller.sampling->jitter > 0);
}

// Placeholder that the model needs; a lane never asks it.
class ControllerPlaceholder : public model::ExternalController {
 public:
  void begin() override {}
  model::Commands command(const model::ControllerSample& /*sample*/, double* /*own*/) override {
    return {};
  }
};

// Longer runs are stepped singly, without a record of their commands.
constexpr double most_samples = 1e5;

bool fits_lanes(const Scenario& scenario) {
  return !scenario.solver.error && choose_method(scenario.solver.method) == Method::radau &&
         scenario.time.end <= most_samples * scenario.controller->sampling->period;
}

// Squared distance of two points of the plate that are farthest from each other, m^2: no reference
// on it is farther from a ball on it.
double farthest_on(const Plate& plate) {
  constexpr double without_plate = 1;
  if (plate.size) return std::pow((*plate.size)[0], 2) + std::pow((*plate.size)[1], 2);
  return plate.diameter ? std::pow(*plate.diameter, 2) : without_plate;
}

}  // namespace

Environments::Environments(ScenarioFamily family, std::size_t count, std::vector<std::string> keys,
                           bool keeps_rows)
    : family_(std::move(family)),
      scenario_(family_.itself()),
      keys_(std::move(keys)),
      keeps_rows_(keeps_rows),
      runs_(count),
      observations_(count * its_columns.size(), 0) {
  if (!scenario_.controller) {
    throw InputError("controller: found none; allowed: a controller with sampling and drives");
  }
  // Fewer runs would leave lanes empty, and single runs match `bbsim run` bit for bit.
  if (keeps_rows_ || count < group || !scenario_.controller->sampling) return;
  for (std::size_t first = 0; first < count; first += group) {
    lanes_.push_back(
        std::make_unique<Lanes>(solve::Tolerances{scenario_.solver.rtol, scenario_.solver.atol}));
  }
}

std::span<const ObservationColumn> Environments::columns() {
  return its_columns;
}

Scenario Environments::scenario_of(const Beginning& beginning) const {
  Scenario scenario = scenario_;
  if (!keys_.empty()) {
    std::vector<ScenarioFamily::Setting> settings;
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      settings.push_back({keys_[k], beginning.values[k]});
    }
    scenario = family_.read(settings);
    scenario.source = family_.source();
  }
  if (draws(scenario)) {
    // The seed needs no place in the text: each run makes its sensor anew.
    auto& sensor = scenario.controller->sensor;
    if (!sensor) sensor.emplace();
    sensor->seed = beginning.seed;
  }
  if (!keeps_rows_) scenario.output.columns = {"t"};
  return scenario;
}

std::optional<model::Model> Environments::model_for_lane(const Scenario& scenario) const {
  if (lanes_.empty()) return {};
  const Scenario commanded = with_outside_commands(scenario);
  if (!fits_lanes(commanded) || commanded.solver.rtol != scenario_.solver.rtol ||
      commanded.solver.atol != scenario_.solver.atol) {
    return {};
  }
  try {
    scenario::Integrals integrals = false;  // rows come from single runs
    integrals.work = false;
    model::Model model = model::assemble(commanded, integrals);
    if (!solve::sampled::fits_lanes(model)) return {};
    model.rig->sampled->external = std::make_shared<ControllerPlaceholder>();
    return model;
  } catch (const InputError&) {  // the single run reports it
    return {};
  }
}

Environments::Ready Environments::prepare(std::size_t which, const Beginning& beginning) const {
  if (which >= count() || beginning.values.size() != keys_.size()) {
    throw InputError("run " + std::to_string(which) + ": found with " +
                     std::to_string(beginning.values.size()) + " values; allowed: one of " +
                     std::to_string(count()) + " runs with " + std::to_string(keys_.size()));
  }
  const Scenario scenario = scenario_of(beginning);
  Ready ready;
  ready.model = model_for_lane(scenario);
  if (!ready.model) ready.run.alone = std::make_unique<SteppedRun>(scenario, RunRequest{});
  ready.run.beginning = beginning;
  ready.run.end = scenario.time.end;
  ready.run.period = scenario.controller->sampling->period;
  ready.run.farthest = farthest_on(scenario.plate);
  return ready;
}

std::vector<Environments::Ready> Environments::prepare(std::span<const std::size_t> which,
                                                       std::span<const Beginning> how) const {
  std::vector<Ready> ready;
  for (std::size_t i = 0; i < which.size(); ++i) ready.push_back(prepare(which[i], how[i]));
  return ready;
}

void Environments::begin(std::span<const std::size_t> which, std::span<const Beginning> how) {
  begin(which, prepare(which, how));
}

void Environments::begin(std::span<const std::size_t> which, std::vector<Ready> ready) {
  for (const std::size_t environment : which) {
    if (!lanes_.empty()) lanes_[environment / group]->drop(environment % group);
  }
  for (std::size_t i = 0; i < which.size(); ++i) {
    const std::size_t environment = which[i];
    runs_[environment] = std::move(ready[i].run);
    if (ready[i].model) {
      lanes_[environment / group]->begin(environment % group, *ready[i].model,
                                         runs_[environment].end);
    }
    std::fill_n(
        observations_.begin() + static_cast<std::ptrdiff_t>(environment * its_columns.size()),
        its_columns.size(), 0.0);
    observe(environment);
  }
}

std::unique_ptr<SteppedRun> Environments::repeat(const Run& run) const {
  auto repeated = std::make_unique<SteppedRun>(scenario_of(run.beginning), RunRequest{});
  for (const Pair& command : run.commands) {
    if (repeated->is_over()) break;
    repeated->step(command);
  }
  return repeated;
}

void Environments::step(std::span<const double> commands, std::span<const std::size_t> which,
                        std::span<const Beginning> how) {
  std::vector<char> moves(count());
  for (std::size_t i = 0; i < count(); ++i) moves[i] = is_over(i) ? 0 : 1;
  std::vector<Ready> ready = prepare(which, how);
  for (const std::size_t environment : which) moves[environment] = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    if (moves[i] != 0) require_finite({commands[2 * i], commands[2 * i + 1]});
  }
  begin(which, std::move(ready));
  // Single runs first: a lane that gives up leaves a single run that has taken its step.
  for (std::size_t i = 0; i < count(); ++i) {
    if (moves[i] == 0) continue;
    Run& run = runs_[i];
    ++run.steps;
    if (!run.alone) continue;
    const Pair command{commands[2 * i], commands[2 * i + 1]};
    run.alone->step(command);
    end_at_last_sample(run, command);
  }
  for (std::size_t g = 0; g < lanes_.size(); ++g) step_lanes(g, commands, moves);
  for (std::size_t i = 0; i < count(); ++i) {
    if (moves[i] != 0) observe(i);
  }
}

void Environments::end_at_last_sample(const Run& run, const Pair& command) {
  if (run.alone->is_over()) return;
  if (run.end - run.alone->sample().t <= rounding_of(run.end)) run.alone->step(command);
}

void Environments::step_lanes(std::size_t of_group, std::span<const double> commands,
                              std::span<const char> moves) {
  Lanes& lanes = *lanes_[of_group];
  const std::size_t first = of_group * group, in_group = std::min(group, count() - first);
  const auto answer = [&](std::size_t l) {
    const Pair command{commands[2 * (first + l)], commands[2 * (first + l) + 1]};
    runs_[first + l].commands.push_back(command);
    lanes.answer(l, command);
  };
  const auto for_each_moving = [&](const auto& does) {
    for (std::size_t l = 0; l < in_group; ++l) {
      if (moves[first + l] != 0 && !runs_[first + l].alone) does(l);
    }
  };
  for_each_moving(answer);
  lanes.advance();
  for_each_moving([&](std::size_t l) {
    if (lanes.state(l) == Lanes::State::waits && lanes.is_at_end(l)) answer(l);
    if (lanes.state(l) != Lanes::State::given_up) return;
    Run& run = runs_[first + l];
    run.alone = repeat(run);
    end_at_last_sample(run, run.commands.back());
    lanes.drop(l);
  });
}

Environments::Lanes::State Environments::lane_state(std::size_t which) const {
  return lanes_.empty() ? Lanes::State::empty : lanes_[which / group]->state(which % group);
}

bool Environments::is_over(std::size_t which) const {
  const Run& run = runs_[which];
  return run.alone ? run.alone->is_over() : lane_state(which) != Lanes::State::waits;
}

bool Environments::terminated(std::size_t which) const {
  const Run& run = runs_[which];
  if (!run.alone) return lane_state(which) == Lanes::State::stopped;
  return run.alone->is_over() && run.alone->result().code != ExitCode::done;
}

bool Environments::truncated(std::size_t which) const {
  const Run& run = runs_[which];
  if (!run.alone) return lane_state(which) == Lanes::State::done;
  return run.alone->is_over() && run.alone->result().code == ExitCode::done;
}

double Environments::cost_of_ending(std::size_t which) const {
  if (!terminated(which)) return 0;
  const Run& run = runs_[which];
  const double* const seen = &observations_[which * its_columns.size()];
  const double x = seen[0] - seen[3], y = seen[1] - seen[4];
  const double all = std::ceil((run.end - rounding_of(run.end)) / run.period);
  const double left = all + 1 - static_cast<double>(std::max<std::size_t>(1, run.steps));
  return std::max(1.0, left) * std::max(run.farthest, x * x + y * y);
}

const RunResult* Environments::result(std::size_t which) {
  if (!terminated(which) && !truncated(which)) return nullptr;
  Run& run = runs_[which];
  if (run.alone) return &run.alone->result();
  if (!run.repeated) run.repeated = repeat(run);
  return run.repeated->is_over() ? &run.repeated->result() : nullptr;
}

std::size_t Environments::in_lanes() const {
  std::size_t found = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    if (lane_state(i) != Lanes::State::empty) ++found;
  }
  return found;
}

void Environments::observe(std::size_t which) {
  double* const into = &observations_[which * its_columns.size()];
  const auto put = [into](const std::optional<Pair>& ball, const Pair& reference,
                          const Pair& reference_rate, const Pair& servo, const Pair& servo_rate) {
    if (ball) std::ranges::copy(*ball, into);
    into[2] = ball ? 1 : 0;
    double* next = into + 3;
    for (const Pair* const pair : {&reference, &reference_rate, &servo, &servo_rate}) {
      next = std::ranges::copy(*pair, next).out;
    }
  };
  if (const Run& run = runs_[which]; run.alone) {
    const Sample& now = run.alone->sample();
    put(now.ball, now.reference, now.reference_rate, {now.servo[0], now.servo[1]},
        {now.servo_rate[0], now.servo_rate[1]});
  } else {
    const auto& now = lanes_[which / group]->sample(which % group);
    const auto& [x, y] = now.reference;
    put(now.seen, {x.value, y.value}, {x.rate, y.rate}, now.servo, now.servo_rate);
  }
}

}  // namespace bbsim::api
