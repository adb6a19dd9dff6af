#include "scenario/columns.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace bbsim::scenario {

const Column* find_column(std::string_view name) {
  const auto found = std::ranges::find(catalogue, name, &Column::name);
  return found == catalogue.end() ? nullptr : &*found;
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

bool any_needs(const std::vector<const Column*>& columns, Needs what) {
  return std::ranges::any_of(columns,
                             [what](const Column* column) { return column->needs == what; });
}

bool need_gamma(const std::vector<const Column*>& columns) {
  return any_needs(columns, Needs::gamma) || any_needs(columns, Needs::orientation);
}

Missing missing(const Column& column, const Scenario& scenario) {
  switch (column.needs) {
    case Needs::controller:
      if (scenario.controller) return {};
      return {"there is no controller", "columns of an open loop, such as x"};
    case Needs::samples:
      if (scenario.controller && scenario.controller->sampling) return {};
      return {"the controller takes no samples", "other columns; or give controller.sampling"};
    case Needs::plate:
      if (scenario.plate.inertia) return {};
      return {"plate.inertia is not known",
              "columns of the ball, such as torque_phi; or give plate.inertia"};
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
