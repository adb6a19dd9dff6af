// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/loop_text.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>

#include "base/short_number.hpp"
#include "model/control/common_cycle.hpp"
#include "model/spectrum.hpp"

namespace bbsim::api {

namespace {

// Whether this is a pair's second pole, which the first one names. Smaller imaginary parts are
// rounding errors of a double pole's root.
bool is_named(const std::complex<double>& pole) {
  return pole.imag() < -1e-7 * std::abs(pole);
}

void add_pole(std::string& line, const std::complex<double>& pole) {
  if (!line.empty()) line += ", ";
  line += short_number(pole.real());
  if (pole.imag() > 1e-7 * std::abs(pole)) line += " +- " + short_number(pole.imag()) + "i";
}

}  // namespace

std::string poles_line(const model::Eigenvalues& poles) {
  std::string line;
  for (const auto& pole : poles) {
    if (!is_named(pole)) add_pole(line, pole);
  }
  return line;
}

std::string sampled_poles_line(const model::Eigenvalues& poles) {
  std::string line;
  std::size_t named = 0;
  for (const auto& pole : poles) {
    if (is_named(pole)) continue;
    if (named == 6 || (named > 0 && std::abs(pole) < 1e-3)) return line + ", smaller ones";
    add_pole(line, pole);
    ++named;
  }
  return line;
}

namespace {

std::string instability_of_samples(const model::Model& model) {
  const model::Eigenvalues poles = model::sampled_poles(model);
  if (poles.empty() || model::stable_by_period(poles)) return "";
  const int outside = model::growing_by_period(poles);
  if (outside == 0) {
    return "the sampled loop is at the stability limit about home, within rounding: poles " +
           sampled_poles_line(poles);
  }
  return "the sampled loop is unstable about home: " + std::to_string(outside) + " of its " +
         std::to_string(poles.size()) + (outside == 1 ? " poles is" : " poles are") +
         " outside the unit circle: " + sampled_poles_line(poles);
}

std::string instability(const model::Model& model) {
  if (model.rig && model.rig->sampled) return instability_of_samples(model);
  const model::Eigenvalues poles = model::closed_loop_poles(model);
  if (poles.empty() || model::stable(poles)) return "";
  const int growing = model::growing(poles);
  if (growing == 0) {
    return "the closed loop is at the stability limit about home, within rounding: poles (1/s) " +
           poles_line(poles);
  }
  return "the closed loop is unstable about home: " + std::to_string(growing) + " of its " +
         std::to_string(poles.size()) + (growing == 1 ? " poles has" : " poles have") +
         " a positive real part (1/s): " + poles_line(poles);
}

bool is_pd_or_pid(const Scenario& scenario) {
  return scenario.controller &&
         (scenario.controller->law == Law::pd || scenario.controller->law == Law::pid);
}

// Reverses theta's row in a state feedback and in the gains with a bit in `which`.
Scenario with_theta_reversed(const Scenario& scenario, unsigned which) {
  Scenario reversed = scenario;
  Controller& controller = *reversed.controller;
  const auto reverse = [&](Matrix2& gain, unsigned bit) {
    if ((which & bit) == 0) return;
    for (double& number : gain[1]) number = -number;
  };
  reverse(controller.kv, 1);
  reverse(controller.kp, 2);
  reverse(controller.ki, 4);
  // Columns 5 to 8 multiply the servos' own angles and rates, and keep their signs.
  for (std::size_t i = 0; i < 4; ++i) controller.gain[1][i] = -controller.gain[1][i];
  return reversed;
}

// Whether the loop is stable with other signs in theta's row.
bool has_wrong_signs(const Scenario& scenario, const model::Model& model) {
  const bool state_feedback =
      scenario.controller && scenario.controller->law == Law::state_feedback;
  if (!is_pd_or_pid(scenario) && !state_feedback) return false;
  const unsigned most = state_feedback ? 1 : 7;
  for (unsigned which = 1; which <= most; ++which) {
    const Scenario reversed = with_theta_reversed(scenario, which);
    if (instability(model::assemble(reversed, model.gamma)).empty()) return true;
  }
  return false;
}

}  // namespace

std::string instability_warning(const Scenario& scenario, const model::Model& model) {
  std::string warning = instability(model);
  if (warning.empty()) return warning;
  if (is_pd_or_pid(scenario) && scenario.controller->drives == Drives::acceleration) {
    warning +=
        "; a law that drives accelerations must feed back the tilt: use drives: angle with "
        "gimbal.servo, or lqr";
  } else if (has_wrong_signs(scenario, model)) {
    warning +=
        "; theta's gains have the wrong sign: positive theta drives the ball towards -y, so a gain "
        "k for both is [[k, 0], [0, -k]]";
  }
  return warning;
}

std::string without_frames(const Scenario& scenario, bool by_sample) {
  const std::optional<Controller>& controller = scenario.controller;
  if (!controller || !controller->sampling || !controller->sensor || !controller->sensor->period) {
    return "";
  }
  const model::CommonCycle cycle = model::common_cycle(*controller->sampling, *controller->sensor);
  const std::string start = "without the sensor's own frames, as if each sample had one: ",
                    frames =
                        "frames every " + short_number(1e3 * *controller->sensor->period) + " ms";
  if (!controller->sampling->is_even()) {
    return start + "with an uneven clock, their age at a sample is not known beforehand";
  }
  if (!cycle.known) {
    return start + frames + " do not coincide again with samples every " +
           short_number(1e3 * controller->sampling->period) + " ms within 500 samples";
  }
  if (by_sample && cycle.samples > 1) {
    return start + frames + " coincide with the samples again after " +
           short_number(cycle.samples) + " samples; the loop differs from sample to sample";
  }
  return "";
}

}  // namespace bbsim::api
