// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sentences about the loop near home: its poles, and whether it is stable.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>

#include "api/check.hpp"
#include "base/number_text.hpp"
#include "model/control/sample_times.hpp"

namespace bbsim::api {
namespace {

// Whether this is a pair's second pole, which the first one names. Smaller imaginary parts are
// rounding errors of a double pole's root.
bool is_named(const std::complex<double>& pole) {
  return pole.imag() < -1e-7 * std::abs(pole);
}

// `largest`: the size of the largest pole. A part that differs from zero by rounding is 0.
void add_pole(std::string& line, const std::complex<double>& pole, double largest) {
  const double rounding = 1e-12 * largest;
  if (!line.empty()) line += ", ";
  line += short_number(std::abs(pole.real()) <= rounding ? 0 : pole.real());
  if (pole.imag() > 1e-7 * std::abs(pole) && pole.imag() > rounding) {
    line += " +- " + short_number(pole.imag()) + "i";
  }
}

// The loop's poles, and how many of them lie beyond the border of stability.
struct LoopPoles {
  bool sampled;
  model::Eigenvalues all;
  bool stable;
  int growing;
};

LoopPoles loop_poles(const model::Model& model) {
  const bool sampled = model.rig && model.rig->sampled;
  model::Eigenvalues poles =
      sampled ? model::sampled_poles(model) : model::closed_loop_poles(model);
  return {sampled, poles, model::stable(poles, sampled), model::growing(poles, sampled)};
}

std::string instability(const model::Model& model) {
  const auto [sampled, poles, stable, growing] = loop_poles(model);
  if (poles.empty() || stable) return "";
  const std::string loop = sampled ? "the sampled loop" : "the closed loop";
  const std::string line = poles_line(poles, sampled);
  if (growing == 0) {
    return loop + " is at the stability limit about home, within rounding: poles " +
           (sampled ? "" : "(1/s) ") + line;
  }
  const std::string beyond =
      sampled ? std::string(growing == 1 ? "is" : "are") + " outside the unit circle: "
              : std::string(growing == 1 ? "has" : "have") + " a positive real part (1/s): ";
  return loop + " is unstable about home: " + std::to_string(growing) + " of its " +
         std::to_string(poles.size()) + " poles " + beyond + line;
}

bool is_pd_or_pid(const Scenario& scenario) {
  return scenario.controller &&
         (scenario.controller->law == Law::pd || scenario.controller->law == Law::pid);
}

enum Rows : unsigned { of_phi = 1, of_theta = 2 };

// Reverses these rows in a state feedback and in the gains with a bit in `which`.
Scenario reversed(const Scenario& scenario, unsigned rows, unsigned which) {
  Scenario changed = scenario;
  Controller& controller = *changed.controller;
  for (const std::size_t row : {0U, 1U}) {
    if ((rows >> row & 1U) == 0) continue;
    unsigned bit = 1;
    for (Matrix2* const gain : {&controller.kv, &controller.kp, &controller.ki}) {
      if ((which & bit) != 0) (*gain)[row] = {-(*gain)[row][0], -(*gain)[row][1]};
      bit *= 2;
    }
    // Columns 5 to 8 multiply the servos' own angles and rates, and keep their signs.
    for (std::size_t i = 0; i < 4; ++i) controller.gain[row][i] = -controller.gain[row][i];
  }
  return changed;
}

bool stable_as(const Scenario& scenario, const model::Model& model) {
  return instability(model::assemble(scenario, model.gamma)).empty();
}

// Which rows of the gains need other signs for a stable loop; 0 if this does not help.
unsigned rows_with_wrong_signs(const Scenario& scenario, const model::Model& model) {
  const bool state_feedback =
      scenario.controller && scenario.controller->law == Law::state_feedback;
  if (!is_pd_or_pid(scenario) && !state_feedback) return 0;
  const unsigned most = state_feedback ? 1 : 7;
  for (const unsigned rows : {+of_theta, +of_phi, of_phi | of_theta}) {
    for (unsigned which = 1; which <= most; ++which) {
      if (stable_as(reversed(scenario, rows, which), model)) return rows;
    }
  }
  return 0;
}

// Whether the loop is unstable because a turn of the plate moves the contact point: also without
// feedback of the position, but not with a ball of almost no radius.
bool feeds_back_the_turn(const Scenario& scenario, const model::Model& model) {
  if (!is_pd_or_pid(scenario) || scenario.controller->drives != Drives::angle) return false;
  Scenario variant = scenario;
  variant.controller->kp = variant.controller->ki = {};
  if (loop_poles(model::assemble(variant, model.gamma)).growing == 0) return false;
  variant = scenario;
  constexpr double almost_none = 1e-6;
  variant.ball.radius *= almost_none;
  if (variant.ball.groove) variant.ball.groove->ball_radius *= almost_none;
  return stable_as(variant, model);
}

}  // namespace

std::string poles_line(const model::Eigenvalues& poles, bool sampled) {
  std::string line;
  std::size_t named = 0;
  double largest = 0;
  for (const auto& pole : poles) largest = std::max(largest, std::abs(pole));
  for (const auto& pole : poles) {
    if (is_named(pole)) continue;
    const bool small = named == 6 || (named > 0 && std::abs(pole) < 1e-3);
    if (sampled && small) return line + ", smaller ones";
    add_pole(line, pole, largest);
    ++named;
  }
  return line;
}

std::string instability_warning(const Scenario& scenario, const model::Model& model) {
  std::string warning = instability(model);
  if (warning.empty()) return warning;
  if (is_pd_or_pid(scenario) && scenario.controller->drives == Drives::acceleration) {
    warning +=
        "; a law that drives accelerations must feed back the tilt: use drives: angle with "
        "gimbal.servo, or lqr";
  } else if (const unsigned rows = rows_with_wrong_signs(scenario, model); rows != 0) {
    constexpr const char* whose[] = {"phi's gains have", "theta's gains have",
                                     "the gains of phi and of theta have"};
    warning += std::string("; ") + whose[rows - 1] +
               " the wrong sign: positive phi drives the ball towards +x, positive theta towards "
               "-y, so a gain k for both is [[k, 0], [0, -k]]";
  } else if (feeds_back_the_turn(scenario, model)) {
    warning +=
        "; the derivative of the contact point causes this: the contact point moves as the plate "
        "turns under the ball, by the ball's radius times the angle, so the gain of the velocity "
        "feeds the servo's own rate back. Lower that gain, or filter the velocity "
        "(controller.sampling.derivative_filter)";
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
