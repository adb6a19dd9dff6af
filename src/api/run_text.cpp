// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sentences about how a run ended (simulation.hpp).
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "api/loop_text.hpp"
#include "api/simulation.hpp"
#include "base/short_number.hpp"

namespace bbsim::api {
namespace {

std::string plate_text(const Plate& plate) {
  if (plate.diameter) return "plate.diameter is " + short_number(*plate.diameter) + " m";
  return "plate.size is [" + short_number((*plate.size)[0]) + ", " +
         short_number((*plate.size)[1]) + "] m";
}

// "the contact point left the plate, at x = 0.15 m, y = 0.02 m".
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
      {"steps_lost", "the driver asks a stepper for more than its torque: it loses steps"},
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

// Which key makes the scene stop there, and how the scene would run on.
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
    return "The scenario asks for this: events.stick is stop; note lets the run continue.";
  }
  const bool plain =
      event == "edge" || event == "lift_off" || event == "rest" || event == "steps_lost";
  return "The scenario asks for this: events." + event + (plain ? "" : ".action") +
         " is stop; note lets the run continue.";
}

}  // namespace

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
    text += "  The cause is the scenario, not the solver: " + warning + ".\n";
    text += "  Change the gains or the servo; `bbsim check` shows the poles.";
  } else if (none != state.end() || (largest != state.end() && std::abs(*largest) > 1e30)) {
    text +=
        "  The cause is the motion, not the solver: end the scenario earlier, or change the "
        "gimbal's "
        "motion.";
  } else {
    text += "  Try a looser solver.rtol, or another solver.method; `bbsim check` shows the model.";
  }
  return text;
}

std::string stopped_text(const Scenario& scenario, const solve::Outcome& outcome) {
  const model::Occurrence& last = outcome.occurrences.back();
  return "the run stopped at t = " + short_number(outcome.reached) + " s of " +
         short_number(scenario.time.end) + " s: " + occurrence_text(last) + ".\n  " +
         stopping_text(scenario, last.name);
}

std::string noted_text(const std::vector<model::Occurrence>& occurrences) {
  std::vector<std::string> names;
  std::string text;
  for (const model::Occurrence& first : occurrences) {
    if (first.stopped || std::find(names.begin(), names.end(), first.name) != names.end()) continue;
    names.push_back(first.name);
    const auto same = [&](const model::Occurrence& occurrence) {
      return occurrence.name == first.name && !occurrence.stopped;
    };
    const auto count = std::count_if(occurrences.begin(), occurrences.end(), same);
    if (!text.empty()) text += "\n";
    text += "noted: " + first.name + ", " +
            (count == 1 ? "once" : std::to_string(count) + " times, first") +
            " at t = " + short_number(first.t) + " s: " + occurrence_text(first);
  }
  return text;
}

std::vector<std::string> warnings_of(const Scenario& scenario, const model::Model& model,
                                     bool failed, const std::optional<record::OffPlate>& left) {
  std::vector<std::string> warnings = scenario.remarks;
  if (model.closed_loop() && !failed) {
    const std::string instability = instability_warning(scenario, model);
    if (!instability.empty()) warnings.push_back("warning: " + instability);
  }
  if (left) {
    warnings.push_back(
        "warning: the ball is off the plate in the row at t = " + short_number(left->t) +
        " s, at x = " + short_number(left->x) + " m, y = " + short_number(left->y) +
        " m, and the run continues as if the plate were larger: " + plate_text(scenario.plate) +
        "; events.edge: stop ends it there");
  }
  return warnings;
}

}  // namespace bbsim::api
