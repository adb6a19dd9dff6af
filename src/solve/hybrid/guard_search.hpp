// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the zero crossings of guards within an integrator's steps.
#pragma once

#include <optional>
#include <vector>

#include "base/maxima.hpp"
#include "model/hybrid/hybrid_system.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

class GuardSearch {
 public:
  // If the stepper moves servos in closed form, their crossings are predicted elsewhere, and only
  // the guards of monitors are searched.
  GuardSearch(model::HybridSystem& run, Stepper& stepper);

  // Sets z to the states at t in the last step. With Model::gamma, returns the integral of u, m.
  double state_at(double t, std::vector<double>& z);

  // The knowledge of the guards at the start of the next search. Transitions:
  //   arm(): any -> armed          begin_step(): proven -> unarmed
  //   forget(): armed -> unarmed   after_switch(): any -> unchecked
  //   begin(): all but unwatched -> proven, if the stepper proves it; otherwise -> armed
  enum class Knowledge {
    unwatched,  // there are no guards to search
    armed,      // the guards have values
    unarmed,    // the guards have no values
    unchecked,  // unarmed, and no monitor was checked since a switch
    proven,     // the stepper proved that no monitor changes sides within its last step
  };
  [[nodiscard]] bool unchecked() const { return knowledge_ == Knowledge::unchecked; }

  // Sets the guards' values for the states z at t. A guard that starts at zero, where it last
  // crossed, fires only once it is clearly below zero.
  void arm(double t, const double* z);
  // For steppers with closed-form servos. Monitors are not checked at a switch, because the bounds
  // of the next step usually cover it.
  void begin_step() {
    if (knowledge_ == Knowledge::proven) knowledge_ = Knowledge::unarmed;
  }
  void forget() {
    if (knowledge_ == Knowledge::armed) knowledge_ = Knowledge::unarmed;
  }
  void after_switch() {
    if (knowledge_ != Knowledge::unwatched) knowledge_ = Knowledge::unchecked;
  }

  // Begins the search of a part of the last step. next() then returns the first crossing that is
  // left; resume() continues after it, with the states there. Returns Effect::stop if a monitor,
  // checked late, stops the run at `from`.
  model::Effect begin(double from, double to);
  [[nodiscard]] std::optional<model::Crossing> next();
  void resume(double t, const double* z);

  // Predicts when an event stops the run, s; infinity if none does. Extrapolates each guard
  // linearly from its value at the last call.
  double predicted_stop(double t);

 private:
  struct Guard {
    double value = 0;      // at the last time evaluated
    double slope = 0;      // at the same time, 1/s
    double threshold = 0;  // the guard fires at or below it; 0 once it was positive
  };

  [[nodiscard]] double clearly(std::size_t i) const { return 1e-12 * run_.guard_scales()[i]; }
  double above(std::size_t i, double t);
  double root(std::size_t i, double from, double to);
  double dip(std::size_t i, double from, double to);
  [[nodiscard]] double point(std::size_t p) const;
  void evaluate_planned();
  void evaluate(double t, std::vector<double>& values);
  bool all_stay_positive(double from, double to);
  std::optional<model::Crossing> first_crossing(double from, double to);

  model::HybridSystem& run_;
  Stepper& stepper_;
  std::size_t first_;  // the first guard that is searched
  Knowledge knowledge_;
  std::vector<Guard> guards_;
  // The search: start, end and last time evaluated (s), number of points, next point.
  double from_ = 0, to_ = 0, last_ = 0;
  std::size_t points_ = 0, point_ = 1;
  ChebyshevTables tables_;
  std::size_t row_size_;
  std::vector<double> row_, z_, values_, now_, near_, least_, most_;
  std::vector<double> planned_times_, planned_rows_;
  std::size_t next_planned_ = 0;
  std::vector<double> paced_;  // guard values at the last call of predicted_stop()
  double paced_time_ = 0;
};

}  // namespace bbsim::solve
