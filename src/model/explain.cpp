// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Explains what the model of a scene includes and omits, for `bbsim check` and the summary.
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "model/assemble.hpp"
#include "model/model.hpp"
#include "model/servo/linkages.hpp"
#include "model/servo/servo.hpp"
#include "scenario/coupled.hpp"

namespace bbsim::model {
namespace {

// A comma-separated list.
class List {
 public:
  void add(const std::string& part) { text_ += (text_.empty() ? "" : ", ") + part; }
  void add_if(bool holds, const std::string& part) {
    if (holds) add(part);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string ball_note(const Scenario& scene, Shape shape) {
  if (scenario::is_coupled(scene)) {
    return "x, y and spin: Newton and Euler with the couples and friction of the contact, (M36) to "
           "(M44)";
  }
  if (!is_the_papers(scene)) {
    return "x, y and spin: equation (27) for any inertia factor and mounting, (M18) to (M20)";
  }
  switch (shape) {
    case Shape::along_x:
      return "x only: theta, y and spin stay zero by symmetry";
    case Shape::along_y:
      return "y only: phi, x and spin stay zero by symmetry";
    case Shape::full:
      break;
  }
  return needs_rig(scene) ? "x, y and spin: equation (27), in the general form (M18) to (M20)"
                          : "x, y and spin: equation (27)";
}

std::string gimbal_note(const Scenario& scene) {
  if (scenario::moved_by_torques(scene)) {
    const std::string states =
        "angles and rates are states: torques move plate, ring and ball, (M45) to (M47), ";
    if (!scene.controller) return states + "given functions of time";
    const Drives drives = scene.controller->drives;
    if (drives == Drives::torque) return states + "the controller's";
    if (drives == Drives::voltage) return states + "of motors under the controller's voltages";
    return states + "of motors whose position loops follow the controller's angles";
  }
  if (!scene.controller) return "no gimbal states: the angles are given functions of time";
  if (scene.controller->drives == Drives::acceleration) {
    return std::string("angles and rates are states: the controller drives their accelerations") +
           (needs_rig(scene) ? "" : ", equation (31)");
  }
  const std::string phi = kind_of(scene.gimbal.servo_of(0)),
                    theta = kind_of(scene.gimbal.servo_of(1));
  return "angles and rates are states: " +
         (phi == theta ? phi + 's' : "a " + phi + " and a " + theta) +
         " follow the controller's angles";
}

std::string limits_note(const Gimbal& gimbal) {
  if (gimbal.three_servos && gimbal.three_servos->legs) {
    const auto& legs = *gimbal.three_servos->legs;
    std::string text = limits_of(*gimbal.servo);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!legs[i].servo) continue;
      text += (text.empty() ? "leg " : "; leg ") + std::to_string(i + 1) + ": " +
              servo_note(*legs[i].servo);
    }
    return text;
  }
  if (!gimbal.theta_servo) return limits_of(*gimbal.servo);
  return "phi: " + servo_note(gimbal.servo_of(0)) + "; theta: " + servo_note(gimbal.servo_of(1));
}

// The plate's tilt when the controller commands it level.
std::string believed_level(const Scenario& scene) {
  const Mechanism mechanism = mechanism_of(scene);
  const Pair tilt = mechanism.tilt(mechanism.commands_for({0, 0}));
  return "phi is " + degrees(tilt[0]) + " and theta " + degrees(tilt[1]);
}

std::string assumes_note(const Scenario& scene) {
  const bool two_of_three = scene.gimbal.three_servos && scene.controller->drives == Drives::angle;
  if (scene.controller->own && !two_of_three) {
    return "; your controller commands the servos itself";
  }
  if (scene.controller->assumed_legs) {
    return "; the controller assumes other legs: where it wants the plate level, " +
           believed_level(scene);
  }
  return assumes_of(scene) == Assumes::exact ? "; the controller inverts the curve"
                                             : "; the controller assumes the ratio at home";
}

// A warning if the servo's stops lie beyond the ends of the curve.
std::string beyond_note(const Linkage& linkage, const Servo& servo) {
  const double stop = servo.angle_limit;
  if (stop == unlimited || (linkage.curve.high > stop && linkage.curve.low < -stop)) return "";
  return "; WARNING: its stops at " + degrees(stop) + " lie beyond that";
}

// Notes for unequal legs and for controllers that command legs.
std::string legs_note(const Scenario& scene, const Mechanism& mechanism) {
  const ThreeServos& three = *mechanism.three;
  std::string text;
  if (!three.equal) {
    text += "; the legs twist the plate by at most " + degrees(greatest_twist(three, 0.1)) +
            " at 0.1 rad, which the ball does not feel";
  }
  if (!three.equal || scene.controller->drives == Drives::legs) {
    List horns;
    for (const ThreeServos::Leg& leg : three.leg) horns.add(degrees(leg.home));
    text += "; at home the horns are at " + horns.text() + " above the horizontal";
  }
  return text;
}

std::string linkage_note(const Scenario& scene) {
  if (!scenario::is_linked(scene)) return "";
  const Mechanism mechanism = mechanism_of(scene);
  if (mechanism.three) {
    const ThreeServos& three = *mechanism.three;
    const double tilt = greatest_tilt(three);
    double plate = 0;
    for (const ThreeServos::Leg& leg : three.leg) plate = std::max(plate, leg.plate);
    return "three servos, two tilts and a height, (M58) to (M61); all legs reach a tilt of " +
           degrees(tilt) + "; the shift of the plate's center is neglected, at most " +
           short_number(1e3 * plate / 2 * (1 - std::cos(tilt))) + " mm there, and " +
           short_number(1e3 * plate / 2 * (1 - std::cos(0.1))) + " mm at 0.1 rad" +
           legs_note(scene, mechanism) + assumes_note(scene);
  }
  std::string text;
  for (std::size_t i = 0; i < 2; ++i) {
    const Linkage& linkage = mechanism.linkages[i];
    text += i == 0 ? "phi: " : "; theta: ";
    const bool as_servo = linkage.curve.kind == LinkCurve::Kind::ideal;
    if (as_servo && !linkage.reach.binds()) {
      text += "none";
      continue;
    }
    text += as_servo
                ? "push rod, a parallelogram: the plate turns with the servo"
                : (linkage.table ? "measured curve, slope " : "push rod, (M54) to (M56), slope ") +
                      short_number(linkage.curve.slope) + " at home";
    const double home = linkage.angle(0);
    if (std::abs(home) > 1e-12) text += ", where the plane is at " + degrees(home);
    if (linkage.curve.high < unlimited) {
      text += ", from " + degrees(linkage.curve.low) + " (" + linkage.low_end + ") to " +
              degrees(linkage.curve.high) + " (" + linkage.high_end + ") of the servo" +
              beyond_note(linkage, scene.gimbal.servo_of(i));
    }
  }
  text += assumes_note(scene) + "; phi_command and theta_command are the servos' angles";
  if (commands_of(scene) != nullptr) text += ", controller.commands the plate's";
  return text;
}

std::string losses_note(const Losses& losses) {
  List list;
  list.add_if(losses.rolling > 0, "rolling resistance " + short_number(losses.rolling));
  list.add_if(losses.viscous > 0, "viscous " + short_number(losses.viscous) + " N m s");
  list.add_if(losses.pivoting > 0, "pivoting " + millimetres(losses.pivoting));
  return list.text();
}

std::string motor_note(const Motor& motor) {
  List list;
  list.add_if(motor.viscous > 0, "viscous " + short_number(motor.viscous) + " N m s");
  list.add_if(motor.friction > 0, "dry friction " + short_number(motor.friction) + " N m");
  if (motor.torque_limit) list.add("at most " + short_number(*motor.torque_limit) + " N m");
  if (motor.dc && motor.dc->voltage_limit) {
    list.add("at most " + short_number(*motor.dc->voltage_limit) + " V");
  }
  if (motor.position_loop) {
    list.add("position loop kp " + short_number(motor.position_loop->kp) + ", kd " +
             short_number(motor.position_loop->kd) + ", ki " +
             short_number(motor.position_loop->ki));
  }
  return list.text();
}

std::string own_law(const OwnController& own) {
  std::string text;
  if (const auto* program = std::get_if<ControllerProgram>(&own.by)) {
    text = "your own, a program:";
    for (const std::string& word : program->command) text += ' ' + word;
  } else if (const auto* library = std::get_if<ControllerLibrary>(&own.by)) {
    text = "your own, a library: " + library->file;
    if (library->serial) {
      text += "; at its serial line a program:";
      for (const std::string& word : library->serial->program.command) text += ' ' + word;
      const double period = library->serial->period, delay = library->serial->delay;
      text += period > 0 ? ", every " + short_number(period) + " s" : ", at each sample";
      if (delay > 0) text += ", which sends " + short_number(delay) + " s later";
    }
  } else {
    text = "your own, " + std::get<ControllerFactory>(own.by).name;
  }
  for (std::size_t i = 0; i < own.parameters.size(); ++i) {
    text += (i == 0 ? ", with " : ", ") + own.parameters[i].name + " = " +
            short_number(own.parameters[i].value);
  }
  return text;
}

std::string law_note(const Controller& controller) {
  std::string text;
  switch (controller.law) {
    case Law::pd:
      text = "PD, equation (31)";
      break;
    case Law::pid:
      text = "PID; the integral waits at the limit while the error drives outward";
      break;
    case Law::state_feedback:
      text = "state feedback";
      break;
    case Law::lqr:
      text = controller.sampling ? "LQR of the sampled plant, without its delays"
                                 : "LQR of the plant about home";
      break;
    case Law::gravity_compensation:
      text = "gravity compensation: the angles at which gravity gives the wanted acceleration";
      break;
    case Law::feedback_linearisation:
      text =
          "feedback linearization of (27): the ball follows, the tilt is an unstable internal "
          "state (docs/how-to/real-effects.md)";
      break;
    case Law::commands:
      text = "commands that are known beforehand, whatever the ball does";
      break;
    case Law::own:
      text = own_law(*controller.own);
      break;
  }
  const auto shown = [&](const std::optional<double>& limit) {
    if (!limit) return std::string("any");
    return drives_servos(controller.drives)
               ? degrees(*limit)
               : short_number(*limit) + ' ' + command_unit(controller.drives);
  };
  const auto phi = command_limit(controller, 0), theta = command_limit(controller, 1);
  if (phi != theta) {
    text += "; command of phi within " + shown(phi) + ", of theta within " + shown(theta);
  } else if (phi) {
    text += (controller.drives == Drives::legs ? "; command of each servo within "
                                               : "; command within ") +
            shown(phi);
  }
  return text;
}

std::string sampling_note(const Sampling& sampling, bool own) {
  List list;
  list.add("a command every " + milliseconds(sampling.period) + ", held between");
  if (sampling.jitter > 0) {
    list.add("periods that jitter by " + milliseconds(sampling.jitter) +
             " (the poles are those of the nominal period)");
  } else if (!sampling.periods.empty()) {
    list.add(std::to_string(sampling.periods.size()) + " measured periods of " +
             sampling.periods_file + ", repeated (the poles are those of the nominal period)");
  }
  list.add_if(sampling.delay > 0, milliseconds(sampling.delay) + " late");
  list.add_if(sampling.resolution > 0, "in steps of " + degrees(sampling.resolution));
  if (own) return list.text();
  list.add(sampling.derivative_filter > 0 ? "velocity from differences, filtered over " +
                                                milliseconds(sampling.derivative_filter)
                                          : "velocity from differences, unfiltered");
  return list.text();
}

std::string sensor_note(const Sensor& sensor) {
  List list;
  if (sensor.period) {
    list.add("frames every " + milliseconds(*sensor.period) +
             (sensor.phase > 0 ? " from " + milliseconds(sensor.phase) + " on" : "") +
             ", of which a sample sees the last (the poles are those of a frame for each sample)");
  }
  list.add_if(sensor.rotation != 0, "turned by " + degrees(sensor.rotation));
  list.add_if(sensor.scale != Pair{1, 1},
              "scaled by " + short_number(sensor.scale[0]) + ", " + short_number(sensor.scale[1]));
  list.add_if(sensor.offset != Pair{0, 0},
              "off by " + millimetres(sensor.offset[0]) + ", " + millimetres(sensor.offset[1]));
  list.add_if(sensor.resolution > 0, "resolution " + millimetres(sensor.resolution));
  list.add_if(sensor.noise > 0,
              "noise " + millimetres(sensor.noise) + " (seed " + std::to_string(sensor.seed) + ")");
  list.add_if(sensor.delay > 0, milliseconds(sensor.delay) + " late");
  list.add_if(sensor.dropout > 0, "misses " + short_number(100 * sensor.dropout) + " %");
  const auto fault = [&](const std::optional<SensorFault>& of, const char* what) {
    if (!of) return;
    list.add(what + milliseconds(of->duration) + " from " + short_number(100 * of->probability) +
             " % of them on");
  };
  fault(sensor.stuck, "readings that stay the same for ");
  fault(sensor.burst, "frames that wait for ");
  if (sensor.area) {
    list.add("sees " + short_number((*sensor.area)[0]) + " m by " +
             short_number((*sensor.area)[1]) + " m");
  }
  const std::size_t zones = sensor.dead_zones.size();
  list.add_if(zones > 0, counted(zones, "dead zone"));
  list.add_if(sensor.contact_force > 0,
              "feels " + short_number(sensor.contact_force) + " N or more");
  list.add_if(sensor.on_miss == OnMiss::last, "repeats its last reading if it misses the ball");
  list.add_if(sensor.on_miss == OnMiss::edge, "reads the corner of its area if it misses the ball");
  return list.text().empty() ? "exact" : list.text();
}

// What makes the ball another than a solid one that rolls on a plane.
std::string unusual_ball_note(const Ball& ball) {
  List list;
  if (ball.groove) {
    list.add("in a groove along " + std::string(ball.groove->axis == 0 ? "x" : "y") +
             " it acts as one of radius " + millimetres(ball.radius));
  }
  list.add_if(ball.inertia_factor != 0.4, "inertia factor " + short_number(ball.inertia_factor));
  return list.text().empty() ? "" : "; " + list.text();
}

std::string mounting_note(const Scenario& scene) {
  const Mounting& mounting = scene.gimbal.mounting;
  List list;
  list.add_if(mounting.height != 0,
              "plane " + short_number(mounting.height) + " m above the gimbal's center");
  list.add_if(mounting.phi_offset != 0, "phi off by " + degrees(mounting.phi_offset));
  list.add_if(mounting.theta_offset != 0, "theta off by " + degrees(mounting.theta_offset));
  list.add_if(mounting.skew != 0, "axes askew by " + degrees(mounting.skew));
  list.add_if(mounting.yaw != 0, "plane turned by " + degrees(mounting.yaw));
  list.add_if(mounting.base_tilt != 0, "base tilted by " + degrees(mounting.base_tilt));
  return list.text();
}

std::string events_note(const Scenario& scene) {
  List list;
  const auto add = [&list](const std::string& name, OnEvent action) {
    list.add(name + (action == OnEvent::stop ? " (stops the run)" : " (is noted)"));
  };
  const Events& events = scene.events;
  if (scene.gimbal.loses_steps()) add("steps_lost", events.steps_lost.value_or(OnEvent::note));
  if (events.rest) add("rest", *events.rest);
  if (events.stick) add("stick", *events.stick);
  for (const Monitor& monitor : event_monitors(scene).monitors) add(monitor.name(), monitor.action);
  return list.text();
}

// The optional parts that this scene lacks.
std::string without(const Scenario& scene) {
  List list;
  const Servo* servo = scene.gimbal.servo ? &*scene.gimbal.servo : nullptr;
  const bool torques = scenario::moved_by_torques(scene);
  const Controller* controller = scene.controller ? &*scene.controller : nullptr;
  if (controller != nullptr) {
    list.add_if(!torques && (servo == nullptr || limits_note(scene.gimbal).empty()),
                "limits and losses of servos");
    list.add_if(!controller->sampling, "sampling");
    list.add_if(!controller->sensor, "sensor errors");
  }
  list.add_if(mounting_note(scene).empty(), "mounting errors");
  list.add_if(losses_note(scene.ball.losses).empty(), "losses of the ball");
  list.add_if(!scene.plate.inertia, "the plate's inertia");
  list.add_if(event_monitors(scene).monitors.empty(), "events");
  return list.text();
}

}  // namespace

std::vector<Note> explain(const Scenario& scene, const Model& model) {
  const Shape shape = std::visit(
      [](const auto& system) { return std::decay_t<decltype(system)>::moves; }, model.system);
  const auto& columns = scene.output.columns;
  const bool gamma = std::find(columns.begin(), columns.end(), "gamma") != columns.end();
  const std::size_t stops = model.stops.size();
  std::vector<Note> notes;
  const auto note = [&notes](const char* part, std::string reason) {
    if (!reason.empty()) notes.push_back({part, std::move(reason)});
  };
  note("ball", ball_note(scene, shape) + unusual_ball_note(scene.ball));
  note("gimbal", gimbal_note(scene));
  if (!gamma) {
    note("gamma", "not integrated: no output column asks for it");
  } else if (shape != Shape::full) {
    note("gamma", "not integrated: it stays zero, like the spin");
  } else {
    note("gamma", "a quadrature of the spin, beside the states");
  }
  if (scene.gimbal.servo) note("servo", limits_note(scene.gimbal));
  note("linkage", linkage_note(scene));
  if (scene.ball.push) note("push", "a force on the ball's center, along the plane's axes");
  if (scene.gimbal.motor) note("motors", motor_note(*scene.gimbal.motor));
  note("losses", losses_note(scene.ball.losses));
  if (scene.events.slip && scene.events.slip->sliding) {
    note("sliding", "beyond " + short_number(scene.events.slip->friction) +
                        " of the normal force, against " +
                        short_number(*scene.events.slip->sliding) + " of it");
  }
  if (scene.controller) {
    note("law", law_note(*scene.controller));
    if (scene.controller->sampling)
      note("sampling",
           sampling_note(*scene.controller->sampling, scene.controller->own.has_value()));
    if (scene.controller->sensor) note("sensor", sensor_note(*scene.controller->sensor));
  }
  note("mounting", mounting_note(scene));
  if (scene.plate.inertia && !scenario::moved_by_torques(scene)) {
    note("plate", "its inertia enters the motors' torques and power");
  }
  note("events", events_note(scene));
  note("without", without(scene));
  if (stops > 0) {
    const std::string of = !scene.controller || scene.ball.push     ? "tables"
                           : scene.controller->law == Law::commands ? "the commands"
                                                                    : "the reference path";
    const char* const what = model.jumps.size() != stops ? " knots of "
                             : stops == 1                ? " jump of "
                                                         : " jumps of ";
    note("stops", std::to_string(stops) + what + of + ", none stepped over");
  }
  return notes;
}

}  // namespace bbsim::model
