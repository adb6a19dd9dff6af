#include "replay/stage.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bbsim::replay {
namespace {

// How far the runs and their references go from home. A run that reaches infinity is not to shrink
// all that went before: what is twenty times as far as half of the rows does not count.
double extent(const Scene& scene) {
  std::vector<double> distances;
  double reference = 0;
  for (const Run& run : scene.runs) {
    const std::vector<double> x = coordinate(run, "x"), y = coordinate(run, "y");
    for (std::size_t row = 0; row < x.size(); ++row) {
      const double far = std::max(std::abs(x[row]), std::abs(y[row]));
      if (std::isfinite(far)) distances.push_back(far);
    }
    for (const auto& point : run.reference) {
      const double far = std::max(std::abs(point[0]), std::abs(point[1]));
      if (std::isfinite(far)) reference = std::max(reference, far);
    }
  }
  if (distances.empty()) return reference;
  std::sort(distances.begin(), distances.end());
  const double middle = std::max(distances[distances.size() / 2], reference);
  const double all = distances.back();
  return std::max(reference, middle > 0 ? std::min(all, 20 * middle) : all);
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
    constexpr double margin = 1.2;
    const double ball = stage.ball_given ? *sized->ball_radius : 0;
    stage.width = stage.depth = 2 * std::max(margin * extent(scene), 6 * ball);
    if (stage.width == 0) stage.width = stage.depth = 0.3;
  }
  constexpr double ball_part = 1.0 / 30;
  stage.ball_radius =
      stage.ball_given ? *sized->ball_radius : ball_part * std::min(stage.width, stage.depth);
  return stage;
}

}  // namespace bbsim::replay
