// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates sampled rigs from one instant to the next in one piece, with servos in closed form.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "solve/collocation/step_length.hpp"
#include "solve/outcome.hpp"
#include "solve/sampled/held_plate.hpp"
#include "solve/sampled/instants.hpp"
#include "solve/sampled/kernel.hpp"
#include "solve/sampled/motion_tables.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve::sampled {

// The kernels of the chosen instruction set. Throws InputError if the environment variable
// BBSIM_SIMD is set, but not to an instruction set of this processor.
[[nodiscard]] const Kernels& choose_kernels();

// Whether HeldStepper can run the model: its command is held between samples, its servos move in
// closed form in every mode, and nothing but their motion moves the plate and the ball.
[[nodiscard]] bool can_step(const model::Model& model);
// Whether such a model has the servos' work among its states, as the last one, and it is wanted.
[[nodiscard]] bool counts_work(const model::Model& model);

// A stepper for models that pass can_step(). A step usually reaches its limit, because pieces are
// short. Steps get shorter if 8 nodes do not resolve the ball's motion, as after a jump of a stiff
// servo. The stepper does not know when a servo switches: the caller must pass a limit no later
// than the next switch. Once its tables are made it does not allocate.
class HeldStepper : public Stepper {
 public:
  HeldStepper(const model::Model& model, const Kernels& kernels, Tolerances tolerances);

  void start(double t, const double* z) override;
  [[nodiscard]] std::optional<Failure> step(double limit) override;
  void evaluate(const double* times, std::size_t count, double* rows) override {
    evaluate(times, count, rows, true);
  }
  void evaluate_ball(const double* times, std::size_t count, double* rows) override {
    evaluate(times, count, rows, counts_work_);
  }
  void jump() override {}
  [[nodiscard]] double time() const override { return time_; }
  [[nodiscard]] std::vector<double> state() const override;
  [[nodiscard]] std::size_t worst_state() const override { return worst_state_; }
  [[nodiscard]] Statistics statistics() const override { return statistics_; }
  [[nodiscard]] std::size_t detail() const override { return nodes; }
  [[nodiscard]] std::size_t parts() const override;

  [[nodiscard]] const model::HeldMotions* servos() const override { return &servo_; }
  [[nodiscard]] bool no_monitor_changes(const std::vector<char>& occurring) override;
  [[nodiscard]] std::optional<Bounds> bounds(Bounded column, const model::BallConstants& constants,
                                             bool closely) override;

 private:
  // The contribution of each coefficient of an acceleration's series to the velocity and to the
  // position, `after` seconds into a piece of `length` s.
  struct Shares {
    double after = -1, length = -1;
    double of_velocity[nodes], of_position[nodes];

    void evaluate(const Piece& piece, double (&ball)[6]) const;
  };

  void settle();
  void finish();
  void put_work(double* z) const;
  void evaluate(const double* times, std::size_t count, double* rows, bool servos);
  void evaluate_some(const double* times, std::size_t count, double* rows, bool servos);
  [[nodiscard]] const Shares* shares(double after);
  const Range& range(Quantity of);
  void take_reference();

  const model::Model* model_;
  const Kernels& kernels_;
  Kernels::Of kernel_;
  Scene scene_{};
  Piece piece_{};
  MotionTables tables_;
  Instants instants_;
  std::array<Shares, 4> shares_{};  // two instants within pieces of each of two lengths
  std::size_t next_shares_ = 0;
  HeldPlate plate_;
  std::size_t servos_, rate_;  // how many; the index of the first one's rate
  bool counts_work_;
  double work_beyond_energy_ = 0;               // servos' work less the rig's energy, J
  model::HeldMotions servo_{};                  // from the start of the last step
  std::vector<double> reached_;                 // states at its end
  std::array<Range, quantity_count> ranges_{};  // of the last step
  QuantityValues at_points_{};
  bool evaluated_ = false;
  const model::BallConstants* loads_of_ = nullptr;
  double began_ = 0, time_ = 0;  // the last step, s
  StepControl steps_;
  double last_error_ = 0;
  bool loses_motion_ = false;  // a servo moved between two nodes of the last step
  double tempo_ = 0;           // of the reference, rad/s
  bool attempted_ = false;     // a step was made that is not yet the present state
  double turned_ = 0;          // integral of u at the step's end, m
  std::size_t worst_state_ = 0;
  Statistics statistics_;
};

}  // namespace bbsim::solve::sampled
