// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The tolerances of an integration, the receivers of its rows, and its outcome.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "model/sample.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::solve {

struct Tolerances {
  double rtol = 1e-8;
  double atol = 1e-10;  // in each state's unit
};

class PieceSink;

// Receives the rows of a run in order. A row has the states at one output time, packed as in the
// system. The integral of u = r gamma' follows if the model asks for gamma. A rig that switches
// adds Model::extras() numbers.
class StateSink {
 public:
  virtual ~StateSink() = default;
  // Takes rows first ... first + count - 1, row-major and without gaps. May throw, which ends the
  // run.
  virtual void accept(std::size_t first, std::size_t count, const double* values) = 0;
  // Returns the receiver of the motion between rows (solve/piece.hpp); null if none is needed.
  [[nodiscard]] virtual PieceSink* pieces() { return nullptr; }
  // If false, the run may skip rows, but neither its first nor its last one.
  [[nodiscard]] virtual bool wants_rows() const { return true; }
  // Whether only the ball's states of rows need be right, except of the first and the last one.
  [[nodiscard]] virtual bool wants_ball_only() const { return false; }
};

// Lets the caller observe and stop a long run.
struct Watch {
  const std::atomic<bool>* stop = nullptr;      // ends the run soon after it becomes true
  std::function<void(double time)> progress{};  // called every few hundred steps
  // Called at most once, when a run turns out to be slow. At `time` (s) it takes `pace` steps per
  // second of motion, and needs `steps` more to its end at that pace.
  std::function<void(double time, double pace, double steps)> slow{};
};

struct Statistics {
  std::size_t steps = 0;
  std::size_t rhs_evaluations = 0;
  std::size_t jacobian_evaluations = 0;
  std::size_t nonlinear_iterations = 0;
  std::size_t error_test_failures = 0;
};

// Why a run is incomplete. Scripts can test the word that name_of() returns.
enum class Why {
  none,
  event,               // an event stops the scene
  unbounded,           // the motion grows without bound
  singular,            // there is no motion beyond this instant
  too_slow,            // the run would take too many steps
  controller,          // an external controller failed
  not_finite,          // the motion, or a requested number, is not finite
  error_out_of_reach,  // double precision cannot reach solver.error, or rtol
  interrupted
};
[[nodiscard]] const char* name_of(Why why);

// Why a stepper cannot go on, with a sentence for users: "the linear system is singular".
struct Failure {
  Why why = Why::singular;
  const char* text = "";
};
// Common to all integrators.
inline constexpr Failure step_is_lost{Why::singular,
                                      "the step shrank to the rounding of the time itself"};

// stopped: an event stops the scene.
enum class Ending { done, failed, interrupted, stopped };

struct Outcome {
  Ending ending = Ending::done;
  Method method = Method::automatic;  // the one that ran
  double reached = 0;                 // s
  std::size_t rows = 0;               // passed to the sink
  Statistics statistics;
  // Details of a failed run: the integrator's reason, the state with the largest error estimate,
  // and all states at the time reached. last_state is empty if the motion is not the cause.
  std::string reason;
  Why why = Why::none;
  std::size_t worst_state = 0;
  std::vector<double> last_state;
  // Events that occurred, in order. If an event stopped the run, it is the last one.
  std::vector<model::Occurrence> occurrences{};
};

// Returns the outcome, changed to failed if it is done but lacks some of the `rows` of its grid. A
// file that lost rows, for whatever cause, must not look complete.
[[nodiscard]] Outcome with_all_rows(Outcome outcome, std::size_t rows);

// Collects a whole run in memory.
class Trajectory : public StateSink {
 public:
  // `pieces`, if not null, receives the motion between rows.
  explicit Trajectory(std::size_t row_size, PieceSink* pieces = nullptr)
      : row_size_(row_size), pieces_(pieces) {}

  void accept(std::size_t, std::size_t count, const double* values) override {
    values_.insert(values_.end(), values, values + count * row_size_);
  }

  [[nodiscard]] PieceSink* pieces() override { return pieces_; }

  [[nodiscard]] std::size_t rows() const { return values_.size() / row_size_; }
  [[nodiscard]] const double* row(std::size_t i) const { return values_.data() + i * row_size_; }

 private:
  std::size_t row_size_;
  PieceSink* pieces_;
  std::vector<double> values_;
};

}  // namespace bbsim::solve
