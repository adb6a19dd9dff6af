// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/error_control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solve/integrate.hpp"
#include "study/checks.hpp"

namespace bbsim::study {
namespace {

using solve::Ending;
using solve::Trajectory;

struct Candidate {
  double rtol;
  Track track;
  Trajectory rows;
};

}  // namespace

ErrorControlled integrate_to_error(const model::Model& model, Method method, double bound,
                                   const solve::OutputGrid& grid, solve::StateSink& sink,
                                   const solve::Watch& watch) {
  ErrorControlled result;
  // `pieces` receives every run that may be chosen. If a later run was not chosen, the chosen one
  // is run again for it.
  solve::PieceSink* const pieces = sink.pieces();
  double received_rtol = 0;  // the relative tolerance of the last run that it received
  const auto run = [&](double rtol) {
    Candidate tried{rtol, {}, Trajectory(model.row_size(), pieces)};
    Tracker tracker(model, tried.track.positions, &tried.rows);
    received_rtol = rtol;
    tried.track.outcome =
        solve::integrate(model, method, tolerances_of(rtol), grid, tracker, watch);
    ++result.runs;
    return tried;
  };
  const auto deliver = [&](Candidate& chosen) {
    if (pieces != nullptr && received_rtol != chosen.rtol) {
      chosen.track.outcome.ending = run(chosen.rtol).track.outcome.ending;
    }
    if (chosen.rows.rows() > 0) sink.accept(0, chosen.rows.rows(), chosen.rows.row(0));
    result.outcome = std::move(chosen.track.outcome);
    result.tolerances = tolerances_of(chosen.rtol);
  };

  Checks checks(model, grid, watch);
  Candidate candidate = run(std::clamp(bound, 100 * finest_rtol, 1e-3));
  Candidate best{candidate.rtol, {}, Trajectory(model.row_size())};
  bool confirmed = false;  // whether the best estimate is confirmed
  for (;;) {
    const bool first = result.runs == 1;
    const double rtol = candidate.rtol;
    if (candidate.track.outcome.ending == Ending::failed && !first)
      // The tolerance was too fine.
      break;
    if (!came_to_its_end(candidate.track.outcome)) {
      result.runs += checks.runs();
      deliver(candidate);
      return result;
    }
    double estimate = checks.estimate(candidate.track, rtol, false);
    const bool confirm = estimate <= bound;
    if (confirm) estimate = checks.estimate(candidate.track, rtol, true);
    if (checks.interrupted()) {
      candidate.track.outcome.ending = Ending::interrupted;
      best = std::move(candidate);
      break;
    }
    if (first || estimate < result.estimate) {
      result.estimate = estimate;
      confirmed = confirm;
      best = std::move(candidate);
    }
    result.met = result.estimate <= bound && confirmed;
    if (result.met || rtol <= finest_rtol || std::isinf(estimate)) break;
    // The error is about proportional to the tolerance. Aim at a third of the bound.
    candidate = run(std::max(finest_rtol, rtol * std::clamp(bound / (3 * estimate), 1e-5, 0.3)));
  }
  if (!confirmed && came_to_its_end(best.track.outcome)) {
    result.estimate = checks.estimate(best.track, best.rtol, true);
    result.met = result.estimate <= bound;
    if (checks.interrupted()) best.track.outcome.ending = Ending::interrupted;
  }
  result.runs += checks.runs();
  result.row_estimates = checks.row_estimates(best.track, result.estimate);
  deliver(best);
  return result;
}

}  // namespace bbsim::study
