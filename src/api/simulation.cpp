// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/simulation.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "api/version.hpp"
#include "base/cpu_clock.hpp"
#include "base/short_number.hpp"
#include "model/control/loop_analysis.hpp"
#include "model/explain.hpp"
#include "record/recorder.hpp"
#include "simd/instruction_set.hpp"
#include "solve/choose.hpp"
#include "solve/integrate.hpp"
#include "study/error_control.hpp"

namespace bbsim::api {
namespace {

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

// What was integrated, and how well, as far as the run knows.
struct Integration {
  solve::Outcome outcome;
  solve::Tolerances tolerances;
  std::optional<double> error_estimate;  // m; only for solver.error
  std::vector<double> row_estimates;     // for each row
  bool within_error = true;
  double cpu_seconds = 0;
};

Integration integrate(const Scenario& scenario, const model::Model& model,
                      const solve::OutputGrid& grid, solve::StateSink& sink,
                      const solve::Watch& watch) {
  const CpuClock clock;
  const Solver& solver = scenario.solver;
  Integration integration;
  if (solver.error) {
    study::ErrorControlled run =
        study::integrate_to_error(model, solver.method, *solver.error, grid, sink, watch);
    integration = {std::move(run.outcome), run.tolerances, {}, {}, true, 0};
    if (integration.outcome.ending == solve::Ending::done ||
        integration.outcome.ending == solve::Ending::stopped) {
      integration.error_estimate = run.estimate;
      integration.row_estimates = std::move(run.row_estimates);
      integration.within_error = run.met;
    }
  } else {
    integration.tolerances = {solver.rtol, solver.atol};
    integration.outcome =
        solve::integrate(model, solver.method, integration.tolerances, grid, sink, watch);
  }
  integration.cpu_seconds = clock.seconds();
  return integration;
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
  if (integration.within_error) return "";
  return "an error of " + short_number(*scenario.solver.error) +
         " m is out of reach: the scenario amplifies rounding, and double precision gives about " +
         short_number(rounded_up(*integration.error_estimate)) +
         " m.\n"
         "  Ask for that, or end the scenario earlier. The file has the rows of the best run.";
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
  summary.method = solve::method_name(outcome.method);
  summary.rtol = integration.tolerances.rtol;
  summary.atol = integration.tolerances.atol;
  summary.error_bound = scenario.solver.error;
  summary.error_estimate = integration.error_estimate;
  for (const model::Occurrence& event : outcome.occurrences) {
    summary.events.push_back(record::event_record(event));
  }
  summary.statistics = {outcome.statistics.steps,
                        outcome.statistics.rhs_evaluations,
                        outcome.statistics.jacobian_evaluations,
                        outcome.statistics.nonlinear_iterations,
                        outcome.statistics.error_test_failures,
                        integration.cpu_seconds};
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

// Measures of the motion and of the loop near home, as one list.
void take_measures(const Scenario& scenario, const model::Model& model,
                   const std::vector<scenario::Measure>& measures,
                   const scenario::SplitMeasures& split, record::Recorder& recorder,
                   const solve::Outcome& outcome, Simulation& into) {
  std::vector<double> of_motion(split.of_motion.size());
  recorder.finish(outcome, of_motion.data());
  into.measures.resize(measures.size());
  into.whys.resize(measures.size());
  for (std::size_t m = 0; m < of_motion.size(); ++m) {
    into.measures[split.motion_places[m]] = of_motion[m];
    into.whys[split.motion_places[m]] = recorder.whys()[m];
  }
  model::LoopAnalysis analysis(scenario, model, model::parts_of(measures));
  for (const std::size_t m : split.loop_places) {
    const model::LoopAnalysis::Value found = analysis.value_of(*measures[m].loop);
    into.measures[m] = found.value;
    into.whys[m] = found.why;
  }
}

}  // namespace

Simulation simulate(const Scenario& scenario, const model::Model& model,
                    const solve::OutputGrid& grid, const RowsAndMeasures& wanted,
                    file::TableWriter& writer, Watch& watch) {
  const model::BallConstants constants = model::constants_of(scenario);
  const scenario::SplitMeasures split = scenario::split_loop_measures(wanted.measures);
  record::Recorder recorder({wanted.columns, split.of_motion, true});
  recorder.begin(model, constants, grid, &writer);
  std::optional<record::EdgeNote> edge;
  if (record::EdgeNote::wanted(scenario)) edge.emplace(model, scenario.plate, grid, recorder);
  solve::StateSink& sink = edge ? static_cast<solve::StateSink&>(*edge) : recorder;

  watch.start(0);
  Integration integration = integrate(scenario, model, grid, sink, watch_of_run(watch, grid.end()));
  watch.end();

  Simulation simulation;
  take_measures(scenario, model, wanted.measures, split, recorder, integration.outcome, simulation);
  simulation.end_row = recorder.end_row(integration.outcome);
  simulation.row_estimates = std::move(integration.row_estimates);

  RunResult& result = simulation.result;
  record::RunSummary& summary = result.summary = summary_of(scenario, model, integration);
  summary.reason = shortfall(scenario, model, integration);
  solve::Why why =
      integration.within_error ? integration.outcome.why : solve::Why::error_out_of_reach;
  const std::string not_finite = recorder.why_not_finite(wanted.finite_columns);
  if (summary.reason.empty() && !not_finite.empty()) {
    summary.reason = "the motion was computed to its end, but " + not_finite +
                     ".\n  There it is beyond the range of doubles, or not defined.";
    why = solve::Why::not_finite;
  }
  summary.reason_code = solve::name_of(why);
  summary.warnings =
      warnings_of(scenario, model, integration.outcome.ending == solve::Ending::failed,
                  edge ? edge->left() : std::nullopt);
  const std::string not_measured =
      scenario::why_not_finite(wanted.measures, simulation.measures.data(), simulation.whys);
  if (!not_measured.empty()) summary.warnings.push_back("note: " + not_measured);
  summary.peaks = recorder.peaks();
  result.noted = noted_text(integration.outcome.occurrences);
  result.code = how(integration.outcome.ending).code;
  const bool whole = integration.within_error && not_finite.empty();
  if (result.code == ExitCode::done && !whole) result.code = ExitCode::ended_early;
  return simulation;
}

}  // namespace bbsim::api
