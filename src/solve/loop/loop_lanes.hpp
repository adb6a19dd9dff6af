// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates many closed loops at once for sweeps of gains, with one loop in each SIMD lane.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "scenario/scenario.hpp"
#include "solve/collocation/shrinking.hpp"
#include "solve/loop/kernel.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve::loop {

// The number of nodes for a relative tolerance: 8 or 12.
[[nodiscard]] int choose_nodes(double rtol);

enum class LoopEnding {
  done,
  unbounded,  // the motion grows without bound, as for a single run (Shrinking)
  given_up,   // left to another integrator
};

// The result of a loop. Its pointers are valid only during LoopStudy::end().
struct LoopRun {
  LoopEnding ending;
  double reached;          // s
  std::size_t rows;        // of the grid, up to there
  const double *x, *y;     // of each row
  const double* state;     // at `reached`, as the loop packs its states
  double greatest[looks];  // over the motion up to there, rows and between
};

// The source of loops and the sink of their results.
class LoopStudy {
 public:
  virtual ~LoopStudy() = default;
  // Fills in the next loop and returns its number; empty if there are no more. A few dozen loops
  // are in progress at a time.
  virtual std::optional<std::size_t> begin(LoopCase& loop) = 0;
  virtual void end(std::size_t number, const LoopRun& run) = 0;
};

// A loop in progress.
struct LoopWay {
  std::size_t number = 0;  // in the study
  double t = 0, next = 0;  // present time and longest next step, s
  bool arrives = false;    // whether this attempt ends the loop
  bool rejected = false;   // whether the last attempt was rejected
  std::size_t attempts = 0, steps = 0, rows = 1;
  Shrinking shrinking;
  std::vector<double> x{}, y{};  // of rows
};

// Integrates loops from t = 0 over an output grid, by collocation at Radau IIA's nodes (step.hpp).
// Each lane has its own time and steps. Loops that need similar numbers of steps run together.
// Loops that fall behind or go to infinity are set aside until they fill the lanes. Stiff servos
// cost no more steps than the motion does.
//
// The tolerances bound each step's error in each state, with one exception. If omega_n is above 1
// rad/s, the absolute tolerance of a servo's rates is atol omega_n, and that of the ball's velocity
// is this value times the radius. Positions and angles keep atol.
//
// A loop's results depend on nothing else, to the bit: neither on loops beside it nor on earlier
// ones. Use one object per thread.
class LoopLanes {
 public:
  // `nodes` comes from choose_nodes(). Throws InputError as choose_kernels() does.
  LoopLanes(Drives drives, int nodes, Tolerances tolerances, const OutputGrid& grid);

  // Integrates all loops of the study. When `stop` becomes true, gives up the loops in progress;
  // end() is not called for these, nor for any later ones.
  void carry(LoopStudy& study, const std::atomic<bool>& stop);

  // Of the last study. A Jacobian and its iterations count once for all lanes of an attempt.
  [[nodiscard]] Statistics statistics() const { return statistics_; }

 private:
  using Way = LoopWay;
  struct Free {
    void operator()(void* memory) const;
  };
  struct Aside {
    Way way;
    LoopState state;
    double greatest[looks];
  };

  void fill(LoopStudy& study);
  void begin(LoopStudy& study);
  void resume(int lane);
  void set_aside(int lane);
  void set_laggards_aside();
  void idle(int lane);
  void plan(int lane, Way& way);
  bool judge(int lane, const Attempt& attempt, Way& way, std::optional<LoopEnding>& ending);
  void record(int lane, Way& way);
  void end(int lane, LoopEnding ending, LoopStudy& study);
  [[nodiscard]] std::optional<Way>& way_of(int lane) {
    return ways_[static_cast<std::size_t>(lane)];
  }
  [[nodiscard]] int live() const;
  [[nodiscard]] double size(int lane) const;
  void take_columns(Way& way);

  const Kernel* kernel_;
  double end_, reach_;         // s; the first step as a multiple of the loop's fastest time
  std::vector<double> times_;  // of the rows, s, padded at the end
  std::size_t rows_;
  std::unique_ptr<void, Free> workspace_;
  bool exhausted_ = false;  // there are no more loops
  bool laggards_ = false;   // the lanes hold loops that were set aside before
  Greatest greatest_{};
  std::array<std::optional<Way>, group> ways_;
  std::vector<Aside> aside_;
  std::vector<std::vector<double>> spare_;  // unused columns
  Spans spans_{};
  Statistics statistics_;
};

}  // namespace bbsim::solve::loop
