// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/ensemble/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "simd/instruction_set.hpp"
#include "solve/collocation/step_length.hpp"

namespace bbsim::solve::ensemble {

namespace {

constexpr std::align_val_t alignment{64};
constexpr double infinite = std::numeric_limits<double>::infinity();

// A case that takes more attempts is left to another integrator.
constexpr std::size_t most_attempts = 100'000;
// A case is given up if its step is below this fraction of the time. Shrinking detects motions that
// go to infinity before that.
constexpr double least_part = 1e-8;

// Lanes are refilled when at most this many are at work.
constexpr int few = group / 2;
// This many shrinking steps usually mean that a motion goes to infinity.
constexpr int long_since = 3;
// A case that is at most this many steps from its end stays in its lane.
constexpr double soon = 2;

// The first step times the fastest rate of the motion. For a given motion with small angles it may
// be longer than resolved(): 1.25 to 1.6 times with up to 12 nodes, 1.1 to 1.25 times with 16.
double first_reach(Actuation actuation, int nodes, double rtol) {
  if (actuation != Actuation::given) return 5 * std::pow(rtol, 1.0 / nodes);
  return (nodes < 16 ? 1.25 : 1.08) * resolved(nodes, rtol);
}

}  // namespace

const Kernels& choose_kernels() {
  return simd::kernels_by([](auto isa) -> const auto& { return kernels<decltype(isa)>(); });
}

const Kernel& kernel_of(const Kernels& kernels, Actuation actuation, int nodes) {
  return *std::find_if(std::begin(kernels.of), std::end(kernels.of), [&](const Kernel& kernel) {
    return kernel.actuation == actuation && kernel.nodes == nodes;
  });
}

int choose_nodes(Actuation actuation, double rtol, double angle) {
  if (actuation != Actuation::given) return rtol < 3e-7 ? 12 : 8;
  const auto cost = [&](int nodes) {
    const double steps = std::max(1.0, std::ceil(angle / first_reach(actuation, nodes, rtol)));
    return steps * nodes * (nodes + 15.0);  // sums over nodes, and coefficients at each
  };
  return std::min({8, 12, 16}, [&](int a, int b) { return cost(a) < cost(b); });
}

void Ensemble::Free::operator()(void* memory) const {
  ::operator delete(memory, alignment);
}

Ensemble::Ensemble(Problem problem, int nodes, Tolerances tolerances)
    : kernel_(&kernel_of(choose_kernels(), problem.actuation, nodes)),
      stops_(std::move(problem.stops)),
      end_(problem.grid.end()),
      reach_(first_reach(problem.actuation, nodes, tolerances.rtol)),
      rows_(problem.rows ? problem.grid.size() : 0),
      workspace_(::operator new(kernel_->workspace, alignment)) {
  stops_.push_back(end_);
  if (rows_ > 0) times_.assign(rows_ + spare_rows, end_);
  for (std::size_t i = 0; i < rows_; ++i) times_[i] = problem.grid[i];
  kernel_->start(workspace_.get(), {tolerances.rtol, tolerances.atol, problem.terms});
}

int Ensemble::live() const {
  return static_cast<int>(std::count_if(cases_.begin(), cases_.end(),
                                        [](const auto& active) { return active.has_value(); }));
}

void Ensemble::take_columns(ActiveCase& active) {
  for (std::vector<double>* const column : {&active.x, &active.y}) {
    if (spare_.empty()) {
      column->resize(times_.size());
    } else {
      *column = std::move(spare_.back());
      spare_.pop_back();
    }
  }
}

// Starts the next cases in the lanes. All lanes must be free.
void Ensemble::begin(Study& study) {
  std::array<std::size_t, group> which;
  int count = 0;
  while (count < group && !exhausted_) {
    Progress& progress = begun_[static_cast<std::size_t>(count)];
    if (const auto number = study.begin(progress.of)) {
      std::copy_n(progress.of.initial, states, progress.state);
      std::fill_n(progress.acceleration, velocities, 0.0);
      progress.last_step = 0;
      kernel_->load(workspace_.get(), count, progress);
      which[static_cast<std::size_t>(count++)] = *number;
    } else {
      exhausted_ = true;
    }
  }
  if (count == 0) return;
  alignas(64) double rates[group];
  kernel_->rates(workspace_.get(), rates);
  for (int lane = 0; lane < count; ++lane) {
    const Case& begun = begun_[static_cast<std::size_t>(lane)].of;
    for (auto& greatest : greatest_.of) greatest[lane] = 0;
    ActiveCase& active = case_in(lane).emplace();
    active.number = which[static_cast<std::size_t>(lane)];
    active.repeats_after = begun.repeats_after;
    active.control.next = rates[lane] > 0 ? reach_ / rates[lane] : end_;
    // The rate is infinite. The case is given up later if none of its steps is finite.
    if (!(active.control.next > 0)) active.control.next = end_ * 1e-6;
    if (rows_ == 0) continue;
    take_columns(active);
    active.x[0] = begun.initial[0];
    active.y[0] = begun.initial[1];
  }
}

void Ensemble::set_aside(int lane) {
  Aside& aside = aside_.emplace_back(Aside{std::move(*case_in(lane)), {}, {}});
  case_in(lane).reset();
  kernel_->store(workspace_.get(), lane, aside.progress);
  for (int i = 0; i < size_count; ++i) aside.greatest[i] = greatest_.of[i][lane];
}

void Ensemble::resume(int lane) {
  Aside& aside = aside_.back();
  kernel_->load(workspace_.get(), lane, aside.progress);
  for (int i = 0; i < size_count; ++i) greatest_.of[i][lane] = aside.greatest[i];
  case_in(lane) = std::move(aside.active);
  aside_.pop_back();
}

// Sets cases aside: all that are far from their end when few lanes are at work, and those that hold
// up the others. On the active to infinity Newton's iteration takes many iterations.
void Ensemble::set_laggards_aside() {
  if (exhausted_ || (laggards_ && !aside_.empty())) return;
  const bool are_few = live() <= few;
  for (int lane = 0; lane < group; ++lane) {
    const auto& active = case_in(lane);
    if (!active) continue;
    const bool is_far = end_ - active->t > soon * active->control.next;
    if ((are_few && is_far) || (!laggards_ && active->shrinking.count() >= long_since))
      set_aside(lane);
  }
}

// Fills free lanes. New cases all begin together, in empty lanes. Cases set aside resume in any
// lane.
void Ensemble::fill(Study& study) {
  if (live() == 0) {
    laggards_ = exhausted_ || aside_.size() >= group;
    if (!laggards_) begin(study);
  }
  for (int lane = 0; lane < group && (laggards_ || exhausted_) && !aside_.empty(); ++lane) {
    if (!case_in(lane)) resume(lane);
  }
}

// Lets a lane without a case repeat an attempt of another lane, if possible of one whose steps do
// not shrink. Its numbers then stay finite and cost next to nothing.
void Ensemble::idle(int lane) {
  auto of = std::find_if(cases_.begin(), cases_.end(), [](const auto& active) {
    return active.has_value() && active->shrinking.count() == 0;
  });
  if (of == cases_.end()) {
    of = std::find_if(cases_.begin(), cases_.end(),
                      [](const auto& active) { return active.has_value(); });
  }
  Progress state;
  kernel_->store(workspace_.get(), static_cast<int>(of - cases_.begin()), state);
  state.last_step = 0;
  kernel_->load(workspace_.get(), lane, state);
  spans_.from[lane] = (*of)->t;
  spans_.length[lane] = (*of)->control.next / 2;
}

double Ensemble::size(int lane) const {
  Progress now;
  kernel_->store(workspace_.get(), lane, now);
  double size = 0;
  for (const double value : now.state) {
    if (!std::isfinite(value)) return infinite;
    size = std::max(size, std::abs(value));
  }
  return size;
}

void Ensemble::plan(int lane, ActiveCase& active) {
  const Stride next = stride(stops_[active.stop] - active.t, active.control.next);
  active.arrives = next.arrives;
  spans_.from[lane] = active.t;
  spans_.length[lane] = next.length;
}

// Returns whether the lane's attempt is accepted. Sets `ending` if this is the case's last attempt,
// accepted or not.
bool Ensemble::judge(int lane, const Attempt& attempt, ActiveCase& active,
                     std::optional<Ending>& ending) {
  const double h = spans_.length[lane];
  const double error = std::sqrt(attempt.error_squared[lane]);
  ++active.attempts;
  if (active.attempts > most_attempts || !(h > least_part * active.t)) {
    ending = Ending::given_up;
    return false;
  }
  if (attempt.converged[lane] && error <= 1 && active.arrives && active.stop + 1 == stops_.size()) {
    active.t = end_;
    ending = Ending::done;
    ++statistics_.steps;
    return true;
  }
  // The first step is a guess, so early steps may grow more.
  const double growth =
      step_growth(static_cast<float>(error), kernel_->nodes, active.steps < 3 ? 30 : 8);
  if (!attempt.converged[lane] || !(error <= 1)) {
    active.control.reject(
        h, attempt.converged[lane] ? growth : std::min(StepControl::unsolved, growth));
    ++statistics_.error_test_failures;
    return false;
  }
  if (!active.arrives && active.shrinking.diverges(h, active.t, [&] { return size(lane); })) {
    ending = Ending::unbounded;
    return false;
  }
  active.control.accept(
      h, active.arrives, growth,
      active.shrinking.bound(error, h * growth, kernel_->nodes, Shrinking::Sign::jump));
  active.t = active.arrives ? stops_[active.stop] : active.t + h;
  if (active.arrives) {
    active.shrinking.interrupt();
    ++active.stop;
  }
  ++active.steps;
  ++statistics_.steps;
  return true;
}

// Evaluates the rows up to the end of the last attempt.
void Ensemble::record(int lane, ActiveCase& active) {
  const std::size_t first = active.rows;
  while (active.rows < rows_ && times_[active.rows] <= active.t) ++active.rows;
  if (active.rows == first) return;
  kernel_->evaluate(workspace_.get(), lane, &times_[first], active.rows - first, &active.x[first],
                    &active.y[first]);
}

void Ensemble::end(int lane, Ending ending, Study& study) {
  ActiveCase active = std::move(*case_in(lane));
  case_in(lane).reset();
  Progress now;
  kernel_->store(workspace_.get(), lane, now);
  Result run{
      ending, active.t, std::min(active.rows, rows_), active.x.data(), active.y.data(), now.state,
      {},     &now.of};
  for (int i = 0; i < size_count; ++i) run.greatest[i] = greatest_.of[i][lane];
  study.end(active.number, run);
  if (rows_ == 0) return;
  for (std::vector<double>* const column : {&active.x, &active.y})
    spare_.push_back(std::move(*column));
}

void Ensemble::carry(Study& study, const std::atomic<bool>& stop) {
  statistics_ = {};
  cases_ = {};
  aside_.clear();
  exhausted_ = laggards_ = false;
  const auto for_each_case = [&](auto use) {
    for (int lane = 0; lane < group; ++lane) {
      if (auto& active = case_in(lane)) use(lane, *active);
    }
  };
  std::array<bool, group> worked;  // had a case in the last attempt
  worked.fill(true);
  while (!stop.load(std::memory_order_relaxed)) {
    fill(study);
    if (live() == 0) return;
    for (int lane = 0; lane < group; ++lane) {
      const auto at = static_cast<std::size_t>(lane);
      if (worked[at] && !cases_[at]) idle(lane);
      worked[at] = cases_[at].has_value();
    }

    Lanes taken{}, kept{}, turning{};
    for_each_case([&](int lane, ActiveCase& active) {
      plan(lane, active);
      if (active.t < active.repeats_after) turning.of[lane] = -1;
    });
    Attempt attempt;
    kernel_->attempt(workspace_.get(), spans_, attempt);
    ++statistics_.jacobian_evaluations;
    statistics_.nonlinear_iterations += static_cast<std::size_t>(attempt.turns);
    std::array<std::optional<Ending>, group> endings;
    for_each_case([&](int lane, ActiveCase& active) {
      if (!judge(lane, attempt, active, endings[static_cast<std::size_t>(lane)])) return;
      taken.of[lane] = -1;
      if (active.shrinking.count() > 0) kept.of[lane] = -1;
      record(lane, active);
    });
    kernel_->raise_maxima(workspace_.get(), taken, turning, greatest_);
    kernel_->accept(workspace_.get(), taken, kept);
    for (int lane = 0; lane < group; ++lane) {
      if (const auto ending = endings[static_cast<std::size_t>(lane)]) end(lane, *ending, study);
    }
    set_laggards_aside();
  }
}

}  // namespace bbsim::solve::ensemble
