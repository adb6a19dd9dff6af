#include "solve/loop/loop_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include "solve/step_growth.hpp"

namespace bbsim::solve::loop {

namespace {

constexpr std::align_val_t alignment{64};

// What takes more is for another integrator.
constexpr std::size_t most_attempts = 100'000;
// From one second to the rounding of its time takes 50 halvings of the step.
constexpr int most_rejections = 60;
// Errors fall with the step to the power of the nodes and more: a lane whose error is so much more
// than the median's needs a step a quarter as long or shorter. What is lost without need is run
// again alone, and only costs time.
constexpr double holding_back = 1e8;
constexpr int most_held = 4;
// What a step that Newton's iteration does not solve counts as: one that needs to be half as long.
constexpr double unsolved = 1e6;

// Steps that have become so short a part of the longest one, so many in a row, are mostly on the
// way to an instant beyond which there is no motion. Loops that ask for them are given up: another
// integrator comes nearer to it in fewer steps.
constexpr double by_far = 0.03, asking = 1e-2;
constexpr int long_since = 8;

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

const Kernel& kernel_of(Drives drives, int nodes) {
  const Kernels& all = choose_kernels();
  const Kernels::Nodes& of = drives == Drives::angle ? all.angle : all.acceleration;
  return of.few.nodes == nodes ? of.few : of.many;
}

double error_of(const Attempt& attempt, std::size_t lane) {
  const double squared = attempt.error_squared[lane];
  if (!std::isfinite(squared)) return std::numeric_limits<double>::infinity();
  return std::max(std::sqrt(squared), attempt.converged[lane] ? 0.0 : unsolved);
}

template <class T>
T* allocate(std::size_t bytes) {
  return static_cast<T*>(::operator new(bytes, alignment));
}

}  // namespace

int choose_nodes(double rtol) {
  constexpr double for_many = 3e-7;
  return rtol < for_many ? 12 : 8;
}

void LoopLanes::Free::operator()(void* memory) const {
  ::operator delete(memory, alignment);
}

LoopLanes::LoopLanes(Drives drives, int nodes, Tolerances tolerances, const OutputGrid& grid)
    : kernel_(&kernel_of(drives, nodes)),
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
double LoopLanes::judge(const Attempt& attempt, bool at_limit) {
  std::array<double, group> errors, sorted;
  std::ptrdiff_t alive = 0;
  double most = 0;
  for (std::size_t lane = 0; lane < group; ++lane) {
    errors[lane] = error_of(attempt, lane);
    if (lost_[lane]) continue;
    sorted[static_cast<std::size_t>(alive++)] = errors[lane];
    most = std::max(most, errors[lane]);
  }
  if (most <= 1) return most;
  const auto middle = sorted.begin() + alive / 2;
  if (alive > 0) std::nth_element(sorted.begin(), middle, sorted.begin() + alive);
  double worst = 0;
  for (std::size_t lane = 0; lane < group; ++lane) {
    if (lost_[lane]) continue;
    const double error = errors[lane];
    if (error > 1 && error > holding_back * *middle) ++held_[lane];
    if ((at_limit && error > 1) || held_[lane] > most_held) {
      lost_[lane] = true;
    } else {
      worst = std::max(worst, error);
    }
  }
  return worst;
}

// Gives up those with such an error and more.
void LoopLanes::give_up(const Attempt& attempt, double least) {
  for (std::size_t lane = 0; lane < group; ++lane) {
    if (error_of(attempt, lane) >= least) lost_[lane] = true;
  }
}

// The rows up to the end of the last attempt.
void LoopLanes::record(double arrived) {
  const std::size_t first = recorded_;
  while (recorded_ < times_.size() && times_[recorded_] <= arrived) ++recorded_;
  if (recorded_ == first) return;
  kernel_->evaluate(workspace_.get(), &times_[first], recorded_ - first, places_only_,
                    rows_.get() + first * states * group);
}

// How fast a lane's loop moves, 1/s: each way round it from an acceleration to itself, by as many
// integrations as there are on the way.
double fastest_of(const Couplings& of, int lane) {
  const auto at = [lane](const double(&values)[group]) { return values[lane]; };
  const double by_velocity = at(of.servo_by_velocity), by_place = at(of.servo_by_place);
  return std::max(
      {at(of.ball_by_velocity), std::sqrt(at(of.ball_by_place)), at(of.servo_by_rate),
       std::sqrt(at(of.servo_by_angle)), at(of.ball_by_turning) * by_velocity,
       std::sqrt(at(of.ball_by_turning) * by_place), std::sqrt(at(of.ball_by_rate) * by_velocity),
       std::cbrt(at(of.ball_by_rate) * by_place), std::cbrt(at(of.ball_by_angle) * by_velocity),
       std::sqrt(std::sqrt(at(of.ball_by_angle) * by_place))});
}

// The fastest motion of any lane, 1/s. Loops that have none for not being finite are given up.
double LoopLanes::fastest(const LoopCase* cases, int count) {
  Couplings couplings;
  kernel_->couplings(workspace_.get(), 0, couplings);
  double rate = 0;
  for (int lane = 0; lane < group; ++lane) {
    const double own =
        fastest_of(couplings, lane) + std::abs(cases[std::min(lane, count - 1)].frequency);
    const bool lost = !std::isfinite(own);
    lost_[static_cast<std::size_t>(lane)] = lost;
    if (!lost) rate = std::max(rate, own);
  }
  return rate;
}

std::array<bool, group> LoopLanes::integrate(const LoopCase* cases, int count) {
  load(cases, count);
  held_.fill(0);
  greatest_ = {};
  statistics_ = {};
  recorded_ = 1;
  const double end = times_.back();
  const double rate = fastest(cases, count);
  replace_lost();
  double next = rate > 0 ? std::pow(tolerances_.rtol, 1.0 / kernel_->nodes) / rate : end;
  if (!(next > 0)) next = end * 1e-6;

  double t = 0;
  int rejections = 0;
  Shrinking shrinking;
  auto lost_before = lost_;
  while (t < end && std::find(lost_.begin(), lost_.end(), false) != lost_.end()) {
    // The steps to the end are alike.
    const double left = end - t;
    const double pieces = std::ceil(left / next * (1 - 1e-3));
    const bool arrives = !(pieces > 1);
    const double h = arrives ? left : pieces < 4 ? left / pieces : next;
    const bool at_limit =
        rejections >= most_rejections || !(h > 4 * std::numeric_limits<double>::epsilon() * t);
    Attempt attempt;
    kernel_->attempt(workspace_.get(), t, h, attempt);
    statistics_.nonlinear_iterations += static_cast<std::size_t>(attempt.iterations);
    if (++statistics_.jacobian_evaluations > most_attempts) lost_.fill(true);
    const double worst = judge(attempt, at_limit);
    // The first step is a guess.
    const double most = statistics_.steps < 3 ? 30 : 8;
    const double growth = step_growth(worst, kernel_->nodes, most);
    if (worst <= 1) {
      t = arrives ? end : t + h;
      record(t);
      kernel_->look(workspace_.get(), greatest_);
      kernel_->accept(workspace_.get());
      ++statistics_.steps;
      if (!arrives && shrinking.lasts(h)) give_up(attempt, asking * worst);
      next = h * (rejections > 0 ? std::min(growth, 1.0) : growth);
      rejections = 0;
    } else {
      next = h * std::min(0.8, growth);
      ++statistics_.error_test_failures;
      ++rejections;
    }
    if (lost_ != lost_before) replace_lost();
    lost_before = lost_;
  }
  if (places_only_) {
    kernel_->read(workspace_.get(), reinterpret_cast<double(*)[group]>(
                                        rows_.get() + (times_.size() - 1) * states * group));
  }
  std::array<bool, group> carried;
  for (std::size_t lane = 0; lane < group; ++lane) {
    carried[lane] = !lost_[lane] && lane < static_cast<std::size_t>(count);
  }
  return carried;
}

}  // namespace bbsim::solve::loop
