// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Many closed loops at once, for studies of their gains: another loop in each SIMD lane.
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

// How many nodes suit a relative tolerance: 8 or 12.
[[nodiscard]] int choose_nodes(double rtol);

enum class LoopEnding {
  done,
  unbounded,  // the motion grew without bound, as for a single run (Shrinking)
  given_up,   // for another integrator
};

// What became of a loop; its rows and its state are there as long as LoopStudy::end() looks at
// them.
struct LoopRun {
  LoopEnding ending;
  double reached;          // s
  std::size_t rows;        // of the grid, up to there
  const double *x, *y;     // of each row
  const double* state;     // at `reached`, as the loop packs its states
  double greatest[looks];  // of the motion up to there, between rows as at them
};

// What loops are taken from, and where what becomes of them goes.
class LoopStudy {
 public:
  virtual ~LoopStudy() = default;
  // The next loop, and a number that it goes by; none if there is none. A few dozen are on their
  // way at a time.
  virtual std::optional<std::size_t> begin(LoopCase& loop) = 0;
  virtual void end(std::size_t number, const LoopRun& run) = 0;
};

// A loop on its way.
struct LoopWay {
  std::size_t number = 0;  // in the study
  double t = 0, next = 0;  // s: where it is, and how long the next step may be
  bool arrives = false;    // with this attempt
  bool rejected = false;   // the last attempt was
  std::size_t attempts = 0, steps = 0, rows = 1;
  Shrinking shrinking;
  std::vector<double> x{}, y{};  // of rows
};

// Integrates loops from t = 0 over an output grid by collocation at Radau IIA's nodes (step.hpp),
// each lane at its own time and by its own steps. Loops that need about as many steps go together;
// those that fall behind, or are on the way to infinity, are set aside until they fill the lanes.
// Stiff servos cost no more steps than the motion does.
//
// The tolerances bound each step's error in each state, with one exception: of a servo's own
// motion, faster than 1 rad/s, its rates are followed to an absolute tolerance of atol omega_n, and
// the ball's velocity to that times the radius. The ball's place and the angles are not concerned.
//
// What becomes of a loop depends on nothing else, to the bit: neither on those beside it nor on
// those before. One for each thread.
class LoopLanes {
 public:
  // Throws InputError as choose_kernels() does. `nodes` is one of choose_nodes()'s.
  LoopLanes(Drives drives, int nodes, Tolerances tolerances, const OutputGrid& grid);

  // Carries all loops of the study, or gives up those on their way when `stop` becomes true: of
  // these, and of any after them, end() is not told.
  void carry(LoopStudy& study, const std::atomic<bool>& stop);

  // Of the last study; a Jacobian and its iterations count for all lanes of an attempt.
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
  double end_, reach_;         // s; of the first step, in parts of what the fastest motion takes
  std::vector<double> times_;  // of the rows, s, and room beyond them
  std::size_t rows_;
  std::unique_ptr<void, Free> workspace_;
  bool exhausted_ = false;  // there are no more loops
  bool laggards_ = false;   // what the lanes have was set aside before
  Greatest greatest_{};
  std::array<std::optional<Way>, group> ways_;
  std::vector<Aside> aside_;
  std::vector<std::vector<double>> spare_;  // columns that no loop has
  Spans spans_{};
  Statistics statistics_;
};

}  // namespace bbsim::solve::loop
