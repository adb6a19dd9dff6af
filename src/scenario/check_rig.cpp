// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Refuses values that do not go together and that no relation of keys describes (relations.hpp):
// times, limits, starts, points, moments of inertia, columns.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "base/number_text.hpp"
#include "scenario/columns.hpp"
#include "scenario/coupled.hpp"
#include "scenario/relations.hpp"
#include "scenario/sections.hpp"

namespace bbsim::scenario {
namespace {

// The longest delay in periods. Delayed samples enlarge the loop's state and the matrix whose
// eigenvalues are the loop's poles.
constexpr double most_periods = 100;

// The mean of the measured periods (s); without them, the nominal period.
double mean_period(const Sampling& sampling) {
  const auto& periods = sampling.periods;
  if (periods.empty()) return sampling.period;
  return std::accumulate(periods.begin(), periods.end(), 0.0) / static_cast<double>(periods.size());
}

class Checks {
 public:
  Checks(const yaml::Value& root, const Scenario& scene) : root_(root), scene_(scene) {}

  void all() {
    if (check_relations(root_, scene_)) signs();
    controller();
    starts();
    groove();
    plate();
    body();
    inertia();
    columns();
  }

 private:
  // Reports `why` at the key, if present.
  void refuse(std::string_view path, std::string_view why) const {
    if (const auto value = root_.at(path)) value->report_at_key(why);
  }

  void controller() {
    if (!scene_.controller) return;
    const Controller& controller = *scene_.controller;
    frames(controller);
    serial_program(controller);
    contact_force();
    if (controller.law == Law::gravity_compensation &&
        (controller.limit_of(0).value_or(0) > 1.4 || controller.limit_of(1).value_or(0) > 1.4)) {
      refuse("controller.limit",
             "found more than 1.4 rad (80 deg), near which gravity_compensation cannot invert its "
             "sine; allowed: at most that");
    }
    if (controller.sampling && controller.sampling->period > 0) check_times(controller);
    if (const auto* square = std::get_if<SquareReference>(&controller.reference)) {
      if (square->period > 0 &&
          2 * scene_.time.end > static_cast<double>(most_jumps) * square->period) {
        refuse("controller.reference.square.period",
               "found more than 100,000 jumps until time.end; allowed: a longer period");
      }
    }
  }

  // Refuses a number as the gain of a law that drives angles, because it pushes the ball away along
  // y.
  void signs() const {
    const auto drives = root_.at("controller.drives");
    if (!drives || drives->node->text != "angle") return;
    for (const char* const path : {"controller.pd.kv", "controller.pd.kp", "controller.pid.kv",
                                   "controller.pid.kp", "controller.pid.ki"}) {
      const auto gain = root_.at(path);
      if (!gain || gain->node->kind != yaml::Node::Kind::scalar) continue;
      const double k =
          yaml::read_quantity(gain->node->text, gain->node->quoted, yaml::Dimension::number)
              .value.value_or(0);
      if (k == 0) continue;
      const std::string theirs = number_text(k), reversed = number_text(-k);
      gain->report_at_key("found " + theirs + ", which means [[" + theirs + ", 0], [0, " + theirs +
                          "]], but positive theta drives the ball towards -y; allowed: [[" +
                          theirs + ", 0], [0, " + reversed +
                          "]], or another matrix with rows phi, theta and columns x, y");
    }
  }

  // Limits the number of samples and the delays, if the period is valid.
  void check_times(const Controller& controller) {
    const double period = mean_period(*controller.sampling);
    if (!(period > 0)) return;  // reported before
    if (scene_.time.end > 0 && scene_.time.end / period > 1e8) {
      const std::string why =
          "found more than 1e8 samples until time.end; allowed: a longer period";
      if (controller.sampling->periods.empty()) {
        refuse("controller.sampling.period", why);
      } else {
        refuse("controller.sampling.jitter", why + " on average");
      }
    }
    const auto check_delay = [&](std::string_view path, double delay) {
      if (delay <= most_periods * period) return;
      refuse(path,
             "found more than 100 periods of controller.sampling; allowed: a shorter delay, or a "
             "longer period");
    };
    check_delay("controller.sampling.delay", controller.sampling->delay);
    if (controller.sensor) check_delay("controller.sensor.delay", controller.sensor->delay);
  }

  void contact_force() const {
    const auto& sensor = scene_.controller->sensor;
    const double weight = scene_.ball.mass * scene_.gravity;
    if (!sensor || !(sensor->contact_force > weight)) return;
    if (const auto at = root_.at("controller.sensor.contact_force")) {
      at->warn("exceeds the ball's weight of " + short_number(weight) +
               " N, so the screen misses a ball that lies on it");
    }
  }

  // Checks the samples of a program at a sketch's serial line.
  void serial_program(const Controller& controller) {
    const auto* const library =
        controller.own ? std::get_if<ControllerLibrary>(&controller.own->by) : nullptr;
    if (library == nullptr || !library->serial || library->serial->period == 0) return;
    if (library->serial->period < controller.sampling->period) {
      refuse("controller.library.serial.period",
             "found a shorter time than controller.sampling.period, at whose samples bbsim asks "
             "the program; allowed: at least that");
    }
  }

  // Checks the frames of a sensor with its own period.
  void frames(const Controller& controller) {
    if (!controller.sensor) return;
    const Sensor& sensor = *controller.sensor;
    if (!sensor.period) return;
    if (scene_.time.end / *sensor.period > 1e8) {
      refuse("controller.sensor.period",
             "found more than 1e8 frames until time.end; allowed: a longer period");
    }
    if (sensor.phase >= *sensor.period) {
      refuse("controller.sensor.phase",
             "found a phase of a whole sensor.period or more; allowed: less than a period");
    }
    if (sensor.delay > most_periods * *sensor.period) {
      refuse("controller.sensor.delay",
             "found more than 100 frames of sensor.period; allowed: a shorter delay, or a longer "
             "period");
    }
  }

  void starts() const {
    const Gimbal& gimbal = scene_.gimbal;
    const GimbalStart& start = gimbal.start;
    if (!scene_.controller) return;
    if (gimbal.three_servos &&
        (start.phi != 0 || start.theta != 0 || start.phi_rate != 0 || start.theta_rate != 0)) {
      refuse("gimbal.start",
             "found beside gimbal.three_servos, which start at home; allowed: no start");
    }
    if (!gimbal.servo) return;
    const Servo& phi = *gimbal.servo;
    const Servo& theta = gimbal.theta_servo ? *gimbal.theta_servo : phi;
    if ((phi.time_constant && start.phi_rate != 0) ||
        (theta.time_constant && start.theta_rate != 0)) {
      refuse("gimbal.start",
             "found a rate, but a servo of first order (time_constant) has no rate state; allowed: "
             "phi and theta");
    }
    const auto within = [](double value, double limit) { return std::abs(value) <= limit; };
    const auto check = [&](bool fine, const char* what) {
      if (fine) return;
      refuse("gimbal.start", std::string("found beyond gimbal.servo.") + what +
                                 "; allowed: a start within the servo's limits");
    };
    check(within(start.phi, phi.angle_limit) && within(start.theta, theta.angle_limit),
          "angle_limit");
    check(within(start.phi_rate, phi.rate_limit) && within(start.theta_rate, theta.rate_limit),
          "rate_limit");
  }

  void groove() {
    if (!scene_.ball.groove || scene_.gimbal.three_servos || scene_.ball.rotation)
      return;  // refused
    const std::string along_x = why_not_along(0, scene_), along_y = why_not_along(1, scene_);
    if (!along_x.empty() && !along_y.empty()) {
      refuse("ball.rolling_radius",
             "found, but the scenario moves along two axes: not along x alone, since " + along_x +
                 "; not along y alone, since " + along_y +
                 "; allowed: only for a ball that rolls along one axis, in a groove or between "
                 "rails");
    }
  }

  // Warns of points beside the plate, which are often lengths without their unit.
  void plate() {
    const Plate& plate = scene_.plate;
    const auto warn_beside = [&](std::string_view path, const Pair& point) {
      const bool beside = (plate.size && (std::abs(point[0]) > (*plate.size)[0] / 2 ||
                                          std::abs(point[1]) > (*plate.size)[1] / 2)) ||
                          (plate.diameter && std::hypot(point[0], point[1]) > *plate.diameter / 2);
      const auto value = beside ? root_.at(path) : std::nullopt;
      if (value) value->warn("is not on the plate; lengths without a unit are read in m");
    };
    warn_beside("ball.position", scene_.ball.position);
    if (!scene_.controller) return;
    const auto* const point = std::get_if<PointReference>(&scene_.controller->reference);
    if (point != nullptr) warn_beside("controller.reference.point", point->position);
    const auto* const stairs = std::get_if<StaircaseReference>(&scene_.controller->reference);
    if (stairs != nullptr && stairs->points.size() == 2) {
      warn_beside("controller.reference.step.from", stairs->points[0]);
      warn_beside("controller.reference.step.to", stairs->points[1]);
    }
  }

  // Warns about moments that no body has: each moment is an integral of squared distances over the
  // mass.
  void body() {
    const auto inertia = root_.at("plate.inertia");
    if (!inertia || !scene_.plate.inertia) return;
    const auto& j = *scene_.plate.inertia;
    // Tolerance for moments given with few digits.
    constexpr double more = 1 + 1e-6;
    constexpr const char* axes[] = {"x", "y", "the normal"};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t second = (i + 1) % 3, third = (i + 2) % 3;
      if (!(j[i] > more * (j[second] + j[third]))) continue;
      inertia->warn("the moment about " + std::string(axes[i]) +
                    " is greater than the sum of the other two, which no body has");
    }
    const double z = scene_.plate.centre_of_mass, least = scene_.plate.mass * z * z;
    const auto height = root_.at("plate.center_of_mass");
    if (height && std::min(j[0], j[1]) * more < least) {
      inertia->warn("a moment about x or y is less than " + number_text(least) +
                    " kg m^2, plate.mass times the square of " + height->path +
                    ", which no body has: the moments are about the gimbal's center");
    }
  }

  void inertia() const {
    if (!scene_.plate.inertia || !moved_by_torques(scene_)) return;
    const Gimbal& gimbal = scene_.gimbal;
    const double rotor = gimbal.motor ? gimbal.motor->rotor_inertia : 0;
    const auto& j = *scene_.plate.inertia;
    if (!(j[0] + rotor > 0) || !(j[1] + gimbal.ring_inertia + rotor > 0)) {
      refuse("plate.inertia", "found an axis without inertia; allowed: moments greater than 0");
    }
  }

  void columns() {
    const auto columns = root_.at("output.columns");
    if (!columns || columns->node->kind != yaml::Node::Kind::sequence) return;
    for (std::size_t i = 0; i < columns->node->items.size(); ++i) {
      const yaml::Value item = columns->item(i);
      const Column* column = find_column(item.node->text);
      if (column == nullptr) continue;
      // Without motion and controller, check_relations() has reported a problem.
      const bool of_controller =
          column->needs == Needs::controller || column->needs == Needs::commands;
      if (of_controller && !scene_.gimbal.motion && commands_of(scene_) == nullptr) continue;
      if (const Missing lacks = missing(*column, scene_)) {
        item.refuse(std::string(", but ") + lacks.why, lacks.instead);
      }
    }
  }

  const yaml::Value& root_;
  const Scenario& scene_;
};

}  // namespace

void check_rig(const yaml::Value& root, const Scenario& scenario) {
  Checks(root, scenario).all();
}

}  // namespace bbsim::scenario
