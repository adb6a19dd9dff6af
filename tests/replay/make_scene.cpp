// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "make_scene.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "file/table_writer.hpp"
#include "replay/sources.hpp"
#include "results/result.hpp"
#include "scenario/reader.hpp"
#include "support/folder.hpp"
#include "support/text.hpp"

using bbsim::replay::Run;
using bbsim::replay::Sweep;

namespace bbsim_test {
namespace {

void add_summary(Run& run, const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  run.summary = text;
  run.status = json.at("status").get<std::string>();
  run.reason = json.at("reason").get<std::string>();
  run.version = json.at("version").get<std::string>();
  for (const auto& event : json.at("events")) {
    run.events.push_back({event.at("event").get<std::string>(), event.at("action") == "stop",
                          event.at("t").get<double>(), event.at("x").get<double>(),
                          event.at("y").get<double>()});
  }
}

}  // namespace

Run run_of(const std::string& files) {
  const std::vector<std::string> names = split(files, ',');
  const std::string base = names.at(0).substr(names.at(0).rfind('/') + 1);
  Run run = bbsim::replay::run_of_table(bbsim::file::read_table(names.at(0)), base);
  if (names.size() > 1 && !names[1].empty()) {
    bbsim::replay::describe(run, bbsim::read_scenario(names[1]));
  }
  if (names.size() > 2) add_summary(run, content_of(names[2]));
  if (names.size() > 3) run.check = lines(content_of(names[3]));
  return run;
}

Sweep sweep_of(const std::string& table, const std::string& scenario) {
  Sweep sweep = bbsim::replay::sweep_of_result(bbsim::results::read_result(table, {}), table);
  sweep.name = table.substr(table.rfind('/') + 1);
  sweep.title = bbsim::read_scenario(scenario).title;
  sweep.source = {scenario, content_of(scenario), {}};
  return sweep;
}

Run circling(std::size_t rows) {
  Run run;
  run.name = "circle.csv";
  run.title = "A circle";
  run.status = "done";
  run.ball_radius = 0.01;
  run.plate.size = {0.3, 0.2};
  run.columns = {{"t", {}, {}, "s"},          {"x", {}, {}, "m"},
                 {"y", {}, {}, "m"},          {"phi", {}, {}, "rad"},
                 {"theta", {}, {}, "rad"},    {"x_reference", {}, {}, "m"},
                 {"y_reference", {}, {}, "m"}};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const double values[] = {t,
                             0.05 * std::cos(0.3 * t),
                             -0.05 * std::sin(0.3 * t),
                             0.02 * std::sin(t),
                             0.03 * std::cos(0.7 * t),
                             0.052 * std::cos(0.3 * t),
                             -0.052 * std::sin(0.3 * t)};
    for (std::size_t c = 0; c < run.columns.size(); ++c)
      run.columns[c].numbers.push_back(values[c]);
  }
  return run;
}

Sweep swept() {
  Sweep sweep;
  sweep.name = "swept.csv";
  sweep.source.file = "configs/my scene.yaml";
  sweep.keys = {{"ball.radius", "", {}, {}}, {"ball.position.0", "", {}, {}}};
  sweep.measures = {{"max_distance", "m", {}, {}}};
  for (int i = 0; i < 41; ++i) {
    for (int k = 0; k < 21; ++k) {
      sweep.cases.push_back(21 * i + k);
      sweep.keys[0].values.push_back(0.01 + 0.001 * i);
      sweep.keys[1].values.push_back(-0.1 + 0.01 * k);
      const bool failed = i + k > 50;
      sweep.status.emplace_back(failed ? "failed at 0.7 s: it grew, \"fast\"" : "done");
      sweep.measures[0].values.push_back(failed ? std::nan("") : std::hypot(i / 40.0, k / 20.0));
    }
  }
  return sweep;
}

}  // namespace bbsim_test
