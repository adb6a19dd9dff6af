// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/choose.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/noise.hpp"
#include "design/merit.hpp"
#include "design/multisine.hpp"
#include "tune/cobyla.hpp"

namespace bbsim::design {
namespace {

constexpr std::size_t draws = 60, improved = 4, tries = 100;

struct Draw {
  Multisine shape;
  std::vector<double> numbers;
  double merit;
  double scale;   // of the shape
  Pair position;  // of the ball, m
};

class Choice {
 public:
  Choice(const Task& task, const Experiment& experiment, double frequency)
      : task_(task), experiment_(experiment), frequency_(frequency), limits_(Use{}.all().size()) {}

  std::optional<Chosen> run() {
    std::vector<Draw> drawn = draw();
    std::ranges::stable_sort(drawn, std::ranges::greater{}, &Draw::merit);
    for (std::size_t i = 0; i < std::min(improved, drawn.size()); ++i) improve(drawn[i]);
    if (task_.is_stopped()) return {};
    if (best_) best_->tried = tried_;
    return std::move(best_);
  }

 private:
  void count() {
    ++tried_;
    if (!task_.progress) return;
    task_.progress(static_cast<double>(tried_) / static_cast<double>(draws + improved * tries),
                   std::to_string(tried_) + " motions");
  }

  // The merit of a motion that keeps the limits. Records the best motion.
  double merit(const Motion& motion) {
    const double merit = merit_of(experiment_.information(motion).matrix);
    if (!best_ || merit > best_->merit) best_ = Chosen{motion, merit};
    return merit;
  }

  std::vector<Draw> draw() {
    Noise noise(1);
    const Multisine::Band band{task_.plays, task_.length,
                               highest_multiple(task_.length, task_.rate),
                               frequency_ * task_.length / turn, task_.axes};
    std::vector<Draw> drawn;
    for (std::size_t i = 0; i < draws && !task_.is_stopped(); ++i) {
      Draw one{Multisine(band, noise), {}, 0, 1, {0, 0}};
      for (std::size_t k = 0; k < one.shape.size(); ++k) one.numbers.push_back(noise.normal());
      count();
      const auto scaled = experiment_.within_limits(one.shape.motion(one.numbers));
      if (!scaled) continue;
      one.merit = merit(scaled->motion);
      one.scale = scaled->scale;
      one.position = scaled->motion.position;
      drawn.push_back(std::move(one));
    }
    return drawn;
  }

  // Takes the numbers of the shape, then those of the ball's initial position.
  [[nodiscard]] Motion motion_of(const Draw& from, const std::vector<double>& numbers) const {
    constexpr double place = 0.05;  // m
    Motion motion = from.shape.motion(numbers).scaled(from.scale);
    if (!motion.centered) return motion;
    for (std::size_t i = 0; i < 2; ++i) {
      motion.position[i] = from.position[i] + place * numbers[from.numbers.size() + i];
    }
    return motion;
  }

  // Improves the merit under the limits. If each motion were scaled to the limits instead, the
  // merit would have kinks wherever another limit becomes the closest.
  void improve(const Draw& from) {
    std::vector<double> start = from.numbers;
    if (task_.plays == Plays::tilts) start.insert(start.end(), {0, 0});
    tune::Cobyla search;
    search.lower.assign(start.size(), -INFINITY);
    search.upper.assign(start.size(), INFINITY);
    search.constraints = limits_;
    search.step = 0.3;  // of numbers of size 1
    search.tolerance = 1e-3;
    search.most = tries;
    double worst = -from.merit, most = from.merit;
    Motion best = motion_of(from, start);
    search.function = [&](const std::vector<double>& numbers, double& value, double* constraints) {
      if (task_.is_stopped()) return false;
      count();
      const Motion motion = motion_of(from, numbers);
      const auto use = experiment_.use(motion);
      if (!use) {  // worse than any motion that runs
        value = worst + 1;
        std::fill_n(constraints, limits_, 1.0);
        return true;
      }
      const double merit = merit_of(experiment_.information(motion).matrix);
      value = -merit;
      worst = std::max(worst, value);
      const auto used = use->all();
      for (std::size_t i = 0; i < limits_; ++i) constraints[i] = used[i] - 1;
      // The merit at the scale that keeps the limits.
      const double kept = merit - 2 * static_cast<double>(task_.keys.size()) *
                                      std::max(0.0, std::log(use->greatest()));
      if (kept > most) {
        most = kept;
        best = motion;
      }
      return true;
    };
    tune::minimize(search, start);
    if (const auto scaled = experiment_.within_limits(best))
      static_cast<void>(merit(scaled->motion));
  }

  const Task& task_;
  const Experiment& experiment_;
  const double frequency_;
  const std::size_t limits_;
  std::optional<Chosen> best_;
  std::size_t tried_ = 0;
};

}  // namespace

std::optional<Chosen> choose(const Task& task, const Experiment& experiment, double frequency) {
  return Choice(task, experiment, frequency).run();
}

}  // namespace bbsim::design
