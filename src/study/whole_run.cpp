// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The allowance of a run.
//
// In each step, an integrator with tolerances rtol and atol may make an error of rtol |z| + atol in
// each state. An error in a speed lets the position drift by that times the rest of the scene.
// If a scene grows exponentially, an error grows as the solution does, so |z| is the solution's
// largest value. Hence, for positions, for u = r gamma' and for r gamma,
//
//     allowance = steps (rtol size + atol) (1 + end / 1 s).
#include "study/whole_run.hpp"

#include <algorithm>
#include <cmath>

#include "solve/output_grid.hpp"

namespace bbsim::study {

WholeRun whole_run(const Scenario& scene, const solve::Watch& watch, Method method,
                   solve::Tolerances tolerances) {
  const model::Model model = model::assemble(scene, true);
  const solve::OutputGrid grid(scene.time);
  solve::Trajectory rows(model.row_size());
  const solve::Outcome outcome =
      solve::integrate(model, method, tolerances, grid, rows, {watch.stop, {}});
  WholeRun result;
  result.done = outcome.ending == solve::Ending::done && rows.rows() == grid.size();
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const model::Sample sample = model.sample(grid[i], rows.row(i));
    const model::BallMotion& ball = sample.ball;
    for (const double value :
         {ball.x, ball.y, ball.x_dot, ball.y_dot, scene.ball.radius * ball.gamma_dot}) {
      result.size = larger(result.size, std::abs(value));
    }
    result.samples.push_back(sample);
  }
  result.allowance = static_cast<double>(outcome.statistics.steps) *
                     (tolerances.rtol * result.size + tolerances.atol) * (1 + scene.time.end);
  return result;
}

}  // namespace bbsim::study
