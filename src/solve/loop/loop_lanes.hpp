// Many closed loops at once, for studies of their gains: another loop in each SIMD lane.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "scenario/scenario.hpp"
#include "solve/loop/kernel.hpp"
#include "solve/lost_lanes.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve::loop {

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

// How many nodes suit a relative tolerance: 8 or 12.
[[nodiscard]] int choose_nodes(double rtol);

// Integrates groups of loops from t = 0 over an output grid, in lock step: a group takes one step
// for all its lanes, short enough for each, by collocation at Radau IIA's nodes (step.hpp). Stiff
// servos cost no more steps than the motion does.
//
// The tolerances bound each step's error in each state, with one exception: of a servo's own
// motion, faster than 1 rad/s, its rates are followed to an absolute tolerance of atol omega_n, and
// the ball's velocity to that times the radius. The ball's place and the angles are not concerned.
//
// A loop's rows depend, within the tolerance, on its companions in the group (their steps, and in
// one pack their turns of Newton's iteration), and on nothing else: the same group gives the same
// bits whichever thread and whatever ran before. Allocates nothing once it is made; one for each
// thread.
class LoopLanes {
 public:
  // Throws InputError as choose_kernels() does. `nodes` is one of choose_nodes()'s.
  LoopLanes(Drives drives, int nodes, Tolerances tolerances, const OutputGrid& grid);

  // Rows but the last one then are of x and y alone.
  void leave_out_all_but_places() { places_only_ = true; }

  // The first `count` cases, 1 <= count <= group. Whether each was carried to the end; one that was
  // not, for values that are not finite, for steps that shrank to nothing or were about to, for too
  // many steps, or because it would hold the others back, is for another integrator.
  std::array<bool, group> integrate(const LoopCase* cases, int count);

  // The last group's states, [row][state][lane], a row for each time of the grid; aligned to 64.
  // Rows of a case that was given up, and of lanes beyond `count`, mean nothing.
  [[nodiscard]] const double* rows() const { return rows_.get(); }
  // From row to row.
  [[nodiscard]] std::size_t row_size() const {
    return static_cast<std::size_t>(places_only_ ? 2 : states) * group;
  }

  // What the last group's motion was greatest at, between rows as at them.
  [[nodiscard]] const Greatest& greatest() const { return greatest_; }

  // Of the last group.
  [[nodiscard]] Statistics statistics() const { return statistics_; }

 private:
  struct Free {
    void operator()(void* memory) const;
  };

  void load(const LoopCase* cases, int count);
  double fastest(const LoopCase* cases, int count);
  void record(double arrived);

  const Kernel* kernel_;
  Tolerances tolerances_;
  std::vector<double> times_;  // of the rows, s
  bool places_only_ = false;
  std::unique_ptr<double, Free> rows_;
  std::unique_ptr<void, Free> workspace_;
  Greatest greatest_{};
  LostLanes<group> lost_;
  std::size_t recorded_ = 0;
  Statistics statistics_;
};

}  // namespace bbsim::solve::loop
