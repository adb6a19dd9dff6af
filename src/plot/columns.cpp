// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "scenario/columns.hpp"
#include "yaml/nearest.hpp"

namespace bbsim::plot {
namespace {

// The panels of a picture, in their order.
enum class Place {
  x,
  y,
  tracking_error,
  position_error,
  distance,
  velocity,
  spin,
  gamma,
  orientation,
  phi,
  theta,
  servos,
  rates,
  accelerations,
  tilt,
  tilt_rate,
  friction,
  forces,
  torques,
  motor_torques,
  given_torques,
  currents,
  voltages,
  slip,
  power,
  energy,
  singularity,
};

struct Known {
  std::string_view column, name;
  Place place;
  Role role = Role::main;
  std::string_view short_name{};  // beside others of its kind, if that is another one
};

// What a panel of several columns is called: the quantity that they have in common.
std::string_view common_name(Place place) {
  switch (place) {
    case Place::orientation:
      return "ball's orientation";
    case Place::velocity:
      return "velocity";
    case Place::servos:
      return "servos";
    case Place::rates:
      return "rates";
    case Place::accelerations:
      return "accelerations";
    case Place::forces:
      return "forces";
    case Place::torques:
      return "torque";
    case Place::motor_torques:
      return "motor torque";
    case Place::given_torques:
      return "motors' torque";
    case Place::currents:
      return "motors' current";
    case Place::voltages:
      return "motors' voltage";
    case Place::slip:
      return "slip";
    case Place::power:
      return "power";
    case Place::energy:
      return "energy";
    default:
      return "";
  }
}

constexpr std::array known_columns = {
    Known{"x", "x", Place::x},
    Known{"x_reference", "x reference", Place::x, Role::reference},
    Known{"x_measured", "x as seen", Place::x, Role::measured},
    Known{"y", "y", Place::y},
    Known{"y_reference", "y reference", Place::y, Role::reference},
    Known{"y_measured", "y as seen", Place::y, Role::measured},
    Known{"tracking_error", "tracking error", Place::tracking_error},
    Known{"position_error", "error of x, y", Place::position_error},
    Known{"distance", "distance", Place::distance},
    Known{"vx", "vx", Place::velocity},
    Known{"vy", "vy", Place::velocity},
    Known{"spin", "spin", Place::spin},
    Known{"gamma", "γ", Place::gamma},
    Known{"ball_qw", "orientation w", Place::orientation, Role::main, "w"},
    Known{"ball_qx", "orientation x", Place::orientation, Role::main, "x"},
    Known{"ball_qy", "orientation y", Place::orientation, Role::main, "y"},
    Known{"ball_qz", "orientation z", Place::orientation, Role::main, "z"},
    Known{"phi", "φ", Place::phi},
    Known{"phi_command", "φ command", Place::phi, Role::command},
    Known{"theta", "θ", Place::theta},
    Known{"theta_command", "θ command", Place::theta, Role::command},
    Known{"servo_phi", "servo φ", Place::servos, Role::main, "φ"},
    Known{"servo_theta", "servo θ", Place::servos, Role::main, "θ"},
    Known{"servo_third", "third servo", Place::servos, Role::main, "third"},
    Known{"phi_rate", "φ'", Place::rates},
    Known{"theta_rate", "θ'", Place::rates},
    Known{"phi_acceleration", "φ''", Place::accelerations},
    Known{"theta_acceleration", "θ''", Place::accelerations},
    Known{"tilt", "tilt", Place::tilt},
    Known{"tilt_rate", "tilt rate", Place::tilt_rate},
    Known{"friction_demand", "friction demand", Place::friction},
    Known{"normal_force", "normal force", Place::forces, Role::main, "normal"},
    Known{"friction_force", "friction force", Place::forces, Role::main, "friction"},
    Known{"torque_phi", "torque φ", Place::torques, Role::main, "φ"},
    Known{"torque_theta", "torque θ", Place::torques, Role::main, "θ"},
    Known{"motor_torque_phi", "motor torque φ", Place::motor_torques, Role::main, "φ"},
    Known{"motor_torque_theta", "motor torque θ", Place::motor_torques, Role::main, "θ"},
    Known{"phi_torque", "φ motor's torque", Place::given_torques, Role::main, "φ"},
    Known{"phi_torque_asked", "φ torque asked", Place::given_torques, Role::command},
    Known{"theta_torque", "θ motor's torque", Place::given_torques, Role::main, "θ"},
    Known{"theta_torque_asked", "θ torque asked", Place::given_torques, Role::command},
    Known{"phi_current", "φ motor's current", Place::currents, Role::main, "φ"},
    Known{"theta_current", "θ motor's current", Place::currents, Role::main, "θ"},
    Known{"phi_voltage", "φ motor's voltage", Place::voltages, Role::main, "φ"},
    Known{"theta_voltage", "θ motor's voltage", Place::voltages, Role::main, "θ"},
    Known{"slip_x", "slip x", Place::slip, Role::main, "x"},
    Known{"slip_y", "slip y", Place::slip, Role::main, "y"},
    Known{"motor_power", "motor power", Place::power, Role::main, "motors, with plate"},
    Known{"power", "power", Place::power, Role::main, "motors, ball only"},
    Known{"electrical_power", "electrical power", Place::power, Role::main, "electrical"},
    Known{"loss_power", "power lost", Place::power, Role::main, "lost"},
    Known{"energy", "energy", Place::energy, Role::main, "ball"},
    Known{"total_energy", "total energy", Place::energy, Role::main, "total"},
    Known{"energy_lost", "energy lost", Place::energy, Role::main, "lost"},
    Known{"motor_work", "motors' work", Place::energy, Role::main, "motors' work"},
    Known{"singularity_distance", "singularity distance", Place::singularity},
};

const Known* find_known(std::string_view column) {
  const auto found = std::ranges::find(known_columns, column, &Known::column);
  return found == known_columns.end() ? nullptr : &*found;
}

bool is_command(std::string_view column) {
  return column == "phi_command" || column == "theta_command";
}

Unit drawn_unit(const std::vector<Result>& runs, std::string_view column, Drives driven) {
  if (!is_command(column)) return unit_of(runs, column);
  switch (driven) {
    case Drives::acceleration:
      return unit_of(runs, "phi_acceleration");
    case Drives::torque:
      return unit_of(runs, "phi_torque");
    case Drives::voltage:
      return unit_of(runs, "phi_voltage");
    case Drives::angle:
      break;
  }
  return unit_of(runs, column);
}

Unit drawn(std::string_view unit, bool turns) {
  constexpr double degrees = 180 / std::numbers::pi;
  if (unit == "1") return {};
  if (!turns && unit == "rad") return {"°", degrees};
  if (!turns && unit == "rad/s") return {"°/s", degrees};
  if (unit == "rad/s^2") return {"°/s²", degrees};
  return {std::string(unit)};
}

// Of the ball, often many times round.
bool is_turn(std::string_view column) {
  return column == "gamma" || column == "spin";
}

// Commands stand beside what they command.
Place place_of(const Known& known, Drives driven) {
  if (!is_command(known.column)) return known.place;
  switch (driven) {
    case Drives::acceleration:
      return Place::accelerations;
    case Drives::torque:
      return Place::given_torques;
    case Drives::voltage:
      return Place::voltages;
    case Drives::angle:
      break;
  }
  return known.place;
}

PlannedLine line_of(std::string_view column) {
  const Known* const known = find_known(column);
  if (known == nullptr) return {std::string(column), Role::main, std::string(column)};
  return {std::string(column), known->role, std::string(known->name)};
}

bool is_drawable(const Result& run, std::string_view column) {
  const Column* const found = run.find(column);
  return found != nullptr &&
         std::ranges::any_of(found->numbers, [](double value) { return std::isfinite(value); });
}

bool any_draws(const std::vector<Result>& runs, std::string_view column) {
  return std::ranges::any_of(runs, [&](const Result& run) { return is_drawable(run, column); });
}

Range range_of(const std::vector<Result>& runs, std::string_view column) {
  Range range;
  for (const Result& run : runs) {
    if (const Column* found = run.find(column)) range.include(found->numbers);
  }
  return range;
}

std::size_t count_of(const PlannedPanel& panel, Role role) {
  return static_cast<std::size_t>(std::ranges::count(panel.lines, role, &PlannedLine::role));
}

// The quantity that all main lines have in common, if there are several of one.
std::string_view common_name(const PlannedPanel& panel) {
  std::optional<Place> place;
  for (const PlannedLine& line : panel.lines) {
    const Known* const known = find_known(line.column);
    if (line.role != Role::main) continue;
    if (known == nullptr || (place && *place != known->place)) return "";
    place = known->place;
  }
  return place ? common_name(*place) : "";
}

// The panel's heading, and short names for lines where it says the rest.
void name_panel(PlannedPanel& panel) {
  const bool one = count_of(panel, Role::main) == 1;
  panel.name.clear();
  const std::string_view common = one ? "" : common_name(panel);
  if (!common.empty()) {
    panel.name = common;
    for (PlannedLine& line : panel.lines) {
      const Known* const known = find_known(line.column);
      if (known != nullptr && !known->short_name.empty()) line.name = known->short_name;
    }
    return;
  }
  for (PlannedLine& line : panel.lines) {
    const bool beside = line.role != Role::main;
    if (one && beside) {
      constexpr std::string_view names[] = {"", "reference", "as seen", "command"};
      line.name = names[static_cast<int>(line.role)];
    } else if (!beside || count_of(panel, Role::main) == 0) {
      panel.name += (panel.name.empty() ? "" : ", ") + line.name;
    }
  }
}

// Beside one of the lines another would be flat.
bool flattens(const std::vector<Result>& runs, const PlannedPanel& panel) {
  double widest = 0, narrowest = 0;
  bool first = true;
  for (const PlannedLine& line : panel.lines) {
    if (line.role != Role::main) continue;
    const Range range = range_of(runs, line.column);
    if (!range.wide()) continue;  // flat anyway
    const double width = range.high - range.low;
    widest = std::max(widest, width);
    narrowest = first ? width : std::min(narrowest, width);
    first = false;
  }
  return widest > 50 * narrowest;
}

// The axis of phi_command is phi, as that of phi_acceleration is.
std::string_view axis_of(std::string_view column) {
  return column.substr(0, column.find('_'));
}

// A panel for each main line, with what stands beside it.
void split_into(std::vector<PlannedPanel>& panels, const PlannedPanel& panel) {
  std::vector<PlannedPanel> parts;
  for (const PlannedLine& line : panel.lines) {
    if (line.role == Role::main) parts.push_back({"", panel.unit, {line}});
  }
  for (const PlannedLine& line : panel.lines) {
    if (line.role == Role::main) continue;
    const auto partner = std::ranges::find_if(parts, [&](const PlannedPanel& part) {
      return axis_of(part.lines.front().column) == axis_of(line.column);
    });
    (partner == parts.end() ? parts.front() : *partner).lines.push_back(line);
  }
  panels.insert(panels.end(), parts.begin(), parts.end());
}

// With several runs, the lines of a panel differ by the run, so that no two quantities share one;
// only references do, which are bands.
void split_for_comparison(std::vector<PlannedPanel>& panels, const PlannedPanel& panel) {
  const std::size_t begin = panels.size();
  for (const PlannedLine& line : panel.lines) {
    if (line.role != Role::reference) panels.push_back({"", panel.unit, {line}});
  }
  for (const PlannedLine& line : panel.lines) {
    if (line.role != Role::reference) continue;
    if (panels.size() == begin) panels.push_back({"", panel.unit, {}});
    panels[begin].lines.push_back(line);
  }
}

std::vector<PlannedPanel> finish(const std::vector<Result>& runs,
                                 const std::vector<PlannedPanel>& wanted, bool may_split) {
  std::vector<PlannedPanel> panels;
  for (const PlannedPanel& panel : wanted) {
    if (runs.size() > 1) {
      split_for_comparison(panels, panel);
    } else if (may_split && count_of(panel, Role::main) > 1 &&
               (flattens(runs, panel) || count_of(panel, Role::command) > 0)) {
      split_into(panels, panel);
    } else {
      panels.push_back(panel);
    }
  }
  for (PlannedPanel& panel : panels) name_panel(panel);
  return panels;
}

// Root mean square of the difference of two columns, of which the second may be one to be
// differentiated twice over time.
double misfit(const std::vector<double>& t, const std::vector<double>& u,
              const std::vector<double>& angle, bool second_derivative) {
  double sum = 0, count = 0;
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
    if (!(before > 0) || !(std::abs(after - before) < 1e-6 * before)) continue;
    const double other = second_derivative
                             ? (angle[i + 1] - 2 * angle[i] + angle[i - 1]) / (before * after)
                             : angle[i];
    const double difference = u[i] - other;
    if (!std::isfinite(difference)) continue;
    sum += difference * difference;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

std::string did_you_mean(const std::vector<Result>& runs, const std::string& name) {
  std::vector<std::string_view> names{"path"};
  for (const Column& column : runs.front().columns) names.push_back(column.name);
  const std::string_view nearest = yaml::nearest_name(name, names);
  return nearest.empty() ? "" : "; did you mean " + std::string(nearest) + "?";
}

std::string columns_of(const std::vector<Result>& runs) {
  std::string names;
  for (const Column& column : runs.front().columns) {
    names += (names.empty() ? "" : ", ") + column.name;
  }
  return names;
}

}  // namespace

Unit unit_of(std::string_view column) {
  const scenario::Column* const found = scenario::find_column(column);
  return found == nullptr ? Unit{} : drawn(found->unit, is_turn(column));
}

Unit unit_of(const std::vector<Result>& runs, std::string_view column) {
  if (!std::ranges::all_of(runs, &Result::units_known)) return {};
  const scenario::Column* const known = scenario::find_column(column);
  if (known != nullptr) return unit_of(column);
  for (const Result& run : runs) {
    const Column* const found = run.find(column);
    if (found != nullptr && !found->unit.empty()) return drawn(found->unit, false);
  }
  return {};
}

Drives driven_quantity(const Result& run) {
  if (run.scenario && run.scenario->controller) return run.scenario->controller->drives;
  const Column* const t = run.find("t");
  double as_angle = 0, as_acceleration = 0;
  for (const char* axis : {"phi", "theta"}) {
    const Column* const angle = run.find(axis);
    const Column* const command = run.find(std::string(axis) + "_command");
    if (t == nullptr || angle == nullptr || command == nullptr) continue;
    as_angle += misfit(t->numbers, command->numbers, angle->numbers, false);
    as_acceleration += misfit(t->numbers, command->numbers, angle->numbers, true);
  }
  return as_acceleration < as_angle ? Drives::acceleration : Drives::angle;
}

std::vector<PlannedPanel> plan_panels(const std::vector<Result>& runs) {
  const Drives driven = driven_quantity(runs.front());
  std::vector<PlannedPanel> panels;
  constexpr auto places = static_cast<int>(Place::singularity) + 1;
  for (int place = 0; place < places; ++place) {
    PlannedPanel panel;
    for (const Known& known : known_columns) {
      if (static_cast<int>(place_of(known, driven)) != place || !any_draws(runs, known.column)) {
        continue;
      }
      panel.unit = drawn_unit(runs, known.column, driven);
      panel.lines.push_back(line_of(known.column));
    }
    if (panel.lines.empty()) continue;
    const bool pairs =
        static_cast<Place>(place) == Place::y || static_cast<Place>(place) == Place::theta;
    const auto plain = [](const PlannedPanel& one) {
      return one.lines.size() == 1 && one.lines.front().role == Role::main;
    };
    const std::string_view partner = static_cast<Place>(place) == Place::y ? "x" : "phi";
    if (pairs && !panels.empty() && plain(panel) && plain(panels.back()) &&
        panels.back().lines.front().column == partner) {
      panels.back().lines.push_back(panel.lines.front());
    } else {
      panels.push_back(panel);
    }
  }
  for (const Result& run : runs) {
    for (const Column& column : run.columns) {
      const bool planned = std::ranges::any_of(panels, [&](const PlannedPanel& panel) {
        return std::ranges::find(panel.lines, column.name, &PlannedLine::column) !=
               panel.lines.end();
      });
      if (planned || column.name == "t" || !is_drawable(run, column.name)) continue;
      panels.push_back({"", unit_of(runs, column.name), {line_of(column.name)}});
    }
  }
  return finish(runs, panels, true);
}

std::vector<PlannedPanel> plan_panels(const std::vector<Result>& runs,
                                      const std::vector<std::vector<std::string>>& asked) {
  const Drives driven = driven_quantity(runs.front());
  std::vector<PlannedPanel> panels;
  for (const std::vector<std::string>& names : asked) {
    PlannedPanel panel;
    for (const std::string& name : names) {
      const std::string found = "--columns: found " + (name.empty() ? "nothing" : name);
      if (name == "t") throw InputError(found + ", over which the others are drawn");
      if (std::ranges::none_of(runs,
                               [&](const Result& run) { return run.find(name) != nullptr; })) {
        throw InputError(found + did_you_mean(runs, name) + "; " + runs.front().file + " has " +
                         columns_of(runs) + ", and path is their picture in the plane");
      }
      if (!any_draws(runs, name)) throw InputError(found + ", which holds no finite number");
      const Unit unit = drawn_unit(runs, name, driven);
      if (!panel.lines.empty() && !(unit == panel.unit)) {
        throw InputError(found + " in a panel with " + panel.lines.front().column +
                         ", which has another unit; a semicolon begins another panel");
      }
      panel.unit = unit;
      panel.lines.push_back(line_of(name));
    }
    panels.push_back(panel);
  }
  return finish(runs, panels, false);
}

}  // namespace bbsim::plot
