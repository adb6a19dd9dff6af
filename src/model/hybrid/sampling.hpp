// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sampled controller in a run: its sensor, its law or program, and its delayed commands.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "model/control/external_controller.hpp"
#include "model/control/sample_exchange.hpp"
#include "model/control/sampled_controller.hpp"
#include "model/hybrid/part.hpp"

namespace bbsim::model {

class Sampling : public Part {
 public:
  explicit Sampling(const SwitchedModel& model);

  [[nodiscard]] double next_time() const { return exchange_.next(); }
  [[nodiscard]] double next_change() const { return exchange_.next_command(); }
  [[nodiscard]] double next_sample() const { return exchange_.next_sample(); }
  // Takes the exposures due by t.
  void observe(double t, const double* z) {
    while (exchange_.exposes_by(t)) exchange_.expose(z[0], z[1], is_firm(t, z));
  }

  [[nodiscard]] double rounding(double t) const { return exchange_.rounding(t); }
  [[nodiscard]] double instant_end(double t) const { return exchange_.instant_end(t); }

  // A sample at t, whose instant ends at `end`: either begin(), then end() with the command of the
  // law; or take(), which computes the law. take() returns false, and has changed nothing, if an
  // external controller has no answer yet.
  [[nodiscard]] bool samples_by(double end) const { return exchange_.samples_by(end); }
  std::optional<Pair> begin(double end) { return exchange_.begin_sample(end); }
  void end(const Pair& command, const Pair& measured, double third = 0) {
    exchange_.end_sample({command[0], command[1], third});
    measured_ = measured;
  }
  bool take(double t, double end, const double* z);
  [[nodiscard]] const std::array<Jet<double>, 2>& reference_at(double t);
  void share_reference(SharedSignals& shared) { shared_reference_ = &shared; }

  // Takes the next command that arrives by `end`. Returns the commands to the servos.
  [[nodiscard]] bool commands_by(double end) const { return exchange_.commands_by(end); }
  [[nodiscard]] std::array<double, most_servos> take_command(RigMode& mode);

  // The last measurement of the ball, m, and the last numbers from an external controller.
  [[nodiscard]] const Pair& measured() const { return measured_; }
  [[nodiscard]] const std::vector<double>& own() const { return own_; }
  [[nodiscard]] const SampledController& controller() const { return controller_; }

 private:
  // Whether the ball presses hard enough on a touch screen.
  [[nodiscard]] bool is_firm(double t, const double* z) const {
    return !(least_force_ > 0) || normal_force(t, z) >= least_force_;
  }
  [[nodiscard]] double normal_force(double t, const double* z) const;  // N
  bool ask_external(double t, double end, const double* z);

  const SwitchedModel& model_;
  bool is_direct_;      // servos follow commands without a linkage
  double least_force_;  // of sensor.contact_force, N
  Pair measured_{0, 0};
  SampleExchange exchange_;
  SampledController controller_;
  std::vector<double> own_;
  KnownSignals known_reference_;  // used without a shared cache
  SharedSignals* shared_reference_ = nullptr;
};

}  // namespace bbsim::model
