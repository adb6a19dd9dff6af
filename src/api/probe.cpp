// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Test of the user's controller with a ball away from its reference.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "api/check.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "model/control/derivatives.hpp"
#include "model/control/external_controller.hpp"
#include "model/control/identified_law.hpp"
#include "model/control/sampled_controller.hpp"
#include "model/dense.hpp"
#include "model/hybrid/switched_model.hpp"

namespace bbsim::api {
namespace {

// Most controllers answer at the first sample; a sketch that filters or waits takes longer.
constexpr std::size_t few_samples = 25, most_probed = 20000;
using Commands = std::vector<Pair>;

constexpr std::array<const char*, 2> coordinates{"x", "y"}, angles{"phi", "theta"};

// Gives the controller samples of a plate at rest.
class Bench {
 public:
  explicit Bench(const model::Model& model)
      : model_(model),
        sensor_(without_chance(model.rig->sampled->sensor)),
        own_(model.own_columns().size()) {}

  [[nodiscard]] std::array<model::Jet<double>, 2> reference_at(double t) const {
    return model_.with_loop([t](const auto& loop) { return loop.reference().at(t); });
  }

  [[nodiscard]] double period() const { return model_.rig().sampled->sampling.period; }

  // Commands for a ball at away(sample) from the reference, m.
  Commands commands(std::size_t count, const std::function<Pair(double)>& away) {
    return answers(count, 0, [&](std::size_t i, const Pair& reference) {
      const Pair from = away(static_cast<double>(i));
      std::optional<Pair> seen = Pair{};
      if (!sensor_.read(reference[0] + from[0], reference[1] + from[1], *seen)) seen.reset();
      return seen;
    });
  }

  // Commands for a ball at the reference that one sample shows displaced by `pulse`, m. All servos
  // are at the angle `servo`, rad.
  Commands answers_to_pulse(std::size_t count, std::size_t at, const Pair& pulse, double servo) {
    return answers(count, servo, [&](std::size_t i, const Pair& reference) {
      Pair seen = reference;
      for (std::size_t k = 0; k < 2; ++k) seen[k] += i == at ? pulse[k] : 0;
      return std::optional(seen);
    });
  }

 private:
  Commands answers(std::size_t count, double angle,
                   const std::function<std::optional<Pair>(std::size_t, const Pair&)>& see) {
    const model::SampledLoop& loop = *model_.rig().sampled;
    const std::array<double, 3> still{}, at{angle, angle, angle};
    const std::size_t servos = loop.legs ? 3 : 2;
    Commands commands;
    loop.external->begin();
    for (std::size_t i = 0; i < count; ++i) {
      const double t = static_cast<double>(i) * loop.sampling.period;
      const auto reference = reference_at(t);
      const std::optional<Pair> seen = see(i, {reference[0].value, reference[1].value});
      const model::Commands answer = loop.external->command(
          {i, t, seen, std::span(at).first(servos), std::span(still).first(servos), reference},
          own_.data());
      commands.push_back(loop.legs ? model_.rig().mechanism.tilt(answer)
                                   : Pair{answer[0], answer[1]});
    }
    return commands;
  }

  static Sensor without_chance(Sensor sensor) {
    sensor.noise = sensor.dropout = 0;
    return sensor;
  }

  model::SwitchedModel model_;
  model::BallSensor sensor_;
  std::vector<double> own_;
};

// How much a positive command in phi and theta moves the ball along x and y, through the angle to
// which it turns the plate. Leaves out motion while the plate accelerates, which may be opposite.
Eigen::MatrixXd effect_of(const model::Model& model) {
  const model::PlantDerivatives plant =
      model::plant_derivatives(model, model::home_point(), model::Heave::left_out);
  constexpr int speed = 2, angle = model::spin_state + 1, rate = angle + 2;
  Eigen::MatrixXd turned = plant.of_command.block(rate, 0, 2, 2);
  for (int i = 0; i < 2; ++i) {
    if (!model.rig->servo[i].time_constant) continue;
    // A first-order servo takes its rate from the command, and has no acceleration.
    turned.row(i).setZero();
    turned(i, i) = 1;
  }
  // Effect of angles under commands that hold them.
  const Eigen::MatrixXd holding = model::solve(turned, plant.of_state.block(rate, angle, 2, 2));
  const Eigen::MatrixXd of_angle = plant.of_state.block(speed, angle, 2, 2) -
                                   model::product(plant.of_command.block(speed, 0, 2, 2), holding);
  return model::product(of_angle, turned);
}

// Distance of the test ball from the reference, m: less near the end of the plate or sensor area.
double greatest_distance(const Scenario& scenario, std::size_t axis, double reference) {
  double half = std::numeric_limits<double>::infinity();
  if (scenario.plate.size) half = (*scenario.plate.size)[axis] / 2;
  if (scenario.plate.diameter) half = *scenario.plate.diameter / 2;
  const auto& sensor = scenario.controller->sensor;
  if (sensor && sensor->area) half = std::min(half, (*sensor->area)[axis] / 2);
  const double room = 0.8 * (half - std::abs(reference));
  return room > 0 ? std::min(room, 0.05) : 0.05;
}

// The controller's commands on either side of the reference along an axis.
struct Sides {
  double distance;  // m
  Commands up, down;

  // Rise of a command with the coordinate, in its unit per m.
  [[nodiscard]] double slope(std::size_t sample, std::size_t command) const {
    return (up[sample][command] - down[sample][command]) / (2 * distance);
  }
};

// Answers along x and y.
struct Answers {
  std::size_t count;  // of samples
  // Whether the commands come to their values on ramps, as those of a sketch that pulses steppers.
  bool ramps;
  std::array<std::optional<Sides>, 2> near, far;

  // All that were probed.
  [[nodiscard]] std::vector<const Sides*> all() const {
    std::vector<const Sides*> found;
    for (const auto* sides : {&near[0], &near[1], &far[0], &far[1]}) {
      if (*sides) found.push_back(&**sides);
    }
    return found;
  }
  // The first sample at which a command depends on the ball's position.
  [[nodiscard]] std::optional<std::size_t> first(std::size_t command) const {
    for (std::size_t i = 0; i < count; ++i) {
      for (const Sides* const sides : all()) {
        if (sides->up[i][command] != sides->down[i][command]) return i;
      }
    }
    return {};
  }
  // The sample whose commands show the gains, if `first` is the first with an answer.
  [[nodiscard]] std::size_t telling(std::size_t first) const { return ramps ? count - 1 : first; }
  // Whether a command keeps one value at all samples and wherever the ball is.
  [[nodiscard]] bool is_constant(std::size_t command) const {
    const std::vector<const Sides*> sides = all();
    return std::ranges::all_of(sides, [&](const Sides* of) {
      const double value = sides.front()->up.front()[command];
      const auto is_value = [&](const Pair& commands) { return commands[command] == value; };
      return std::ranges::all_of(of->up, is_value) && std::ranges::all_of(of->down, is_value);
    });
  }

  // Rise of a command with a coordinate about the reference, in its unit per m.
  [[nodiscard]] double gain(std::size_t sample, std::size_t command, std::size_t axis) const {
    const auto slope = [&](const std::optional<Sides>& sides) {
      return sides ? sides->slope(sample, command) : 0;
    };
    const double close = slope(near[axis]);
    return close != 0 ? close : slope(far[axis]);
  }
};

bool has_ramps(const Scenario& scenario) {
  return scenario.controller->is_sketch() && scenario.gimbal.has_steppers();
}

Answers probe_along(Bench& bench, const Scenario& scenario, const std::vector<std::size_t>& axes,
                    std::size_t count) {
  const auto reference = bench.reference_at(0);
  Answers answers{count, has_ramps(scenario), {}, {}};
  for (const std::size_t axis : axes) {
    const auto at = [&](double distance) {
      const auto commands = [&](double away) {
        Pair from{0, 0};
        from[axis] = away;
        return bench.commands(count, [from](double) { return from; });
      };
      return Sides{distance, commands(distance), commands(-distance)};
    };
    const double far = greatest_distance(scenario, axis, reference[axis].value);
    answers.near[axis] = at(far / 5);
    answers.far[axis] = at(far);
  }
  return answers;
}

// Samples in the time in which any controller must act: three times that in which the ball rolls
// the longest distance on a plate tilted by 3 degrees, and the delays.
std::size_t samples_to_act(const Scenario& scenario, const Bench& bench,
                           const std::vector<std::size_t>& axes) {
  double distance = 0;
  const auto reference = bench.reference_at(0);
  for (const std::size_t axis : axes) {
    distance = std::max(distance, greatest_distance(scenario, axis, reference[axis].value));
  }
  const double acceleration =
      scenario.gravity * std::sin(3 * std::numbers::pi / 180) / (1 + scenario.ball.inertia_factor);
  const Controller& controller = *scenario.controller;
  double time = controller.sampling->delay;
  if (acceleration > 0) time += 3 * std::sqrt(2 * distance / acceleration);
  if (controller.sensor) time += controller.sensor->delay + controller.sensor->period.value_or(0);
  return static_cast<std::size_t>(std::clamp(std::ceil(time / bench.period()),
                                             static_cast<double>(few_samples),
                                             static_cast<double>(most_probed)));
}

// Whether the scene has the ball move along an axis, by its start or its reference.
bool moves_along(const Scenario& scenario, const Bench& bench, std::size_t axis) {
  const auto reference = bench.reference_at(0)[axis];
  return reference.value != 0 || reference.rate != 0 || reference.acceleration != 0 ||
         scenario.ball.position[axis] != 0 || scenario.ball.velocity[axis] != 0;
}

std::string centimeters(double meters) {
  return short_number(100 * meters) + " cm";
}

// Assesses the command for phi or theta; `effect` is its effect_of() on x and y. With legs, a
// remedy exists only for both commands together (turn_of).
Line line_of(const Answers& answers, std::size_t command, const std::string& within,
             const Eigen::Vector2d& effect, const std::string& unit, bool legs) {
  constexpr const char* warning = "WARNING";
  const std::string name = std::string(angles[command]) + ": ";
  const std::size_t axis = std::abs(effect[0]) >= std::abs(effect[1]) ? 0 : 1, across = 1 - axis;
  const std::optional<std::size_t> first = answers.first(command);
  if (!first) return {warning, name + "does not depend on where the ball is, " + within};
  const std::size_t sample = answers.telling(*first);
  const double gain = answers.gain(sample, command, axis);
  const double cross = answers.gain(sample, command, across);
  // The rest on its own axis may be rounding, or a sensor that is turned slightly.
  if (std::abs(gain) < 0.1 * std::abs(cross)) {
    return {warning, name + "depends on " + coordinates[across] + ", but moves the ball along " +
                         coordinates[axis] +
                         (legs ? "" : "; swap the commands, or the coordinates")};
  }
  std::string gains = "gain " + short_number(gain) + ' ' + unit + " per m of " + coordinates[axis];
  if (std::abs(cross) > 1e-3 * std::abs(gain)) {
    gains += ", " + short_number(cross) + " per m of " + coordinates[across];
  }
  const double far = answers.far[axis] ? answers.far[axis]->slope(sample, command) : 0;
  const auto words = [&](double slope) {
    return slope * effect[static_cast<Eigen::Index>(axis)] < 0 ? "towards the reference"
                                                               : "away from the reference";
  };
  if (far * gain < 0) {
    return {warning, name + "pushes the ball " + words(gain) + " at " +
                         centimeters(answers.near[axis]->distance) + ", and " + words(far) +
                         " at " + centimeters(answers.far[axis]->distance) + "; " + gains};
  }
  const std::string does = name + "pushes the ball " + words(gain);
  const double push = effect[static_cast<Eigen::Index>(axis)];
  if (gain * push < 0) return {"", does + "; " + gains};
  if (legs) return {warning, does + "; " + gains};
  return {warning, does + "; change the sign: positive " + angles[command] +
                       " drives the ball towards " + (push > 0 ? "+" : "-") + coordinates[axis] +
                       "; " + gains};
}

// Finds what is wrong with the commands of three legs together: they should push the ball back
// along the line to the reference, but push it along a line that is turned or mirrored.
std::optional<Line> turn_of(const Answers& answers, std::size_t sample,
                            const Eigen::Matrix2d& effect) {
  Eigen::Matrix2d gains;
  for (const std::size_t command : {0U, 1U}) {
    for (const std::size_t axis : {0U, 1U}) {
      gains(static_cast<Eigen::Index>(command), static_cast<Eigen::Index>(axis)) =
          answers.gain(sample, command, axis);
    }
  }
  const Eigen::Matrix2d push = effect * gains;
  const double along = -(push(0, 0) + push(1, 1)), across = push(0, 1) - push(1, 0);
  const double mirrored = std::hypot(push(0, 0) - push(1, 1), push(0, 1) + push(1, 0));
  if (mirrored > std::hypot(along, across)) {
    return Line{"WARNING",
                "its commands are mirrored; are two legs swapped, or does one turn the other way "
                "(direction: -1)?"};
  }
  constexpr double much = 20;
  const double turn = std::atan2(across, along) * 180 / std::numbers::pi;
  if (std::abs(turn) < much) return {};
  return Line{"WARNING",
              "its commands are turned by " + rounded(turn, 2) +
                  " deg; are the legs numbered and placed (legs.angle) as in your code?"};
}

// Response to pulses of `size` (m) in each coordinate at a sample.
model::PulseResponse response_to(Bench& bench, std::size_t at, double size) {
  model::PulseResponse response(model::pulse_samples, Eigen::MatrixXd(2, 2));
  const std::size_t count = at + response.size();
  const Commands rest = bench.answers_to_pulse(count, at, {0, 0}, 0);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    Pair pulse{0, 0};
    pulse[axis] = size;
    const Commands moved = bench.answers_to_pulse(count, at, pulse, 0);
    for (std::size_t i = 0; i < response.size(); ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        response[i](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(axis)) =
            (moved[at + i][k] - rest[at + i][k]) / size;
      }
    }
  }
  return response;
}

struct Estimate {
  std::optional<model::LinearSystem> law;
  std::string why;  // there is no law
};

// Law about the reference, if linear there and the same at every sample: two pulses of different
// size at different samples get the same response. The controller answers from `start` on.
Estimate law_about_reference(Bench& bench, std::size_t start, double size) {
  constexpr std::size_t settling = 10;
  constexpr double servo = 0.01;  // rad
  const std::size_t at = start + settling;
  if (bench.answers_to_pulse(at, at, {0, 0}, 0) != bench.answers_to_pulse(at, at, {0, 0}, servo)) {
    return {{}, "the controller feeds back the servos' angles"};
  }
  const model::PulseResponse first = response_to(bench, at, size),
                             second = response_to(bench, at + 1, -size / 2);
  double largest = 0, apart = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    largest = std::max(largest, first[i].cwiseAbs().maxCoeff());
    apart = std::max(apart, (first[i] - second[i]).cwiseAbs().maxCoeff());
  }
  const char* const not_linear = "the controller is not linear about the reference";
  if (!(largest > 0 && apart <= 0.02 * largest)) return {{}, not_linear};
  Estimate estimate{model::law_of(first, apart), not_linear};
  // Rounding must not connect an axis that the law leaves alone.
  for (const Eigen::Index k : {0, 1}) {
    const auto none = [&](const auto& part) {
      return std::ranges::all_of(first, [&](const auto& sample) { return part(sample).isZero(0); });
    };
    if (!estimate.law) break;
    if (none([k](const auto& of) { return of.row(k); })) {
      estimate.law->c.row(k).setZero();
      estimate.law->d.row(k).setZero();
    }
    if (none([k](const auto& of) { return of.col(k); })) {
      estimate.law->b.col(k).setZero();
      estimate.law->d.col(k).setZero();
    }
  }
  return estimate;
}

// The loop of the plant and the estimated law, and its margins.
Probed estimated_loop(const Scenario& scenario, const model::Model& model, Bench& bench,
                      const std::vector<int>& axes, const Answers& answers, std::size_t start) {
  const auto none = [](const std::string& why) {
    return Probed{{{"", "margins: no estimate: " + why}}, {}, why};
  };
  if (answers.ramps) return none("the sketch's pulses make ramps, which are not linear");
  double size = std::numeric_limits<double>::infinity();
  for (const auto& near : answers.near) size = std::min(size, near ? near->distance / 10 : size);
  try {
    const model::Linearization plant =
        model::linearize(scenario, model, model::LinearKind::sampled, model::home_point());
    const Estimate estimate = law_about_reference(bench, start, size);
    if (!estimate.law) return none(estimate.why);
    model::Linearization loop = model::loop_with(plant, *estimate.law, axes);
    Report report;
    if (!loop.stable) report.add("WARNING", "the loop is not stable, by its estimate");
    report.add(margins_of(loop, "estimated from its answers to small pulses; "));
    if (loop.stable) report.add(margin_remarks(loop));
    if (const std::string note = without_frames(scenario, true); !note.empty()) {
      report.add("", note);
    }
    return {report, std::move(loop), {}};
  } catch (const InputError& error) {  // the plant has no linear system
    return none(error.what());
  }
}

}  // namespace

Probed probe(const Scenario& scenario, const model::Model& model) {
  Bench bench(model);
  Report report;
  const std::vector<int> moving =
      scenario.ball.groove ? std::vector{scenario.ball.groove->axis} : model::moving_axes(model);
  const std::vector<std::size_t> axes(moving.begin(), moving.end());
  const bool ramps = has_ramps(scenario);
  Answers answers = probe_along(bench, scenario, axes,
                                ramps ? samples_to_act(scenario, bench, axes) : few_samples);
  const auto depends = [&](std::size_t axis) { return answers.first(axis).has_value(); };
  if (!ramps && !std::ranges::all_of(axes, depends)) {
    answers = probe_along(bench, scenario, axes, samples_to_act(scenario, bench, axes));
  }
  const std::string within =
      "within " + short_number(static_cast<double>(answers.count) * bench.period()) + " s";
  // The ball moves, so that a controller takes differences and divides them by time.
  const auto moves = [](double sample) {
    return Pair{0.01 * std::cos(0.1 * sample), 0.007 * std::sin(0.1 * sample)};
  };
  if (bench.commands(answers.count, moves) != bench.commands(answers.count, moves)) {
    report.add("WARNING", "the controller answers differently to the same samples, " + within +
                              "; does it read a wall clock?");
  }
  if (std::ranges::none_of(axes, depends)) {
    const std::string idle = "its commands do not depend on where the ball is, " + within;
    report.add("WARNING", idle);
    return {report, {}, idle};
  }
  std::size_t sample = 0;  // from which on all commands answer
  for (const std::size_t axis : axes) {
    sample = std::max(sample, answers.first(axis).value_or(0));
  }
  if (sample > 0) {
    report.add("", "it answers to where the ball is from sample " + std::to_string(sample) +
                       " on, t = " + short_number(static_cast<double>(sample) * bench.period()) +
                       " s");
  }
  const Eigen::MatrixXd effect = effect_of(model);
  const std::string unit = command_unit(scenario.controller->drives);
  const bool legs = model.rig->sampled->legs;
  std::vector<int> driven;
  for (const std::size_t command : axes) {
    const int axis = static_cast<int>(command);
    if (!legs && answers.is_constant(command) && !moves_along(scenario, bench, command)) {
      report.add("", std::string(angles[command]) + ": stays the same, and nothing moves " +
                         "the ball along " + coordinates[command]);
      continue;
    }
    driven.push_back(axis);
    report.push_back(line_of(answers, command, within, effect.col(axis), unit, legs));
  }
  if (legs && axes.size() == 2) {
    if (const auto line = turn_of(answers, answers.telling(sample), effect))
      report.push_back(*line);
  }
  Probed found = estimated_loop(scenario, model, bench, driven, answers, sample);
  found.report.insert(found.report.begin(), report.begin(), report.end());
  return found;
}

}  // namespace bbsim::api
