// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim's own integrator: Radau IIA collocation of high order, with the stages in SIMD lanes.
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

// The kernels of the chosen instruction set. Throws InputError if the environment variable
// BBSIM_SIMD is set, but not to an instruction set of this processor.
[[nodiscard]] const StepKernels& choose_kernels();

// The number of stages for a model and a relative tolerance: 8, 12 or 16. Open loops take 16 at
// looser tolerances. Rigs beyond the paper's have kernels of 8 and 12 stages only, and run with 12
// instead of 16.
[[nodiscard]] int choose_stages(const model::Model& model, double rtol);

// The number of stages that a model runs with if `stages` are asked for.
[[nodiscard]] int stages_of(const model::Model& model, int stages);

// The method is L-stable and superconvergent: a stiff servo costs no more steps than the motion
// itself. Rows between steps are values of the collocation polynomial. gamma comes from the
// polynomial's integral, under error control.
//
// Steps end at the model's stops if the driver passes these as limits. A step is short enough that
// no sinusoid of the input passes unseen between two nodes. After construction the stepper
// allocates only while steps keep shrinking. Keeps a reference to the model.
class RadauStepper : public Stepper {
 public:
  // `end` (s): the length of the first step if nothing moves.
  RadauStepper(const model::Model& model, const StepKernels& kernels, int stages,
               Tolerances tolerances, double end);

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

 private:
  void look_at_model();
  void settle();
  [[nodiscard]] bool diverges(double step, double t);

  const model::Model* model_;
  const Kernel* kernel_;
  Tolerances tolerances_;
  double end_, highest_frequency_, reach_, widest_;
  double tempo_;                         // rate of explicit functions of time, rad/s
  std::unique_ptr<std::byte[]> memory_;  // of the two below
  void* workspace_ = nullptr;
  void* view_ = nullptr;
  double time_ = 0;
  StepControl steps_{.next = 0};  // 0: not known yet
  bool attempted_ = false;        // a step was made that is not yet the present state
  double turned_ = 0;             // integral of u until start(), m
  Shrinking shrinking_;
  // Length of the accepted step (s), and its fraction of the length that would have passed
  double accepted_step_ = 0, fill_ = 1;
  std::size_t worst_state_ = 0;
  Statistics statistics_;
};

}  // namespace bbsim::solve::radau
