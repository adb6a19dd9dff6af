// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "base/real.hpp"

namespace bbsim::model {
namespace {

// The servos' angles and rates as the firmware knows them.
struct KnownServos {
  double angle[most_servos], rate[most_servos];

  KnownServos(const SwitchedModel& model, double t, const double* z) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(model.rig().servos); ++i) {
      const SwitchedModel::ServoReading of = model.counted(i, t, z);
      angle[i] = of.angle;
      rate[i] = of.rate;
    }
  }
};

}  // namespace

Sampling::Sampling(const SwitchedModel& model)
    : model_(model),
      is_direct_(model.rig().mechanism.none()),
      least_force_(model.rig().sampled->sensor.contact_force),
      exchange_(*model.rig().sampled),
      controller_(*model.rig().sampled),
      own_(model.get().own_columns().size(), no_number) {
  const SampledLoop& loop = *model.rig().sampled;
  if (loop.law.kind == LawKind::held && !loop.external) {
    throw std::logic_error("a run of a scene whose controller nobody has attached");
  }
  // Commands of samples before t = 0 that have not arrived yet.
  const SampleExchange::Numbers next = exchange_.numbers();
  for (double sample = next.command; sample < next.sample; ++sample) {
    const double t = exchange_.time_of(sample);
    const auto reference =
        model_.with_loop([t](const auto& rig_loop) { return rig_loop.reference().at(t); });
    end(controller_.command(Pair{0, 0}, {0, 0, 0, 0}, reference), measured_);
  }
}

double Sampling::normal_force(double t, const double* z) const {
  const Sample now = model_.sample(t, z, Detail::motion);
  return contact_force(now, *model_.rig().sampled->pressing).z();
}

const std::array<Jet<double>, 2>& Sampling::reference_at(double t) {
  KnownSignals& known =
      shared_reference_ != nullptr ? shared_reference_->entry(t) : known_reference_;
  return known.at(t, [&] {
    return model_.with_loop([t](const auto& loop) { return loop.reference().at(t); });
  });
}

bool Sampling::take(double t, double end, const double* z) {
  if (model_.rig().sampled->external) return ask_external(t, end, z);
  const std::optional<Pair> seen = begin(end);
  const auto [angle, rate] = KnownServos(model_, t, z);
  double servo[4] = {angle[0], angle[1], rate[0], rate[1]};
  if (!is_direct_ && controller_.law().law.feeds_servos_back()) {
    model_.rig().mechanism.believed(angle, rate, servo);
  }
  const Pair command = controller_.command(seen, servo, reference_at(t));
  this->end(command, controller_.last_seen());
  return true;
}

bool Sampling::ask_external(double t, double end, const double* z) {
  const Rig& rig = model_.rig();
  const bool legs = rig.sampled->legs;
  const auto [angle, rate] = KnownServos(model_, t, z);
  double servo[4] = {angle[0], angle[1], rate[0], rate[1]};
  if (rig.mechanism.three && !legs) rig.mechanism.believed(angle, rate, servo);
  using Numbers = std::span<const double>;
  const double number = exchange_.sample_number();
  const std::optional<Pair> seen = exchange_.reading(end);
  const ControllerSample sample{static_cast<std::size_t>(number),
                                t,
                                seen,
                                legs ? Numbers(angle) : Numbers(servo, 2),
                                legs ? Numbers(rate) : Numbers(servo + 2, 2),
                                reference_at(t)};
  ExternalController& external = *rig.sampled->external;
  if (!external.has_answer(sample)) return false;
  begin(end);
  if (number == 0) external.begin();
  const Commands asked = external.command(sample, own_.data());
  this->end(controller_.within_limits({asked[0], asked[1]}), seen.value_or(measured_),
            legs ? controller_.within_limits({asked[2], 0})[0] : 0);
  return true;
}

std::array<double, most_servos> Sampling::take_command(RigMode& mode) {
  const std::array<double, most_servos> command = exchange_.take_command();
  if (model_.rig().sampled->legs) {
    // The servos turn towards any angles. Those without a pose leave the tilt that is shown.
    const Pair tilt = model_.rig().mechanism.tilt(command);
    if (std::isfinite(tilt[0]) && std::isfinite(tilt[1])) {
      std::copy(tilt.begin(), tilt.end(), mode.wanted);
    }
    return command;
  }
  for (std::size_t i = 0; i < 2; ++i) mode.wanted[i] = command[i];
  return is_direct_ ? command : controller_.servo_commands({command[0], command[1]});
}

}  // namespace bbsim::model
