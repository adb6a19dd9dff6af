// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/rig_sensitivity.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/quoted.hpp"
#include "base/short_number.hpp"

namespace bbsim::study {
namespace {

constexpr auto first_angle = static_cast<Eigen::Index>(model::RigLayout::angle);

// Calls `use` with the loop of a system that has one.
template <class Any, class Use>
auto with_loop(Any& system, Use use) {
  return std::visit(
      [&](auto& any) {
        using System = std::decay_t<decltype(any)>;
        if constexpr (model::is_rig<System>) {
          return use(any);
        } else if constexpr (model::is_coupled_loop<System>) {
          return use(any.loop);
        } else {
          throw std::logic_error("a sampled rig without a loop");
          return use(std::get<model::RigLoop<>>(system));
        }
      },
      system);
}

const model::RigMode& mode_of(const model::Model& model) {
  return *with_loop(model.system, [](const auto& loop) { return &loop.mode; });
}

model::SampledLaw<double> law_of(const model::Model& model) {
  return model::SampledController(*model.rig->sampled).law();
}

// Replaces infinite limits by 0.
Eigen::VectorXd numbers_of(model::SampledLaw<double> law) {
  std::vector<double> numbers;
  model::for_each_number(law, [&](double one) { numbers.push_back(std::isfinite(one) ? one : 0); });
  return Eigen::Map<Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

// Whether the servo keeps its rate, at its rate limit or stop.
bool keeps_rate(const model::AxisMode& axis) {
  return axis.demand_factor == 0 && axis.set_acceleration == 0;
}

void require_same_decisions(const model::Rig& rig, const model::Rig& other,
                            const std::string& key) {
  const Sensor &one = rig.sampled->sensor, &two = other.sampled->sensor;
  bool same = one.noise == two.noise && one.resolution == two.resolution &&
              one.dropout == two.dropout && one.area == two.area &&
              rig.sampled->sampling.resolution == other.sampled->sampling.resolution;
  for (int i = 0; i < rig.servos; ++i) {
    same = same && rig.servo[i].dead_band == other.servo[i].dead_band;
  }
  if (same) return;
  no_sensitivity(shown(key) +
                 ": it acts through rounding, noise, missed measurements or a dead band, which "
                 "have no derivative; allowed: other keys of the rig");
}

}  // namespace

void RigSensitivity::require_smooth_parts(const model::Model& model) {
  const model::Rig& rig = *model.rig;
  if (rig.sampled->law.kind == model::LawKind::held) {
    no_sensitivity("found with a controller of your own; allowed: bbsim's own laws");
  }
  if (model.dry || rig.between.has_pieces()) {
    no_sensitivity(
        "found with a sampled controller and dry friction, sliding, limits of torques or a linkage "
        "given by a curve; allowed: a sampled controller without these");
  }
  for (const model::RigServo& servo : rig.servo) {
    if (servo.backlash > 0) no_sensitivity("found with backlash; allowed: servos without");
  }
}

Eigen::VectorXd RigSensitivity::reference(const model::Model& model, double t) {
  if (!model.rig || !model.rig->sampled) return {};
  const auto [x, y] =
      with_loop(model.system, [t](const auto& loop) { return loop.reference().at(t); });
  Eigen::VectorXd numbers(6);
  numbers << x.value, x.rate, x.acceleration, y.value, y.rate, y.acceleration;
  return numbers;
}

RigSensitivity::RigSensitivity(const model::Model& model, std::vector<Neighbors>& keys)
    : model_(model),
      loop_(*model.rig->sampled),
      keys_(keys),
      servos_(model.rig->servos),
      first_rate_(first_angle + servos_),
      times_(loop_.sampling, loop_.sensor.seed) {
  const model::SampledLaw<double> law = law_of(model);
  const Eigen::VectorXd numbers = numbers_of(law);
  for (const Neighbors& neighbors : keys_) {
    Key& key = by_key_.emplace_back();
    std::vector<Eigen::VectorXd> numbers_beside;
    key.law.integrates = law.integrates;
    for (const model::Model& other : neighbors.models) {
      require_same_decisions(*model.rig, *other.rig, neighbors.key.name);
      const model::SampledLaw<double> beside = law_of(other);
      numbers_beside.push_back(numbers_of(beside));
      key.law.integrates = key.law.integrates || beside.integrates;
      key.times.emplace_back(other.rig->sampled->sampling, other.rig->sampled->sensor.seed);
    }
    key.period = neighbors.slope(
        [&](std::size_t i) { return neighbors.models[i].rig->sampled->sampling.period; });
    const Eigen::VectorXd slopes =
        neighbors.slope([&](std::size_t i) -> const Eigen::VectorXd& { return numbers_beside[i]; });
    key.law.law.kind = law.law.kind;
    Eigen::Index next = 0;
    model::for_each_number(key.law, [&](Moving& one) {
      one = Moving(numbers[next], Moving::Gradient(slopes[next]));
      ++next;
    });
    // The gradient of a limit is that before rounding to the resolution.
    key.law.resolution = law.resolution;
    for (std::size_t i = 0; i < 2; ++i) {
      auto& limit = key.law.limit[i];
      limit.low.value = law.limit[i].low;
      limit.high.value = law.limit[i].high;
      key.law.reached[i] = {Moving(law.reached[i].low, limit.low.gradient),
                            Moving(law.reached[i].high, limit.high.gradient)};
    }
  }
}

void RigSensitivity::begin_run() {
  const auto keys = static_cast<Eigen::Index>(keys_.size());
  numbers_ = model::SampleExchange(loop_).numbers();
  since_ = {};
  memory_ = {};
  memory_slopes_ = Eigen::MatrixXd::Zero(6, keys);
  command_slopes_ = wanted_slopes_ = Eigen::MatrixXd::Zero(2, keys);
  followed_slopes_ = Eigen::MatrixXd::Zero(servos_, keys);
  seen_.clear();
  commands_.clear();
  put(mode_of(model_));
}

double RigSensitivity::time_of(const model::SampledLoop& loop, model::SampleTimes& times,
                               Clock clock, double number) {
  switch (clock) {
    case Clock::exposure:
      return loop.sensor.period ? number * *loop.sensor.period + loop.sensor.phase
                                : times.at(number) - loop.sensor.delay;
    case Clock::sample:
      return times.at(number);
    case Clock::command:
      break;
  }
  return times.at(number) + loop.sampling.delay;
}

// The derivative by key k of an instant of a clock.
double RigSensitivity::move(std::size_t k, Clock clock, double number) {
  return keys_[k].slope([&](std::size_t i) {
    return time_of(*keys_[k].models[i].rig->sampled, by_key_[k].times[i], clock, number);
  });
}

Eigen::VectorXd RigSensitivity::pass(const SwitchInstant& now, Eigen::MatrixXd& slopes) {
  const model::SampleExchange::Numbers numbers = now.run.sampling()->exchange().numbers();
  const model::RigMode& mode = mode_of(now.run.model());
  for (; numbers_.exposure < numbers.exposure; ++numbers_.exposure) expose(now, slopes);
  for (; numbers_.sample < numbers.sample; ++numbers_.sample) sample(now, slopes);
  const bool commanded = numbers_.command < numbers.command;
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(slopes.cols());
  if (!commanded && now.t > 0) moves = moves_at_rate_limit(now, mode, slopes);
  for (; numbers_.command < numbers.command; ++numbers_.command) {
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      moves[static_cast<Eigen::Index>(k)] = move(k, Clock::command, numbers_.command);
    }
    take_command(mode);
  }
  require_away_from_stops(now, mode);
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    auto slope = slopes.col(column);
    slope += moves[column] * now.rates_before;
    if (commanded || now.t == 0) turn_first_order(k, now, mode, slope);
    slope -= moves[column] * now.rates_after;
  }
  put(mode);
  return moves;
}

void RigSensitivity::expose(const SwitchInstant& now, const Eigen::MatrixXd& slopes) {
  const Sensor& sensor = loop_.sensor;
  const double at = time_of(loop_, times_, Clock::exposure, numbers_.exposure);
  Seen& seen = seen_.emplace_back(Seen{at, Eigen::MatrixXd(2, slopes.cols())});
  const double x = now.before[0], y = now.before[1];
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    // Before the start the ball rests at its initial position.
    const double later = at > 0 ? move(k, Clock::exposure, numbers_.exposure) : 0;
    const std::array<double, 2> moved =
        model::turned(sensor, slopes(0, column) + later * now.rates_before[0],
                      slopes(1, column) + later * now.rates_before[1]);
    const Eigen::Vector2d by_sensor = keys_[k].slope([&](std::size_t i) {
      const Sensor& its = keys_[k].models[i].rig->sampled->sensor;
      const std::array<double, 2> says = model::turned(its, x, y);
      return Eigen::Vector2d(says[0] + its.offset[0], says[1] + its.offset[1]);
    });
    seen.slopes.col(column) = Eigen::Vector2d(moved[0], moved[1]) + by_sensor;
    if (sensor.only) seen.slopes(*sensor.only == 0 ? 1 : 0, column) = 0;
  }
}

void RigSensitivity::sample(const SwitchInstant& now, const Eigen::MatrixXd& slopes) {
  // Use the exposure for this sample or, with a frame period, the last frame that has arrived.
  const bool frames = loop_.sensor.period.has_value();
  const double end = now.run.instant_end(now.t);
  while (!seen_.empty() && (!frames || seen_.front().at + loop_.sensor.delay <= end)) {
    last_seen_ = std::move(seen_.front());
    seen_.pop_front();
    if (!frames) break;
  }
  const model::SampledController& controller = now.run.sampling()->controller();
  if (controller.since_seen().unseen == 0) {
    for (std::size_t k = 0; k < keys_.size(); ++k) compute(k, now, slopes);
  }
  since_ = controller.since_seen();
  memory_ = controller.memory();
  commands_.push_back(command_slopes_);
}

// Differentiates the controller's arithmetic by one key, for a sample that saw the ball.
void RigSensitivity::compute(std::size_t k, const SwitchInstant& now,
                             const Eigen::MatrixXd& slopes) {
  const auto column = static_cast<Eigen::Index>(k);
  const Key& key = by_key_[k];
  const double later = move(k, Clock::sample, numbers_.sample);
  if (later != 0 && model_.jumps_at(now.t)) {
    no_sensitivity(shown(keys_[k].key.name) +
                   ": it moves the sample at t = " + short_number(now.t) +
                   " s, at which the reference jumps; allowed: jumps between samples, or keys that "
                   "do not move the samples");
  }
  const auto moving = [](double value, double slope) {
    return Moving(value, Moving::Gradient(slope));
  };
  const auto n = static_cast<Eigen::Index>(model_.size());
  const Eigen::VectorXd moves = slopes.col(column).head(n) + later * now.rates_before.head(n);
  Moving servo[4];
  for (std::size_t i = 0; const auto& [value, slope] : servo_numbers(k, now, moves)) {
    servo[i++] = moving(value, slope);
  }
  const Pair seen_at = now.run.sampling()->controller().last_seen();
  Moving seen[2], commanded[2];
  model::SampledMemory<Moving> memory;
  for (Eigen::Index i = 0; i < 2; ++i) {
    seen[i] = moving(seen_at[static_cast<std::size_t>(i)], last_seen_.slopes(i, column));
    memory.position[i] = moving(memory_.position[i], memory_slopes_(i, column));
    memory.velocity[i] = moving(memory_.velocity[i], memory_slopes_(2 + i, column));
    memory.integral[i] = moving(memory_.integral[i], memory_slopes_(4 + i, column));
  }
  std::array<model::Jet<Moving>, 2> path = with_loop(
      model_.system, [&](const auto& loop) { return loop.reference().at(moving(now.t, later)); });
  const Eigen::VectorXd by_path =
      keys_[k].slope([&](std::size_t i) { return reference(keys_[k].models[i], now.t); });
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Index first = 3 * static_cast<Eigen::Index>(i);
    path[i].value.gradient[0] += by_path[first];
    path[i].rate.gradient[0] += by_path[first + 1];
    path[i].acceleration.gradient[0] += by_path[first + 2];
  }
  const Moving elapsed =
      moving(since_.elapsed(loop_.sampling.period), since_.elapsed(1) * key.period);
  model::take_sample(key.law, memory, seen, elapsed, !since_.any, servo, path, commanded);
  for (Eigen::Index i = 0; i < 2; ++i) {
    memory_slopes_(i, column) = memory.position[i].gradient[0];
    memory_slopes_(2 + i, column) = memory.velocity[i].gradient[0];
    memory_slopes_(4 + i, column) = memory.integral[i].gradient[0];
    command_slopes_(i, column) = commanded[i].gradient[0];
  }
}

// The angles and rates that the law uses as the plane's, with their derivatives, if the states
// change by `moves`.
std::array<RigSensitivity::Moved, 4> RigSensitivity::servo_numbers(
    std::size_t k, const SwitchInstant& now, const Eigen::VectorXd& moves) const {
  const Neighbors& neighbors = keys_[k];
  const auto believed = [this](const model::Model& model, const Eigen::VectorXd& z) {
    const double* const angle = z.data() + first_angle;
    const double* const rate = z.data() + first_rate_;
    Eigen::Vector4d numbers(angle[0], angle[1], rate[0], rate[1]);
    double into[4];
    if (model.rig->between.none()) return numbers;
    model.rig->between.believed(angle, rate, into);
    return Eigen::Vector4d(into);
  };
  const auto n = moves.size();
  const Eigen::Vector4d values = believed(model_, now.before.head(n));
  const Eigen::Vector4d slopes = neighbors.slope([&](std::size_t j) {
    return believed(neighbors.models[j],
                    now.before.head(n) + Neighbors::offsets[j] * neighbors.key.step * moves);
  });
  std::array<Moved, 4> moved{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    moved[i] = {values[at], slopes[at]};
  }
  return moved;
}

// Within its dead band, a servo keeps its previous command.
void RigSensitivity::take_command(const model::RigMode& mode) {
  wanted_slopes_ = commands_.front();
  commands_.pop_front();
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const Neighbors& neighbors = keys_[k];
    Eigen::Vector3d told(wanted_slopes_(0, column), wanted_slopes_(1, column), 0);
    if (!loop_.between.none()) {
      told = neighbors.slope([&](std::size_t j) {
        const double change = Neighbors::offsets[j] * neighbors.key.step;
        return Eigen::Vector3d(neighbors.models[j]
                                   .rig->sampled->between
                                   .told({mode.wanted[0] + change * wanted_slopes_(0, column),
                                          mode.wanted[1] + change * wanted_slopes_(1, column)})
                                   .data());
      });
    }
    for (int i = 0; i < servos_; ++i) {
      const bool in_band =
          model_.rig->servo[i].dead_band > 0 && mode.command[i] == mode_.command[i];
      if (!in_band) followed_slopes_(i, column) = told[i];
    }
  }
}

void RigSensitivity::require_away_from_stops(const SwitchInstant& now,
                                             const model::RigMode& mode) const {
  constexpr double at_stop = 1 - 1e-9;
  for (int i = 0; i < servos_; ++i) {
    const model::RigServo& servo = model_.rig->servo[i];
    const bool stops = std::abs(now.after[first_angle + i]) >= at_stop * servo.angle_limit;
    if (!stops && !(servo.time_constant && keeps_rate(mode.axis[i]))) continue;
    no_sensitivity("at t = " + short_number(now.t) + " s a servo reaches its " +
                   (stops ? "stop" : "rate limit, which has no derivative in one of first order") +
                   "; allowed: runs in which it does not, such as those up to an earlier time.end");
  }
}

// How far each key moves the time at which a servo reaches its rate limit; 0 if none does. Other
// switches between modes do not change the rates of the states.
Eigen::VectorXd RigSensitivity::moves_at_rate_limit(const SwitchInstant& now,
                                                    const model::RigMode& mode,
                                                    const Eigen::MatrixXd& slopes) const {
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(slopes.cols());
  for (int i = 0; i < servos_; ++i) {
    if (!keeps_rate(mode.axis[i]) || keeps_rate(mode_.axis[i])) continue;
    const double side = std::copysign(1.0, now.after[first_rate_ + i]);
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      const double limit = keys_[k].slope(
          [&](std::size_t j) { return side * keys_[k].models[j].rig->servo[i].rate_limit; });
      const auto column = static_cast<Eigen::Index>(k);
      moves[column] = (limit - slopes(first_rate_ + i, column)) / now.rates_before[first_rate_ + i];
    }
  }
  return moves;
}

// The rate of a first-order servo jumps with its command, and the ball's velocity jumps with the
// plane's rates.
void RigSensitivity::turn_first_order(std::size_t k, const SwitchInstant& now,
                                      const model::RigMode& mode,
                                      Eigen::Ref<Eigen::VectorXd> slope) const {
  bool any = false;
  for (int i = 0; i < servos_; ++i) any = any || model_.rig->servo[i].time_constant;
  if (!any) return;
  const Neighbors& neighbors = keys_[k];
  const auto n = static_cast<Eigen::Index>(model_.size());
  const Eigen::VectorXd before = slope.head(n);
  slope.head(n) = neighbors.slope([&](std::size_t j) {
    const double change = Neighbors::offsets[j] * neighbors.key.step;
    const model::Model& beside = neighbors.models[j];
    Eigen::VectorXd z = now.before.head(n) + change * before;
    const auto plane_rates = [&] {
      return with_loop(beside.system, [&](const auto& loop) { return loop.plane_rates(z.data()); });
    };
    const std::array<double, 2> rates_before = plane_rates();
    for (int i = 0; i < servos_; ++i) {
      const auto& time_constant = beside.rig->servo[i].time_constant;
      if (!time_constant) continue;
      const double command =
          mode.command[i] + change * followed_slopes_(i, static_cast<Eigen::Index>(k));
      z[first_rate_ + i] = (command - z[first_angle + i]) / *time_constant;
    }
    const std::array<double, 2> rates = plane_rates();
    const auto kick = with_loop(beside.system, [&](const auto& loop) {
      return loop.impulse(z.data(), rates[0] - rates_before[0], rates[1] - rates_before[1]);
    });
    for (Eigen::Index i = 0; i < 3; ++i) z[2 + i] += kick[static_cast<std::size_t>(i)];
    return z;
  });
}

// Puts the neighboring models into the mode, with their own commands, limits and offsets.
void RigSensitivity::put(const model::RigMode& mode) {
  mode_ = mode;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    Neighbors& neighbors = keys_[k];
    for (std::size_t j = 0; j < neighbors.models.size(); ++j) {
      model::Model& beside = neighbors.models[j];
      const double change = Neighbors::offsets[j] * neighbors.key.step;
      const auto column = static_cast<Eigen::Index>(k);
      model::RigMode& its = *with_loop(beside.system, [](auto& loop) { return &loop.mode; });
      its = mode;
      for (int i = 0; i < 2; ++i) its.wanted[i] += change * wanted_slopes_(i, column);
      for (int i = 0; i < servos_; ++i) {
        model::AxisMode& axis = its.axis[i];
        const model::RigServo& servo = beside.rig->servo[i];
        axis.offset = servo.offset;
        if (axis.set_acceleration != 0) {
          axis.set_acceleration = std::copysign(servo.acceleration_limit, axis.set_acceleration);
        }
        its.command[i] += change * followed_slopes_(i, column);
      }
    }
  }
}

Eigen::VectorXd RigSensitivity::extras(std::size_t k, double t, const Eigen::VectorXd& z,
                                       const Eigen::VectorXd& slope) const {
  Eigen::VectorXd found = slope_of_extras(keys_[k], t, z, slope);
  found.segment(measured_extras, 2) = memory_slopes_.col(static_cast<Eigen::Index>(k)).head(2);
  return found;
}

}  // namespace bbsim::study
