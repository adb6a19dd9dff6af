// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Linear system of a scene: A, B, C, D, poles, zeros and margins.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "api/assemble.hpp"
#include "api/check.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "study/operating_point.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::api {
namespace {

// Margins and bandwidths are estimates for a model.
std::string three_digits(double value) {
  return rounded(value, 3);
}

std::string at(double frequency) {
  return " at " + three_digits(frequency) + " rad/s";
}

std::string text_of(const model::Margins& margins) {
  std::string text;
  if (std::isfinite(margins.gain)) {
    text += "gain by " + three_digits(margins.gain) + " (" +
            three_digits(20 * std::log10(margins.gain)) + " dB)" + at(margins.gain_at);
  } else {
    text += "any gain above";
  }
  if (margins.reduction > 0) {
    text += ", or down by " + three_digits(margins.reduction) + at(margins.reduction_at);
  }
  if (!std::isfinite(margins.phase)) return text + "; any phase and delay";
  text += "; phase " + three_digits(std::abs(margins.phase) * 180 / std::numbers::pi) + " deg" +
          (margins.phase < 0 ? " of lead" : "") + at(margins.phase_at);
  return text + "; delay " + three_digits(margins.delay) + " s";
}

std::string names_line(const std::vector<model::LinearSignal>& signals) {
  return joined(signals, [](const auto& its) { return its.name + " (" + its.unit + ")"; });
}

std::string values_line(const model::Eigenvalues& values) {
  return values.empty() ? "none" : poles_line(values);
}

// In the order of LinearKind.
constexpr const char* kinds[] = {"plant", "loop", "sampled"};

double read_time(const std::string& text, const Scenario& scenario) {
  const yaml::Quantity time = yaml::read_quantity(text, false, yaml::Dimension::time);
  if (!time.value || !(*time.value >= 0 && *time.value <= scenario.time.end)) {
    throw InputError("--at: found " + text +
                     "; allowed: home, equilibrium, or a time from 0 to time.end, which is " +
                     short_number(scenario.time.end) + " s");
  }
  return *time.value;
}

// State of the run at that time; empty, with the reason in `linearized`, if the run does not get
// there.
std::optional<model::LinearPoint> point_at(double time, const Scenario& scenario,
                                           const model::Model& model, Watch& watch,
                                           Linearized& linearized) {
  study::PointInTime found = study::point_in_time(scenario, model, time, {watch.stop(), {}});
  if (found.point) return std::move(found.point);
  const std::string reached = short_number(found.outcome.reached);
  if (found.outcome.ending == solve::Ending::interrupted) {
    linearized.reason = "interrupted at t = " + reached + " s.";
    linearized.code = ExitCode::interrupted;
  } else {
    linearized.reason = "the run does not reach t = " + short_number(time) +
                        " s: it ends at t = " + reached + " s; `bbsim run` says why.";
    linearized.code = ExitCode::ended_early;
  }
  return {};
}

// What the names of states and commands mean behind push rods; empty without.
std::string behind_linkage(const Scenario& scenario) {
  const auto& linkage = scenario.gimbal.linkage;
  if (!linkage[0] && !linkage[1]) return "";
  return "phi, theta and their commands are the servos' angles, before the linkage; the gains of "
         "state_feedback are for the plate's";
}

Linearization estimated_loop(const Scenario& scenario, Watch& watch) {
  controller::Host host = make_host(watch);
  const model::Model model =
      assemble(scenario, scenario::columns_named(scenario.output.columns), host);
  Probed found = with_places(scenario, [&] { return probe(scenario, model); });
  if (!found.loop) throw InputError("linearize: no estimate of the loop: " + found.why);
  return std::move(*found.loop);
}

}  // namespace

std::optional<LinearKind> kind_named(const std::string& name) {
  if (name.empty()) return {};
  const auto* const found = std::ranges::find(kinds, name);
  if (found == std::end(kinds)) {
    throw InputError("kind: found " + name + "; allowed: plant, loop, sampled");
  }
  return static_cast<LinearKind>(found - std::begin(kinds));
}

Linearized linearize(const LinearizeRequest& request, Watch& watch) {
  const Scenario& scenario = request.scenario;
  const model::Model model = assemble(scenario, {});
  const LinearKind kind = request.kind.value_or(model::usual_kind(scenario));
  Linearized linearized;
  linearized.scenario = scenario.source.file;
  linearized.kind = kinds[static_cast<std::size_t>(kind)];
  linearized.at = request.at;
  const bool own = scenario.controller && scenario.controller->own;
  if (request.estimates && own && kind == LinearKind::loop && request.at == "home") {
    linearized.linearization = estimated_loop(scenario, watch);
    linearized.note = "the law is an estimate from its answers to small pulses about the reference";
    return linearized;
  }
  model::LinearPoint point = model::home_point();
  if (request.at == "equilibrium") {
    point = model::equilibrium(scenario);
  } else if (request.at != "home") {
    const double time = read_time(request.at, scenario);
    linearized.at = "t = " + number_text(time) + " s";
    auto found = point_at(time, scenario, model, watch, linearized);
    if (!found) return linearized;
    point = std::move(*found);
  }
  linearized.linearization = model::linearize(scenario, model, kind, point);
  if (linearized.linearization.poles.empty()) {
    linearized.reason = "the " + linearized.kind + " about " + linearized.at +
                        " has poles beyond the range of doubles.";
    linearized.code = ExitCode::ended_early;
    return linearized;
  }
  if (linearized.linearization.system.period) linearized.note = without_frames(scenario, true);
  const std::string linkage = behind_linkage(scenario);
  if (!linkage.empty() && !linearized.note.empty()) linearized.note += "; ";
  linearized.note += linkage;
  return linearized;
}

Report margins_of(const Linearization& linearization, const std::string& how) {
  Report lines;
  if (linearization.margins.empty()) return lines;
  lines.add("margins", how + "of each command's loop, the other one closed" +
                           (linearization.stable ? ""
                                                 : "; the loop is not stable: these are where "
                                                   "poles cross the stability limit"));
  for (const model::LoopMargins& loop : linearization.margins) {
    lines.add("  " + loop.command.substr(0, loop.command.find('_')), text_of(loop.margins));
  }
  const auto bandwidths = [&linearization](double model::Bandwidth::*of) {
    return joined(linearization.bandwidths, [of](const model::Bandwidth& its) {
      return its.output + " " +
             (std::isfinite(its.*of) ? three_digits(its.*of) + " rad/s" : "none");
    });
  };
  const auto all_end = [&linearization](double model::Bandwidth::*of) {
    return std::ranges::all_of(linearization.bandwidths, [of](const auto& bandwidth) {
      return std::isfinite(bandwidth.*of);
    });
  };
  if (linearization.bandwidths.empty()) return lines;
  if (all_end(&model::Bandwidth::value)) {
    lines.add("  bandwidth", bandwidths(&model::Bandwidth::value));
  } else if (all_end(&model::Bandwidth::of_feedback)) {
    lines.add("  bandwidth", bandwidths(&model::Bandwidth::of_feedback) +
                                 ", of the feedback: with the reference's accelerations, which the "
                                 "law knows, the response does not fall to 1/sqrt(2)");
  } else {
    lines.add("  bandwidth",
              bandwidths(&model::Bandwidth::value) + ": the response does not fall to 1/sqrt(2)" +
                  (linearization.system.period ? " up to half the sampling rate" : ""));
  }
  return lines;
}

Report margin_remarks(const Linearization& linearization) {
  constexpr double least_gain = 6, least_phase = 30;  // dB, deg
  const auto decibels = [](double factor) { return 20 * std::log10(factor); };
  Report remarks;
  for (const model::LoopMargins& loop : linearization.margins) {
    const model::Margins& margins = loop.margins;
    std::string small;
    const auto add = [&small](const char* name, double value, double least, const char* unit) {
      if (value < least) {
        small += (small.empty() ? "" : ", ") + std::string(name) + three_digits(value) + unit;
      }
    };
    add("gain ", decibels(margins.gain), least_gain, " dB");
    if (margins.reduction > 0) add("gain down ", -decibels(margins.reduction), least_gain, " dB");
    add("phase ", std::abs(margins.phase) * 180 / std::numbers::pi, least_phase, " deg");
    if (small.empty()) continue;
    remarks.add("remark", loop.command.substr(0, loop.command.find('_')) +
                              ": small margins: " + small +
                              "; with less than 6 dB or 30 deg, a loop rings, and small errors of "
                              "the model may make it unstable");
  }
  return remarks;
}

Report report_of(const Linearized& linearized) {
  const Linearization& linearization = linearized.linearization;
  const model::LinearSystem& system = linearization.system;
  Report report{
      {"linear", "the " + linearized.kind + (linearized.kind == "sampled" ? " plant" : "") +
                     " about " + linearized.at},
      {"states", names_line(system.states)},
      {"inputs", names_line(system.inputs)},
      {"outputs", names_line(system.outputs)},
      {"period", system.period ? short_number(*system.period) + " s" : "continuous time"},
      {"poles", values_line(linearization.poles)},
      {"zeros", values_line(linearization.zeros)}};
  report.add(margins_of(linearization));
  return report;
}

std::string file_text(const Linearized& linearized, const std::string& file) {
  if (file.ends_with(".m")) return to_matlab(linearized);
  if (file.ends_with(".py")) return to_python(linearized);
  if (file.ends_with(".csv")) return to_csv(linearized);
  return to_json(linearized);
}

}  // namespace bbsim::api
