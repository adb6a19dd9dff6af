// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How far a run is from the truth, by runs that are unlike it.
#pragma once

#include <array>
#include <functional>
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

// Positions matter in metres: the absolute part of the tolerance is the same fraction of a metre as
// the relative part, but never so coarse that a scene of millimetres would not be resolved.
[[nodiscard]] solve::Tolerances tolerances_of(double rtol);

// Whether a run came to where the scene ends it, or to something that the scene stops at.
[[nodiscard]] bool came_to_its_end(const solve::Outcome& outcome);

// A run, by what its error is measured in.
struct Track {
  solve::Outcome outcome;
  std::vector<double> positions;  // of the ball, one output time after the other, m
};

// Runs whose distance from another run is that one's error. Each is as exact as doubles allow: a
// tolerance says what a step's error is at most, not how small it is, so that a check of a
// hundredth of the run's tolerance may be no better than the run, and wrong in the same way. And
// each has other stages and other steps than the run and than the other checks, so that they have
// no error in common.
//
// Checks are made when they are first needed, and serve all runs of the model that are asked about.
class Checks {
 public:
  // Both outlive the checks.
  Checks(const model::Model& model, const solve::OutputGrid& grid, const solve::Watch& watch)
      : model_(model), grid_(grid), watch_(watch) {}

  // About the largest error of x and y in a run that came to its end, at the output times, m: one
  // and a half times its distance from a check, or more where checks themselves are so far apart
  // that it says little. Infinite if they do not come to the same end, or none comes to its end at
  // a tolerance at least as fine as the run's.
  //
  // With `confirm` two checks or more are made. One may be near the run by luck, where rounding is
  // all that is left of the error.
  [[nodiscard]] double estimate(const Track& run, double rtol, bool confirm);

  // The estimate for each of the run's rows, once `estimate` of the whole run is known. For a row
  // that no check has it is no number.
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
  struct Made {
    solve::CheckRun how;
    std::unique_ptr<Track> track;  // null if it did not come to its end
  };
  std::vector<Made> made_;
  bool interrupted_ = false;
  int runs_ = 0;
};

// Keeps the positions of a run, and hands its rows on to a sink if there is one.
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
