#include "model/control/sampled_controller.hpp"

#include <cmath>

namespace bbsim::model {

bool BallSensor::read(double x, double y, Pair& seen) {
  double says[2] = {x, y};
  if (!sensor_.is_aligned()) {
    const double c = std::cos(sensor_.rotation), s = std::sin(sensor_.rotation);
    says[0] = sensor_.scale[0] * (c * x - s * y) + sensor_.offset[0];
    says[1] = sensor_.scale[1] * (s * x + c * y) + sensor_.offset[1];
  }
  bool missed = false;
  // Each sample draws alike, whatever it sees, so that runs with one seed have one noise.
  if (sensor_.noise > 0) {
    for (double& coordinate : says) coordinate += sensor_.noise * noise_.normal();
  }
  if (sensor_.dropout > 0) missed = noise_.uniform() < sensor_.dropout;
  if (sensor_.area) {
    missed = missed || std::abs(x) > (*sensor_.area)[0] / 2 || std::abs(y) > (*sensor_.area)[1] / 2;
  }
  for (std::size_t i = 0; i < 2; ++i) seen[i] = in_steps(says[i], sensor_.resolution);
  return !missed;
}

SampledController::SampledController(const SampledLoop& loop)
    : period_(loop.sampling.period), resolution_(loop.sampling.resolution), between_(loop.between) {
  law_.law = loop.law;
  law_.integrates = loop.law.integrates();
  law_.filter = loop.sampling.derivative_filter;
  // What is between the servos and the plane makes steps of its own.
  const double step = loop.between.none() ? loop.sampling.resolution : 0;
  law_.resolution = step;
  const auto inward = [step](double limit) {
    return step > 0 && limit < unlimited ? std::floor(limit / step * (1 + 1e-12)) * step : limit;
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const CommandRange& limit = loop.limit[i];
    law_.limit[i] = {limit.low, limit.high};
    law_.sine[i] = {-1, 1};
    if (loop.law.kind == LawKind::gravity_compensation) {
      law_.sine[i] = {std::sin(limit.low), std::sin(limit.high)};
    }
    law_.reached[i] = {-inward(-limit.low), inward(limit.high)};
  }
}

Pair SampledController::command(const std::optional<Pair>& seen, const double (&servo)[4],
                                const std::array<Jet<double>, 2>& reference) {
  if (!seen) {
    since_.miss();
    return command_;
  }
  const double at[2] = {(*seen)[0], (*seen)[1]};
  double u[2];
  take_sample(law_, memory_, at, since_.elapsed(period_), !since_.any, servo, reference, u);
  since_.see();
  command_ = {u[0], u[1]};
  return command_;
}

Pair SampledController::within_limits(Pair command) const {
  double u[2] = {command[0], command[1]};
  keep_within_limits(law_, u);
  return {u[0], u[1]};
}

std::array<double, 3> SampledController::told(Pair command) const {
  if (between_.none()) return {command[0], command[1], 0};
  std::array<double, 3> servo = between_.told(command);
  for (double& one : servo) one = in_steps(one, resolution_);
  return servo;
}

}  // namespace bbsim::model
