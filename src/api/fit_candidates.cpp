// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/fit_candidates.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>

#include "base/error.hpp"

namespace bbsim::api {
namespace {

void add_tables(const std::string& key, const Profile& profile, std::vector<std::string>& names) {
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (!std::holds_alternative<Table>(profile[i])) continue;
    const std::string table = key + (profile.size() == 1 ? "" : "." + std::to_string(i)) + ".table";
    for (const char* const of : {".offset", ".delay", ".scale"}) names.push_back(table + of);
  }
}

}  // namespace

std::vector<fit::FreeKey> fit_candidates(const fit::Task& task) {
  const Scenario scenario = task.family.read(task.logs.front().settings);
  std::vector<std::string> names;
  if (scenario.gimbal.motion) {
    add_tables("gimbal.motion.phi", scenario.gimbal.motion->phi, names);
    add_tables("gimbal.motion.theta", scenario.gimbal.motion->theta, names);
  }
  if (const CommandProfiles* const commands = commands_of(scenario)) {
    add_tables("controller.commands.phi", commands->phi, names);
    add_tables("controller.commands.theta", commands->theta, names);
  }
  for (const char* const one :
       {"ball.inertia_factor", "ball.losses.rolling", "ball.losses.viscous",
        "gimbal.mounting.phi_offset", "gimbal.mounting.theta_offset", "gimbal.mounting.yaw",
        "gimbal.mounting.skew", "gimbal.mounting.height", "gimbal.servo.natural_frequency",
        "gimbal.servo.damping", "gimbal.servo.time_constant", "controller.sampling.delay"}) {
    names.emplace_back(one);
  }
  for (const scenario::Column* const column : task.columns) {
    names.push_back("log." + std::string(column->name) + ".scale");
  }
  std::vector<fit::FreeKey> keys;
  for (const std::string& name : names) {
    if (std::ranges::find(task.keys, name, &fit::FreeKey::name) != task.keys.end()) continue;
    try {
      keys.push_back(fit::is_of_log(name) ? fit::read_log_key(name, task.columns)
                                          : fit::read_free_key(name, task.family));
    } catch (const InputError&) {  // not in this scene
    }
  }
  return keys;
}

}  // namespace bbsim::api
