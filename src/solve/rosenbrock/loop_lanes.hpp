// Many closed loops at once, for studies of their gains: another loop in each SIMD lane.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "scenario/scenario.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/rosenbrock/kernel.hpp"

namespace bbsim::solve::rosenbrock {

// One loop, in SI: model::ClosedLoop<Shape::full, ...> about a reference
// start + rate t + sine sin(frequency t) + cosine cos(frequency t), components x, y.
struct LoopCase {
  double radius, gravity;
  double kv[2][2], kp[2][2];  // rows phi, theta; columns x, y
  double omega_n, zeta;       // of the servo; not used where accelerations are driven
  double start[2], rate[2];
  double frequency, sine[2], cosine[2];
  double initial[states];  // as the loop packs its states
};

// A step of a group, to be looked at before the next one.
class GroupStep {
 public:
  GroupStep(const Kernel& kernel, void* workspace, double from, double to)
      : kernel_(kernel), workspace_(workspace), from_(from), to_(to) {}

  [[nodiscard]] double from() const { return from_; }  // s
  [[nodiscard]] double to() const { return to_; }
  // Looks at the step as Kernel::look() does; to be called once for each step.
  [[nodiscard]] bool look(Looks& looks) const { return kernel_.look(workspace_, &looks); }
  // States at times within the step, [time][state][lane], aligned to 64. They are polynomials of
  // degree 4 over it.
  void evaluate(const double* times, std::size_t count, double* rows) const {
    kernel_.evaluate(workspace_, times, count, rows);
  }

 private:
  const Kernel& kernel_;
  void* workspace_;
  double from_, to_;
};

// Is told of each step of a group. What it is told of a lane that is given up later means nothing.
class StepSink {
 public:
  virtual ~StepSink() = default;
  virtual void accept(const GroupStep& step) = 0;
};

// Integrates groups of loops from t = 0 over an output grid, in lock step: a group takes one step
// for all its lanes, short enough for each, by a Rosenbrock method of order 5 (rodas5p.hpp) with
// the exact Jacobian. Stiff servos cost no more steps than the motion does.
//
// The tolerances bound each step's error in each state, with one exception: of a servo's own
// motion, faster than 1 rad/s, its rates are followed to an absolute tolerance of atol omega_n, and
// the ball's velocity to that times the radius. The ball's place and the angles are not concerned.
//
// A loop's rows depend, within the tolerance, on its companions in the group, and on nothing else:
// the same group gives the same bits whichever thread and whatever ran before. Allocates nothing
// once it is made; one for each thread.
class LoopLanes {
 public:
  // Throws InputError as choose_kernels() does.
  LoopLanes(Drives drives, solve::Tolerances tolerances, const solve::OutputGrid& grid);

  // The first `count` cases, 1 <= count <= group. Whether each was carried to the end; one that was
  // not, for values that are not finite, for steps that shrank to nothing or were about to, for too
  // many steps, or because it would hold the others back, is for another integrator. `steps`, which
  // may be null, is told of the motion between rows.
  std::array<bool, group> integrate(const LoopCase* cases, int count, StepSink* steps = nullptr);

  // The last group's states, [row][state][lane], a row for each time of the grid; aligned to 64.
  // Rows of a case that was given up, and of lanes beyond `count`, mean nothing.
  [[nodiscard]] const double* rows() const { return rows_.get(); }

  // The statistics are those of the last group; each attempted step takes one Jacobian.
  [[nodiscard]] solve::Statistics statistics() const { return statistics_; }

 private:
  struct Free {
    void operator()(void* memory) const;
  };

  void load(const LoopCase* cases, int count);
  double fastest(const LoopCase* cases, int count);
  double judge(const double* errors, bool at_limit);
  void give_up(const double* errors, double least);
  void record(double arrived);
  void replace_lost();

  const Kernel* kernel_;
  solve::Tolerances tolerances_;
  std::vector<double> times_;  // of the rows, s
  std::unique_ptr<double, Free> rows_;
  std::unique_ptr<void, Free> workspace_;
  std::array<bool, group> lost_{};
  std::array<int, group> held_{};  // attempts in which a lane alone needed a far shorter step
  std::size_t recorded_ = 0;
  solve::Statistics statistics_;
};

}  // namespace bbsim::solve::rosenbrock
