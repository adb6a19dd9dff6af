// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/check.hpp"

#include <cmath>
#include <cstddef>
#include <functional>
#include <set>
#include <string_view>
#include <utility>
#include <variant>

#include "api/assemble.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "model/control/sample_times.hpp"
#include "scenario/exercise.hpp"
#include "scenario/family.hpp"
#include "solve/output_grid.hpp"
#include "sweep/plan.hpp"

namespace bbsim::api {
namespace {

// Rows of an LQR's gain K in u = K (reference - z), which follow from the weights.
void report_gain(Report& report, const Scenario& scenario, const model::Model& model) {
  if (!scenario.controller || scenario.controller->law != Law::lqr) return;
  const model::ControlLaw law = model.rig->sampled
                                    ? model.rig->sampled->law
                                    : std::visit(
                                          [](const auto& any) -> model::ControlLaw {
                                            if constexpr (requires { any.law().gain; })
                                              return any.law();
                                            return {};
                                          },
                                          model.system);
  const auto row = [](const double(&gain)[8]) {
    // Entries that symmetry makes zero differ from it by rounding.
    return joined(gain,
                  [](double value) { return short_number(std::abs(value) < 1e-12 ? 0 : value); });
  };
  report.add("gain phi", row(law.gain[0]));
  report.add("gain theta", row(law.gain[1]));
  report.add("", "on x, y, vx, vy, phi, theta, phi_rate, theta_rate");
}

// Margins mean nothing for an unstable loop.
void report_margins(Report& report, const Scenario& scenario, const model::Model& model) {
  const model::Linearization linearization =
      model::linearize(scenario, model, model::LinearKind::loop, model::home_point());
  report.add(margins_of(linearization));
  report.add(margin_remarks(linearization));
}

// Says which axis poles and margins leave out.
void report_idle_axis(Report& report, const model::Model& model) {
  const std::optional<int> idle = model::idle_axis(model);
  if (!idle) return;
  const bool x = *idle == 0;
  report.add("", std::string("without ") + (x ? "x and phi" : "y and theta") +
                     ": no command moves the ball along " + (x ? "x" : "y") +
                     ", and it has no reference there");
}

void report_sampled_loop(Report& report, const Scenario& scenario, const model::Model& model) {
  const model::Eigenvalues poles = model::sampled_poles(model);
  if (poles.empty()) {
    report.add(
        "WARNING",
        "the poles of the sampled loop exceed the range of doubles: its gains are too large");
    return;
  }
  const std::string warning = instability_warning(scenario, model);
  const model::SampledLoop& loop = *model.rig->sampled;
  const model::CommonCycle cycle = model::common_cycle(loop.sampling, loop.sensor);
  const std::string of = cycle.samples > 1
                             ? short_number(cycle.samples) + " sample periods, with " +
                                   short_number(cycle.frames) + " of the sensor's frames,"
                             : "a sample period";
  report.add("closed loop", std::to_string(poles.size()) + " poles of " + of +
                                " about home: " + poles_line(poles, true));
  report_idle_axis(report, model);
  if (const std::string frames = without_frames(scenario, false); !frames.empty()) {
    report.add("", frames);
  }
  if (!warning.empty()) {
    report.add("WARNING", warning);
    return;
  }
  const double size = std::abs(poles.front()), period = loop.sampling.period * cycle.samples;
  report.add("", "stable: the slowest mode decays by a factor of " + short_number(size) +
                     (cycle.samples > 1 ? " in these periods" : " a period") +
                     ", with a time constant of " + rounded(-period / std::log(size), 3) + " s");
  const Gimbal& gimbal = scenario.gimbal;
  report.add("", std::string("without noise, dropouts, rounding, limits, and losses of servos") +
                     (gimbal.has_steppers() ? "; steppers' ramps are over at once" : ""));
  if (!model::why_not_linear(scenario).empty()) return;
  if (cycle.samples > 1) {
    report.add("margins",
               "none: the loop differs from sample to sample because of the sensor's frames");
  } else {
    report_margins(report, scenario, model);
  }
}

// For loops that are open, or whose law bbsim cannot see.
void report_plant(Report& report, const model::Model& model, const std::string& why) {
  const model::Eigenvalues poles = model::plant_poles(model);
  report.add("plant", poles.empty() ? "poles about home beyond the range of doubles"
                                    : std::to_string(poles.size()) +
                                          " poles about home under a held command (1/s): " +
                                          poles_line(poles));
  report.add("closed loop", "no poles: " + why);
}

void report_closed_loop(Report& report, const Scenario& scenario, const model::Model& model) {
  if (scenario.controller->own) {
    return report_plant(report, model, "only the controller knows its law");
  }
  if (scenario.controller->law == Law::commands) {
    return report_plant(report, model, "commands do not depend on the ball");
  }
  if (model.rig && model.rig->sampled) return report_sampled_loop(report, scenario, model);
  const model::Eigenvalues poles = model::closed_loop_poles(model);
  if (poles.empty()) {
    report.add("WARNING",
               "the closed loop has no linearization about home: the law is singular there, or "
               "poles exceed the range of doubles");
    return;
  }
  const std::string warning = instability_warning(scenario, model);
  report.add("closed loop",
             std::to_string(poles.size()) + " poles about home (1/s): " + poles_line(poles));
  report_idle_axis(report, model);
  if (warning.empty()) {
    report.add("", model.dry ? "stable, without dry friction and limits" : "stable");
    if (model::why_not_linear(scenario).empty()) report_margins(report, scenario, model);
  } else {
    report.add("WARNING", warning);
  }
}

void report_solver(Report& report, const Solver& solver) {
  report.add("solver",
             std::string(method_name(choose_method(solver.method))) +
                 (solver.error ? ", error of x and y at most " + short_number(*solver.error) + " m"
                               : ", rtol " + short_number(solver.rtol) + ", atol " +
                                     short_number(solver.atol)));
}

// How many times the fastest mode decays by a factor of e over the run. Above about 100, stability
// would limit the steps of an explicit method.
double decays_over_run(const model::Model& model, double end) {
  double fastest = 0;
  const auto look = [&](const model::Eigenvalues& values) {
    for (const auto& value : values) fastest = std::max(fastest, -value.real());
  };
  const auto look_at = [&](double t) { look(model::eigenvalues(model, t, model.initial.data())); };
  if (model.closed_loop()) {
    look_at(0);
    look(model::closed_loop_poles(model));
  } else {
    // The Jacobian depends only on time. Sample it across the run.
    constexpr int samples = 8;
    for (int i = 0; i <= samples; ++i) look_at(end * i / samples);
  }
  return fastest * end;
}

void report_reasons(Report& report, const Scenario& scenario, const model::Model& model) {
  report.add("", scenario.solver.method == Method::automatic
                     ? "auto takes the method that was fastest in all measurements"
                     : "asked for");
  const double decays = decays_over_run(model, scenario.time.end);
  if (decays <= 1) {
    report.add("", "not stiff: no motion decays within the run");
    return;
  }
  report.add("", std::string(decays > 100 ? "stiff" : "not stiff") +
                     ": the fastest motion decays with a time constant of " +
                     rounded(scenario.time.end / decays, 3) + " s, in a run of " +
                     short_number(scenario.time.end) + " s");
}

// Describes the scenario's sweep block, after a check of its values.
void report_sweep(Report& report, const Scenario& scenario) {
  if (scenario.sweep.vary.empty()) return;
  const ScenarioFamily family(scenario.source);
  const sweep::SweepPlan plan(family, scenario.sweep);
  static_cast<void>(plan.check(family, 0, plan.cases(), [](double) { return true; }));
  report.add("sweep", std::to_string(plan.cases()) + " cases of bbsim sweep, over " +
                          joined(plan.axes(), &sweep::PlanAxis::key));
}

void report_exercise(Report& report, const Scenario& scenario) {
  const auto exercise = scenario::checked_exercise(scenario);
  if (!exercise) return;
  const std::string free = joined(exercise->free);
  const std::size_t count = exercise->tasks.size();
  report.add("exercise", counted(count, "task") + "; free keys: " + (free.empty() ? "none" : free));
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [text, expect] = exercise->tasks[i];
    report.add("", std::to_string(i + 1) + ". " + text + " (" + expect + ')');
  }
}

// Starts the user's controller, if there is one, and reports what it says and how it answers.
void report_controller(Report& report, const Scenario& scenario, Watch& watch) {
  if (!scenario.controller || !scenario.controller->own) return;
  // The controller starts several times: pass each line on once, and at once, so that a signal that
  // ends bbsim loses none.
  std::set<std::string, std::less<>> seen_lines;
  controller::Host host([&](std::string_view line) {
    if (seen_lines.emplace(line).second) watch.controller_says(line);
  });
  const model::Model model =
      assemble(scenario, scenario::columns_named(scenario.output.columns), host);
  std::string label = "controller";
  for (const std::string& line : host.describe()) {
    report.add(std::exchange(label, ""), line);
  }
  // A function of the calling program is not probed: it may remember earlier calls.
  if (std::holds_alternative<ControllerFactory>(scenario.controller->own->by)) return;
  const Report found = with_places(scenario, [&] {
    Report answers = probe(scenario, model).report;
    host.require_printed();
    const std::string unheard = host.unheard();
    if (!unheard.empty()) throw KeyError("controller.library.wiring", unheard);
    if (const std::string remark = host.line_remark(); !remark.empty()) {
      answers.insert(answers.begin(), {"WARNING", remark});
    }
    return answers;
  });
  report.add(found);
}

Report report_of(const Scenario& scenario, bool sweep, bool reasons) {
  const auto columns = scenario::columns_named(scenario.output.columns);
  const model::Model model = assemble(scenario, columns);
  const solve::OutputGrid grid(scenario.time);

  Report report;
  report.add("scenario", scenario.source.file + " is valid");
  if (!scenario.title.empty()) report.add("title", scenario.title);
  report.add("model", std::to_string(model.state_names().size()) +
                          " states: " + joined(model.state_names()));
  for (const model::Note& note : model::explain(scenario, model)) {
    report.add("  " + note.part, note.reason);
  }

  std::string names;
  for (const std::string& name : scenario.output.columns) names += " " + name;
  report.add("output", std::to_string(grid.size()) + " rows to t = " + short_number(grid.end()) +
                           " s:" + names);
  if (!scenario::need_dynamics(columns) && !scenario.plate.inertia) {
    report.add("", "no forces, torques or energy: no output column asks for them");
  }

  report_gain(report, scenario, model);
  if (model.closed_loop()) {
    report_closed_loop(report, scenario, model);
  } else if (const model::Eigenvalues poles = model::closed_loop_poles(model); !poles.empty()) {
    report.add("plant", std::to_string(poles.size()) +
                            " poles about home under no torque (1/s): " + poles_line(poles));
    if (model.dry) report.add("", "without dry friction and limits");
  }

  report_solver(report, scenario.solver);
  if (reasons) report_reasons(report, scenario, model);
  if (sweep) {
    report_sweep(report, scenario);
    report_exercise(report, scenario);
  }
  for (const std::string& remark : scenario.remarks) report.add("remark", remark);
  return report;
}

}  // namespace

Report describe(const Scenario& scenario) {
  return report_of(scenario, false, false);
}

Report check(const Scenario& scenario, Watch& watch, bool reasons) {
  Report report = report_of(scenario, true, reasons);
  report_controller(report, scenario, watch);
  return report;
}

}  // namespace bbsim::api
