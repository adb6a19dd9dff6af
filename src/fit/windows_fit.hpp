// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The windows of a fit at some values of its keys: residuals and derivatives, with the best start
// of each window.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <cstddef>
#include <string>
#include <vector>

#include "fit/chain.hpp"
#include "fit/fit.hpp"
#include "fit/window_run.hpp"

namespace bbsim::fit {

// What the logs show of each compared column: offset + scale column(t - delay).
struct Sensors {
  std::vector<double> scales, offsets;
  double delay = 0;  // s
};

// Scenarios at one set of values, one for each log; none if the values are refused.
struct Variant {
  std::vector<Scenario> scenes;
  Sensors sensors;
};

class WindowsFit {
 public:
  // The residuals of a window that does not run, in standard deviations.
  static constexpr double far = 1e6;

  WindowsFit(const Task& task, std::vector<Window> windows);

  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  // The numbers that are compared, and those of the starts.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t starts() const {
    return (joined_ ? chains_.size() : windows_.size()) * coordinates_.size();
  }
  // The rows of a window, of the numbers of all windows.
  [[nodiscard]] std::size_t first_row(std::size_t window) const { return first_rows_[window]; }
  [[nodiscard]] const std::vector<std::size_t>& columns_of_rows() const { return columns_; }

  // The standard deviation of each column's noise, which its residuals are divided by.
  void set_noise(std::vector<double> noise);
  [[nodiscard]] const std::vector<double>& noise() const { return noise_; }
  // Factors of each residual, 1 at first.
  void set_weights(Eigen::VectorXd weights);
  [[nodiscard]] const Eigen::VectorXd& weights() const { return weights_; }

  // The residuals over the noise, times their weights, at the best starts. What does not run is far
  // away; with `first`, it is an InputError.
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& u, bool first = false);

  // What log and model show at u in each window.
  [[nodiscard]] std::vector<WindowSeries> series(const Eigen::VectorXd& u);

  // The derivatives of the residuals by u, at u; residuals() may be asked before or not. `free`:
  // with the starts as they are, without letting them follow. `known`: those that were computed
  // last, with the noise and weights of now.
  struct Derivatives {
    Eigen::MatrixXd projected;
    Eigen::VectorXd free_norms;
  };
  [[nodiscard]] Derivatives derivatives(const Eigen::VectorXd& u);
  [[nodiscard]] Derivatives known_derivatives() const { return projected(base_u_.size()); }
  // The same where the windows' starts are known.
  [[nodiscard]] Derivatives derivatives(const Eigen::VectorXd& u, const std::vector<Start>& starts);

  // From now on, windows that go on are joined: each window begins where the one before ends. The
  // starts begin at those of the last residuals().
  void join();
  [[nodiscard]] bool is_joined() const { return joined_; }
  // Begins with the starts of `other`, of the same windows, and is joined if that is.
  void begin_as(const WindowsFit& other);

  // Begins again with guesses of the windows' starts.
  void restart();
  // From now on, a task that is stopped is computed nevertheless.
  void finish() { heeds_stop_ = false; }

 private:
  // Derivatives are those where they were last computed.
  struct State : Link {
    Start start{}, end{};
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> start_solver;  // of by_start
    int fresh_rounds = 3;  // for which slopes are still to be computed; the first start is a guess
  };

  [[nodiscard]] Derivatives differences(const Eigen::VectorXd& u);
  [[nodiscard]] Derivatives projected(Eigen::Index keys) const;
  void scale_rows(const Eigen::VectorXd& factors);
  [[nodiscard]] Variant variant(const Eigen::VectorXd& u, std::string* why) const;
  void guess_starts();
  // One window at one set of values.
  struct Scene {
    Scenario scenario;
    const Sensors& sensors;
  };
  // `end`: where the next window begins; only if this one is joined to it.
  bool residual_of(std::size_t w, const Scene& scene, const Start& start, Eigen::VectorXd& into,
                   std::string& why, Start* end = nullptr) const;
  // The derivatives by the start; false, and none, if a run fails.
  bool slopes(std::size_t w, const Scene& scene, State& state) const;
  bool settle(std::size_t w, const Scene& scene, State& state, std::string& why) const;
  [[nodiscard]] Scene scene_of(std::size_t w, const Variant& variant) const;
  [[nodiscard]] bool is_stopped() const;
  void for_each_window(const std::function<void(std::size_t)>& work) const;

  // Of joined windows.
  struct Chain {
    std::size_t first, last;
  };
  class Closing;
  [[nodiscard]] bool has_joint(std::size_t w) const { return joined_ && windows_[w].goes_on; }
  [[nodiscard]] bool has_derivatives(const Chain& chain, Eigen::Index keys) const;
  [[nodiscard]] Eigen::VectorXd states_of(const Start& start) const;
  [[nodiscard]] Condensed condensed(const Chain& chain, const std::vector<State>& states,
                                    Eigen::Index keys) const;
  void predict(const Chain& chain, const Eigen::VectorXd& change);
  void move(Start& start, const Eigen::VectorXd& by) const;
  void close_chains(const Variant& scenes, std::vector<char>& runs,
                    std::vector<std::string>& faults);

  const Task& task_;
  std::vector<Window> windows_;
  std::vector<std::size_t> coordinates_;  // of a start that is free
  bool joined_ = false;
  std::vector<std::size_t> states_;  // coordinates that pass from window to window
  std::vector<Chain> chains_;
  std::vector<std::size_t> first_rows_, columns_;
  std::size_t size_ = 0;
  std::vector<double> noise_;
  Eigen::VectorXd weights_;
  bool heeds_stop_ = true;
  std::vector<State> base_, trial_;
  Eigen::VectorXd base_u_;   // where the derivatives of base_ are from; empty if there are none
  Eigen::VectorXd trial_u_;  // of trial_
};

}  // namespace bbsim::fit
