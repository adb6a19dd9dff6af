// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim's own integrator: Radau IIA collocation of high order, its stages in SIMD lanes.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "model/model.hpp"
#include "simd/instruction_set.hpp"
#include "solve/collocation/shrinking.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/radau/kernel.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve::radau {

[[nodiscard]] const StepKernels& kernels_for(simd::InstructionSet set);

// Those of the instruction set that was chosen. Throws InputError if the environment variable
// BBSIM_SIMD names none of this processor.
[[nodiscard]] const StepKernels& choose_kernels();

// How many stages suit a model and a relative tolerance: 8, 12 or 16, of which open loops take 16
// sooner. Rigs beyond the paper's have kernels of 8 and 12, and take 12 for 16.
[[nodiscard]] int choose_stages(const model::Model& model, double rtol);

// How many stages a model gets that is asked to take so many.
[[nodiscard]] int stages_of(const model::Model& model, int stages);

// L-stable and superconvergent: stiff servos cost no more steps than the motion itself does. The
// collocation polynomial gives the rows between steps. gamma is the polynomial's integral, under
// error control.
//
// A step never goes over a time of the model's stops, if the driver makes them its limits, nor over
// a time at which a sinusoid of the input would pass between two nodes unseen. Allocates nothing
// once it is made, but where steps shrink one after another. Keeps a reference to the model.
class RadauStepper : public Stepper {
 public:
  // `end` (s) scales the first step where nothing moves.
  RadauStepper(const model::Model& model, const StepKernels& kernels, int stages,
               Tolerances tolerances, double end);

  // Makes the stepper as if it were made anew for another model, with the memory of the last one.
  void renew(const model::Model& model, int stages, double end);

  // Rows then have the positions alone; what else is in them is left as it is. To be called before
  // start().
  void leave_out_velocities(bool yes) { positions_only_ = yes; }

  void start(double t, const double* z) override;
  [[nodiscard]] std::optional<Failure> step(double limit) override;
  void evaluate(const double* times, std::size_t count, double* rows) override;
  void jump() override {}
  [[nodiscard]] double time() const override { return time_; }
  [[nodiscard]] std::vector<double> state() const override;
  [[nodiscard]] std::size_t worst_state() const override { return worst_state_; }
  [[nodiscard]] Statistics statistics() const override { return statistics_; }
  [[nodiscard]] std::size_t detail() const override;
  [[nodiscard]] std::size_t parts() const override;
  [[nodiscard]] bool save(StateWriter& into) override;
  void restore(StateReader& from) override;
  [[nodiscard]] double least_end() const override { return least_end_; }

 private:
  template <class Archive>
  void archive(Archive& archive);

  void look_at_model();
  void settle();
  [[nodiscard]] bool diverges(double step, double t);

  const model::Model* model_;
  const StepKernels& kernels_;
  const Kernel* kernel_ = nullptr;
  Tolerances tolerances_;
  double end_ = 0, highest_frequency_ = 0, reach_ = 0, widest_ = 0;
  double tempo_ = 0;  // of what depends on the time alone, rad/s
  bool positions_only_ = false;
  std::unique_ptr<std::byte[]> memory_;  // of the two that follow
  void* workspace_ = nullptr;
  void* view_ = nullptr;
  double time_ = 0;
  double next_step_ = 0;    // s; 0: not known yet
  bool attempted_ = false;  // a step was made, and is not yet the present state
  double turned_ = 0;       // integral of u until start(), m
  Shrinking shrinking_;
  double accepted_step_ = 0, fill_ = 1;  // its length (s), and part of what would have passed
  std::size_t worst_state_ = 0;
  double least_end_ = 0;  // see least_end(), s
  Statistics statistics_;
};

}  // namespace bbsim::solve::radau
