// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/loop/loop_lanes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "simd/instruction_set.hpp"
#include "solve/collocation/step_length.hpp"

namespace bbsim::solve::loop {

namespace {

constexpr std::align_val_t alignment{64};
constexpr double infinite = std::numeric_limits<double>::infinity();

// A loop that takes more attempts is left to another integrator.
constexpr std::size_t most_attempts = 100'000;
// A loop is given up if its step is below this fraction of the time. If the loop went to infinity,
// Shrinking would have detected that before.
constexpr double least_part = 1e-8;
// The factor of the step if Newton's iteration does not converge.
constexpr double unsolved = 0.4;

// Lanes are refilled when at most this many are at work.
constexpr int few = group / 2;
// So many shrinking steps mostly mean that a loop goes to infinity.
constexpr int long_since = 3;
// A loop that is this many steps from its end stays in its lane.
constexpr double soon = 2;

void put(Loops& loops, int lane, const LoopCase& loop) {
  constexpr std::size_t count = sizeof(LoopCase) / sizeof(double);
  const auto numbers = std::bit_cast<std::array<double, count>>(loop);
  auto* row = reinterpret_cast<double*>(&loops) + lane;
  for (const double number : numbers) {
    *row = number;
    row += group;
  }
}

const Kernel& kernel_of(Drives drives, int nodes) {
  const Kernels& all = choose_kernels();
  const Kernels::Nodes& of = drives == Drives::angle ? all.angle : all.acceleration;
  return of.few.nodes == nodes ? of.few : of.many;
}

// The fastest rate of a lane's loop, 1/s. Each path leads from an acceleration back to itself. Its
// rate is the n-th root of the product of its couplings, where n is the number of integrations on
// the path.
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

}  // namespace

const Kernels& choose_kernels() {
  return simd::kernels_by([](auto isa) -> const auto& { return kernels<decltype(isa)>(); });
}

int choose_nodes(double rtol) {
  constexpr double for_many = 3e-7;
  return rtol < for_many ? 12 : 8;
}

void LoopLanes::Free::operator()(void* memory) const {
  ::operator delete(memory, alignment);
}

LoopLanes::LoopLanes(Drives drives, int nodes, Tolerances tolerances, const OutputGrid& grid)
    : kernel_(&kernel_of(drives, nodes)),
      end_(grid.end()),
      reach_(5 * std::pow(tolerances.rtol, 1.0 / nodes)),
      times_(grid.size() + spare_rows, grid.end()),
      rows_(grid.size()),
      workspace_(::operator new(kernel_->workspace, alignment)) {
  for (std::size_t i = 0; i < rows_; ++i) times_[i] = grid[i];
  kernel_->start(workspace_.get(), tolerances.rtol, tolerances.atol);
}

int LoopLanes::live() const {
  return static_cast<int>(
      std::count_if(ways_.begin(), ways_.end(), [](const auto& way) { return way.has_value(); }));
}

void LoopLanes::take_columns(Way& way) {
  for (std::vector<double>* const column : {&way.x, &way.y}) {
    if (spare_.empty()) {
      column->resize(times_.size());
    } else {
      *column = std::move(spare_.back());
      spare_.pop_back();
    }
  }
}

// Starts the next loops in the lanes, all of which are free.
void LoopLanes::begin(LoopStudy& study) {
  std::array<LoopState, group> begun{};
  std::array<std::size_t, group> numbers{};
  int count = 0;
  while (count < group && !exhausted_) {
    const auto at = static_cast<std::size_t>(count);
    if (const auto number = study.begin(begun[at].loop)) {
      numbers[at] = *number;
      ++count;
    } else {
      exhausted_ = true;
    }
  }
  if (count == 0) return;
  Loops loops;
  for (int lane = 0; lane < group; ++lane) {
    put(loops, lane, begun[static_cast<std::size_t>(std::min(lane, count - 1))].loop);
  }
  Couplings couplings;
  kernel_->couplings(loops, couplings);
  for (int lane = 0; lane < count; ++lane) {
    LoopState& state = begun[static_cast<std::size_t>(lane)];
    std::copy_n(state.loop.initial, states, state.state);
    kernel_->load(workspace_.get(), lane, state);
    for (auto& greatest : greatest_.of) greatest[lane] = 0;
    const double rate = fastest_of(couplings, lane) + std::abs(state.loop.frequency);
    Way& way = way_of(lane).emplace();
    way.number = numbers[static_cast<std::size_t>(lane)];
    way.next = rate > 0 ? reach_ / rate : end_;
    // A loop that is not finite is given up when no step of it is finite.
    if (!(way.next > 0)) way.next = end_ * 1e-6;
    take_columns(way);
    way.x[0] = state.loop.initial[0];
    way.y[0] = state.loop.initial[1];
  }
}

void LoopLanes::set_aside(int lane) {
  Aside& aside = aside_.emplace_back(Aside{std::move(*way_of(lane)), {}, {}});
  way_of(lane).reset();
  kernel_->store(workspace_.get(), lane, aside.state);
  for (int i = 0; i < looks; ++i) aside.greatest[i] = greatest_.of[i][lane];
}

void LoopLanes::resume(int lane) {
  Aside& aside = aside_.back();
  kernel_->load(workspace_.get(), lane, aside.state);
  for (int i = 0; i < looks; ++i) greatest_.of[i][lane] = aside.greatest[i];
  way_of(lane) = std::move(aside.way);
  aside_.pop_back();
}

// Makes room when few lanes are at work, and sets aside lanes that hold up the others: on the way
// to infinity Newton's iteration takes many iterations.
void LoopLanes::set_laggards_aside() {
  if (exhausted_ || (laggards_ && !aside_.empty())) return;
  const bool are_few = live() <= few;
  for (int lane = 0; lane < group; ++lane) {
    const auto& way = way_of(lane);
    if (!way) continue;
    const bool is_far = end_ - way->t > soon * way->next;
    if ((are_few && is_far) || (!laggards_ && way->shrinking.count() >= long_since))
      set_aside(lane);
  }
}

// Fills free lanes. New loops all begin together, in empty lanes. Loops set aside resume in any
// lane.
void LoopLanes::fill(LoopStudy& study) {
  if (live() == 0) {
    laggards_ = exhausted_ || aside_.size() >= group;
    if (!laggards_) begin(study);
  }
  for (int lane = 0; lane < group && (laggards_ || exhausted_) && !aside_.empty(); ++lane) {
    if (!way_of(lane)) resume(lane);
  }
}

// A lane without a loop repeats an attempt of another lane, if possible of one whose steps do not
// shrink. Its numbers stay finite and cost next to nothing.
void LoopLanes::idle(int lane) {
  auto of = std::find_if(ways_.begin(), ways_.end(), [](const auto& way) {
    return way.has_value() && way->shrinking.count() == 0;
  });
  if (of == ways_.end()) {
    of = std::find_if(ways_.begin(), ways_.end(), [](const auto& way) { return way.has_value(); });
  }
  LoopState state;
  kernel_->store(workspace_.get(), static_cast<int>(of - ways_.begin()), state);
  state.last_step = 0;
  kernel_->load(workspace_.get(), lane, state);
  spans_.from[lane] = (*of)->t;
  spans_.length[lane] = (*of)->next / 2;
}

double LoopLanes::size(int lane) const {
  LoopState now;
  kernel_->store(workspace_.get(), lane, now);
  double size = 0;
  for (const double value : now.state) {
    if (!std::isfinite(value)) return infinite;
    size = std::max(size, std::abs(value));
  }
  return size;
}

void LoopLanes::plan(int lane, Way& way) {
  const Stride next = stride(end_ - way.t, way.next);
  way.arrives = next.arrives;
  spans_.from[lane] = way.t;
  spans_.length[lane] = next.length;
}

// Returns whether the lane's attempt is accepted. Sets `ending` if this is the loop's last attempt,
// accepted or not.
bool LoopLanes::judge(int lane, const Attempt& attempt, Way& way,
                      std::optional<LoopEnding>& ending) {
  const double h = spans_.length[lane];
  const double error = std::sqrt(attempt.error_squared[lane]);
  // The first step is a guess, so early steps may grow more.
  const double growth =
      step_growth(static_cast<float>(error), kernel_->nodes, way.steps < 3 ? 30 : 8);
  ++way.attempts;
  if (way.attempts > most_attempts || !(h > least_part * way.t)) {
    ending = LoopEnding::given_up;
    return false;
  }
  if (!attempt.converged[lane] || !(error <= 1)) {
    way.rejected = true;
    way.next = h * std::min(attempt.converged[lane] ? 0.8 : unsolved, growth);
    ++statistics_.error_test_failures;
    return false;
  }
  if (!way.arrives && way.shrinking.diverges(h, way.t, [&] { return size(lane); })) {
    ending = LoopEnding::unbounded;
    return false;
  }
  if (way.arrives) ending = LoopEnding::done;
  const double next = h * (way.rejected ? std::min(growth, 1.0) : growth);
  way.next =
      std::min(next, way.shrinking.bound(error, h * growth, kernel_->nodes, Shrinking::Sign::jump));
  way.rejected = false;
  way.t = way.arrives ? end_ : way.t + h;
  ++way.steps;
  ++statistics_.steps;
  return true;
}

// Evaluates the rows up to the end of the last attempt.
void LoopLanes::record(int lane, Way& way) {
  const std::size_t first = way.rows;
  while (way.rows < rows_ && times_[way.rows] <= way.t) ++way.rows;
  if (way.rows == first) return;
  kernel_->evaluate(workspace_.get(), lane, &times_[first], way.rows - first, &way.x[first],
                    &way.y[first]);
}

void LoopLanes::end(int lane, LoopEnding ending, LoopStudy& study) {
  Way way = std::move(*way_of(lane));
  way_of(lane).reset();
  LoopState now;
  kernel_->store(workspace_.get(), lane, now);
  LoopRun run{ending, way.t, way.rows, way.x.data(), way.y.data(), now.state, {}};
  for (int i = 0; i < looks; ++i) run.greatest[i] = greatest_.of[i][lane];
  study.end(way.number, run);
  for (std::vector<double>* const column : {&way.x, &way.y}) spare_.push_back(std::move(*column));
}

void LoopLanes::carry(LoopStudy& study, const std::atomic<bool>& stop) {
  statistics_ = {};
  ways_ = {};
  aside_.clear();
  exhausted_ = laggards_ = false;
  const auto for_each_way = [&](auto use) {
    for (int lane = 0; lane < group; ++lane) {
      if (auto& way = way_of(lane)) use(lane, *way);
    }
  };
  std::array<bool, group> worked;  // had a loop in the last attempt
  worked.fill(true);
  while (!stop.load(std::memory_order_relaxed)) {
    fill(study);
    if (live() == 0) return;
    for (int lane = 0; lane < group; ++lane) {
      const auto at = static_cast<std::size_t>(lane);
      if (worked[at] && !ways_[at]) idle(lane);
      worked[at] = ways_[at].has_value();
    }

    for_each_way([&](int lane, Way& way) { plan(lane, way); });
    Attempt attempt;
    kernel_->attempt(workspace_.get(), spans_, attempt);
    ++statistics_.jacobian_evaluations;
    statistics_.nonlinear_iterations += static_cast<std::size_t>(attempt.turns);
    Lanes taken{}, kept{};
    std::array<std::optional<LoopEnding>, group> endings;
    for_each_way([&](int lane, Way& way) {
      if (!judge(lane, attempt, way, endings[static_cast<std::size_t>(lane)])) return;
      taken.of[lane] = -1;
      if (way.shrinking.count() > 0) kept.of[lane] = -1;
      record(lane, way);
    });
    kernel_->look(workspace_.get(), taken, greatest_);
    kernel_->accept(workspace_.get(), taken, kept);
    for (int lane = 0; lane < group; ++lane) {
      if (const auto ending = endings[static_cast<std::size_t>(lane)]) end(lane, *ending, study);
    }
    set_laggards_aside();
  }
}

}  // namespace bbsim::solve::loop
