// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "check.hpp"

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "assemble.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "linear_report.hpp"
#include "model/control/common_cycle.hpp"
#include "model/explain.hpp"
#include "model/spectrum.hpp"
#include "scenario/family.hpp"
#include "scenario/reader.hpp"
#include "solve/choose.hpp"
#include "solve/output_grid.hpp"
#include "sweep/plan.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

// Lines of a label and what belongs to it.
class Report {
 public:
  void line(const std::string& label, const std::string& text) {
    constexpr std::size_t width = 12;
    text_ += label + std::string(label.size() < width ? width - label.size() : 0, ' ') + ' ' +
             text + '\n';
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// The rows of an LQR's gain K, of u = K (reference - z): what the weights came to.
void tell_gain(Report& report, const Scenario& scenario, const model::Model& model) {
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
    std::string text;
    for (const double value : gain) {
      // What symmetry makes zero is zero but for rounding.
      text += (text.empty() ? "" : ", ") + short_number(std::abs(value) < 1e-12 ? 0 : value);
    }
    return text;
  };
  report.line("gain phi", row(law.gain[0]));
  report.line("gain theta", row(law.gain[1]));
  report.line("", "on x, y, vx, vy, phi, theta, phi_rate, theta_rate");
}

// Of an unstable loop they would mean nothing.
void tell_margins(Report& report, const Scenario& scenario, const model::Model& model) {
  const model::Linearization made =
      model::linearize(scenario, model, model::LinearKind::loop, model::home_point());
  report.line("margins", "of each command's loop, the other one closed");
  for (const LabelledLine& line : margin_lines(made)) report.line(line.label, line.text);
}

void tell_sampled_loop(Report& report, const Scenario& scenario, const model::Model& model) {
  const model::Eigenvalues poles = model::sampled_poles(model);
  if (poles.empty()) {
    report.line(
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
  report.line("closed loop", std::to_string(poles.size()) + " poles of " + of +
                                 " about home: " + sampled_poles_line(poles));
  if (const std::string frames = without_frames(scenario, false); !frames.empty()) {
    report.line("", frames);
  }
  if (!warning.empty()) return report.line("WARNING", warning);
  const double size = std::abs(poles.front()), period = loop.sampling.period * cycle.samples;
  report.line("", "stable: the slowest mode decays by a factor of " + short_number(size) +
                      (cycle.samples > 1 ? " in these periods" : " a period") +
                      ", with a time constant of " + short_number(-period / std::log(size)) + " s");
  report.line("", "without noise, dropouts, rounding, limits, dead band and backlash");
  if (!model::why_not_linear(scenario).empty()) return;
  if (cycle.samples > 1) {
    report.line("margins", "none: the loop differs from sample to sample, by the sensor's frames");
  } else {
    tell_margins(report, scenario, model);
  }
}

// Of a loop whose law is not for bbsim to know.
void tell_plant(Report& report, const model::Model& model) {
  const model::Eigenvalues poles = model::plant_poles(model);
  report.line("plant", std::to_string(poles.size()) +
                           " poles about home under a held command (1/s): " + poles_line(poles));
  report.line("closed loop", "no poles: only the controller knows its law");
}

void tell_closed_loop(Report& report, const Scenario& scenario, const model::Model& model) {
  if (scenario.controller->own) return tell_plant(report, model);
  if (model.rig && model.rig->sampled) return tell_sampled_loop(report, scenario, model);
  const model::Eigenvalues poles = model::closed_loop_poles(model);
  if (poles.empty()) {
    report.line("WARNING",
                "the closed loop has no linearization about home: the law is singular there");
    return;
  }
  const std::string warning = instability_warning(scenario, model);
  report.line("closed loop",
              std::to_string(poles.size()) + " poles about home (1/s): " + poles_line(poles));
  if (warning.empty()) {
    report.line("", model.dry ? "stable, without dry friction and limits" : "stable");
    if (model::why_not_linear(scenario).empty()) tell_margins(report, scenario, model);
  } else {
    report.line("WARNING", warning);
  }
}

void tell_solver(Report& report, const Scenario& scenario, const model::Model& model) {
  const Solver& solver = scenario.solver;
  std::string line{solve::method_name(solve::choose_method(solver.method))};
  line += solver.error
              ? ", error of x and y at most " + short_number(*solver.error) + " m"
              : ", rtol " + short_number(solver.rtol) + ", atol " + short_number(solver.atol);
  line +=
      solver.method == Method::automatic
          ? "; auto chooses it: it was the cheapest at every error on every kind of scene measured"
          : "; asked for";
  report.line("solver", line);
  const double decays = solve::decays_over_scene(model, scenario.time.end);
  report.line("", std::string(decays > 100 ? "a stiff scene" : "not a stiff scene") +
                      ": its fastest mode decays " + short_number(decays) + " times over it");
}

// Tells what a sweep block of the scenario holds; its values are checked too.
void tell_sweep(Report& report, const Scenario& scenario) {
  if (scenario.sweep.vary.empty()) return;
  const ScenarioFamily family(scenario.source);
  const sweep::SweepPlan plan(family, scenario.sweep);
  static_cast<void>(plan.check(family, 0, plan.cases(), [](double) { return true; }));
  std::string keys;
  for (const sweep::Axis& axis : plan.axes()) keys += (keys.empty() ? "" : ", ") + axis.key;
  report.line("sweep", std::to_string(plan.cases()) + " cases of bbsim sweep, over " + keys);
}

// What comes of starting the controller, if the scene has one of its own; it is asked for nothing.
std::string try_controller(const Scenario& scenario) {
  if (!scenario.controller || !scenario.controller->own) return "";
  controller::Host host = make_host(nullptr);
  const model::Model model =
      assemble(scenario, scenario::columns_named(scenario.output.columns), host);
  Report report;
  std::string label = "controller";
  for (const std::string& line : host.describe()) {
    report.line(std::exchange(label, ""), line);
  }
  return report.text();
}

ExitCode check(const ScenarioArguments& arguments, const Options& options) {
  say_if_waiting(arguments.file, "a scenario", options.quiet);
  const Scenario scenario = read_scenario(arguments.file, arguments.overrides);
  file::Outputs outputs;
  reads_scenario(outputs, arguments.file, scenario);
  prints(outputs);
  print(check_report(scenario, true) + try_controller(scenario));
  return ExitCode::done;
}

}  // namespace

std::string check_report(const Scenario& scenario, bool sweep) {
  const auto columns = scenario::columns_named(scenario.output.columns);
  const model::Model model = assemble(scenario, columns);
  const solve::OutputGrid grid(scenario.time);

  Report report;
  report.line("scenario", scenario.source.file + " is valid");
  if (!scenario.title.empty()) report.line("title", scenario.title);
  report.line("model", states_line(model));
  for (const model::Note& note : model::explain(scenario, model)) {
    report.line("  " + note.part, note.reason);
  }

  std::string names;
  for (const std::string& name : scenario.output.columns) names += " " + name;
  report.line("output", std::to_string(grid.size()) + " rows to t = " + short_number(grid.end()) +
                            " s:" + names);
  if (!scenario::need_dynamics(columns) && !scenario.plate.inertia) {
    report.line("", "no forces, torques or energy: no output column asks for them");
  }

  tell_gain(report, scenario, model);
  if (model.closed_loop()) {
    tell_closed_loop(report, scenario, model);
  } else if (const model::Eigenvalues poles = model::closed_loop_poles(model); !poles.empty()) {
    report.line("plant", std::to_string(poles.size()) +
                             " poles about home under no torque (1/s): " + poles_line(poles));
    if (model.dry) report.line("", "without dry friction and limits");
  }

  tell_solver(report, scenario, model);
  if (sweep) tell_sweep(report, scenario);
  for (const std::string& remark : scenario.remarks) report.line("remark", remark);
  return report.text();
}

void add_check(Command& command, const Options& options) {
  const auto arguments = std::make_shared<ScenarioArguments>();
  add_scenario(command, *arguments);
  command.does([arguments, &options] { return check(*arguments, options); });
}

}  // namespace bbsim::app
