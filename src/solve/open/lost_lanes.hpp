// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Decides which lanes of a group in lock step are given up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bbsim::solve {

template <std::size_t group>
class LostLanes {
 public:
  // How far a lane may fall behind the others. A lane that is given up without need is run again
  // alone and only costs time.
  struct Patience {
    double notable;       // lanes with errors up to this do not hold others back
    double holding_back;  // a lane with an error above this times the median does
    int most_held;        // the number of attempts in which a lane may do so
  };

  explicit LostLanes(const Patience& patience) : patience_(patience) {}

  // All lanes are good.
  void begin() {
    lost_.fill(false);
    twins_.fill(false);
    held_.fill(0);
  }

  void give_up(std::size_t lane) { lost_[lane] = true; }
  void give_up_all() { lost_.fill(true); }
  [[nodiscard]] bool all() const {
    return std::find(lost_.begin(), lost_.end(), false) == lost_.end();
  }

  // Returns the largest error of the lanes that continue, relative to the tolerance; an error that
  // is not finite counts as infinite. Gives up lanes whose error is above `bearable`, and lanes
  // that held the others back for too long.
  double judge(const double* errors, double bearable) {
    std::array<double, group> all, sorted;
    std::ptrdiff_t alive = 0;
    bool fine = true;
    for (std::size_t lane = 0; lane < group; ++lane) {
      all[lane] = std::isfinite(errors[lane]) ? errors[lane] : infinite;
      if (lost_[lane]) continue;
      sorted[static_cast<std::size_t>(alive++)] = all[lane];
      fine = fine && all[lane] <= patience_.notable;
    }
    double far = infinite;
    if (!fine) {
      const auto middle = sorted.begin() + alive / 2;
      std::nth_element(sorted.begin(), middle, sorted.begin() + alive);
      far = patience_.holding_back * *middle;
    }
    double worst = 0;
    for (std::size_t lane = 0; lane < group; ++lane) {
      if (lost_[lane]) continue;
      if (all[lane] > patience_.notable && all[lane] > far) ++held_[lane];
      if (all[lane] > bearable || held_[lane] > patience_.most_held) {
        lost_[lane] = true;
      } else {
        worst = std::max(worst, all[lane]);
      }
    }
    return worst;
  }

  // Makes lost lanes copies of the first good lane, by twin(lane, of). Their numbers stay finite
  // and cost nothing.
  template <class Twin>
  void replace(Twin twin) {
    if (lost_ == twins_) return;
    twins_ = lost_;
    const auto healthy = std::find(lost_.begin(), lost_.end(), false);
    if (healthy == lost_.end()) return;
    for (std::size_t lane = 0; lane < group; ++lane) {
      if (lost_[lane]) twin(static_cast<int>(lane), static_cast<int>(healthy - lost_.begin()));
    }
  }

  // Which of the first `count` lanes are not lost.
  [[nodiscard]] std::array<bool, group> carried(int count) const {
    std::array<bool, group> kept;
    for (std::size_t lane = 0; lane < group; ++lane) {
      kept[lane] = !lost_[lane] && lane < static_cast<std::size_t>(count);
    }
    return kept;
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  Patience patience_;
  std::array<bool, group> lost_{}, twins_{};
  std::array<int, group> held_{};  // attempts in which the lane needed a far shorter step
};

}  // namespace bbsim::solve
