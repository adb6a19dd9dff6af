// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/open/open_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>
#include <utility>

#include "simd/instruction_set.hpp"
#include "solve/collocation/step_length.hpp"

namespace bbsim::solve::open {
namespace {

constexpr std::align_val_t alignment{64};

// A group that takes more attempts is left to another integrator.
constexpr std::size_t most_attempts = 100'000;
// 50 halvings take a step from one second to the rounding of its time.
constexpr int most_rejections = 60;
// The error falls with the step to the power of the nodes or more. A lane whose error exceeds the
// median by this factor needs a step of a quarter or less.
constexpr LostLanes<group>::Patience patience{.notable = 1, .holding_back = 1e8, .most_held = 4};

// Half the distance between two points of the plate's motion, rad at its tempo. The cubics of
// simd/peaks.hpp then find the maxima.
constexpr double look_angle = 0.9;
// Within this many points a gimbal has reached all its extremes.
constexpr double most_looks = 1e6;

const Kernel& kernel_of(const Kernels& all, int nodes) {
  for (const Kernel* one : {&all.few, &all.some}) {
    if (one->nodes == nodes) return *one;
  }
  return all.many;
}

// The cost of a step: sums over nodes, and coefficients at each node.
double step_cost(int nodes) {
  return nodes * (nodes + 15.0);
}

}  // namespace

const Kernels& choose_kernels() {
  return simd::kernels_by([](auto isa) -> const auto& { return kernels<decltype(isa)>(); });
}

void OpenLanes::Free::operator()(void* memory) const {
  ::operator delete(memory, alignment);
}

OpenLanes::OpenLanes(Tolerances tolerances, double end, std::vector<double> stops, Pace pace)
    : kernels_(choose_kernels()),
      tolerances_(tolerances),
      end_(end),
      stops_(std::move(stops)),
      pace_(pace),
      lost_(patience) {
  kernel_ = &kernel_of(kernels_, pace.nodes);
  workspace_.reset(::operator new(kernel_->workspace, alignment));
  stops_.push_back(end);
}

// Unused lanes repeat the last case.
void OpenLanes::load(const OpenCase* cases, int count) {
  double most = 0;  // the largest angle, rad
  for (int lane = 0; lane < group; ++lane) {
    const OpenCase& one = cases[std::min(lane, count - 1)];
    const GivenMotion& motion = one.motion;
    scenes_.radius[lane] = one.radius;
    scenes_.gravity[lane] = one.gravity;
    for (int i = 0; i < states; ++i) scenes_.initial[i][lane] = one.initial[i];
    double angle = 0;
    for (int i = 0; i < 2; ++i) {
      scenes_.start[i][lane] = motion.start[i];
      scenes_.rate[i][lane] = motion.rate[i];
      angle += std::abs(motion.start[i]) + std::abs(motion.rate[i]) * end_;
    }
    for (int k = 0; k < motion.wave_count; ++k) angle += std::abs(motion.waves[k].amplitude);
    most = std::max(most, angle);
  }
  scenes_.shared = cases[0].motion.shared;
  scenes_.small = most < 0.785 && !scenes_.shared.any();
  load_waves(cases, count);
  kernel_->start(workspace_.get(), scenes_, tolerances_.rtol, tolerances_.atol);
}

// A sine costs more than the rest of the equation. Waves of one frequency share one sine, even if
// the frequency differs between lanes: a sin(w t + p) = a cos p sin w t + a sin p cos w t.
void OpenLanes::load_waves(const OpenCase* cases, int count) {
  scenes_.harmonic_count = 0;
  for (int k = 0; k < cases[0].motion.wave_count; ++k) {
    alignas(64) double frequency[group], phase[group], sine[group], cosine[group];
    const auto wave = [&](int lane) -> const GivenMotion::Wave& {
      return cases[std::min(lane, count - 1)].motion.waves[k];
    };
    for (int lane = 0; lane < group; ++lane) {
      frequency[lane] = wave(lane).frequency;
      phase[lane] = wave(lane).phase;
    }
    Scenes::Harmonic* const end = scenes_.harmonics + scenes_.harmonic_count;
    Scenes::Harmonic* const to =
        std::find_if(scenes_.harmonics, end, [&](const Scenes::Harmonic& one) {
          return std::equal(frequency, frequency + group, one.frequency);
        });
    if (to == end) {
      *to = {};
      std::copy(frequency, frequency + group, to->frequency);
      ++scenes_.harmonic_count;
    }
    kernels_.directions(phase, sine, cosine);
    const int component = cases[0].motion.waves[k].component;
    for (int lane = 0; lane < group; ++lane) {
      to->sine[component][lane] += wave(lane).amplitude * cosine[lane];
      to->cosine[component][lane] += wave(lane).amplitude * sine[lane];
    }
  }
}

// The highest frequency of a motion, and a bound of its angular velocities, rad/s.
struct OpenLanes::Tempo {
  explicit Tempo(const GivenMotion& motion) {
    frequency = motion.shared.highest_frequency;
    rate = std::abs(motion.rate[0]) + std::abs(motion.rate[1]);
    for (int k = 0; k < motion.wave_count; ++k) {
      const double of = std::abs(motion.waves[k].frequency);
      frequency = std::max(frequency, of);
      rate += of * std::abs(motion.waves[k].amplitude);
    }
  }
  double frequency = 0, rate;
};

// The fastest rate at which the gimbal's action on the ball changes, over all lanes, rad/s. The
// action has sinusoids and, where angles are large, sinusoids of these.
double OpenLanes::tempo(const OpenCase* cases, int count) {
  double fastest = 0;
  for (int lane = 0; lane < count; ++lane) {
    const Tempo one(cases[lane].motion);
    fastest = std::max(fastest, one.frequency + one.rate);
  }
  return fastest;
}

// Returns the largest error of the lanes that continue. At the shortest step, gives up all lanes
// that do not pass.
double OpenLanes::judge(const Attempt& attempt, bool at_limit) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::array<double, group> errors;
  for (std::size_t lane = 0; lane < group; ++lane) {
    errors[lane] = std::sqrt(attempt.error_squared[lane]);
  }
  if (!at_limit) return lost_.judge(errors.data(), infinite);
  return lost_.judge(errors.data(), attempt.converged ? 1 : -infinite);
}

// Integrates over an interval without input corners. Returns whether any lane arrived.
bool OpenLanes::go(double from, double to) {
  double t = from;
  int rejections = 0;
  while (t < to) {
    if (lost_.all()) return false;
    const auto [h, arrives] = stride(to - t, next_);
    const bool at_limit = rejections >= most_rejections || is_lost(h, t);
    Attempt attempt;
    kernel_->attempt(workspace_.get(), t, h, attempt);
    statistics_.nonlinear_iterations += static_cast<std::size_t>(attempt.iterations);
    if (statistics_.steps + statistics_.error_test_failures > most_attempts) lost_.give_up_all();
    const double worst = judge(attempt, at_limit);
    if (worst <= 1 && attempt.converged) {
      t = arrives ? to : t + h;
      kernel_->accept(workspace_.get());
      ++statistics_.steps;
      // A step that a stop cut short says nothing about longer steps.
      if (!arrives || h >= next_) {
        const double factor = std::max(1.0, step_growth(worst, kernel_->nodes));
        next_ = rejections > 0 ? h : h * factor;
      }
      rejections = 0;
    } else {
      next_ = h * (attempt.converged ? std::min(0.8, step_growth(worst, kernel_->nodes)) : 0.5);
      ++statistics_.error_test_failures;
      ++rejections;
    }
    lost_.replace([&](int lane, int of) { kernel_->twin(workspace_.get(), lane, of); });
  }
  return true;
}

// Computes the plate's extremes. After `until` the motion repeats: one sinusoid in both angles
// shows all its extremes within one period, and within half a period if the plate is level on
// average.
void OpenLanes::turn(const OpenCase* cases, int count) {
  alignas(64) double until[group];
  double most = 1;
  for (int lane = 0; lane < group; ++lane) {
    const GivenMotion& motion = cases[std::min(lane, count - 1)].motion;
    const Tempo tempo(motion);
    until[lane] = end_;
    if (motion.rate[0] == 0 && motion.rate[1] == 0 && scenes_.harmonic_count == 1) {
      const bool level = motion.start[0] == 0 && motion.start[1] == 0;
      until[lane] = std::min(end_, (level ? 1 : 2) * std::numbers::pi / tempo.frequency);
    }
    most = std::max(most, until[lane] * (2 * tempo.frequency + tempo.rate) / look_angle);
  }
  kernels_.turning(scenes_, until, static_cast<int>(std::ceil(std::min(most, most_looks))),
                   turning_);
}

std::array<bool, group> OpenLanes::integrate(const OpenCase* cases, int count) {
  load(cases, count);
  lost_.begin();
  statistics_ = {};
  const double fastest = tempo(cases, count);
  next_ = fastest > 0 ? pace_.angle / fastest : end_;
  if (!(next_ > 0)) lost_.give_up_all();
  double from = 0;
  for (const double stop : stops_) {
    if (!go(from, stop)) break;
    from = stop;
  }
  kernel_->read(workspace_.get(), state_, distance_squared_);
  if (!scenes_.shared.any()) turn(cases, count);
  return lost_.carried(count);
}

Reached OpenLanes::reached(int lane) const {
  Reached one{};
  for (int i = 0; i < states; ++i) one.state[i] = state_[i][lane];
  one.distance_squared = distance_squared_[lane];
  one.versine = turning_.versine[lane];
  one.rate_squared = turning_.rate_squared[lane];
  return one;
}

std::optional<OpenLanes::Measured> OpenLanes::measure(const OpenCase* cases, int count) {
  const Pace before = pace_;
  std::optional<Measured> found;
  const double fastest = tempo(cases, count);
  const auto try_steps = [&](double steps) {
    pace_.angle = fastest > 0 ? fastest * end_ / steps : 1;
    const auto carried = integrate(cases, count);
    return std::any_of(carried.begin(), carried.end(), [](bool one) { return one; });
  };
  if (try_steps(4)) {
    // Repeat with the number of steps that the last try needed, then with fewer while all steps
    // pass.
    double steps = static_cast<double>(statistics_.steps);
    for (bool better = true; better && steps >= 1;) {
      static_cast<void>(try_steps(steps));
      better = statistics_.error_test_failures == 0;
      const double needed = static_cast<double>(statistics_.steps);
      if (better) {
        found = {{pace_.nodes, pace_.angle}, needed * step_cost(pace_.nodes)};
        steps = std::min(steps, needed) - 1;
      } else if (!found) {
        found = {{pace_.nodes, pace_.angle}, needed * step_cost(pace_.nodes)};
        better = needed > steps;
        steps = needed;
      }
    }
  }
  pace_ = before;
  return found;
}

}  // namespace bbsim::solve::open
