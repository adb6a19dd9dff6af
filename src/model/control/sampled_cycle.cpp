// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/sampled_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "model/control/sample_times.hpp"
#include "model/dense.hpp"

namespace bbsim::model {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct SampledCycle::Parts {
  MatrixXd plant;
  std::deque<Pairs> exposures, commands;
  Pairs position, velocity, integral, held;
};

// Inputs that stay constant over a cycle.
struct SampledCycle::Inputs {
  Eigen::Matrix<double, 6, Eigen::Dynamic> reference;
  Pairs command;   // in place of the law's
  bool open[2]{};  // whether that loop is open
};

SampledCycle::SampledCycle(const PlantDerivatives& plant, const Rig& rig, const LinearPoint& at,
                           Frames frames)
    : places_(plant.places),
      states_(linear_states(plant.places, plant.of_state, {0, 1}, SpinStands::last)) {
  const std::vector<int>& states = states_;
  const SampledLoop& sampled = *rig.sampled;
  CycleParts& parts = parts_;
  parts.servos = plant.places.servos;
  parts.a = plant.of_state(states, states);
  parts.b = plant.of_command(states, Eigen::all);
  parts.jump = plant.kick(states, Eigen::all);
  const LawDerivatives law = law_derivatives(sampled.law, plant.fed, at.reference);
  parts.of_feedback = law.of_feedback;
  parts.of_reference = law.of_reference;
  if (plant.believed.size() > 0) parts.fed = plant.believed(Eigen::all, states);
  if (plant.servo_commands.size() > 0 && parts.servos == 2) {
    // Commands in the queue are servo angles.
    parts.of_feedback = product(plant.servo_commands, law.of_feedback);
    parts.of_reference = product(plant.servo_commands, law.of_reference);
  } else {
    parts.servo_commands = plant.servo_commands;
  }
  parts.sampling = sampled.sampling;
  parts.sensor = sampled.sensor;
  const double(&k)[2][2] = sampled.law.integral;
  parts.of_integral << k[0][0], k[0][1], k[1][0], k[1][1];
  for (int i = 0; i < parts.servos; ++i) parts.time_constant[i] = rig.servo[i].time_constant;
  if (frames == Frames::of_equal_age && common_cycle(parts.sampling, parts.sensor).samples > 1) {
    parts.sensor.period.reset();
  }
  for (const Eigen::Index i : {0, 1}) {
    if (!parts_.of_integral.row(i).isZero(0)) integrating_.push_back(i);
  }
  plan();
}

void SampledCycle::plan() {
  const CommonCycle cycle = common_cycle(parts_.sampling, parts_.sensor);
  const double period = parts_.sampling.period, near = one_instant * period;
  // The frames that the samples use, by number, and their times of exposure.
  const Sensor& sensor = parts_.sensor;
  const bool own = sensor.period && cycle.known;
  const double of_frames = own ? *sensor.period : period,
               phase = own ? sensor.phase : -sensor.delay;
  const auto seen_by = [&](double sample) {
    return std::floor(((sample + one_instant) * period - sensor.delay - phase) / of_frames);
  };
  const double first_seen = seen_by(0);  // by the sample at the cycle's start
  const double first = std::ceil((-near - phase) / of_frames);  // exposed in the cycle
  const auto samples = static_cast<int>(cycle.samples);

  struct Event {
    double time;
    Act act;
  };
  std::vector<Event> events;
  // Numbers of the frames in use, as of the cycle in which they are exposed.
  std::vector<double> seen;
  for (int i = 0; i < samples; ++i) {
    const double number = seen_by(i);
    seen.push_back(number - cycle.frames * std::floor((number - first) / cycle.frames));
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (const double number : seen) {
    double time = phase + number * of_frames;
    const double at_sample = std::round(time / period) * period;
    if (std::abs(time - at_sample) <= near) time = at_sample;
    events.push_back({time, Act::expose});
  }
  // All of them in order, from the one that the first sample uses.
  std::vector<double> queue;
  for (double back = std::ceil((first - first_seen) / cycle.frames); back >= 0; --back) {
    for (const double number : seen) {
      const double then = number - back * cycle.frames;
      if (then >= first_seen) queue.push_back(then);
    }
  }
  exposures_ = static_cast<std::size_t>(
      std::ranges::count_if(queue, [&](double number) { return number < first; }));
  std::size_t front = 0;
  const auto skip_to = [&](double number) {
    int skipped = 0;
    for (; front < queue.size() && queue[front] < number; ++front) ++skipped;
    return skipped;
  };
  for (int i = 0; i < samples; ++i) skipped_.push_back(skip_to(seen_by(i)));
  skipped_last_ = skip_to(first_seen + cycle.frames);

  const double whole = std::floor(parts_.sampling.delay / period + one_instant);
  double application = std::max(0.0, parts_.sampling.delay - whole * period);
  if (application <= near) application = 0;
  commands_ = static_cast<std::size_t>(whole);
  begins_held_ = application > 0;
  for (int i = 0; i < samples; ++i) {
    events.push_back({i * period, Act::sample});
    events.push_back({i * period + application, Act::apply});
  }
  events.push_back({samples * period, Act::end});
  // At one instant, exposures precede samples, and samples precede commands.
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return a.time != b.time ? a.time < b.time : a.act < b.act;
  });

  ways_.emplace_back();
  std::vector<double> lengths{0};
  double last = 0;
  for (const Event& event : events) {
    const double length = event.time - last;
    last = std::max(last, event.time);
    std::size_t way = 0;
    if (length > 1e-3 * near) {
      const auto known = std::ranges::find_if(
          lengths, [&](double earlier) { return std::abs(earlier - length) <= 1e-3 * near; });
      way = static_cast<std::size_t>(known - lengths.begin());
      if (known == lengths.end()) {
        lengths.push_back(length);
        ways_.push_back(zero_order_hold({parts_.a, parts_.b}, length));
      }
    }
    steps_.push_back({way, event.act});
  }
}

int SampledCycle::controller_at() const {
  return static_cast<int>(parts_.a.rows()) + 2 * static_cast<int>(exposures_);
}

int SampledCycle::controller_size() const {
  return 4 + static_cast<int>(integrating_.size());
}

int SampledCycle::size() const {
  // A command that is applied at once is not a state at the cycle's start.
  return controller_at() + controller_size() + 2 * static_cast<int>(commands_) +
         (begins_held_ ? 2 : 0);
}

std::vector<LinearSignal> SampledCycle::signals(const std::string& command_unit) const {
  std::vector<LinearSignal> signals = state_signals(places_, command_unit, states_);
  const auto add = [&signals](const char* first, const char* second, const std::string& suffix,
                              const std::string& unit) {
    signals.push_back({first + suffix, unit});
    signals.push_back({second + suffix, unit});
  };
  for (std::size_t i = 1; i <= exposures_; ++i) add("x", "y", "_seen_" + std::to_string(i), "m");
  add("x", "y", "_known", "m");
  add("vx", "vy", "_known", "m/s");
  for (const Eigen::Index i : integrating_) {
    signals.push_back({i == 0 ? "phi_command_integral" : "theta_command_integral", command_unit});
  }
  for (std::size_t i = 1; i <= commands_; ++i) {
    add("phi", "theta", "_waiting_" + std::to_string(i), command_unit);
  }
  if (begins_held_) add("phi", "theta", "_held", command_unit);
  return signals;
}

template <class Use>
void SampledCycle::for_each_part(Parts& of, Use use) const {
  use(of.plant);
  for (Pairs& seen : of.exposures) use(seen);
  use(of.position);
  use(of.velocity);
  for (const Eigen::Index i : integrating_) use(of.integral.row(i));
  for (Pairs& command : of.commands) use(command);
  if (begins_held_) use(of.held);
}

SampledCycle::Parts SampledCycle::unpacked(const MatrixXd& states) const {
  const Pairs none = Pairs::Zero(2, states.cols());
  Parts of{MatrixXd(parts_.a.rows(), states.cols()),
           std::deque<Pairs>(exposures_, none),
           std::deque<Pairs>(commands_, none),
           none,
           none,
           none,
           none};
  Eigen::Index next = 0;
  for_each_part(of, [&](auto&& part) {
    part = states.middleRows(next, part.rows());
    next += part.rows();
  });
  return of;
}

MatrixXd SampledCycle::packed(Parts& of) const {
  MatrixXd states(size(), of.plant.cols());
  Eigen::Index next = 0;
  for_each_part(of, [&](auto&& part) {
    states.middleRows(next, part.rows()) = part;
    next += part.rows();
  });
  return states;
}

void SampledCycle::expose(Parts& of) const {
  const MatrixXd at = of.plant.topRows(2);
  of.exposures.emplace_back(parts_.sensor.is_aligned() ? at
                                                       : product(seen_matrix(parts_.sensor), at));
}

void SampledCycle::apply(Parts& of) const {
  of.held = of.commands.front();
  of.commands.pop_front();
  const MatrixXd commands = parts_.servo_commands.size() > 0
                                ? product(parts_.servo_commands, of.held)
                                : MatrixXd(of.held);
  MatrixXd jump = MatrixXd::Zero(parts_.servos, of.plant.cols());
  for (int i = 0; i < parts_.servos; ++i) {
    if (!parts_.time_constant[i]) continue;
    jump.row(i) = (commands.row(i) - of.plant.row(4 + i)) / *parts_.time_constant[i] -
                  of.plant.row(4 + parts_.servos + i);
  }
  if (!jump.isZero(0)) of.plant += product(parts_.jump, jump);
}

SampledCycle::Pairs SampledCycle::sample(Parts& of, const Inputs& inputs) const {
  const double period = parts_.sampling.period, filter = parts_.sampling.derivative_filter;
  const double keep = filter / (filter + period);
  const Pairs& seen = of.exposures.front();
  of.velocity = (keep * of.velocity + (1 - keep) / period * (seen - of.position)).eval();
  of.position = seen;
  of.integral += period * product(parts_.of_integral, inputs.reference.topRows(2) - seen);
  MatrixXd known(10, of.plant.cols());
  known << of.position, of.velocity, of.plant.middleRows(4, 4), of.integral;
  if (parts_.fed.size() > 0) known.middleRows(4, 4) = product(parts_.fed, of.plant);
  const MatrixXd led = product(parts_.of_reference, inputs.reference);
  Pairs law = product(parts_.of_feedback, known) + led;
  Pairs& command = of.commands.emplace_back(law);
  for (int i = 0; i < 2; ++i) {
    if (inputs.open[i]) command.row(i) = inputs.command.row(i);
  }
  return law;
}

SampledMap SampledCycle::map(bool phi_open, bool theta_open) const {
  // One column for each state and each input.
  const int n = size();
  const Eigen::Index columns = n + 8;
  Parts of = unpacked(MatrixXd::Identity(n, columns));
  const MatrixXd inputs = MatrixXd::Identity(columns, columns).bottomRows(8);
  const Inputs input{inputs.topRows(6), inputs.bottomRows(2), {phi_open, theta_open}};
  SampledMap map;
  const auto skip = [&of](int count) {
    for (; count > 0; --count) of.exposures.pop_front();
  };
  std::size_t next_sample = 0;
  for (const Step& step : steps_) {
    if (step.way > 0) {
      const LinearPlant& way = ways_[step.way];
      of.plant = way.a * of.plant + product(way.b, of.held);
    }
    switch (step.act) {
      case Act::expose:
        expose(of);
        break;
      case Act::sample: {
        const bool first = next_sample == 0;
        skip(skipped_[next_sample++]);
        if (first) map.seen = of.exposures.front().leftCols(n);
        const Pairs law = sample(of, input);
        if (first) map.law = law.leftCols(n);
        break;
      }
      case Act::apply:
        apply(of);
        break;
      case Act::end:
        skip(skipped_last_);
        break;
    }
  }
  const MatrixXd states = packed(of);
  map.a = states.leftCols(n);
  map.of_reference = states.middleCols(n, 6);
  map.of_command = states.rightCols(2);
  return map;
}

LinearPlant zero_order_hold(const LinearPlant& plant, double time) {
  const Eigen::Index n = plant.a.rows();
  MatrixXd both = MatrixXd::Zero(n + 2, n + 2);
  both.topLeftCorner(n, n) = plant.a * time;
  both.topRightCorner(n, 2) = plant.b * time;
  const MatrixXd all = exponential(both);
  return {all.topLeftCorner(n, n), all.topRightCorner(n, 2)};
}

}  // namespace bbsim::model
