// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Refuses combinations of keys that no single relation describes (sections.hpp): sampling, laws,
// servos, linkages, losses, events.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "base/number_text.hpp"
#include "base/short_number.hpp"
#include "scenario/columns.hpp"
#include "scenario/coupled.hpp"
#include "scenario/groove.hpp"
#include "scenario/relations.hpp"
#include "scenario/sections.hpp"

namespace bbsim::scenario {
namespace {

// The longest delay in periods. Delayed samples enlarge the loop's state and the matrix whose
// eigenvalues are the loop's poles.
constexpr double most_periods = 100;

// The value at a path of keys, if present.
std::optional<yaml::Value> find_at(yaml::Keys& keys, std::initializer_list<std::string_view> path) {
  std::optional<yaml::Value> value = keys.mapping();
  for (const std::string_view key : path) {
    if (!value) return {};
    value = yaml::Keys(*value).find(key);
  }
  return value;
}

// The mean of the measured periods (s); without them, the nominal period.
double mean_period(const Sampling& sampling) {
  const auto& periods = sampling.periods;
  if (periods.empty()) return sampling.period;
  return std::accumulate(periods.begin(), periods.end(), 0.0) / static_cast<double>(periods.size());
}

class Checks {
 public:
  Checks(yaml::Keys& keys, const Scenario& scene) : keys_(keys), scene_(scene) {}

  void all() {
    check_relations(keys_);
    controller();
    servo();
    linkage();
    push();
    groove();
    events();
    plate();
    losses();
    sliding();
    body();
    torques();
    columns();
  }

 private:
  using Path = std::initializer_list<std::string_view>;

  // Reports `why` at the key, if present.
  void refuse(Path path, const std::string& why) {
    const auto value = find_at(keys_, path);
    if (value) value->context->problems.add(value->position, value->path + ": " + why);
  }

  // The key feedback_linearization in the scenario's spelling.
  std::string law() {
    const auto value = find_at(keys_, {"controller", "feedback_linearization"});
    return value ? std::string(value->name()) : "feedback_linearization";
  }

  void controller() {
    if (!scene_.controller) return;
    const Controller& controller = *scene_.controller;
    frames(controller);
    serial_program(controller);
    contact_force();
    if (controller.law == Law::own && !controller.sampling) {
      for (const char* key : {"program", "library"}) {
        refuse({"controller", key},
               "found without controller.sampling; allowed: only with it, since bbsim calls it "
               "once per sample");
      }
    }
    if (controller.law == Law::feedback_linearisation) {
      if (controller.sampling) {
        refuse({"controller", "sampling"}, "found beside " + law() +
                                               ", which needs the exact state at all times; "
                                               "allowed: any other law");
      }
      if (controller.drives != Drives::acceleration) {
        refuse({"controller", "drives"},
               std::string("found ") +
                   (drives_servos(controller.drives) ? name_of(controller.drives) : "torques") +
                   ", but " + law() +
                   " gives the gimbal's accelerations; allowed: "
                   "acceleration");
      }
    }
    if (controller.law == Law::lqr) {
      if (!(scene_.gravity > 0)) {
        refuse({"controller", "lqr"},
               "found, but gravity is 0, and a tilted plate does not move the ball; allowed: "
               "gravity greater than 0");
      }
      if (any_servo([](const Servo& servo) { return servo.time_constant.has_value(); })) {
        refuse({"controller", "lqr"},
               "found with a servo of first order (time_constant); allowed: one with "
               "natural_frequency and damping, whose state the regulator feeds back");
      }
    }
    if (controller.law == Law::commands && controller.drives != Drives::angle) {
      refuse({"controller", "commands"},
             "found, but controller.drives is not angle; allowed: only with drives: angle, since "
             "commands are angles");
    }
    if (controller.law == Law::gravity_compensation) {
      if (controller.drives != Drives::angle) {
        refuse({"controller", "gravity_compensation"},
               "found, but controller.drives is not angle; allowed: only with drives: angle, "
               "since it gives angles");
      }
      if (!(scene_.gravity > 0)) {
        refuse({"controller", "gravity_compensation"},
               "found, but gravity is 0; allowed: gravity greater than 0");
      }
      if (controller.limit_of(0).value_or(0) > 1.4 || controller.limit_of(1).value_or(0) > 1.4) {
        refuse({"controller", "limit"},
               "found more than 1.4 rad (80 deg), near which gravity_compensation cannot invert "
               "its sine; allowed: at most that");
      }
    }
    if (controller.drives == Drives::legs) legs(controller);
    if (!drives_servos(controller.drives) && controller.sampling &&
        controller.sampling->resolution > 0) {
      refuse({"controller", "sampling", "resolution"},
             "found, but controller.drives is not angle; allowed: only with drives: angle");
    }
    if (controller.sampling && controller.sampling->period > 0) check_times(controller);
    if (const auto* square = std::get_if<SquareReference>(&controller.reference)) {
      if (2 * scene_.time.end > static_cast<double>(most_jumps) * square->period) {
        refuse({"controller", "reference", "square", "period"},
               "found more than 100,000 jumps until time.end; allowed: a longer period");
      }
    }
  }

  void legs(const Controller& controller) {
    if (!scene_.gimbal.three_servos) {
      refuse({"controller", "drives"},
             "found legs, but there are no three servos; allowed: angle, or gimbal.three_servos "
             "given");
    }
    if (controller.law != Law::own) {
      refuse(
          {"controller", "drives"},
          "found legs beside a law that gives two angles; allowed: angle, or your own program or "
          "library, which gives an angle for each servo");
    }
    if (controller.axis_limits) {
      refuse({"controller", "limit"},
             "found limits of phi and theta, but the commands are those of three servos; allowed: "
             "one angle for all");
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
        refuse({"controller", "sampling", "period"}, why);
      } else {
        refuse({"controller", "sampling", "jitter"}, why + " on average");
      }
    }
    if (controller.sampling->delay > most_periods * period) {
      refuse({"controller", "sampling", "delay"},
             "found more than 100 periods of controller.sampling; allowed: a shorter delay, or a "
             "longer period");
    }
    if (controller.sensor && controller.sensor->delay > most_periods * period) {
      refuse({"controller", "sensor", "delay"},
             "found more than 100 periods of controller.sampling; allowed: a shorter delay, or a "
             "longer period");
    }
  }

  void contact_force() const {
    const auto& sensor = scene_.controller->sensor;
    const double weight = scene_.ball.mass * scene_.gravity;
    if (!sensor || !(sensor->contact_force > weight)) return;
    if (const auto at = find_at(keys_, {"controller", "sensor", "contact_force"})) {
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
      refuse({"controller", "library", "serial", "period"},
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
      refuse({"controller", "sensor", "period"},
             "found more than 1e8 frames until time.end; allowed: a longer period");
    }
    if (sensor.phase >= *sensor.period) {
      refuse({"controller", "sensor", "phase"},
             "found a phase of a whole sensor.period or more; allowed: less than a period");
    }
    if (sensor.delay > most_periods * *sensor.period) {
      refuse({"controller", "sensor", "delay"},
             "found more than 100 frames of sensor.period; allowed: a shorter delay, or a longer "
             "period");
    }
  }

  // Refuses a key of one axis's servo: at the axis's own key if present, else at the common key.
  void refuse_of_servo(std::size_t axis, std::string_view key, const std::string& why) {
    const char* const name = axis == 0 ? "phi" : "theta";
    if (find_at(keys_, {"gimbal", "servo", name, key})) {
      refuse({"gimbal", "servo", name, key}, why);
    } else if (axis == 0 || scene_.gimbal.theta_servo) {
      refuse({"gimbal", "servo", key}, why);
    }
  }

  template <class Holds>
  [[nodiscard]] bool any_servo(Holds holds) const {
    const Gimbal& gimbal = scene_.gimbal;
    if (!gimbal.servo) return false;
    for (std::size_t leg = 0; leg < 3 && gimbal.three_servos; ++leg) {
      if (holds(gimbal.servo_of(leg))) return true;
    }
    return holds(*gimbal.servo) || (gimbal.theta_servo && holds(*gimbal.theta_servo));
  }

  void servo() {
    if (scene_.events.steps_lost && !scene_.gimbal.loses_steps()) {
      refuse({"events", "steps_lost"},
             "found, but no stepper loses steps; allowed: only with gimbal.servo.stepper.torque");
    }
    if (!scene_.controller || !scene_.gimbal.servo) return;
    leg_servos();
    for (std::size_t axis = 0; axis < (scene_.gimbal.theta_servo ? 2U : 1U); ++axis) servo(axis);
    const GimbalStart& start = scene_.gimbal.start;
    const Servo &phi = scene_.gimbal.servo_of(0), &theta = scene_.gimbal.servo_of(1);
    const auto within = [&](double angle, const std::optional<double>& limit) {
      return !limit || std::abs(angle) <= *limit;
    };
    const auto check = [&](bool fine, const char* what) {
      if (fine) return;
      refuse({"gimbal", "start"}, std::string("found beyond gimbal.servo.") + what +
                                      "; allowed: a start within the servo's limits");
    };
    check(within(start.phi, phi.angle_limit) && within(start.theta, theta.angle_limit),
          "angle_limit");
    check(within(start.phi_rate, phi.rate_limit) && within(start.theta_rate, theta.rate_limit),
          "rate_limit");
  }

  // Null if there is none.
  [[nodiscard]] const char* trouble_of_stepper(const Servo& servo) const {
    if (!scene_.controller->sampling) {
      return "without controller.sampling; allowed: only with it, since the driver plans a ramp to "
             "each command";
    }
    if (scene_.controller->is_sketch()) {
      if (servo.stepper->torque) {
        return "with torque; allowed: only under a law of bbsim, whose ramps it limits. To test a "
               "sketch's ramp, give its speed and acceleration as rate_limit and "
               "acceleration_limit of such a law";
      }
      if (servo.rate_limit || servo.acceleration_limit) {
        return "beside rate_limit or acceleration_limit; allowed: without them, since the sketch's "
               "pulses make the ramp";
      }
    } else if (!servo.rate_limit || !servo.acceleration_limit) {
      return "without rate_limit and acceleration_limit; allowed: only with both, which are the "
             "driver's ramp";
    }
    if (servo.time_constant || servo.natural_frequency > 0) {
      return "beside natural_frequency, time_constant or model; allowed: one of them";
    }
    const StepperMotor& motor = *servo.stepper;
    if (motor.torque.has_value() != motor.inertia.has_value()) {
      return "with one of torque and inertia; allowed: both, whose ratio is the greatest "
             "acceleration, or neither";
    }
    if (motor.corner_speed && !motor.torque) {
      return "with corner_speed, but no torque; allowed: only with torque and inertia";
    }
    if (motor.torque && servo.backlash > 0) {
      return "with torque, beside backlash; allowed: one of the two";
    }
    if (motor.natural_frequency && servo.backlash > 0) {
      return "with natural_frequency, beside backlash; allowed: one of the two";
    }
    return servo.angle_limit
               ? "beside angle_limit; allowed: controller.limit, which keeps commands within bounds"
               : nullptr;
  }

  void leg_servos() {
    const auto& three = scene_.gimbal.three_servos;
    for (std::size_t i = 0; three && three->legs && i < 3; ++i) {
      const auto& servo = (*three->legs)[i].servo;
      if (!servo) continue;
      const auto refuse_leg = [&](const std::string& why) {
        refuse({"gimbal", "three_servos", "legs"},
               "found a servo of leg " + std::to_string(i + 1) + " with " + why);
      };
      if (const char* const why = servo->stepper ? trouble_of_stepper(*servo) : nullptr) {
        refuse_leg(std::string("stepper ") + why);
      }
      if (servo->time_constant && !scene_.controller->sampling) {
        refuse_leg("time_constant, but no controller.sampling; allowed: only with it");
      }
      if (servo->time_constant && servo->acceleration_limit) {
        refuse_leg("time_constant and acceleration_limit; allowed: one of the two");
      }
      if (servo->dead_band > 0 && !scene_.controller->sampling) {
        refuse_leg("dead_band, but no controller.sampling; allowed: only with it");
      }
    }
  }

  void servo(std::size_t axis) {
    const Servo& servo = axis == 0 ? *scene_.gimbal.servo : scene_.gimbal.servo_of(axis);
    if (servo.stepper) {
      if (const char* const why = trouble_of_stepper(servo)) {
        refuse_of_servo(axis, "stepper", std::string("found ") + why);
      }
    }
    if (servo.time_constant) {
      if (!scene_.controller->sampling) {
        refuse_of_servo(axis, "time_constant",
                        "found without controller.sampling; allowed: only with it. The rate of a "
                        "servo of first order follows its command at once, so a continuous command "
                        "would have to be differentiated");
      }
      if (servo.acceleration_limit) {
        refuse_of_servo(axis, "acceleration_limit",
                        "found with time_constant: a servo of first order changes its rate at "
                        "once; allowed: only with natural_frequency and damping");
      }
      const GimbalStart& start = scene_.gimbal.start;
      const bool has_theta_servo = scene_.gimbal.theta_servo.has_value();
      const double rate = axis == 0 ? start.phi_rate : start.theta_rate;
      if (has_theta_servo ? rate != 0 : start.phi_rate != 0 || start.theta_rate != 0) {
        refuse({"gimbal", "start"},
               "found a rate, but a servo of first order (time_constant) has no rate state; "
               "allowed: phi and theta");
      }
    }
    if (servo.dead_band > 0 && !scene_.controller->sampling) {
      const bool of_model = !find_at(keys_, {"gimbal", "servo", "dead_band"}) &&
                            find_at(keys_, {"gimbal", "servo", "model"});
      refuse_of_servo(
          axis, of_model ? "model" : "dead_band",
          std::string(of_model ? "has a dead band, " : "") +
              "found without controller.sampling; allowed: only with it, since a dead band "
              "compares each command with the one before");
    }
  }

  void linkage() {
    const Gimbal& gimbal = scene_.gimbal;
    const bool linked = find_at(keys_, {"gimbal", "linkage"}).has_value();
    const bool three = gimbal.three_servos.has_value();
    if (!linked && !three) return;
    const char* const key = linked ? "linkage" : "three_servos";
    if (!scene_.controller) {
      refuse({"gimbal", key},
             "found without a controller, and no servo moves it; allowed: only with a controller "
             "that drives angle");
      return;
    }
    const bool driven = three ? drives_servos(scene_.controller->drives)
                              : scene_.controller->drives == Drives::angle;
    if (!driven || gimbal.motor) {
      refuse({"gimbal", key},
             std::string("found, but ") +
                 (gimbal.motor ? "gimbal.motor moves the axes themselves"
                               : "controller.drives is not angle, and no servo moves it") +
                 "; allowed: only with drives: angle and gimbal.servo");
    }
    if (scene_.controller->own && (!three || scene_.controller->drives == Drives::legs)) {
      refuse({"controller", "assumes"},
             std::string("found with your own controller, which commands the servos itself; "
                         "allowed: only with a built-in law") +
                 (three ? ", or under drives: angle" : ""));
    }
    if (scene_.controller->assumed_legs && (!three || !scene_.controller->sampling)) {
      refuse({"controller", "assumes"},
             "found legs; allowed: only with gimbal.three_servos and controller.sampling, since "
             "only firmware assumes other legs");
    }
    if (!three) return;
    if (gimbal.theta_servo) {
      refuse({"gimbal", "servo"},
             "found keys for phi and theta beside gimbal.three_servos, which belong to no axis; "
             "allowed: the same keys for all three");
    }
    if (gimbal.start.phi != 0 || gimbal.start.theta != 0 || gimbal.start.phi_rate != 0 ||
        gimbal.start.theta_rate != 0) {
      refuse({"gimbal", "start"},
             "found beside gimbal.three_servos, which start at home; allowed: no start");
    }
  }

  void push() {
    if (!scene_.ball.push) return;
    if (inverts()) {
      refuse({"ball", "push"}, "found beside " + law() +
                                   ", whose equations do not include it; allowed: any other law");
    }
  }

  void groove() {
    if (!scene_.ball.groove) return;
    const std::string along_x = why_not_along(0, scene_), along_y = why_not_along(1, scene_);
    if (!along_x.empty() && !along_y.empty()) {
      refuse({"ball", "rolling_radius"},
             "found, but the scenario moves along two axes: not along x alone, since " + along_x +
                 "; not along y alone, since " + along_y +
                 "; allowed: only for a ball that rolls along one axis, in a groove or between "
                 "rails");
    }
    if (scene_.events.slip) {
      refuse({"events", "slip"},
             "found beside ball.rolling_radius, and the friction of two contacts is not that of "
             "one; allowed: any other event");
    }
  }

  void events() {
    if (scene_.events.singularity &&
        !(scene_.controller && scene_.controller->law == Law::feedback_linearisation)) {
      refuse({"events", "singularity"},
             "found without controller.feedback_linearization; allowed: only with it");
    }
  }

  // Warns of points beside the plate, which are often lengths without their unit.
  void plate() {
    const Plate& plate = scene_.plate;
    const auto warn_beside = [&](Path path, const Pair& point) {
      const bool beside = (plate.size && (std::abs(point[0]) > (*plate.size)[0] / 2 ||
                                          std::abs(point[1]) > (*plate.size)[1] / 2)) ||
                          (plate.diameter && std::hypot(point[0], point[1]) > *plate.diameter / 2);
      const auto value = beside ? find_at(keys_, path) : std::nullopt;
      if (value) value->warn("is not on the plate; lengths without a unit are read in m");
    };
    warn_beside({"ball", "position"}, scene_.ball.position);
    if (!scene_.controller) return;
    const auto* const point = std::get_if<PointReference>(&scene_.controller->reference);
    if (point != nullptr) warn_beside({"controller", "reference", "point"}, point->position);
    const auto* const stairs = std::get_if<StaircaseReference>(&scene_.controller->reference);
    if (stairs != nullptr && stairs->points.size() == 2) {
      warn_beside({"controller", "reference", "step", "from"}, stairs->points[0]);
      warn_beside({"controller", "reference", "step", "to"}, stairs->points[1]);
    }
  }

  [[nodiscard]] bool inverts() const {
    return scene_.controller && scene_.controller->law == Law::feedback_linearisation;
  }

  void losses() {
    const Losses& losses = scene_.ball.losses;
    if (losses.viscous > 0 && !find_at(keys_, {"ball", "mass"})) {
      refuse({"ball", "losses", "viscous"},
             "found, but no ball.mass, and a lighter ball loses more speed; allowed: only with "
             "ball.mass");
    }
    if (losses.pivoting > 0 && scene_.ball.inertia_factor == 0) {
      refuse(
          {"ball", "losses", "pivoting"},
          "found, but ball.inertia_factor is 0: such a ball's spin would stop at once; allowed: a "
          "factor greater than 0");
    }
    if (has_dry_losses(scene_) && inverts()) {
      refuse({"ball", "losses"},
             "found dry friction beside " + law() +
                 ", which inverts smooth equations; allowed: viscous, or any other law");
    }
    if (scene_.events.rest && !(losses.rolling > 0)) {
      refuse({"events", "rest"},
             "found, but nothing brings the ball to rest; allowed: only with ball.losses.rolling");
    }
  }

  void sliding() {
    const bool slides = scene_.events.slip && scene_.events.slip->sliding;
    if (!slides) return;
    if (scene_.ball.inertia_factor == 0) {
      refuse({"events", "slip", "action"},
             "found slide, but ball.inertia_factor is 0: nothing would make such a ball slide; "
             "allowed: a factor greater than 0");
    }
    if (inverts()) {
      refuse({"events", "slip", "action"}, "found slide beside " + law() +
                                               ", which inverts the equations of a ball that "
                                               "rolls; allowed: stop or note, or any other law");
    }
    if (any_servo([](const Servo& servo) {
          return servo.time_constant || servo.angle_limit || servo.backlash > 0;
        })) {
      refuse({"events", "slip", "action"},
             "found slide with a servo that jolts the plate (time_constant, angle_limit or "
             "backlash), where the sliding motion is not defined; allowed: stop or note");
    }
  }

  // Warns about moments that no body has: each moment is an integral of squared distances over the
  // mass.
  void body() {
    const auto inertia = find_at(keys_, {"plate", "inertia"});
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
    const auto height = find_at(keys_, {"plate", "center_of_mass"});
    if (height && std::min(j[0], j[1]) * more < least) {
      inertia->warn("a moment about x or y is less than " + number_text(least) +
                    " kg m^2, plate.mass times the square of " + height->path +
                    ", which no body has: the moments are about the gimbal's center");
    }
  }

  void torques() {
    const Gimbal& gimbal = scene_.gimbal;
    if (scene_.plate.mass == 0) {
      refuse({"plate", "center_of_mass"},
             "found without plate.mass; allowed: only with it, since the weight acts there");
    }
    const bool sticks = gimbal.motor && gimbal.motor->friction > 0;
    if (scene_.events.stick && !sticks) {
      refuse({"events", "stick"},
             "found, but nothing holds an axis; allowed: only with gimbal.motor.friction");
    }
    if (!moved_by_torques(scene_)) {
      refuse({"gimbal", "ring_inertia"},
             "found, but no torques move the gimbal; allowed: only with gimbal.torque, or a "
             "controller of gimbal.motor");
      return;
    }
    if (!find_at(keys_, {"ball", "mass"})) {
      // If the key `ball` is missing, the reader has reported its radius.
      refuse({"ball"},
             "found no mass, but the ball's weight moves the gimbal; allowed: ball.mass given, "
             "since the default of 1 kg is not a realistic ball");
    }
    if (!scene_.plate.inertia) {
      const auto gimbal_keys = find_at(keys_, {"gimbal"});
      const yaml::Value& place = gimbal_keys ? *gimbal_keys : keys_.mapping();
      place.context->problems.add(
          place.position,
          "plate.inertia: missing, but torques move the gimbal; allowed: three moments of inertia "
          "about x, y and the normal, such as [2e-4, 2e-4, 4e-4]");
    } else {
      const double ring = gimbal.ring_inertia;
      const double rotor = gimbal.motor ? gimbal.motor->rotor_inertia : 0;
      const auto& j = *scene_.plate.inertia;
      if (!(j[0] + rotor > 0) || !(j[1] + ring + rotor > 0)) {
        refuse({"plate", "inertia"},
               "found an axis without inertia; allowed: moments greater than 0");
      }
    }
    if (inverts()) {
      refuse({"controller", "feedback_linearization"},
             "found, but torques move the gimbal, and this law gives its accelerations; allowed: "
             "drives: acceleration, or any other law");
    }
    if (scene_.controller && scene_.controller->law == Law::lqr && gimbal.motor &&
        gimbal.motor->position_loop && gimbal.motor->position_loop->ki > 0) {
      refuse(
          {"gimbal", "motor", "position_loop", "ki"},
          "found beside lqr, which does not see the loop's integral; allowed: ki 0, or any other "
          "law");
    }
  }

  void columns() {
    const auto columns = find_at(keys_, {"output", "columns"});
    if (!columns || columns->node->kind != yaml::Node::Kind::sequence) return;
    for (std::size_t i = 0; i < columns->node->items.size(); ++i) {
      const yaml::Value item = columns->item(i);
      const Column* column = find_column(item.node->text);
      if (column == nullptr) continue;
      // Without motion and controller, check_loop() has reported a problem.
      const bool of_controller =
          column->needs == Needs::controller || column->needs == Needs::commands;
      if (of_controller && !scene_.gimbal.motion && commands_of(scene_) == nullptr) continue;
      if (const Missing lacks = missing(*column, scene_)) {
        item.refuse(std::string(", but ") + lacks.why, lacks.instead);
      }
    }
  }

  yaml::Keys& keys_;
  const Scenario& scene_;
};

}  // namespace

void check_rig(yaml::Keys& keys, const Scenario& scenario) {
  Checks(keys, scenario).all();
}

}  // namespace bbsim::scenario
