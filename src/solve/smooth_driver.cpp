// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Drives a stepper through a smooth run, from stop to stop of the input (stepper.hpp).
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/instant.hpp"
#include "solve/pace.hpp"
#include "solve/piece.hpp"
#include "solve/row_block.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {
namespace {

class StepPiece : public Piece {
 public:
  StepPiece(Stepper& stepper, double from, double to)
      : Piece(from, to, stepper.parts()), stepper_(stepper) {}
  void evaluate(const double* times, std::size_t count, double* rows) const override {
    stepper_.evaluate(times, count, rows);
  }

 private:
  Stepper& stepper_;
};

// Beyond this distance of the ball (m) or angle of the plate (rad), a closed loop has run away. It
// is given up if it takes thousands of steps: commands are then sums of terms of this size, and
// only their rounding moves the servos.
constexpr double most_gone = 1e9;

bool has_run_away(const model::Model& model, const std::vector<double>& state) {
  bool is_loop = false, is_far = false;
  const std::vector<std::string> names = model.state_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_angle = names[i] == "phi" || names[i] == "theta";
    is_loop = is_loop || is_angle;
    if (is_angle || names[i] == "x" || names[i] == "y") {
      is_far = is_far || std::abs(state[i]) > most_gone;
    }
  }
  return is_loop && is_far;
}

}  // namespace

Outcome run_through(Stepper& stepper, const model::Model& model, const OutputGrid& grid,
                    StateSink& sink, const Watch& watch) {
  const std::size_t row_size = model.size() + (model.gamma ? 1 : 0);
  RowBlock rows(sink, row_size);
  double* const first = rows.next();
  std::copy(model.initial.begin(), model.initial.end(), first);
  if (model.gamma) first[model.size()] = 0;

  PieceSink* const pieces = sink.pieces();
  if (pieces != nullptr) pieces->begin_run();
  const bool with_rows = sink.wants_rows();

  Outcome outcome;
  Pace pace(grid.end());
  const auto fail = [&](Why why, std::string reason) {
    outcome.ending = Ending::failed;
    outcome.why = why;
    outcome.reason = std::move(reason);
    outcome.last_state = stepper.state();
    outcome.worst_state = stepper.worst_state();
  };
  std::array<double, 64> times;
  std::size_t next_row = 1, next_stop = 0;
  stepper.start(0, model.initial.data());
  for (std::size_t steps = 1;; ++steps) {
    const double limit = next_stop < model.stops.size() ? model.stops[next_stop] : grid.end();
    const double before = stepper.time();
    if (const auto failure = stepper.step(limit)) {
      fail(failure->why, failure->text);
      break;
    }
    const double reached = stepper.time();
    if (pieces != nullptr) {
      const bool at_stop = reached >= limit && reached < grid.end();
      const double to = std::min(at_stop ? model.just_before(reached) : reached, grid.end());
      if (to > before) pieces->accept(StepPiece(stepper, before, to));
    }
    const std::size_t rows_until = grid.rows_until(reached);
    if (!with_rows && rows_until > next_row + 1) {
      rows.skip(rows_until - 1 - next_row);
      next_row = rows_until - 1;
    }
    while (next_row < rows_until) {
      std::size_t count = std::min(times.size(), rows_until - next_row);
      double* const out = rows.next(count);
      for (std::size_t i = 0; i < count; ++i) times[i] = grid[next_row + i];
      stepper.evaluate(times.data(), count, out);
      next_row += count;
    }
    if (reached >= grid.end() || next_row == grid.size()) break;
    if (reached >= limit) {
      ++next_stop;
      stepper.jump();
    } else if (pace.creeps(reached)) {
      fail(Why::too_slow, pace.reason());
      std::vector<double> row(row_size);
      stepper.evaluate(&reached, 1, row.data());
      outcome.last_state.assign(row.begin(),
                                row.begin() + static_cast<std::ptrdiff_t>(model.size()));
      break;
    } else if (pace.completed_window() && has_run_away(model, stepper.state())) {
      fail(Why::unbounded,
           "the loop has run away beyond 1e9 m or rad, where only rounding moves it");
      break;
    } else if (watch.slow && pace.completed_window() && pace.is_news()) {
      watch.slow(reached, pace.steps_per_second(), pace.steps_left());
    }
    if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) {
      outcome.ending = Ending::interrupted;
      outcome.why = Why::interrupted;
      break;
    }
    if (watch.progress && steps % 256 == 0) watch.progress(reached);
  }
  rows.flush();
  outcome.reached = stepper.time();
  outcome.rows = next_row;
  outcome.statistics = stepper.statistics();
  return with_all_rows(std::move(outcome), grid.size());
}

}  // namespace bbsim::solve
