// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/columns.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>

#include "base/error.hpp"
#include "scenario/coupled.hpp"

namespace bbsim::scenario {

namespace {

static_assert(std::ranges::all_of(catalogue, [](const Column& column) {
  return std::ranges::find(panels, column.panel, &Panel::name) != panels.end();
}));

// Columns of numbers from your own controllers. Each column views its name in the map. Nothing is
// ever removed, because pointers to columns outlive their scenario.
struct OwnColumns {
  std::mutex mutex;
  std::map<std::string, Column, std::less<>> by_name;
};

OwnColumns& all_own_columns() {
  static OwnColumns columns;
  return columns;
}

}  // namespace

const Column* find_column(std::string_view name) {
  const auto found = std::ranges::find(catalogue, name, &Column::name);
  if (found != catalogue.end()) return &*found;
  OwnColumns& own = all_own_columns();
  const std::lock_guard lock(own.mutex);
  const auto known = own.by_name.find(name);
  return known == own.by_name.end() ? nullptr : &known->second;
}

const Column& own_column(std::string_view name) {
  OwnColumns& own = all_own_columns();
  const std::lock_guard lock(own.mutex);
  const auto [place, is_new] = own.by_name.try_emplace(std::string(name), Column{});
  if (is_new) {
    place->second = {place->first, place->first, "1", "as the scenario's own controller gives it",
                     Needs::own};
  }
  return place->second;
}

bool is_own_name(std::string_view name) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !name.empty() && name.size() <= 60 && letter(name[0]) &&
         std::ranges::all_of(name, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

std::vector<std::string> own_columns(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const std::string& name : scenario.output.columns) {
    const Column* const column = find_column(name);
    if (column != nullptr && column->needs == Needs::own) names.push_back(name);
  }
  return names;
}

std::vector<std::string_view> column_names() {
  std::vector<std::string_view> names;
  for (const Column& column : catalogue) names.push_back(column.name);
  return names;
}

std::vector<const Column*> columns_named(const std::vector<std::string>& names) {
  std::vector<const Column*> found;
  for (const std::string& name : names) {
    found.push_back(find_column(name));
    if (found.back() == nullptr) throw InputError("there is no column " + name);
  }
  return found;
}

std::vector<std::string> names_of(const std::vector<const Column*>& columns) {
  std::vector<std::string> names;
  for (const Column* column : columns) names.emplace_back(column->name);
  return names;
}

bool need_dynamics(const std::vector<const Column*>& columns) {
  return std::ranges::any_of(columns,
                             [](const Column* column) { return column->needs >= Needs::dynamics; });
}

bool any_needs(const std::vector<const Column*>& columns, Needs what) {
  return std::ranges::any_of(columns,
                             [what](const Column* column) { return column->needs == what; });
}

Integrals integrals_for(const std::vector<const Column*>& columns) {
  Integrals all(any_needs(columns, Needs::gamma) || any_needs(columns, Needs::orientation));
  all.work = any_needs(columns, Needs::work);
  return all;
}

int axis_of(std::string_view name) {
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('_'), name.size());
    const std::string_view word = name.substr(0, end);
    if (word == "x" || word == "vx" || word == "phi") return 1;
    if (word == "y" || word == "vy" || word == "theta") return 2;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return 0;
}

bool is_command(std::string_view name) {
  const Column* const column = find_column(name);
  return column != nullptr && column->needs == Needs::commands;
}

const Panel& panel_of(const Column& column, std::string_view unit) {
  std::string_view name = column.panel;
  if (column.needs == Needs::commands) {
    if (unit == "rad/s^2") name = "accelerations";
    if (unit == "N m") name = "given_torques";
    if (unit == "V") name = "voltages";
  }
  return *std::ranges::find(panels, name, &Panel::name);
}
static_assert([] {
  const auto is_panel = [](std::string_view name) {
    return std::ranges::find(panels, name, &Panel::name) != panels.end();
  };
  return is_panel("accelerations") && is_panel("given_torques") && is_panel("voltages");
}());

Missing missing(const Column& column, const Scenario& scenario) {
  switch (column.needs) {
    case Needs::controller:
      if (scenario.controller && scenario.controller->law == Law::commands) {
        return {"commands follow no path", "other columns, such as phi_command"};
      }
      [[fallthrough]];
    case Needs::commands:
      if (scenario.controller) return {};
      return {"there is no controller", "columns of an open loop, such as x"};
    case Needs::servos:
      if (scenario.gimbal.servo) return {};
      return {"no servo moves the gimbal", "other columns, such as phi; or give gimbal.servo"};
    case Needs::third_servo:
      if (scenario.gimbal.three_servos) return {};
      return {"there are no three servos",
              "servo_phi and servo_theta; or give gimbal.three_servos"};
    case Needs::believed:
    case Needs::legs_believed: {
      if (!scenario.gimbal.servo || !scenario.gimbal.servo_of(0).stepper) {
        return {"no stepper moves the gimbal",
                "other columns, such as phi; or give gimbal.servo.stepper"};
      }
      const bool legs = column.needs == Needs::legs_believed;
      if (legs == scenario.gimbal.three_servos.has_value()) return {};
      return legs ? Missing{"there are no three legs", "phi_believed and theta_believed"}
                  : Missing{"the steppers turn legs", "servo_1_believed to servo_3_believed"};
    }
    case Needs::samples:
      if (scenario.controller && scenario.controller->sampling) return {};
      return {"the controller takes no samples", "other columns; or give controller.sampling"};
    case Needs::plate:
      if (scenario.plate.inertia) return {};
      return {"plate.inertia is not known",
              "columns of the ball, such as torque_phi; or give plate.inertia"};
    case Needs::torques:
      if (moved_by_torques(scenario)) return {};
      return {"no torques move the gimbal",
              "the torque of the gimbal's motion, such as motor_torque_phi; or give gimbal.motor"};
    case Needs::armature:
      if (moved_by_torques(scenario) && scenario.gimbal.motor && scenario.gimbal.motor->dc)
        return {};
      return {"gimbal.motor.dc is not known",
              "columns of the torque, such as phi_torque; or give gimbal.motor.dc"};
    case Needs::coupled:
    case Needs::work:
      if (is_coupled(scenario) || is_linked(scenario)) return {};
      return {"the ball rolls without losses",
              "other columns, such as energy; or give ball.losses, or slip with action: slide"};
    case Needs::pushed:
      if (scenario.ball.push) return {};
      return {"nothing pushes the ball", "other columns, such as energy; or give ball.push"};
    case Needs::own:
      if (scenario.controller && scenario.controller->own) return {};
      return {"no controller of yours gives it",
              "columns of bbsim columns; or controller.program or controller.library"};
    case Needs::ball:
    case Needs::gamma:
    case Needs::orientation:
    case Needs::gimbal:
    case Needs::accelerations:
    case Needs::dynamics:
      break;
  }
  return {};
}

}  // namespace bbsim::scenario
