// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/linearize.hpp"

#include <utility>

#include "api/assemble.hpp"
#include "api/linear_text.hpp"
#include "api/loop_text.hpp"
#include "base/number_text.hpp"
#include "base/short_number.hpp"
#include "record/linear_text.hpp"
#include "study/operating_point.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::api {
namespace {

const char* name_of(LinearKind kind) {
  switch (kind) {
    case LinearKind::plant:
      return "plant";
    case LinearKind::loop:
      return "loop";
    case LinearKind::sampled:
      return "sampled";
  }
  return "";
}

double read_time(const std::string& text, const Scenario& scenario) {
  const yaml::Quantity time = yaml::read_quantity(text, false, yaml::Dimension::time);
  if (!time.value || !(*time.value >= 0 && *time.value <= scenario.time.end)) {
    throw InputError("--at: found " + text +
                     "; allowed: home, equilibrium, or a time from 0 to time.end, which is " +
                     short_number(scenario.time.end) + " s");
  }
  return *time.value;
}

// Where the run is at that time; nothing, and why, if it does not get there.
std::optional<model::LinearPoint> point_at(double time, const Scenario& scenario,
                                           const model::Model& model, Watch& watch,
                                           Linearized& made) {
  study::PointInTime found = study::point_in_time(scenario, model, time, {watch.stop(), {}});
  if (found.point) return std::move(found.point);
  const std::string reached = short_number(found.outcome.reached);
  if (found.outcome.ending == solve::Ending::interrupted) {
    made.reason = "interrupted at t = " + reached + " s.";
    made.code = ExitCode::interrupted;
  } else {
    made.reason = "the run does not reach t = " + short_number(time) +
                  " s: it ends at t = " + reached + " s; `bbsim run` says why.";
    made.code = ExitCode::ended_early;
  }
  return {};
}

}  // namespace

Linearized linearize(const LinearizeRequest& request, Watch& watch) {
  const Scenario& scenario = request.scenario;
  const model::Model model = assemble(scenario, {});
  const LinearKind kind = request.kind.value_or(model::usual_kind(scenario));
  Linearized made;
  made.scenario = scenario.source.file;
  made.kind = name_of(kind);
  made.at = request.at;
  model::LinearPoint point = model::home_point();
  if (request.at == "equilibrium") {
    point = model::equilibrium(scenario);
  } else if (request.at != "home") {
    const double time = read_time(request.at, scenario);
    made.at = "t = " + number_text(time) + " s";
    auto found = point_at(time, scenario, model, watch, made);
    if (!found) return made;
    point = std::move(*found);
  }
  made.linearisation = model::linearize(scenario, model, kind, point);
  if (made.linearisation.poles.empty()) {
    made.reason =
        "the " + made.kind + " about " + made.at + " has poles beyond the range of doubles.";
    made.code = ExitCode::ended_early;
  } else if (made.linearisation.system.period) {
    made.note = without_frames(scenario, true);
  }
  return made;
}

Report report_of(const Linearized& made) {
  return linear_report(
      "the " + made.kind + (made.kind == "sampled" ? " plant" : "") + " about " + made.at,
      made.linearisation);
}

std::string file_text(const Linearized& made, const std::string& file) {
  const record::LinearReport report{made.scenario, made.kind, made.at, made.linearisation};
  if (file.ends_with(".m")) return record::to_matlab(report);
  if (file.ends_with(".py")) return record::to_python(report);
  if (file.ends_with(".csv")) return record::to_csv(report);
  return record::to_json(report);
}

}  // namespace bbsim::api
