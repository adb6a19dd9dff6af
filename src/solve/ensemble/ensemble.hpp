// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates many balls on the paper's rig at once, with one case in each SIMD lane: under a given
// motion of the gimbal, or in a closed loop.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "solve/collocation/shrinking.hpp"
#include "solve/ensemble/kernel.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve::ensemble {

// The number of nodes for a relative tolerance: 8 or 12 for loops, and 8, 12 or 16 for given
// motions. For these it also depends on `angle` (rad), through which the fastest sinusoid goes over
// the run. A poor choice only costs time.
[[nodiscard]] int choose_nodes(Actuation actuation, double rtol, double angle = 0);

enum class Ending {
  done,
  unbounded,  // the motion grows without bound (Shrinking)
  given_up,   // left to another integrator
};

// The result of a case. Its pointers are valid only during Study::end().
struct Result {
  Ending ending;
  double reached;               // s
  std::size_t rows;             // of the grid, up to `reached`; 0 if no rows are wanted
  const double *x, *y;          // of each row
  const double* state;          // at `reached`, packed as in the loop
  double greatest[size_count];  // over the motion up to `reached`, also between rows
  const Case* of;
};

// The source of cases and the sink of their results.
class Study {
 public:
  virtual ~Study() = default;
  // Fills in the next case and returns its number; empty if there are no more. A few dozen cases
  // are in progress at a time.
  virtual std::optional<std::size_t> begin(Case& next) = 0;
  virtual void end(std::size_t number, const Result& run) = 0;
};

// The data that all cases share.
struct Problem {
  Actuation actuation;
  OutputGrid grid;
  bool rows = true;             // whether rows are wanted
  std::vector<double> stops{};  // ordered times in (0, end) at which steps end, s
  model::SharedTerms terms{};   // splines of given angles; their knots are stops
};

// A case in progress.
struct ActiveCase {
  std::size_t number = 0;  // in the study
  double t = 0;            // s
  StepControl control;
  std::size_t stop = 0;  // the next one
  bool arrives = false;  // whether this attempt reaches it
  std::size_t attempts = 0, steps = 0, rows = 1;
  double repeats_after;  // see Case
  Shrinking shrinking;
  std::vector<double> x{}, y{};  // of rows
};

// Integrates cases from t = 0 over an output grid, by collocation at Radau IIA's nodes (step.hpp).
// Each lane has its own time and steps. Cases that need similar numbers of steps run together.
// Cases that fall behind or go to infinity are set aside until they fill the lanes. Stiff servos
// need no more steps than the motion does.
//
// The tolerances bound each step's error in each state, with one exception. If omega_n is above 1
// rad/s, the absolute tolerance of a servo's rates is atol omega_n, and that of the ball's velocity
// is this times the radius. Positions and angles keep atol.
//
// Bit for bit, a case's results do not depend on the cases beside it or before it. Use one object
// per thread.
class Ensemble {
 public:
  // `nodes` comes from choose_nodes(). The tables of problem.terms must outlive the object. Throws
  // InputError as choose_kernels() does.
  Ensemble(Problem problem, int nodes, Tolerances tolerances);

  // Integrates all cases of the study. Once `stop` is true, gives up the cases in progress and
  // starts no more. end() is not called for any of these.
  void carry(Study& study, const std::atomic<bool>& stop);

  // The sum of the squared distances of a loop's rows from its reference, m^2. Call it in end().
  [[nodiscard]] double squared_errors(const Result& run) const {
    return kernel_->squared_errors(*run.of, times_.data(), run.rows, run.x, run.y);
  }

  // Counts of the last study. A Jacobian and its iterations count once for all lanes of an attempt.
  [[nodiscard]] Statistics statistics() const { return statistics_; }

 private:
  struct Free {
    void operator()(void* memory) const;
  };
  struct Aside {
    ActiveCase active;
    Progress progress;
    double greatest[size_count];
  };

  void fill(Study& study);
  void begin(Study& study);
  void resume(int lane);
  void set_aside(int lane);
  void set_laggards_aside();
  void idle(int lane);
  void plan(int lane, ActiveCase& active);
  bool judge(int lane, const Attempt& attempt, ActiveCase& active, std::optional<Ending>& ending);
  void record(int lane, ActiveCase& active);
  void end(int lane, Ending ending, Study& study);
  [[nodiscard]] std::optional<ActiveCase>& case_in(int lane) {
    return cases_[static_cast<std::size_t>(lane)];
  }
  [[nodiscard]] int live() const;
  [[nodiscard]] double size(int lane) const;
  void take_columns(ActiveCase& active);

  const Kernel* kernel_;
  std::vector<double> stops_;  // with the end, s
  double end_, reach_;         // s; the first step times the fastest rate
  std::vector<double> times_;  // of the rows, s, padded at the end; empty without rows
  std::size_t rows_;
  std::unique_ptr<void, Free> workspace_;
  bool exhausted_ = false;  // there are no more cases
  bool laggards_ = false;   // the lanes hold cases that were set aside before
  Greatest greatest_{};
  std::array<std::optional<ActiveCase>, group> cases_;
  std::vector<Aside> aside_;
  std::vector<std::vector<double>> spare_;  // unused columns
  std::array<Progress, group> begun_;       // a buffer for begin()
  Spans spans_{};
  Statistics statistics_;
};

}  // namespace bbsim::solve::ensemble
