// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/environments.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "base/error.hpp"

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

// What of a scene draws by controller.sensor.seed.
bool draws(const Scenario& scenario) {
  const Controller& controller = *scenario.controller;
  return (controller.sensor && (controller.sensor->noise > 0 || controller.sensor->dropout > 0)) ||
         (controller.sampling && controller.sampling->jitter > 0);
}

}  // namespace

Environments::Environments(ScenarioFamily family, std::size_t count, std::vector<std::string> keys,
                           bool keeps_rows)
    : family_(std::move(family)),
      scenario_(family_.read({})),
      keys_(std::move(keys)),
      keeps_rows_(keeps_rows),
      runs_(count),
      observations_(count * its_columns.size(), 0) {
  if (!scenario_.controller) {
    throw InputError("controller: found none; allowed: a controller with sampling and drives");
  }
}

std::span<const ObservationColumn> Environments::columns() {
  return its_columns;
}

void Environments::begin(std::size_t which, std::span<const std::string> values, std::size_t seed) {
  std::vector<ScenarioFamily::Setting> settings;
  for (std::size_t k = 0; k < keys_.size(); ++k) settings.push_back({keys_[k], values[k]});
  Scenario scenario = family_.read(settings);
  scenario.source = family_.source();
  if (draws(scenario)) {
    // Its place in the text is of no matter: the sensor is made anew with each run.
    auto& sensor = scenario.controller->sensor;
    if (!sensor) sensor.emplace();
    sensor->seed = seed;
  }
  if (!keeps_rows_) scenario.output.columns = {"t"};
  runs_[which].reset();
  runs_[which] = std::make_unique<SteppedRun>(scenario, RunRequest{});
  std::fill_n(observations_.begin() + static_cast<std::ptrdiff_t>(which * its_columns.size()),
              its_columns.size(), 0.0);
  observe(which);
}

void Environments::step(std::size_t which, Pair command) {
  if (!runs_[which] || runs_[which]->is_over()) return;
  runs_[which]->step(command);
  observe(which);
}

bool Environments::terminated(std::size_t which) const {
  return runs_[which] && runs_[which]->is_over() && runs_[which]->result().code != ExitCode::done;
}

bool Environments::truncated(std::size_t which) const {
  return runs_[which] && runs_[which]->is_over() && runs_[which]->result().code == ExitCode::done;
}

void Environments::observe(std::size_t which) {
  const Sample& now = runs_[which]->sample();
  double* const into = &observations_[which * its_columns.size()];
  if (now.ball) std::ranges::copy(*now.ball, into);
  into[2] = now.ball ? 1 : 0;
  double* next = into + 3;
  const Pair servo{now.servo[0], now.servo[1]}, servo_rate{now.servo_rate[0], now.servo_rate[1]};
  for (const Pair& pair : {now.reference, now.reference_rate, servo, servo_rate}) {
    next = std::ranges::copy(pair, next).out;
  }
}

}  // namespace bbsim::api
