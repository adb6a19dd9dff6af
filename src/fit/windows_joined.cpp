// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Joined windows of a fit: chains in place of free windows.

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {}  // namespace

void WindowsFit::join() {
  if (trial_u_.size() > 0 || task_.keys.empty()) base_ = trial_;
  const std::vector<Scenario> scenes =
      variant(VectorXd::Zero(at(task_.keys.size())), nullptr).scenes;
  const bool has_gimbal = begins_anywhere(scenes.front());
  bool from_within = false;
  joined_ = true;
  chains_.clear();
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const bool follows = w > 0 && windows_[w - 1].goes_on;
    if (!follows) chains_.push_back({w, w});
    chains_.back().last = w;
    from_within = from_within || (!follows && !windows_[w].first);
  }
  coordinates_ = start_coordinates(task_.columns, from_within && has_gimbal);
  states_ = {0, 1, 2, 3};
  for (std::size_t i = 4; i < 8 && has_gimbal; ++i) states_.push_back(i);
  states_.push_back(8);
  const Start given = start_of(scenes.front());
  for (const Chain& chain : chains_) {
    Start& start = base_[chain.first].start;
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (std::ranges::find(coordinates_, i) == coordinates_.end()) start[i] = given[i];
    }
  }
  for (State& state : base_) {
    state.fresh_rounds = State{}.fresh_rounds;
    state.by_start.resize(0, 0);
    state.by_key.resize(0, 0);
  }
  base_u_.resize(0);
  trial_u_.resize(0);
}

VectorXd WindowsFit::states_of(const Start& start) const {
  VectorXd made(at(states_.size()));
  for (std::size_t i = 0; i < states_.size(); ++i) made[at(i)] = start[states_[i]];
  return made;
}

Condensed WindowsFit::condensed(const Chain& chain, const std::vector<State>& states,
                                Index keys) const {
  std::vector<const Link*> links;
  for (std::size_t w = chain.first; w <= chain.last; ++w) links.push_back(&states[w]);
  MatrixXd first = MatrixXd::Zero(at(states_.size()), at(coordinates_.size()));
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const auto row = std::ranges::find(states_, coordinates_[k]) - states_.begin();
    first(row, at(k)) = 1;
  }
  return condense(links, first, keys);
}

bool WindowsFit::has_derivatives(const Chain& chain, Index keys) const {
  for (std::size_t w = chain.first; w <= chain.last; ++w) {
    if (base_[w].by_start.rows() == 0 || base_[w].by_key.cols() != keys) return false;
  }
  return true;
}

// The trajectory of a chain follows the keys almost linearly.
void WindowsFit::predict(const Chain& chain, const VectorXd& change) {
  if (!has_derivatives(chain, change.size())) return;
  const Condensed linear = condensed(chain, base_, change.size());
  const VectorXd first = linear.best_first_by_key() * change;
  for (std::size_t w = chain.first; w <= chain.last; ++w) {
    const Condensed::Shift& shift = linear.shifts[w - chain.first];
    move(trial_[w].start, shift.by_first * first + shift.by_key * change);
  }
}

void WindowsFit::move(Start& start, const VectorXd& by) const {
  for (std::size_t i = 0; i < states_.size(); ++i) start[states_[i]] += by[at(i)];
}

// Newton's method for the starts of a chain that close all gaps and minimize the residuals. A step
// that makes both worse is halved.
class WindowsFit::Closing {
 public:
  Closing(const WindowsFit& fit, const Chain& chain, std::vector<State>& states)
      : fit_(fit), chain_(chain), states_(states) {}

  [[nodiscard]] bool goes_on() const { return !is_done_ && !has_failed_; }
  [[nodiscard]] bool is_closed() const { return is_done_; }
  [[nodiscard]] bool wants_slopes() const { return is_accepted_; }
  void fail() { has_failed_ = true; }

  // `runs`: whether all windows ran from their starts.
  void judge(bool runs) {
    double cost = 0, gap = 0;
    for (std::size_t w = chain_.first; w <= chain_.last && runs; ++w) {
      State& state = states_[w];
      cost += state.residual.squaredNorm();
      if (w == chain_.last) continue;
      state.gap = fit_.states_of(state.end) - fit_.states_of(states_[w + 1].start);
      const VectorXd sizes =
          VectorXd::Ones(state.gap.size()) + fit_.states_of(state.end).cwiseAbs();
      gap = std::max(gap, state.gap.cwiseQuotient(sizes).cwiseAbs().maxCoeff());
    }
    is_accepted_ = runs && (steps_.empty() || cost < cost_ || gap < gap_ || gap <= tight);
    if (is_accepted_) {
      settled_ = std::abs(cost_ - cost) <= 1e-12 * cost;
      cost_ = cost;
      gap_ = gap;
      halvings_ = 0;
      return;
    }
    constexpr int most_halvings = 10;
    has_failed_ = steps_.empty() || ++halvings_ > most_halvings;
    if (has_failed_) return;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      steps_[i] /= 2;
      fit_.move(states_[chain_.first + i].start, -steps_[i]);
    }
  }

  // Call after an accepted step.
  void step(bool fresh) {
    const Condensed linear = fit_.condensed(chain_, states_, 0);
    const VectorXd first = linear.best_first();
    const double left = (linear.by_first * first).squaredNorm();
    if (gap_ <= tight && !fresh && (left <= 1e-14 * cost_ || settled_)) {
      is_done_ = true;
      return;
    }
    steps_.clear();
    for (std::size_t w = chain_.first; w <= chain_.last; ++w) {
      const Condensed::Shift& shift = linear.shifts[w - chain_.first];
      steps_.push_back(shift.closing + shift.by_first * first);
      fit_.move(states_[w].start, steps_.back());
    }
  }

 private:
  static constexpr double tight = 1e-11;  // m, m/s, rad, rad/s, or relative to the state

  const WindowsFit& fit_;
  const Chain& chain_;
  std::vector<State>& states_;
  std::vector<VectorXd> steps_;  // steps to the present starts
  double cost_ = std::numeric_limits<double>::infinity(), gap_ = cost_;
  int halvings_ = 0;
  bool is_accepted_ = false, is_done_ = false, has_failed_ = false, settled_ = false;
};

void WindowsFit::close_chains(const Variant& scenes, std::vector<char>& runs,
                              std::vector<std::string>& faults) {
  std::vector<Closing> closings;
  std::vector<std::size_t> chain_of;
  for (const Chain& chain : chains_) {
    chain_of.insert(chain_of.end(), chain.last - chain.first + 1, closings.size());
    closings.emplace_back(*this, chain, trial_);
  }
  constexpr int most_rounds = 40;
  for (int round = 0; round < most_rounds; ++round) {
    if (std::ranges::none_of(closings, &Closing::goes_on)) break;
    for_each_window([&](std::size_t w) {
      if (!closings[chain_of[w]].goes_on()) return;
      State& state = trial_[w];
      runs[w] =
          residual_of(w, scene_of(w, scenes), state.start, state.residual, faults[w], &state.end)
              ? 1
              : 0;
    });
    if (is_stopped()) return;
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      if (!closings[c].goes_on()) continue;
      const auto first = runs.begin() + static_cast<std::ptrdiff_t>(chains_[c].first);
      const auto last = runs.begin() + static_cast<std::ptrdiff_t>(chains_[c].last);
      closings[c].judge(std::find(first, last + 1, 0) == last + 1);
    }
    std::vector<char> fresh(windows_.size(), 0), lost(windows_.size(), 0);
    for_each_window([&](std::size_t w) {
      const Closing& closing = closings[chain_of[w]];
      State& state = trial_[w];
      if (!closing.goes_on() || !closing.wants_slopes() || state.fresh_rounds == 0) return;
      --state.fresh_rounds;
      fresh[w] = 1;
      if (!slopes(w, scene_of(w, scenes), state)) lost[w] = 1;
    });
    if (is_stopped()) return;
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      for (std::size_t w = chains_[c].first; w <= chains_[c].last; ++w) {
        if (lost[w] != 0) closings[c].fail();
      }
      if (!closings[c].goes_on() || !closings[c].wants_slopes()) continue;
      closings[c].step(fresh[chains_[c].first] != 0);
    }
  }
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    if (closings[chain_of[w]].is_closed()) continue;
    runs[w] = 0;
    if (faults[w].empty()) faults[w] = "its windows cannot be joined";
  }
}

void WindowsFit::begin_as(const WindowsFit& other) {
  base_ = other.trial_;
  for (State& state : base_) {
    state.fresh_rounds = State{}.fresh_rounds;
    state.by_start.resize(0, 0);
    state.by_key.resize(0, 0);
  }
  if (!other.joined_) return;
  trial_ = base_;
  join();
}

}  // namespace bbsim::fit
