#include "solve/collocation/radau.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>
#include <variant>

#include "solve/row_block.hpp"

namespace bbsim::solve {
namespace collocation {
namespace {

constexpr std::align_val_t alignment{64};

double highest_frequency(const model::Model& model) {
  return std::visit(
      [](const auto& system) {
        if constexpr (std::decay_t<decltype(system)>::linear) {
          return system.motion().highest_frequency();
        } else {
          return system.reference().highest_frequency();
        }
      },
      model.system);
}

// z such that (z/2)^s / s! = tolerance: half a step of a sinusoid, in radians, whose s-th
// Legendre coefficient has just fallen to the tolerance.
double resolved(int stages, double tolerance) {
  return 2 * std::exp((std::log(tolerance) + std::lgamma(stages + 1.0)) / stages);
}

// The size of the next step relative to one whose error was `error`.
double growth(double error, int stages) {
  constexpr double safety = 0.9, least = 0.1, most = 8;
  if (!(error > 0)) return error == 0 ? most : least;
  return std::clamp(safety * std::pow(error, -1.0 / (stages + 1)), least, most);
}

}  // namespace

void Integrator::Free::operator()(void* memory) const {
  ::operator delete(memory, alignment);
}

int choose_stages(double rtol) {
  return rtol > 3e-6 ? 8 : rtol > 3e-9 ? 12 : 16;
}

Integrator::Integrator(const model::Model& model, const KernelSet& kernels, int stages)
    : model_(model),
      kernel_(&kernels.kernels[stages == 8    ? 0
                               : stages == 12 ? 1
                                              : 2][model.system.index()]),
      row_size_(model.size() + (model.gamma ? 1 : 0)),
      highest_frequency_(highest_frequency(model)),
      workspace_(::operator new(kernel_->workspace, alignment)) {
  view_ = std::visit(
      [](const auto& system) {
        using View = decltype(system.view());
        static_assert(std::is_trivially_destructible_v<View>);
        std::unique_ptr<void, Free> memory(::operator new(sizeof(View), alignment));
        new (memory.get()) View(system.view());
        return memory;
      },
      model.system);
}

std::vector<double> Integrator::state() const {
  std::vector<double> z(model_.size());
  kernel_->state(workspace_.get(), z.data());
  return z;
}

Integrator::Run Integrator::run(Tolerances tolerances, const OutputGrid& grid, RowBlock& rows,
                                const Watch& watch) {
  void* const workspace = workspace_.get();
  const int stages = kernel_->stages;
  kernel_->start(workspace, {view_.get(), model_.initial.data(), tolerances.rtol, tolerances.atol,
                             model_.gamma});
  Run result;
  double* const first = rows.next();
  std::copy(model_.initial.begin(), model_.initial.end(), first);
  if (model_.gamma) first[model_.size()] = 0;

  const double end = grid.end();
  const double reach = resolved(stages, tolerances.rtol);
  // A sinusoid shorter than the distance between nodes would be mistaken for a longer one.
  const double widest = highest_frequency_ > 0 ? 1.6 * stages / highest_frequency_
                                               : std::numeric_limits<double>::max();

  double t = 0;
  std::size_t next_row = 1, next_stop = 0;
  double h = [&] {
    const double rate = std::max(kernel_->rate(workspace, 0), highest_frequency_);
    return rate > 0 ? 2 * reach / rate : end;
  }();
  if (!(h > 0)) h = end * 1e-6;

  std::array<double, 64> times;
  bool rejected = false;
  for (;;) {
    const double target = next_stop < model_.stops.size() ? model_.stops[next_stop] : end;
    const double left = target - t;
    h = std::min(h, widest);
    // The steps to the target are alike.
    const double pieces = std::ceil(left / h * (1 - 1e-3));
    const bool arrives = pieces <= 1;
    const double step = arrives ? left : pieces < 4 ? left / pieces : h;
    if (!(step > 4 * std::numeric_limits<double>::epsilon() * t) && !arrives) {
      result.ending = Ending::failed;
      result.reason = "the step shrank to the rounding of the time itself";
      break;
    }

    Attempt attempt;
    kernel_->attempt(workspace, t, step, &attempt);
    result.statistics.rhs_evaluations += static_cast<std::size_t>(attempt.right_hand_sides);
    result.statistics.jacobian_evaluations += static_cast<std::size_t>(attempt.jacobians);
    result.statistics.nonlinear_iterations += static_cast<std::size_t>(attempt.iterations);
    if (attempt.verdict != Verdict::converged) {
      h = step * (attempt.verdict == Verdict::not_finite ? 0.1 : 0.4);
      rejected = true;
      ++result.statistics.error_test_failures;
      continue;
    }
    result.worst_state = attempt.worst_state;
    if (!(attempt.error <= 1)) {
      h = step * std::min(0.9, growth(attempt.error, stages));
      rejected = true;
      ++result.statistics.error_test_failures;
      continue;
    }

    const double reached = arrives ? target : t + step;
    while (next_row < grid.size() && grid[next_row] <= reached) {
      std::size_t count = 0;
      while (count < times.size() && next_row + count < grid.size() &&
             grid[next_row + count] <= reached) {
        times[count] = grid[next_row + count];
        ++count;
      }
      double* const out = rows.next(count);
      kernel_->evaluate(workspace, times.data(), count, out);
      next_row += count;
    }
    kernel_->accept(workspace);
    t = reached;
    ++result.statistics.steps;
    const double factor = growth(attempt.error, stages);
    h = step * (rejected ? std::min(factor, 1.0) : factor);
    rejected = false;

    if (arrives && t == end) break;
    if (arrives) ++next_stop;
    if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) {
      result.ending = Ending::interrupted;
      break;
    }
    if (watch.progress && result.statistics.steps % 256 == 0) watch.progress(t);
  }
  result.reached = t;
  return result;
}

}  // namespace collocation

namespace {

Outcome integrate_with(int stages, const model::Model& model, Tolerances tolerances,
                       const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  collocation::Integrator integrator(model, collocation::choose_kernels(), stages);
  RowBlock rows(sink, integrator.row_size());
  const collocation::Integrator::Run run = integrator.run(tolerances, grid, rows, watch);
  rows.flush();
  Outcome outcome;
  outcome.ending = run.ending;
  outcome.method = Method::radau;
  outcome.reached = run.reached;
  outcome.rows = rows.rows();
  outcome.statistics = run.statistics;
  if (run.ending == Ending::failed) {
    outcome.reason = run.reason;
    outcome.worst_state = static_cast<std::size_t>(run.worst_state);
    outcome.last_state = integrator.state();
  }
  return outcome;
}

}  // namespace

Outcome integrate_radau(const model::Model& model, Tolerances tolerances, const OutputGrid& grid,
                        StateSink& sink, const Watch& watch) {
  const int stages = collocation::choose_stages(tolerances.rtol);
  return integrate_with(stages, model, tolerances, grid, sink, watch);
}

Outcome integrate_radau_unlike(const model::Model& model, Tolerances tolerances,
                               const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  const int stages = collocation::choose_stages(tolerances.rtol) == 16 ? 12 : 16;
  return integrate_with(stages, model, tolerances, grid, sink, watch);
}

}  // namespace bbsim::solve
