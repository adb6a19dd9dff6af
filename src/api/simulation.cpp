// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/check.hpp"
#include "api/version.hpp"
#include "base/cpu_clock.hpp"
#include "base/number_text.hpp"
#include "model/control/loop_analysis.hpp"
#include "record/recorder.hpp"
#include "simd/instruction_set.hpp"
#include "solve/integrate.hpp"
#include "study/error_control.hpp"

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

// Why a run failed: when, what the integrator reported, what grew, and what to do.
std::string failure_text(const Scenario& scenario, const model::Model& model,
                         const solve::Outcome& outcome) {
  std::string text = "the run ended early, at t = " + short_number(outcome.reached) + " s of " +
                     short_number(scenario.time.end) + " s: " + outcome.reason + '.';
  if (outcome.why == solve::Why::controller) return text;
  text += '\n';
  const std::vector<std::string> names = model.state_names();
  const auto& state = outcome.last_state;
  const auto lost = std::ranges::find_if(state, [](double value) { return !std::isfinite(value); });
  if (lost != state.end()) {
    return text + "  " + names[static_cast<std::size_t>(lost - state.begin())] +
           " is no longer a finite number; the file has the rows before that.";
  }
  const auto largest = std::max_element(
      state.begin(), state.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (largest != state.end()) {
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
  } else if (largest != state.end() && std::abs(*largest) > 1e30) {
    text +=
        "  The cause is the motion, not the solver: end the scenario earlier, or change the "
        "gimbal's "
        "motion.";
  } else {
    text += "  Try a looser solver.rtol, or another solver.method; `bbsim check` shows the model.";
  }
  return text;
}

// Why a run stopped: when, at which event, which key asks for it, and how the scene would run on.
std::string stopped_text(const Scenario& scenario, const solve::Outcome& outcome) {
  const model::Occurrence& last = outcome.occurrences.back();
  return "the run stopped at t = " + short_number(outcome.reached) + " s of " +
         short_number(scenario.time.end) + " s: " + occurrence_text(last) + ".\n  " +
         stopping_text(scenario, last.name);
}

// How often each event was noted, and when first; one line each, empty if none was.
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

// Remarks on the scenario, an unstable loop, and a ball that left its plate without an event.
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

struct Ended {
  const char* status;
  ExitCode code;
};

// In the order of solve::Ending.
constexpr Ended endings[] = {{"done", ExitCode::done},
                             {"failed", ExitCode::ended_early},
                             {"interrupted", ExitCode::interrupted},
                             {"stopped", ExitCode::ended_early}};

Ended how(solve::Ending ending) {
  return endings[static_cast<std::size_t>(ending)];
}

// Rounds up to two digits, so that the user can ask for the error shown.
double rounded_up(double error) {
  const double digit = std::pow(10.0, std::floor(std::log10(error)) - 1);
  return std::ceil(error / digit) * digit;
}

// Why the run falls short of the request; empty if it does not.
std::string shortfall(const Scenario& scenario, const model::Model& model,
                      const Integration& integration) {
  const double end = scenario.time.end;
  switch (integration.outcome.ending) {
    case solve::Ending::failed:
      return failure_text(scenario, model, integration.outcome);
    case solve::Ending::interrupted:
      return "interrupted at t = " + short_number(integration.outcome.reached) + " s of " +
             short_number(end) + " s.";
    case solve::Ending::stopped:
      return stopped_text(scenario, integration.outcome);
    case solve::Ending::done:
      break;
  }
  if (integration.within_error()) return "";
  return "an error of " + short_number(*scenario.solver.error) +
         " m is out of reach: the scenario amplifies rounding, and double precision gives about " +
         short_number(rounded_up(integration.estimate)) +
         " m.\n"
         "  Ask for that, or end the scenario earlier. The rows are those of the best run.";
}

record::RunSummary summary_of(const Scenario& scenario, const model::Model& model,
                              const Integration& integration) {
  const solve::Outcome& outcome = integration.outcome;
  record::RunSummary summary;
  summary.version = version();
  summary.instruction_set = simd::name_of(simd::chosen_instruction_set());
  summary.scenario = scenario.source.file;
  summary.scenario_text = scenario.source.text;
  summary.title = scenario.title;
  summary.overrides = scenario.source.overrides;
  summary.status = how(outcome.ending).status;
  summary.end_time = outcome.reached;
  summary.rows = outcome.rows;
  summary.states = model.state_names();
  for (const model::Note& note : model::explain(scenario, model)) {
    summary.model_notes.push_back(note.part + ": " + note.reason);
  }
  summary.method = method_name(outcome.method);
  summary.rtol = integration.tolerances.rtol;
  summary.atol = integration.tolerances.atol;
  summary.error_bound = scenario.solver.error;
  if (integration.has_estimate) summary.error_estimate = integration.estimate;
  summary.events = outcome.occurrences;
  summary.statistics = {outcome.statistics, integration.cpu_seconds};
  return summary;
}

solve::Watch watch_of_run(Watch& watch, double end) {
  return {watch.stop(), [&watch, end](double time) { watch.update(time / end, ""); },
          [&watch](double time, double pace, double steps) {
            watch.note("note: at t = " + short_number(time) + " s the run takes " +
                       short_number(pace) + " steps per second of motion, and " +
                       short_number(steps) +
                       " more to its end at that pace. Ctrl-C ends it and keeps its rows; a looser "
                       "solver.rtol or an earlier time.end needs fewer steps.");
          }};
}

}  // namespace

SimulatedRun::SimulatedRun(const Scenario& scenario, const model::Model& model,
                           const solve::OutputGrid& grid, RowsAndMeasures wanted,
                           file::TableWriter& writer, Watch& watch)
    : scenario_(scenario),
      model_(model),
      grid_(grid),
      wanted_(std::move(wanted)),
      watch_(watch),
      constants_(model::constants_of(scenario)),
      split_(scenario::split_loop_measures(wanted_.measures)),
      recorder_({wanted_.columns, split_.of_motion, true}),
      sink_(&recorder_),
      solve_watch_(watch_of_run(watch, grid.end())) {
  recorder_.begin(model, constants_, grid, &writer);
  if (record::EdgeNote::wanted(scenario)) {
    sink_ = &edge_.emplace(model, scenario.plate, grid, recorder_);
  }
  const Solver& solver = scenario.solver;
  integration_.tolerances = {solver.rtol, solver.atol};
  if (!solver.error) {
    integrate_ =
        solve::begin(model, solver.method, integration_.tolerances, grid, *sink_, solve_watch_);
  }
  watch_.start(0);
}

bool SimulatedRun::advance() {
  const CpuClock clock;
  bool is_over = true;
  if (integrate_) {
    auto outcome = integrate_();
    is_over = outcome.has_value();
    if (is_over) integration_.outcome = *std::move(outcome);
  } else {
    const Solver& solver = scenario_.solver;
    static_cast<study::ErrorControlled&>(integration_) = study::integrate_to_error(
        model_, solver.method, *solver.error, grid_, *sink_, solve_watch_);
    const solve::Ending ending = integration_.outcome.ending;
    integration_.has_estimate = ending == solve::Ending::done || ending == solve::Ending::stopped;
  }
  integration_.cpu_seconds += clock.seconds();
  return is_over;
}

// Measures of the motion and of the loop near home, as one list.
void SimulatedRun::take_measures(Simulation& into) {
  std::vector<double> of_motion(split_.of_motion.size());
  recorder_.finish(integration_.outcome, of_motion.data());
  into.measures.resize(wanted_.measures.size());
  into.whys.resize(wanted_.measures.size());
  for (std::size_t m = 0; m < of_motion.size(); ++m) {
    into.measures[split_.motion_places[m]] = of_motion[m];
    into.whys[split_.motion_places[m]] = recorder_.whys()[m];
  }
  model::LoopAnalysis analysis(scenario_, model_, model::parts_of(wanted_.measures));
  for (const std::size_t m : split_.loop_places) {
    const model::LoopAnalysis::Value found = analysis.value_of(*wanted_.measures[m].loop);
    into.measures[m] = found.value;
    into.whys[m] = found.why;
  }
}

Simulation SimulatedRun::finish() {
  watch_.end();
  Simulation simulation;
  take_measures(simulation);
  const solve::Outcome& outcome = integration_.outcome;
  simulation.end_row = recorder_.end_row(outcome);
  simulation.row_estimates = std::move(integration_.row_estimates);

  RunResult& result = simulation.result;
  record::RunSummary& summary = result.summary = summary_of(scenario_, model_, integration_);
  summary.reason = shortfall(scenario_, model_, integration_);
  solve::Why why = integration_.within_error() ? outcome.why : solve::Why::error_out_of_reach;
  const std::string not_finite = recorder_.why_not_finite(wanted_.finite_columns);
  if (summary.reason.empty() && !not_finite.empty()) {
    summary.reason = "the motion was computed to its end, but " + not_finite +
                     ".\n  There it is beyond the range of doubles, or not defined.";
    why = solve::Why::not_finite;
  }
  summary.reason_code = solve::name_of(why);
  summary.warnings = warnings_of(scenario_, model_, outcome.ending == solve::Ending::failed,
                                 edge_ ? edge_->left() : std::nullopt);
  const std::string not_measured =
      scenario::why_not_finite(wanted_.measures, simulation.measures.data(), simulation.whys);
  if (!not_measured.empty()) summary.warnings.push_back("note: " + not_measured);
  summary.peaks = recorder_.peaks();
  result.noted = noted_text(outcome.occurrences);
  result.code = how(outcome.ending).code;
  const bool whole = integration_.within_error() && not_finite.empty();
  if (result.code == ExitCode::done && !whole) result.code = ExitCode::ended_early;
  return simulation;
}

}  // namespace bbsim::api
