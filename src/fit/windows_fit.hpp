// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The windows of a fit at given values of its keys: residuals and derivatives, with the best start
// of each window.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "fit/chain.hpp"
#include "fit/fit.hpp"
#include "fit/window_run.hpp"
#include "model/dense.hpp"

namespace bbsim::fit {

inline Eigen::Index at(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

// A log shows offset + scale column(t - delay) of each compared column.
struct Sensors {
  std::vector<double> scales, offsets;
  double delay = 0;  // s
};

// Scenarios at one set of values, one per log; none if the values are refused.
struct Variant {
  std::vector<Scenario> scenes;
  Sensors sensors;
};

class WindowsFit {
 public:
  // Residual of a window that does not run, in standard deviations.
  static constexpr double far = 1e6;

  WindowsFit(const Task& task, std::vector<Window> windows);

  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  // Number of compared values, and of free coordinates of starts.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t starts() const {
    return (joined_ ? chains_.size() : windows_.size()) * coordinates_.size();
  }
  // First row of a window among the numbers of all windows.
  [[nodiscard]] std::size_t first_row(std::size_t window) const { return first_rows_[window]; }
  [[nodiscard]] const std::vector<std::size_t>& columns_of_rows() const { return columns_; }

  // Standard deviation of each column's noise, by which its residuals are divided.
  void set_noise(std::vector<double> noise);
  [[nodiscard]] const std::vector<double>& noise() const { return noise_; }
  // Factor of each residual, initially 1.
  void set_weights(Eigen::VectorXd weights);
  [[nodiscard]] const Eigen::VectorXd& weights() const { return weights_; }

  // Residuals over the noise, times their weights, at the best starts. A window that does not run
  // gets `far`; with `first`, it throws InputError.
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& u, bool first = false);

  // Values of log and model at u, by window.
  [[nodiscard]] std::vector<WindowSeries> series(const Eigen::VectorXd& u);

  // Derivatives of the residuals by u, at u; residuals() need not be called before. `projected`
  // lets the starts follow; `free_norms` are the columns' norms with fixed starts.
  // known_derivatives() returns the last computed ones, with the present noise and weights.
  struct Derivatives {
    Eigen::MatrixXd projected;
    Eigen::VectorXd free_norms;
  };
  [[nodiscard]] Derivatives derivatives(const Eigen::VectorXd& u);
  [[nodiscard]] Derivatives known_derivatives() const { return projected(base_u_.size()); }
  // The same with known starts of the windows.
  [[nodiscard]] Derivatives derivatives(const Eigen::VectorXd& u, const std::vector<Start>& starts);

  // Joins windows that go on: from now on each one starts where the last ends. The initial starts
  // are those of the last residuals().
  void join();
  [[nodiscard]] bool is_joined() const { return joined_; }
  // Takes the starts of `other`, which has the same windows, and joins if `other` is joined.
  void begin_as(const WindowsFit& other);

  // Starts again with guesses of the windows' starts.
  void restart();
  // From now on, computes even if the task is stopped.
  void finish() { heeds_stop_ = false; }

 private:
  // Derivatives are from the point where they were last computed.
  struct State : Link {
    Start start{}, end{};
    model::LeastSquares start_solver;  // of by_start
    int fresh_rounds = 3;  // rounds that still compute slopes; the first start is a guess
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
  // `end` receives the state at the next window's start, if this one is joined to it.
  bool residual_of(std::size_t w, const Scene& scene, const Start& start, Eigen::VectorXd& into,
                   std::string& why, Start* end = nullptr) const;
  // Computes derivatives by the start; returns false and sets none if a run fails.
  bool slopes(std::size_t w, const Scene& scene, State& state) const;
  bool settle(std::size_t w, const Scene& scene, State& state, std::string& why) const;
  [[nodiscard]] Scene scene_of(std::size_t w, const Variant& variant) const;
  [[nodiscard]] bool is_stopped() const;
  void for_each_window(const std::function<void(std::size_t)>& work) const;

  // A range of joined windows.
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
  std::vector<std::size_t> coordinates_;  // free coordinates of a start
  bool joined_ = false;
  std::vector<std::size_t> states_;  // coordinates passed from window to window
  std::vector<Chain> chains_;
  std::vector<std::size_t> first_rows_, columns_;
  std::size_t size_ = 0;
  std::vector<double> noise_;
  Eigen::VectorXd weights_;
  bool heeds_stop_ = true;
  std::vector<State> base_, trial_;
  Eigen::VectorXd base_u_;   // the point of base_'s derivatives; empty if there are none
  Eigen::VectorXd trial_u_;  // of trial_
};

}  // namespace bbsim::fit
