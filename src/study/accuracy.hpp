// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures the cost of accuracy: methods and tolerances against a reference (reference.hpp).
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {

// One method at one tolerance.
struct AccuracyPoint {
  Method method = Method::automatic;  // as requested
  solve::Tolerances tolerances;
  double error = 0;        // max |dx|, |dy| over the output times that both reached, m
  double cpu_seconds = 0;  // median of repeated runs
  std::size_t repeats = 0;
  solve::Statistics statistics;  // of one run
  solve::Ending ending = solve::Ending::done;
};

struct AccuracyStudy {
  std::vector<AccuracyPoint> points;  // method by method, rtol by rtol, as requested
  double reference_error = 0;         // the reference's estimate of its own error, m
  bool reference_by_cvode = false;    // otherwise in quad precision
  bool reference_complete = false;    // if not, errors are those up to its end
  double reference_reached = 0;       // s
  std::string reference_reason;
  bool interrupted = false;  // if so, points has only those finished before
};

struct AccuracyWatch {
  const std::atomic<bool>* stop = nullptr;          // ends the study soon after it becomes true
  std::function<void(double fraction)> progress{};  // of the whole study, in [0, 1]
};

// `value` rounded to ten decimal digits: 1e-5 for 1e-3 / 100, which is a neighboring double.
[[nodiscard]] double ten_digits(double value);

// Runs every method at every rtol, with the rows kept in memory. atol is a hundredth of rtol, as in
// the scenario's defaults. Repeats each run until its time is steady: at least 5 times and for 20
// ms, but for no more than a second.
[[nodiscard]] AccuracyStudy measure_accuracy(const model::Model& model,
                                             const solve::OutputGrid& grid,
                                             const std::vector<Method>& methods,
                                             const std::vector<double>& rtols,
                                             const AccuracyWatch& watch = {});

// The fastest point whose error is within `error`.
struct BestChoice {
  double error = 0;  // m, a power of ten
  const AccuracyPoint* point = nullptr;
};

// The best choice for each decade, from the coarsest that distinguishes points to the finest that a
// point reached. Only runs count that reached their end, or an event that stops them. The results
// point into `study`, which must outlive them.
[[nodiscard]] std::vector<BestChoice> best_by_decade(const AccuracyStudy& study);

// Every point, then the best choice for each decade of error.
[[nodiscard]] std::string accuracy_table(const AccuracyStudy& study);

// method,rtol,atol,error_m,time_us,steps,rhs_evaluations,jacobian_evaluations,status
[[nodiscard]] std::string accuracy_csv(const AccuracyStudy& study);

}  // namespace bbsim::study
