// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace bbsim::replay {
namespace {

// The greatest distances of the runs and their references from home, along each axis.
struct Extent {
  double x = 0, y = 0;

  void include(double at_x, double at_y) {
    if (!(std::abs(at_x) <= largest_drawn && std::abs(at_y) <= largest_drawn)) return;
    x = std::max(x, std::abs(at_x));
    y = std::max(y, std::abs(at_y));
  }
};

Extent extent(const Scene& scene) {
  Extent all;
  for (const Run& run : scene.runs) {
    const std::vector<double> x = coordinate(run, "x"), y = coordinate(run, "y");
    for (std::size_t row = 0; row < x.size(); ++row) all.include(x[row], y[row]);
    for (const auto& point : run.reference) all.include(point[0], point[1]);
  }
  return all;
}

// Makes a plate with some margin around the paths, for a ball of this radius.
void fit_plate(Stage& stage, const Extent& paths, double ball) {
  constexpr double margin = 1.2, thin = 1e-6, beam = 1.0 / 8;
  const double far = std::max(paths.x, paths.y);
  if (far == 0 && ball == 0) {
    stage.width = stage.depth = 0.3;
    return;
  }
  stage.width = stage.depth = 2 * std::max(margin * far, 6 * ball);
  const double across = std::max(beam * stage.width, std::min(4 * ball, stage.width));
  if (paths.y < thin * paths.x) stage.depth = across;
  if (paths.x < thin * paths.y) stage.width = across;
}

}  // namespace

Stage stage_of(const Scene& scene) {
  Stage stage;
  for (const Run& run : scene.runs) {
    if (run.plate.size) {
      stage.width = (*run.plate.size)[0];
      stage.depth = (*run.plate.size)[1];
    } else if (run.plate.diameter) {
      stage.width = stage.depth = *run.plate.diameter;
      stage.round = true;
    } else {
      continue;
    }
    stage.plate_given = true;
    break;
  }
  const auto sized = std::find_if(scene.runs.begin(), scene.runs.end(),
                                  [](const Run& run) { return run.ball_radius.has_value(); });
  stage.ball_given = sized != scene.runs.end();
  if (!stage.plate_given) {
    fit_plate(stage, extent(scene), stage.ball_given ? *sized->ball_radius : 0);
  }
  // On a beam, the ball may be as large as on a plate of the same length.
  constexpr double ball_part = 1.0 / 30;
  const double side =
      stage.plate_given ? std::min(stage.width, stage.depth) : std::max(stage.width, stage.depth);
  stage.ball_radius = stage.ball_given ? *sized->ball_radius : ball_part * side;
  return stage;
}

}  // namespace bbsim::replay
