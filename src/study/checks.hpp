// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Estimates the error of a run by check runs that differ from it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "solve/check_run.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {

// The tightest relative tolerance that is tried, about 50 roundings.
inline constexpr double finest_rtol = 1e-14;

// The absolute tolerance is a hundredth of the relative one, in meters: fine enough to resolve a
// scene of millimeters.
[[nodiscard]] solve::Tolerances tolerances_of(double rtol);

// Whether a run reached the end of the scene, or an event that stops it.
[[nodiscard]] bool came_to_its_end(const solve::Outcome& outcome);

// The number of leading states that are coordinates of the contact point in m: 2 (x and y) or 1.
[[nodiscard]] int coordinates(const model::Model& model);

// The part of a run that determines its error.
struct Track {
  solve::Outcome outcome;
  std::vector<double> positions;  // of the ball, at one output time after another, m
};

// Check runs, whose distance from another run is that run's error. Each is as accurate as doubles
// allow. A tolerance only bounds a step's error from above, so a check at a hundredth of the run's
// tolerance may be no better than the run, and wrong in the same way. Each check also has other
// steps than the run and the other checks, and mostly other stages, so that their errors have no
// common cause.
//
// Checks are made when they are first needed, and serve all runs of the model.
class Checks {
 public:
  // `model`, `grid` and `watch` must outlive the object.
  Checks(const model::Model& model, const solve::OutputGrid& grid, const solve::Watch& watch)
      : model_(model), grid_(grid), watch_(watch) {}

  // Estimates the largest error of x and y at the output times, m, of a run that reached its end:
  // 1.5 times its distance from a check, or more if the checks' own distances are too large.
  // Infinite if they end differently, or if no check reaches its end at a tolerance at least as
  // fine as the run's.
  //
  // `confirm`: make two or more checks. If only rounding is left of the error, one check may be
  // close to the run by luck.
  [[nodiscard]] double estimate(const Track& run, double rtol, bool confirm);

  // The estimate for each of the run's rows, from the `estimate` of the whole run. NaN for a row
  // that no check reached.
  [[nodiscard]] std::vector<double> row_estimates(const Track& run, double estimate) const;

  [[nodiscard]] bool interrupted() const { return interrupted_; }
  // Integrations made so far.
  [[nodiscard]] int runs() const { return runs_; }

 private:
  [[nodiscard]] std::array<solve::CheckRun, 4> kinds(const Track& run, double rtol) const;
  [[nodiscard]] std::optional<double> distance_from(const Track& run,
                                                    const std::array<solve::CheckRun, 4>& kinds,
                                                    bool confirm);
  const Track* check(solve::CheckRun how);
  void use(double rtol);

  const model::Model& model_;
  const solve::OutputGrid& grid_;
  const solve::Watch& watch_;
  double rtol_ = 0;   // of the checks
  double least_ = 0;  // finer tolerances have failed
  struct CheckTrack {
    solve::CheckRun how;
    std::unique_ptr<Track> track;  // null if it did not reach its end
  };
  std::vector<CheckTrack> tracks_;
  bool interrupted_ = false;
  int runs_ = 0;
};

// Keeps the positions of a run, and passes its rows on to a sink if there is one.
class Tracker : public solve::StateSink {
 public:
  Tracker(const model::Model& model, std::vector<double>& positions,
          solve::StateSink* rows = nullptr);
  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override {
    return rows_ != nullptr ? rows_->pieces() : nullptr;
  }

 private:
  std::size_t row_size_, coordinates_;
  std::vector<double>& positions_;
  solve::StateSink* rows_;
};

}  // namespace bbsim::study
