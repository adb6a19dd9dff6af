// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What an integration is asked for, what it hands on, and how it ended.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "model/events/occurrence.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::solve {

struct Tolerances {
  double rtol = 1e-8;
  double atol = 1e-10;  // in each state's own unit
};

class PieceSink;

// Receives the rows of a run in order. A row is the states at one output time, as the system
// packs them; after them, if the model asks for gamma, the integral of u = r gamma'; and, of a rig
// that switches, what Model::extras() counts.
class StateSink {
 public:
  virtual ~StateSink() = default;
  // Rows first ... first + count - 1, row-major and without gaps. May throw; the run then ends.
  virtual void accept(std::size_t first, std::size_t count, const double* values) = 0;
  // Who is told of the motion between rows (solve/piece.hpp); null if nobody asks.
  [[nodiscard]] virtual PieceSink* pieces() { return nullptr; }
  // Whether rows are of use. If not, a run may do without them, and only counts them.
  [[nodiscard]] virtual bool wants_rows() const { return true; }
};

// Lets the caller look in on a long run.
struct Watch {
  const std::atomic<bool>* stop = nullptr;      // end the run soon after this becomes true
  std::function<void(double time)> progress{};  // called every few hundred steps
  // Called once, if that comes: at `time` (s) the run takes so many steps per second of motion, and
  // needs so many more to its end at that pace.
  std::function<void(double time, double pace, double steps)> slow{};
};

struct Statistics {
  std::size_t steps = 0;
  std::size_t rhs_evaluations = 0;
  std::size_t jacobian_evaluations = 0;
  std::size_t nonlinear_iterations = 0;
  std::size_t error_test_failures = 0;
};

// Why a run is not whole, in a word that scripts may ask for.
enum class Why {
  none,
  event,               // the scene stops at what happened
  unbounded,           // the motion grows without bound
  singular,            // there is no motion beyond the instant
  too_slow,            // it would take more steps than anybody waits for
  controller,          // it is the fault of a controller that is not built in
  not_finite,          // what is asked for, or the motion, is no finite number
  error_out_of_reach,  // double precision cannot give solver.error, or rtol
  interrupted
};
[[nodiscard]] const char* name_of(Why why);

// Why there is no further step, with a sentence for people: "the linear system is singular".
struct Failure {
  Why why = Why::singular;
  const char* text = "";
};
// Of all integrators.
inline constexpr Failure step_is_lost{Why::singular,
                                      "the step shrank to the rounding of the time itself"};

// stopped: something happened that the scene stops at.
enum class Ending { done, failed, interrupted, stopped };

struct Outcome {
  Ending ending = Ending::done;
  Method method = Method::automatic;  // the one that ran
  double reached = 0;                 // s
  std::size_t rows = 0;               // handed to the sink
  Statistics statistics;
  // What there is to know of a failed run: what the integrator says, the state with the largest
  // error estimate, and all states, at the time reached; no states if it failed for another reason
  // than the motion.
  std::string reason;
  Why why = Why::none;
  std::size_t worst_state = 0;
  std::vector<double> last_state;
  // What was watched for and happened, in order; of a stopped run the last one stopped it.
  std::vector<model::Occurrence> occurrences{};
};

// The outcome as it is, but failed with its reason if it says that it is done and has not handed on
// every one of the `rows` of its grid: whatever lost them, no file without them may pass for whole.
[[nodiscard]] Outcome with_all_rows(Outcome outcome, std::size_t rows);

// Collects a whole run in memory.
class Trajectory : public StateSink {
 public:
  // `pieces`, which may be null, is told of the motion between rows.
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
