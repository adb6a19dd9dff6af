// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "model/spectrum.hpp"
#include "model/systems/list.hpp"
#include "solve/integrate.hpp"
#include "study/checks.hpp"
#include "study/quad_step.hpp"

namespace bbsim::study {
namespace {

template <class System>
class SystemEquation : public Equation {
 public:
  SystemEquation(const System& system, const model::System& any) : system_(system), any_(any) {}

  [[nodiscard]] int size() const override { return System::size; }
  void derivative(double t, const double* z, double* dz) const override {
    model::derivative(system_, std::min(t, latest), z, dz);
  }
  void derivative(Quad t, const Quad* z, Quad* dz) const override {
    model::derivative(system_, plain(t) > latest ? Quad(latest) : t, z, dz);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian(double t, const double* z) const override {
    Eigen::MatrixXd matrix(System::size, System::size);
    model::jacobian(any_, std::min(t, latest), z, matrix.data());
    return matrix;
  }

 private:
  const System& system_;
  const model::System& any_;  // the variant that holds it
};

std::unique_ptr<Equation> make_equation(const model::Model& model) {
  return std::visit(
      [&](const auto& system) -> std::unique_ptr<Equation> {
        return std::make_unique<SystemEquation<std::decay_t<decltype(system)>>>(system,
                                                                                model.system);
      },
      model.system);
}

// The first step to try: a few times the period of the fastest mode at the start.
double first_step(const model::Model& model, double end) {
  double fastest = 0;
  for (const auto& value : model::eigenvalues(model, 0, model.initial.data())) {
    fastest = std::max(fastest, std::abs(value));
  }
  return std::min(end, 4 / fastest);
}

// One solution with its own steps.
class Run {
 public:
  Run(Equation& equation, const RadauRule& rule, double tolerance, const model::Model& model,
      const solve::OutputGrid& grid)
      : equation_(equation),
        model_(model),
        grid_(grid),
        tolerance_(tolerance),
        step_(equation, rule, tolerance),
        stages_(rule.stages),
        state_(model.initial.begin(), model.initial.end()) {
    solution_.row_size = model.size() + (model.gamma ? 1 : 0);
  }

  // Calls `progress` with the time after every step.
  template <class Progress>
  ReferenceSolution solve(const std::atomic<bool>* stop, const Progress& progress) {
    solution_.values.insert(solution_.values.end(), state_.begin(), state_.end());
    if (model_.gamma) solution_.values.emplace_back(0.0);
    double next_length = first_step(model_, grid_.end());
    std::size_t next_stop = 0;
    while (time_ < grid_.end()) {
      if (stop != nullptr && stop->load(std::memory_order_relaxed)) return ended("");
      const Quad target = next_stop < model_.stops.size() ? model_.stops[next_stop] : grid_.end();
      const Quad left = target - time_;
      const bool to_target = left <= Quad(next_length);
      const Quad length = to_target ? left : Quad(next_length);
      // The reference is constant until it jumps.
      const bool to_jump = to_target && model_.jumps_at(plain(target));
      equation_.latest =
          to_jump ? model_.just_before(plain(target)) : std::numeric_limits<double>::infinity();
      const double error = step_.solve(time_, length, state_);
      double proposal = plain(length) * change_of_step(error);
      if (!(error <= tolerance_)) {
        next_length = proposal;
        if (next_length < 1e-14 * grid_.end()) return ended(explain());
        continue;
      }
      if (!to_target) {
        proposal = std::min(proposal, predicted_length(plain(length), error));
        last_length_ = plain(length);
        last_error_ = error;
      }
      // A step that a stop cut short says nothing about longer steps.
      next_length = to_target ? std::max(proposal, next_length) : proposal;
      accept(length, to_target ? target : time_ + length);
      if (to_target) ++next_stop;
      progress(solution_.reached);
    }
    solution_.complete = true;
    return ended("");
  }

 private:
  // The polynomial's error falls with the power stages + 1 of the step.
  [[nodiscard]] double change_of_step(double error) const {
    if (!std::isfinite(error)) return 0.3;
    return std::clamp(0.9 * root(tolerance_ / error), 0.1, 5.0);
  }
  [[nodiscard]] double root(double ratio) const { return std::pow(ratio, 1.0 / (stages_ + 1)); }

  // The next step if the error keeps changing as in the last step (Gustafsson's predictive
  // control). Saves a rejection per step when the solution gets steeper.
  [[nodiscard]] double predicted_length(double length, double error) const {
    if (!(last_error_ > 0) || !(error > 0)) return 5 * length;
    return length * change_of_step(error) * (length / last_length_) * root(last_error_ / error);
  }

  void accept(Quad length, Quad time_after) {
    std::optional<CollocationStep::Integral> spin;
    if (model_.gamma) spin.emplace(step_, model_.spin_state());
    auto& values = solution_.values;
    for (std::size_t row = solution_.rows(); row < grid_.size() && Quad(grid_[row]) <= time_after;
         row = solution_.rows()) {
      const Quad fraction = (Quad(grid_[row]) - time_) / length;
      values.resize(values.size() + solution_.row_size);
      Quad* to = values.data() + values.size() - solution_.row_size;
      step_.state_at(fraction, to);
      if (spin) to[state_.size()] = turned_ + spin->to(fraction);
    }
    if (spin) turned_ += spin->to(1.0);
    step_.state_at(1.0, state_.data());
    time_ = time_after;
    solution_.reached = plain(time_);
    ++solution_.steps;
  }

  // Describes why steps became too short.
  [[nodiscard]] std::string explain() const {
    std::size_t largest = 0;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      if (abs(state_[i]) > abs(state_[largest])) largest = i;
    }
    char text[160];
    std::snprintf(text, sizeof text,
                  "no step from t = %.17g s is short enough; the largest state is %s = %.3g",
                  solution_.reached, model_.state_names()[largest].c_str(), plain(state_[largest]));
    return text;
  }

  ReferenceSolution ended(std::string reason) {
    solution_.reason = std::move(reason);
    return std::move(solution_);
  }

  Equation& equation_;
  const model::Model& model_;
  const solve::OutputGrid& grid_;
  double tolerance_;
  CollocationStep step_;
  int stages_;
  Quad time_ = 0.0, turned_ = 0.0;
  double last_length_ = 0, last_error_ = 0;  // of the last accepted step that was not cut short
  std::vector<Quad> state_;
  ReferenceSolution solution_;
};

double difference(const ReferenceSolution& a, const ReferenceSolution& b, int coordinates) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.rows(), b.rows()); ++i) {
    for (int c = 0; c < coordinates; ++c) {
      largest = larger(largest, plain(abs(a.row(i)[c] - b.row(i)[c])));
    }
  }
  return largest;
}

}  // namespace

ReferenceSolution solve_reference(const model::Model& model, const solve::OutputGrid& grid,
                                  double tolerance, const solve::Watch& watch) {
  static const RadauRule rule(24), coarser_rule(20);
  std::unique_ptr<Equation> equation = make_equation(model);
  const double finest = std::max(tolerance, 5e3 * Quad::epsilon());
  double done = 0;  // by both runs together
  const auto progress = [&](double time) {
    if (watch.progress) watch.progress(done + time / 2);
  };
  const ReferenceSolution coarser =
      Run(*equation, coarser_rule, 10 * finest, model, grid).solve(watch.stop, progress);
  done = grid.end() / 2;
  ReferenceSolution solution =
      Run(*equation, rule, finest, model, grid).solve(watch.stop, progress);
  solution.error_estimate = difference(solution, coarser, coordinates(model));
  return solution;
}

ReferenceSolution solve_by_cvode(const model::Model& model, const solve::OutputGrid& grid,
                                 const solve::Watch& watch) {
  const auto solved = [&](double rtol, double before) {
    solve::Trajectory rows(model.row_size());
    const solve::Watch half{watch.stop, [&](double time) {
                              if (watch.progress) watch.progress(before + time / 2);
                            }};
    const solve::Outcome outcome =
        solve::integrate(model, Method::adams, {rtol, rtol / 100}, grid, rows, half);
    ReferenceSolution solution;
    solution.row_size = model.row_size();
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      const double* const row = rows.row(i);
      solution.values.insert(solution.values.end(), row, row + solution.row_size);
    }
    solution.complete = outcome.ending == solve::Ending::done;
    solution.reached = outcome.reached;
    solution.steps = outcome.statistics.steps;
    if (outcome.ending == solve::Ending::stopped) {
      solution.reason = "an event stopped the run";
    } else if (outcome.ending == solve::Ending::failed) {
      solution.reason = outcome.reason;
    }
    return solution;
  };
  const ReferenceSolution coarser = solved(1e-12, 0);
  ReferenceSolution solution = solved(1e-13, grid.end() / 2);
  solution.error_estimate = difference(solution, coarser, coordinates(model));
  return solution;
}

}  // namespace bbsim::study
