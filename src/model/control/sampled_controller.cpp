#include "model/control/sampled_controller.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::model {
namespace {

double rounded_to(double value, double resolution) {
  return resolution > 0 ? std::nearbyint(value / resolution) * resolution : value;
}

}  // namespace

std::optional<Pair> BallSensor::read(Pair position) {
  Pair seen = position;
  bool missed = false;
  // Each sample draws alike, whatever it sees, so that runs with one seed have one noise.
  if (sensor_.noise > 0) {
    for (double& coordinate : seen) coordinate += sensor_.noise * noise_.normal();
  }
  if (sensor_.dropout > 0) missed = noise_.uniform() < sensor_.dropout;
  if (sensor_.area) {
    for (std::size_t i = 0; i < 2; ++i) {
      missed = missed || std::abs(position[i]) > (*sensor_.area)[i] / 2;
    }
  }
  if (missed) return {};
  for (double& coordinate : seen) coordinate = rounded_to(coordinate, sensor_.resolution);
  return seen;
}

void SampledController::estimate_velocity(Pair seen, double elapsed) {
  const double filter = loop_.sampling.derivative_filter;
  const double keep = filter / (filter + elapsed);
  for (std::size_t i = 0; i < 2; ++i) {
    const double difference = seen_any_ ? (seen[i] - position_[i]) / elapsed : 0;
    velocity_[i] = keep * velocity_[i] + (1 - keep) * difference;
  }
  position_ = seen;
  seen_any_ = true;
  unseen_ = 0;
}

Pair SampledController::law_output(const double (&servo)[4],
                                   const std::array<Jet<double>, 2>& reference) const {
  const Feedback<double> state{{position_[0], position_[1]},
                               {velocity_[0], velocity_[1]},
                               {servo[0], servo[1]},
                               {servo[2], servo[3]},
                               {integral_[0], integral_[1]}};
  const bool of_sine = loop_.law.kind == LawKind::gravity_compensation;
  const double highest = of_sine ? std::sin(loop_.limit) : unlimited;
  const auto limited = [highest](int, double raw) { return std::clamp(raw, -highest, highest); };
  const Command<double> u = model::command(loop_.law, state, reference, limited);
  return {u.value[0], u.value[1]};
}

Pair SampledController::command(const std::optional<Pair>& seen, const double (&servo)[4],
                                const std::array<Jet<double>, 2>& reference) {
  if (!seen) {
    ++unseen_;
    return command_;
  }
  // Since it last saw the ball; nothing was seen before the first time.
  const double elapsed = (seen_any_ ? 1 + unseen_ : 1) * loop_.sampling.period;
  estimate_velocity(*seen, elapsed);
  const Pair before = law_output(servo, reference);
  bool integrates = false;
  for (std::size_t j = 0; j < 2; ++j) {
    const double e = reference[j].value - position_[j];
    bool grows_beyond = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const double push = loop_.law.integral[i][j] * e;
      integrates = integrates || loop_.law.integral[i][j] != 0;
      grows_beyond = grows_beyond || (std::abs(before[i]) > loop_.limit && push * before[i] > 0);
    }
    if (!grows_beyond) integral_[j] += e * elapsed;
  }
  command_ = within_limits(integrates ? law_output(servo, reference) : before);
  return command_;
}

Pair SampledController::within_limits(Pair command) const {
  // The largest step of the command that the limit lets through.
  const double step = loop_.sampling.resolution;
  const double most = step > 0 && loop_.limit < unlimited
                          ? std::floor(loop_.limit / step * (1 + 1e-12)) * step
                          : loop_.limit;
  for (double& one : command) one = rounded_to(std::clamp(one, -most, most), step);
  return command;
}

}  // namespace bbsim::model
