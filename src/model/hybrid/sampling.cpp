// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/sampling.hpp"

#include <limits>
#include <stdexcept>

namespace bbsim::model {

Sampling::Sampling(const SwitchedModel& model)
    : model_(model),
      is_direct_(model.rig().between.none()),
      exchange_(*model.rig().sampled),
      controller_(*model.rig().sampled),
      own_(model.get().own_columns().size(), std::numeric_limits<double>::quiet_NaN()) {
  const SampledLoop& loop = *model.rig().sampled;
  if (loop.law.kind == LawKind::held && !loop.external) {
    throw std::logic_error("a run of a scene whose controller nobody has attached");
  }
}

const std::array<Jet<double>, 2>& Sampling::reference_at(double t) {
  KnownReference& known =
      shared_reference_ != nullptr ? shared_reference_->at(t) : known_reference_;
  if (known.t != t) {
    known = {t, model_.with_loop([t](const auto& loop) { return loop.reference().at(t); })};
  }
  return known.value;
}

void Sampling::take(double t, double end, const double* z) {
  const double number = exchange_.sample_number();
  const std::optional<Pair> seen = begin(end);
  const auto& reference = reference_at(t);
  const double* const angle = z + SwitchedModel::angle;
  const double* const rate = z + model_.rate();
  double servo[4] = {angle[0], angle[1], rate[0], rate[1]};
  const Rig& rig = model_.rig();
  if (ExternalController* const external = rig.sampled->external.get()) {
    if (number == 0) external->begin();
    const ControllerSample sample{static_cast<std::size_t>(number), t, seen, servo, reference};
    const Pair asked = external->command(sample, own_.data());
    this->end(controller_.within_limits(asked), seen.value_or(measured_));
    return;
  }
  if (!is_direct_) rig.between.believed(angle, rate, servo);
  const Pair command = controller_.command(seen, servo, reference);
  this->end(command, controller_.last_seen());
}

std::array<double, most_servos> Sampling::take_command(RigMode& mode) {
  const Pair command = exchange_.take_command();
  for (std::size_t i = 0; i < 2; ++i) mode.wanted[i] = command[i];
  return is_direct_ ? std::array<double, most_servos>{command[0], command[1], 0}
                    : controller_.told(command);
}

}  // namespace bbsim::model
