// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "describe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include "model/control/common_cycle.hpp"

namespace bbsim::app {

std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string rounded(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  if (!(std::abs(value) >= 1 && std::abs(value) < 1e15)) return text;
  const double kept = std::strtod(text, nullptr);
  const int before_point = static_cast<int>(std::log10(std::abs(kept))) + 1;
  std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - before_point), kept);
  return text;
}

std::string states_line(const model::Model& model) {
  const std::vector<std::string> names = model.state_names();
  std::string line = std::to_string(names.size()) + " states: ";
  for (std::size_t i = 0; i < names.size(); ++i) line += (i > 0 ? ", " : "") + names[i];
  return line;
}

std::string poles_line(const model::Eigenvalues& poles) {
  std::string line;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    if (poles[i].imag() < -1e-7 * std::abs(poles[i])) continue;  // its conjugate has been named
    if (!line.empty()) line += ", ";
    line += short_number(poles[i].real());
    // A smaller imaginary part is the rounding of a double pole's root.
    if (poles[i].imag() > 1e-7 * std::abs(poles[i]))
      line += " +- " + short_number(poles[i].imag()) + "i";
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

// The scene with all gains of theta's row turned round; nothing under a law that knows the signs.
std::optional<Scenario> with_theta_turned(const Scenario& scenario) {
  const auto has_rows = [](Law law) {
    return law == Law::pd || law == Law::pid || law == Law::state_feedback;
  };
  if (!scenario.controller || !has_rows(scenario.controller->law)) return {};
  Scenario turned = scenario;
  Controller& controller = *turned.controller;
  for (Matrix2* gain : {&controller.kv, &controller.kp, &controller.ki}) {
    for (double& number : (*gain)[1]) number = -number;
  }
  // Not those on the servo's own angle and rate.
  for (std::size_t i = 0; i < 4; ++i) controller.gain[1][i] = -controller.gain[1][i];
  return turned;
}

}  // namespace

std::string instability_warning(const Scenario& scenario, const model::Model& model) {
  std::string warning = instability(model);
  if (warning.empty()) return warning;
  const std::optional<Scenario> turned = with_theta_turned(scenario);
  if (turned && instability(model::assemble(*turned, model.gamma)).empty()) {
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

std::string failure_text(const Scenario& scenario, const model::Model& model,
                         const solve::Outcome& outcome) {
  if (outcome.why == solve::Why::controller) {
    return "the run ended early, at t = " + short_number(outcome.reached) + " s of " +
           short_number(scenario.time.end) + " s: " + outcome.reason + '.';
  }
  const std::vector<std::string> names = model.state_names();
  std::string text = "the run ended early, at t = " + short_number(outcome.reached) + " s of " +
                     short_number(scenario.time.end) + " s: " + outcome.reason + ".\n";
  const auto& state = outcome.last_state;
  const auto lost = std::ranges::find_if(state, [](double value) { return !std::isfinite(value); });
  if (lost != state.end()) {
    return text + "  " + names[static_cast<std::size_t>(lost - state.begin())] +
           " is no longer a finite number; the file has the rows before that.";
  }
  const auto largest = std::max_element(
      state.begin(), state.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto none =
      std::find_if(state.begin(), state.end(), [](double z) { return std::isnan(z); });
  if (none != state.end()) {
    text += "  " + names[static_cast<std::size_t>(none - state.begin())] +
            " is no longer a number: the motion has left the range of doubles.\n";
  } else if (largest != state.end()) {
    const auto index = static_cast<std::size_t>(largest - state.begin());
    const char* verb =
        std::abs(*largest) > 1e3 ? " grew without bound, to " : " is the largest, at ";
    text += "  " + names[index] + verb + short_number(*largest) +
            "; the error estimate was worst for " + names[outcome.worst_state] + ".\n";
  }
  const std::string warning = instability_warning(scenario, model);
  if (!warning.empty()) {
    text += "  That is the scene, not the solver: " + warning + ".\n";
    text += "  Change the gains or the servo; `bbsim check` shows the poles.";
  } else if (none != state.end() || (largest != state.end() && std::abs(*largest) > 1e30)) {
    text +=
        "  That is the motion, not the solver: end the scene earlier, or change the gimbal's "
        "motion.";
  } else {
    text += "  Try a looser solver.rtol, or another solver.method; `bbsim check` shows the model.";
  }
  return text;
}

std::string occurrence_text(const model::Occurrence& occurrence) {
  struct Words {
    const char* name;
    const char* text;
  };
  constexpr Words words[] = {
      {"edge", "the contact point left the plate"},
      {"slip", "rolling needs more friction than there is"},
      {"lift_off", "the ball leaves the plane: the normal force is no longer positive"},
      {"tilt", "the plate reaches its tilt limit"},
      {"roll", "the ball rolls again"},
      {"rest", "rolling resistance has brought the ball to rest"},
      {"stick_phi", "friction of its motor holds phi"},
      {"stick_theta", "friction of its motor holds theta"},
      {"dead_point", "the linkage of a servo is at a dead point, or at the end of its curve"},
      {"singularity",
       "no accelerations of the gimbal give the ball the wanted acceleration any more"},
  };
  std::string text = occurrence.name;
  for (const Words& word : words) {
    if (occurrence.name == word.name) text = word.text;
  }
  const model::BallMotion& ball = occurrence.sample.ball;
  return text + ", at x = " + short_number(ball.x) + " m, y = " + short_number(ball.y) + " m";
}

std::string stopping_text(const Scenario& scenario, const std::string& event) {
  const Events& events = scenario.events;
  if (event == "tilt" && !events.tilt) {
    return "This is the default under feedback_linearization; events.tilt with action: note lets "
           "the run continue.";
  }
  if (event == "singularity" && !events.singularity) {
    return "This is the default under feedback_linearization; events.singularity.action: note lets "
           "the run continue.";
  }
  if (event == "lift_off" && !events.lift_off) {
    return "This is the default if friction depends on the normal force; events.lift_off: note "
           "lets the run continue.";
  }
  if (event == "dead_point") {
    return "There is no motion beyond it. `bbsim check` prints the angles between which the servos "
           "may turn; gimbal.servo.angle_limit or controller.limit keeps them there.";
  }
  if (event.starts_with("stick")) {
    return "The scene asks for this: events.stick is stop; note lets the run continue.";
  }
  const bool plain = event == "edge" || event == "lift_off" || event == "rest";
  return "The scene asks for this: events." + event + (plain ? "" : ".action") +
         " is stop; note lets the run continue.";
}

std::string noted_text(const std::vector<model::Occurrence>& occurrences) {
  std::vector<std::string> names;
  std::string text;
  for (const model::Occurrence& first : occurrences) {
    if (first.stopped || std::find(names.begin(), names.end(), first.name) != names.end()) continue;
    names.push_back(first.name);
    const auto same = [&](const model::Occurrence& other) {
      return other.name == first.name && !other.stopped;
    };
    const auto count = std::count_if(occurrences.begin(), occurrences.end(), same);
    if (!text.empty()) text += "\n";
    text += "noted: " + first.name + ", " +
            (count == 1 ? "once" : std::to_string(count) + " times, first") +
            " at t = " + short_number(first.t) + " s: " + occurrence_text(first);
  }
  return text;
}

std::string sampled_poles_line(const model::Eigenvalues& poles) {
  std::string line;
  std::size_t named = 0;
  for (const auto& pole : poles) {
    if (pole.imag() < -1e-7 * std::abs(pole)) continue;  // its conjugate has been named
    if (named == 6 || (named > 0 && std::abs(pole) < 1e-3)) return line + ", smaller ones";
    if (!line.empty()) line += ", ";
    line += short_number(pole.real());
    // A smaller imaginary part is the rounding of a double pole's root.
    if (pole.imag() > 1e-7 * std::abs(pole)) line += " +- " + short_number(pole.imag()) + "i";
    ++named;
  }
  return line;
}

}  // namespace bbsim::app
