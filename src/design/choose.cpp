// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/choose.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/noise.hpp"
#include "design/merit.hpp"
#include "design/multisine.hpp"
#include "tune/cobyla.hpp"

namespace bbsim::design {
namespace {

constexpr std::size_t draws = 48, improved = 2, tries = 70;

struct Draw {
  Multisine shape;
  std::vector<double> numbers;
  double merit;
};

class Choice {
 public:
  Choice(const Task& task, const Experiment& experiment) : task_(task), experiment_(experiment) {}

  std::optional<Chosen> run() {
    std::vector<Draw> drawn = draw();
    std::ranges::stable_sort(drawn, std::ranges::greater{}, &Draw::merit);
    for (std::size_t i = 0; i < std::min(improved, drawn.size()); ++i) improve(drawn[i]);
    if (task_.is_stopped()) return {};
    return std::move(best_);
  }

 private:
  // The merit of numbers, at the largest scale that keeps the limits; nothing if none does.
  std::optional<double> merit(const Multisine& shape, const std::vector<double>& numbers) {
    ++tried_;
    if (task_.progress) {
      const auto done = static_cast<double>(tried_);
      task_.progress(std::min(1.0, done / static_cast<double>(draws + improved * tries)),
                     std::to_string(tried_) + " motions");
    }
    const auto motion = experiment_.within_limits(shape.motion(numbers));
    if (!motion) return {};
    const double merit = merit_of(experiment_.information(*motion).matrix);
    if (!best_ || merit > best_->merit) best_ = Chosen{*motion, merit};
    best_->tried = tried_;
    return merit;
  }

  std::vector<Draw> draw() {
    Noise noise(1);
    const Multisine::Band band{task_.plays, task_.length,
                               highest_multiple(task_.length, task_.rate), task_.axes};
    std::vector<Draw> drawn;
    for (std::size_t i = 0; i < draws && !task_.is_stopped(); ++i) {
      Draw one{Multisine(band, noise), {}, 0};
      for (std::size_t k = 0; k < one.shape.size(); ++k) one.numbers.push_back(noise.normal());
      const auto found = merit(one.shape, one.numbers);
      if (!found) continue;
      one.merit = *found;
      drawn.push_back(std::move(one));
    }
    return drawn;
  }

  void improve(const Draw& from) {
    tune::Cobyla search;
    search.lower.assign(from.numbers.size(), -INFINITY);
    search.upper.assign(from.numbers.size(), INFINITY);
    search.step = 0.4;  // of numbers of size 1
    search.tolerance = 1e-3;
    search.most = tries;
    double worst = -from.merit;
    search.function = [&](const std::vector<double>& numbers, double& value, double*) {
      if (task_.is_stopped()) return false;
      const auto found = merit(from.shape, numbers);
      // What cannot be played is worse than all that can.
      worst = std::max(worst, found ? -*found : worst);
      value = found ? -*found : worst + 1;
      return true;
    };
    tune::minimize(search, from.numbers);
  }

  const Task& task_;
  const Experiment& experiment_;
  std::optional<Chosen> best_;
  std::size_t tried_ = 0;
};

}  // namespace

std::optional<Chosen> choose(const Task& task, const Experiment& experiment) {
  return Choice(task, experiment).run();
}

}  // namespace bbsim::design
