#include "study/error_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solve/collocation/radau.hpp"
#include "solve/hybrid.hpp"
#include "solve/integrate.hpp"
#include "study/reference.hpp"

namespace bbsim::study {
namespace {

using solve::Ending;
using solve::Outcome;
using solve::Tolerances;
using solve::Trajectory;

// The tightest relative tolerance that is tried, about 50 roundings.
constexpr double finest = 1e-14;
// The second run's tolerance, relative to that of the first. Its own error is then a hundredth of
// what is estimated.
constexpr double check_factor = 1e-2;
// An estimate is the distance of two runs, which can be near each other by luck.
constexpr double safety = 1.5;

struct Run {
  Tolerances tolerances;
  Outcome outcome;
  Trajectory rows;
};

// Positions matter in metres: the absolute part of the tolerance is the same fraction of a metre
// as the relative part, but never so coarse that a scene of millimetres would not be resolved.
Tolerances tolerances_of(double rtol) {
  return {rtol, 1e-2 * rtol};
}

// Where the scene ends it, or where something happens that the scene stops at.
bool came_to_its_end(const Outcome& outcome) {
  return outcome.ending == Ending::done || outcome.ending == Ending::stopped;
}

double largest_distance(const model::Model& model, const Trajectory& a, const Trajectory& b) {
  double largest = 0, size = 0;
  const int n = coordinates(model);
  for (std::size_t i = 0; i < std::min(a.rows(), b.rows()); ++i) {
    for (int k = 0; k < n; ++k) {
      largest = std::max(largest, std::abs(a.row(i)[k] - b.row(i)[k]));
      size = std::max(size, std::abs(a.row(i)[k]));
    }
  }
  // Below a few roundings of the position itself no two runs can tell.
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * size;
  return std::max(safety * largest, rounding);
}

}  // namespace

ErrorControlled integrate_to_error(const model::Model& model, Method method, double bound,
                                   const solve::OutputGrid& grid, solve::StateSink& sink,
                                   const solve::Watch& watch) {
  const std::size_t row_size = model.row_size();
  ErrorControlled result;
  const auto run = [&](double rtol, const auto& integrate) {
    Run made{tolerances_of(rtol), {}, Trajectory(row_size)};
    made.outcome = integrate(made.tolerances, made.rows);
    ++result.runs;
    return made;
  };
  const auto asked = [&](Tolerances tolerances, solve::StateSink& rows) {
    return solve::integrate(model, method, tolerances, grid, rows, watch);
  };
  const auto other = [&](Tolerances tolerances, solve::StateSink& rows) {
    return model.hybrid() ? solve::integrate_hybrid_unlike(model, tolerances, grid, rows, watch)
                          : solve::integrate_radau_unlike(model, tolerances, grid, rows, watch);
  };
  const auto deliver = [&](Run& chosen) {
    if (chosen.rows.rows() > 0) sink.accept(0, chosen.rows.rows(), chosen.rows.row(0));
    result.outcome = std::move(chosen.outcome);
    result.tolerances = chosen.tolerances;
  };

  double rtol = std::clamp(bound, 100 * finest, 1e-3);
  Run candidate = run(rtol, asked);
  Run best{candidate.tolerances, {}, Trajectory(row_size)};
  for (;;) {
    const bool first = result.runs == 1;
    if (candidate.outcome.ending == Ending::failed && !first) break;  // too fine a tolerance
    if (!came_to_its_end(candidate.outcome)) {
      deliver(candidate);
      return result;
    }
    const Run check = run(std::max(finest, rtol * check_factor), other);
    if (check.outcome.ending == Ending::interrupted) {
      candidate.outcome.ending = Ending::interrupted;
      deliver(candidate);
      return result;
    }
    const double estimate = came_to_its_end(check.outcome)
                                ? largest_distance(model, candidate.rows, check.rows)
                                : std::numeric_limits<double>::infinity();
    if (first || estimate < result.estimate) {
      result.estimate = estimate;
      best = std::move(candidate);
    }
    result.met = result.estimate <= bound;
    if (result.met || rtol <= finest || !came_to_its_end(check.outcome)) break;
    // The error is about proportional to the tolerance; a margin of three on the way to the bound.
    rtol = std::max(finest, rtol * std::clamp(bound / (3 * estimate), 1e-5, 0.3));
    candidate = run(rtol, asked);
  }
  deliver(best);
  return result;
}

}  // namespace bbsim::study
