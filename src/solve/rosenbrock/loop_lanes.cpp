#include "solve/rosenbrock/loop_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include "simd/instruction_set.hpp"

namespace bbsim::solve::rosenbrock {

namespace {

constexpr std::align_val_t alignment{64};
constexpr int order = 5;

// What takes more is for another integrator.
constexpr std::size_t most_attempts = 100'000;
// From one second to the rounding of its time takes 16 tenfold reductions of the step.
constexpr int most_rejections = 40;
// A step ten times shorter than the group's median is one error 10^order times larger; what is
// lost without need is run again alone, and only costs time.
constexpr double holding_back = 1e5;
constexpr int most_held = 16;

// Steps that have become so short a part of the longest one, so many in a row, are mostly on the
// way to an instant beyond which there is no motion. Loops that ask for them are given up: another
// integrator comes nearer to it in fewer steps.
constexpr double by_far = 0.03, asking = 1e-2;
constexpr int long_since = 8;

// The size of the next step relative to one whose error was `error`.
double growth(double error) {
  constexpr double safety = 0.9, least = 0.1, most = 8;
  if (!(error > 0)) return error == 0 ? most : least;
  return std::clamp(safety * std::pow(error, -1.0 / order), least, most);
}

double finite_or_infinite(double error) {
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

// How steps shrink after the longest one.
class Shrinking {
 public:
  // To be told of each step that is accepted; whether they have been short for long.
  bool lasts(double h) {
    longest_ = std::max(longest_, h);
    short_ = h < by_far * longest_ ? short_ + 1 : 0;
    return short_ >= long_since;
  }

 private:
  double longest_ = 0;
  int short_ = 0;
};

template <class T>
T* allocate(std::size_t bytes) {
  return static_cast<T*>(::operator new(bytes, alignment));
}

}  // namespace

void LoopLanes::Free::operator()(void* memory) const {
  ::operator delete(memory, alignment);
}

LoopLanes::LoopLanes(Drives drives, solve::Tolerances tolerances, const solve::OutputGrid& grid)
    : kernel_(drives == Drives::angle ? &choose_kernels().angle : &choose_kernels().acceleration),
      tolerances_(tolerances),
      times_(grid.size()),
      rows_(allocate<double>(grid.size() * states * group * sizeof(double))),
      workspace_(allocate<void>(kernel_->workspace)) {
  for (std::size_t i = 0; i < grid.size(); ++i) times_[i] = grid[i];
}

// Unused lanes repeat the last case.
void LoopLanes::load(const LoopCase* cases, int count) {
  Loops loops;
  alignas(64) double initial[states][group];
  for (int lane = 0; lane < group; ++lane) {
    const LoopCase& one = cases[std::min(lane, count - 1)];
    loops.radius[lane] = one.radius;
    loops.gravity[lane] = one.gravity;
    loops.omega_n[lane] = one.omega_n;
    loops.zeta[lane] = one.zeta;
    loops.frequency[lane] = one.frequency;
    for (int i = 0; i < 2; ++i) {
      loops.start[i][lane] = one.start[i];
      loops.rate[i][lane] = one.rate[i];
      loops.sine[i][lane] = one.sine[i];
      loops.cosine[i][lane] = one.cosine[i];
      for (int j = 0; j < 2; ++j) {
        loops.kv[i][j][lane] = one.kv[i][j];
        loops.kp[i][j][lane] = one.kp[i][j];
      }
    }
    for (int i = 0; i < states; ++i) initial[i][lane] = one.initial[i];
  }
  kernel_->start(workspace_.get(), loops, initial, tolerances_.rtol, tolerances_.atol);
  std::memcpy(rows_.get(), initial, sizeof(initial));
}

// Lanes that were given up go on as twins of the first that was not: their numbers stay finite and
// cost nothing.
void LoopLanes::replace_lost() {
  const auto healthy = std::find(lost_.begin(), lost_.end(), false);
  if (healthy == lost_.end()) return;
  for (std::size_t lane = 0; lane < group; ++lane) {
    if (!lost_[lane]) continue;
    kernel_->twin(workspace_.get(), static_cast<int>(lane),
                  static_cast<int>(healthy - lost_.begin()));
  }
}

// The largest error of the lanes that are carried on; gives up those that cannot be.
double LoopLanes::judge(const double* errors, bool at_limit) {
  std::array<double, group> sorted;
  std::ptrdiff_t alive = 0;
  for (std::size_t lane = 0; lane < group; ++lane) {
    if (!lost_[lane]) sorted[static_cast<std::size_t>(alive++)] = finite_or_infinite(errors[lane]);
  }
  const auto middle = sorted.begin() + alive / 2;
  if (alive > 0) std::nth_element(sorted.begin(), middle, sorted.begin() + alive);
  double worst = 0;
  for (std::size_t lane = 0; lane < group; ++lane) {
    if (lost_[lane]) continue;
    const double error = finite_or_infinite(errors[lane]);
    if (error > 1e-3 && error > holding_back * *middle) ++held_[lane];
    if ((at_limit && error > 1) || held_[lane] > most_held) {
      lost_[lane] = true;
    } else {
      worst = std::max(worst, error);
    }
  }
  return worst;
}

// Gives up those with such an error and more.
void LoopLanes::give_up(const double* errors, double least) {
  for (std::size_t lane = 0; lane < group; ++lane) {
    if (errors[lane] >= least) lost_[lane] = true;
  }
}

// The rows up to the end of the last attempt.
void LoopLanes::record(double arrived) {
  const std::size_t first = recorded_;
  while (recorded_ < times_.size() && times_[recorded_] <= arrived) ++recorded_;
  if (recorded_ == first) return;
  kernel_->evaluate(workspace_.get(), &times_[first], recorded_ - first,
                    rows_.get() + first * states * group);
}

// The fastest motion of any lane, 1/s. Loops that have none for not being finite are given up.
double LoopLanes::fastest(const LoopCase* cases, int count) {
  std::array<double, group> rates;
  kernel_->rate(workspace_.get(), 0, rates.data());
  double rate = 0;
  for (int lane = 0; lane < group; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    const double own = rates[at] + std::abs(cases[std::min(lane, count - 1)].frequency);
    lost_[at] = !std::isfinite(own);
    if (!lost_[at]) rate = std::max(rate, own);
  }
  return rate;
}

std::array<bool, group> LoopLanes::integrate(const LoopCase* cases, int count, StepSink* steps) {
  load(cases, count);
  held_.fill(0);
  statistics_ = {};
  recorded_ = 1;
  const double end = times_.back();
  const double rate = fastest(cases, count);
  replace_lost();
  double next = rate > 0 ? std::pow(tolerances_.rtol, 1.0 / order) / rate : end;
  if (!(next > 0)) next = end * 1e-6;

  double t = 0;
  int rejections = 0;
  Shrinking shrinking;
  auto lost_before = lost_;
  while (t < end && std::find(lost_.begin(), lost_.end(), false) != lost_.end()) {
    // The steps to the end are alike.
    const double left = end - t;
    const double pieces = std::ceil(left / next * (1 - 1e-3));
    const bool arrives = pieces <= 1;
    const double h = arrives ? left : pieces < 4 ? left / pieces : next;
    const bool at_limit =
        rejections >= most_rejections || !(h > 4 * std::numeric_limits<double>::epsilon() * t);
    std::array<double, group> errors;
    kernel_->attempt(workspace_.get(), t, h, errors.data());
    if (++statistics_.jacobian_evaluations > most_attempts) lost_.fill(true);
    const double worst = judge(errors.data(), at_limit);
    if (worst <= 1) {
      const double from = t;
      t = arrives ? end : t + h;
      record(t);
      if (steps != nullptr) steps->accept({*kernel_, workspace_.get(), from, t});
      kernel_->accept(workspace_.get());
      ++statistics_.steps;
      if (!arrives && shrinking.lasts(h)) give_up(errors.data(), asking * worst);
      const double factor = growth(worst);
      next = h * (rejections > 0 ? std::min(factor, 1.0) : factor);
      rejections = 0;
    } else {
      next = h * std::min(0.9, growth(worst));
      ++statistics_.error_test_failures;
      ++rejections;
    }
    if (lost_ != lost_before) replace_lost();
    lost_before = lost_;
  }
  std::array<bool, group> carried;
  for (std::size_t lane = 0; lane < group; ++lane) {
    carried[lane] = !lost_[lane] && lane < static_cast<std::size_t>(count);
  }
  return carried;
}

}  // namespace bbsim::solve::rosenbrock
