#include "model/control/sampled_controller.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::model {
namespace {

// The nearest integer, of two the even one. At 2^52 the spacing of doubles is one, so that the sum
// rounds; the C library would have to be called for it.
double nearest_integer(double value) {
  constexpr double spaced_by_one = 0x1.8p52;
  if (!(std::abs(value) < 0x1p51)) return value;
  return std::copysign((value + spaced_by_one) - spaced_by_one, value);
}

double rounded_to(double value, double resolution) {
  return resolution > 0 ? nearest_integer(value / resolution) * resolution : value;
}

}  // namespace

std::optional<Pair> BallSensor::read(Pair position) {
  Pair seen = position;
  if (!sensor_.is_aligned()) {
    const double c = std::cos(sensor_.rotation), s = std::sin(sensor_.rotation);
    seen = {sensor_.scale[0] * (c * position[0] - s * position[1]) + sensor_.offset[0],
            sensor_.scale[1] * (s * position[0] + c * position[1]) + sensor_.offset[1]};
  }
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

SampledController::SampledController(const SampledLoop& loop) : loop_(loop) {
  const double step = loop.sampling.resolution;
  const auto inward = [step](double limit) {
    return step > 0 && limit < unlimited ? std::floor(limit / step * (1 + 1e-12)) * step : limit;
  };
  for (std::size_t i = 0; i < 2; ++i) {
    reached_[i].high = inward(loop.limit[i].high);
    reached_[i].low = -inward(-loop.limit[i].low);
    sine_[i] = {std::sin(loop.limit[i].low), std::sin(loop.limit[i].high)};
  }
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
  const auto limited = [&](int i, double raw) {
    if (!of_sine) return raw;
    return std::clamp(raw, sine_[i].low, sine_[i].high);
  };
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
      const CommandRange& limit = loop_.limit[i];
      const bool beyond = before[i] > limit.high || before[i] < limit.low;
      grows_beyond = grows_beyond || (beyond && push * before[i] > 0);
    }
    if (!grows_beyond) integral_[j] += e * elapsed;
  }
  command_ = within_limits(integrates ? law_output(servo, reference) : before);
  return command_;
}

Pair SampledController::within_limits(Pair command) const {
  for (std::size_t i = 0; i < 2; ++i) {
    command[i] = std::clamp(command[i], loop_.limit[i].low, loop_.limit[i].high);
  }
  return loop_.between.none() ? in_steps(command) : command;
}

// The nearest multiple of the resolution that is within the range; the largest one that the range
// lets through, where that is beyond.
Pair SampledController::in_steps(Pair command) const {
  const double step = loop_.sampling.resolution;
  if (!(step > 0)) return command;
  for (std::size_t i = 0; i < 2; ++i) {
    command[i] = rounded_to(std::clamp(command[i], reached_[i].low, reached_[i].high), step);
  }
  return command;
}

std::array<double, 3> SampledController::told(Pair command) const {
  if (loop_.between.none()) return {command[0], command[1], 0};
  std::array<double, 3> servo = loop_.between.told(command);
  for (double& one : servo) one = rounded_to(one, loop_.sampling.resolution);
  return servo;
}

}  // namespace bbsim::model
