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
constexpr double infinite = std::numeric_limits<double>::infinity();

// What takes more is for another integrator.
constexpr std::size_t most_attempts = 100'000;
// From one second to the rounding of its time takes 50 halvings of the step.
constexpr int most_rejections = 60;
// Errors fall with the step to the power of the nodes and more: a lane whose error is so much more
// than the median's needs a step a quarter as long or shorter.
constexpr LostLanes<group>::Patience patience{.notable = 1, .holding_back = 1e8, .most_held = 4};
// What a step that Newton's iteration does not solve counts as: one that needs to be half as long.
constexpr double unsolved = 1e6;

// Steps each of which is so much shorter than the one before, so many in a row, are mostly on the
// way to an instant beyond which there is no motion. Loops that ask for them are given up, unless
// they arrive before it: another integrator looks at them more closely, and says why they end.
constexpr double shorter = 0.85, asking = 0.1;
constexpr int long_since = 4;

// How steps shrink.
class Shrinking {
 public:
  // To be told of each step that is accepted.
  void take(double h) {
    ratio_ = last_ > 0 ? h / last_ : 1;
    count_ = ratio_ < shorter ? count_ + 1 : 0;
    last_ = h;
  }
  // Whether they have shrunk for long, and would not get so far if they went on like that.
  [[nodiscard]] bool ends_before(double left) const {
    return count_ >= long_since && last_ * ratio_ < left * (1 - ratio_);
  }
  // How much longer than the last one the next may be, if its error alone would have it grow like
  // that: what shrank twice is going to shrink as much again, which spares rejections.
  [[nodiscard]] double bound(double growth) const { return count_ >= 2 ? ratio_ * growth : growth; }

 private:
  double last_ = 0, ratio_ = 1;
  int count_ = 0;
};

const Kernel& kernel_of(Drives drives, int nodes) {
  const Kernels& all = choose_kernels();
  const Kernels::Nodes& of = drives == Drives::angle ? all.angle : all.acceleration;
  return of.few.nodes == nodes ? of.few : of.many;
}

// Errors in the tolerances' weights; no numbers where a step is not finite.
std::array<double, group> errors_of(const Attempt& attempt) {
  std::array<double, group> errors;
  for (std::size_t lane = 0; lane < group; ++lane) {
    errors[lane] = std::sqrt(attempt.error_squared[lane]);
    if (!attempt.converged[lane]) errors[lane] = std::max(errors[lane], unsolved);
  }
  return errors;
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
      workspace_(allocate<void>(kernel_->workspace)),
      lost_(patience) {
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

// The rows up to the end of the last attempt.
void LoopLanes::record(double arrived) {
  const std::size_t first = recorded_;
  while (recorded_ < times_.size() && times_[recorded_] <= arrived) ++recorded_;
  if (recorded_ == first) return;
  kernel_->evaluate(workspace_.get(), &times_[first], recorded_ - first, places_only_,
                    rows_.get() + first * row_size());
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
    if (std::isfinite(own)) {
      rate = std::max(rate, own);
    } else {
      lost_.give_up(static_cast<std::size_t>(lane));
    }
  }
  return rate;
}

std::array<bool, group> LoopLanes::integrate(const LoopCase* cases, int count) {
  load(cases, count);
  lost_.begin();
  greatest_ = {};
  statistics_ = {};
  recorded_ = 1;
  const double end = times_.back();
  const double rate = fastest(cases, count);
  const auto twin = [&](int lane, int of) { kernel_->twin(workspace_.get(), lane, of); };
  lost_.replace(twin);
  double next = rate > 0 ? std::pow(tolerances_.rtol, 1.0 / kernel_->nodes) / rate : end;
  if (!(next > 0)) next = end * 1e-6;

  double t = 0;
  int rejections = 0;
  Shrinking shrinking;
  while (t < end && !lost_.all()) {
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
    if (++statistics_.jacobian_evaluations > most_attempts) lost_.give_up_all();
    const auto errors = errors_of(attempt);
    const double worst = lost_.judge(errors.data(), at_limit ? 1 : infinite);
    // The first step is a guess.
    const double most = statistics_.steps < 3 ? 30 : 8;
    const double growth = step_growth(worst, kernel_->nodes, most);
    if (worst <= 1) {
      t = arrives ? end : t + h;
      record(t);
      kernel_->look(workspace_.get(), greatest_);
      kernel_->accept(workspace_.get());
      ++statistics_.steps;
      shrinking.take(h);
      if (shrinking.ends_before(end - t)) {
        for (std::size_t lane = 0; lane < group; ++lane) {
          if (errors[lane] >= asking * worst) lost_.give_up(lane);
        }
        shrinking = {};
      }
      const double bound = shrinking.bound(growth);
      next = h * (rejections > 0 ? std::min(bound, 1.0) : bound);
      rejections = 0;
    } else {
      next = h * std::min(0.8, growth);
      ++statistics_.error_test_failures;
      ++rejections;
    }
    lost_.replace(twin);
  }
  if (places_only_) {
    kernel_->read(workspace_.get(), reinterpret_cast<double(*)[group]>(
                                        rows_.get() + (times_.size() - 1) * row_size()));
  }
  return lost_.carried(count);
}

}  // namespace bbsim::solve::loop
