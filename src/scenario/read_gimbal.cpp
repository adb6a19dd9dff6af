// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `gimbal`: motions, torques, servos, motors, linkages, mounting.
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "base/number_text.hpp"
#include "scenario/calibration.hpp"
#include "scenario/sections.hpp"
#include "scenario/table_rows.hpp"
#include "yaml/quantity.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

void read_motion(yaml::Keys& keys, GimbalMotion& motion) {
  keys.optional("phi", ProfileRule{}, motion.phi,
                {.meaning = "[profiles](#profiles): a prescribed motion", .standard = "0"});
  keys.optional("theta", ProfileRule{}, motion.theta, yaml::same);
}

void read_torque(yaml::Keys& keys, GimbalMotion& torque) {
  keys.optional("phi", ProfileRule{yaml::Dimension::torque}, torque.phi,
                {.meaning = "[profiles](#profiles): torques of the motors", .standard = "0"});
  keys.optional("theta", ProfileRule{yaml::Dimension::torque}, torque.theta, yaml::same);
}

void read_dc(yaml::Keys& keys, DcMotor& dc) {
  const yaml::Number positive{yaml::Dimension::number, {.above = 0}};
  keys.required("resistance", positive, dc.resistance, {"resistance of the armature", "Ω"});
  keys.required("torque_constant", positive, dc.torque_constant,
                {"torque constant of the armature", "N m/A"});
  keys.optional("gear", positive, dc.gear, {"turns of the motor per turn of the axis"});
  keys.optional("voltage_limit", positive, dc.voltage_limit, {"largest voltage", "V"});
}

void read_position_loop(yaml::Keys& keys, PositionLoop& loop) {
  const yaml::Number gain{yaml::Dimension::number, {.at_least = 0}};
  keys.required("kp", yaml::Number{yaml::Dimension::number, {.above = 0}}, loop.kp,
                {"proportional gain", "N m/rad"});
  keys.optional("kd", gain, loop.kd, {"rate gain", "N m s/rad"});
  keys.optional("ki", gain, loop.ki, {"integral gain", "N m/(rad s)"});
}

void read_motor(yaml::Keys& keys, Motor& motor) {
  const yaml::Number at_least_none{yaml::Dimension::number, {.at_least = 0}, "1e-3"};
  keys.optional("rotor_inertia", at_least_none, motor.rotor_inertia,
                {"inertia of each rotor, seen through its gear", "kg m²"});
  keys.optional("viscous", at_least_none, motor.viscous,
                {"friction torque divided by the axis' rate", "N m s"});
  keys.optional("friction", yaml::Number{yaml::Dimension::torque, {.at_least = 0}}, motor.friction,
                {"dry friction; up to this torque it holds an axis at rest"});
  keys.optional("torque_limit", yaml::Number{yaml::Dimension::torque, {.above = 0}},
                motor.torque_limit, {"largest torque"});
  keys.optional("dc", yaml::MappingOf(read_dc), motor.dc);
  keys.optional("position_loop", yaml::MappingOf(read_position_loop), motor.position_loop);
}

void read_start(yaml::Keys& keys, GimbalStart& start) {
  keys.optional("phi", yaml::Number{yaml::Dimension::angle}, start.phi,
                {"angles at t = 0 under a controller or torques, without the mounting's offsets"});
  keys.optional("theta", yaml::Number{yaml::Dimension::angle}, start.theta, yaml::same);
  keys.optional("phi_rate", yaml::Number{yaml::Dimension::angular_rate}, start.phi_rate,
                {"rates at t = 0"});
  keys.optional("theta_rate", yaml::Number{yaml::Dimension::angular_rate}, start.theta_rate,
                yaml::same);
}

// The width of a gap: 0, or enough that rounding does not decide when the servo touches the plane.
struct Backlash {
  static constexpr double least = 1e-6;

  [[nodiscard]] static yaml::Usual width() { return yaml::angle_limit({.at_least = 0}, 0.15); }
  [[nodiscard]] static std::string allowed() { return width().allowed(); }
  [[nodiscard]] static yaml::Declared declared() {
    return yaml::Declared::any(
        {yaml::Declared::number(yaml::Dimension::angle, {.at_least = least}),
         yaml::Declared::number(yaml::Dimension::angle, {.at_least = 0, .at_most = 0})});
  }
  [[nodiscard]] static std::string text_of(double value) { return number_text(value); }
  static bool read(const yaml::Value& value, double& into) {
    if (!width().read(value, into)) return false;
    return into == 0 || into >= least || value.refuse("", "0, or an angle of at least 1e-6 rad");
  }
};

// The keys of commercial servos (docs/reference/scenario.md, "Servos").
yaml::NameOf<Servo> servo_models() {
  constexpr double degree = std::numbers::pi / 180, hertz = 2 * std::numbers::pi;
  const auto servo = [](double frequency, double damping, double stop, double rate,
                        double dead_band, double backlash) {
    return Servo{.natural_frequency = frequency * hertz,
                 .damping = damping,
                 .angle_limit = stop * degree,
                 .rate_limit = rate * degree,
                 .dead_band = dead_band * degree,
                 .backlash = backlash * degree};
  };
  return {{{servo(6, 0.9, 60, 350, 0.4, 0.3), "hobby-standard"},
           {servo(5, 0.8, 60, 500, 1, 0.6), "hobby-micro"},
           {servo(10, 1, 150, 360, 0.1, 0.25), "smart-serial"}}};
}

// A rate as vendors state it: the time for an angle.
struct Speed {
  [[nodiscard]] static std::string allowed() {
    return "a time for an angle, such as \"0.17 s/60deg\"";
  }
  [[nodiscard]] static yaml::Declared declared() { return yaml::Declared::Kind::text; }
  static bool read(const yaml::Value& value, double& rate) {
    if (value.node->kind != yaml::Node::Kind::scalar) return value.refuse("", allowed());
    const std::string_view text = value.node->text;
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) return value.refuse("", allowed());
    const auto part = [](std::string_view of, yaml::Dimension dimension) {
      while (of.ends_with(' ')) of.remove_suffix(1);
      while (of.starts_with(' ')) of.remove_prefix(1);
      // Reading it as quoted requires a unit.
      return yaml::read_quantity(of, true, dimension).value.value_or(0);
    };
    const double time = part(text.substr(0, slash), yaml::Dimension::time);
    const double angle = part(text.substr(slash + 1), yaml::Dimension::angle);
    if (!(time > 0 && angle > 0)) return value.refuse("", allowed());
    rate = angle / time;
    return true;
  }
};

// An angle, or the width of a pulse, which turns the servo by `scale` (rad) per microsecond.
struct DeadBand {
  double scale;

  [[nodiscard]] static yaml::Usual angle() { return yaml::angle_limit({.at_least = 0}, 0.15); }
  [[nodiscard]] static std::string allowed() {
    return angle().allowed() + ", or a pulse's width such as \"4 us\"";
  }
  [[nodiscard]] static yaml::Declared declared() {
    return yaml::Declared::any(
        {angle().declared(), yaml::Declared::number(yaml::Dimension::time, {.at_least = 0})});
  }
  [[nodiscard]] static std::string text_of(double value) { return number_text(value); }
  bool read(const yaml::Value& value, double& into) const {
    if (value.node->kind == yaml::Node::Kind::scalar) {
      const auto width = yaml::read_quantity(value.node->text, true, yaml::Dimension::time).value;
      if (width && *width >= 0) {
        into = *width * 1e6 * scale;
        return true;
      }
    }
    return angle().read(value, into);
  }
};

// Common motors (docs/reference/scenario.md, "Stepper motors"): half of their holding torque (N m),
// and the inertia of their rotors (kg m^2).
struct MotorModel {
  double torque = 0, inertia = 0;
};

void read_stepper(yaml::Keys& keys, StepperMotor& stepper) {
  const yaml::NameOf<MotorModel> models{
      {{{0.09, 1.4e-6}, "nema14"}, {{0.175, 5.4e-6}, "nema17"}, {{0.63, 3e-5}, "nema23"}}};
  if (const auto given = keys.find(
          "model", models,
          {"values for `steps`, `torque` and `inertia`; a key that is given replaces its value"})) {
    MotorModel model;
    if (models.read(*given, model)) {
      stepper.steps = 200;
      stepper.torque = model.torque;
      stepper.inertia = model.inertia;
    }
  }
  const yaml::Whole count{1, "200"};
  keys.optional("steps", count, stepper.steps,
                {.meaning = "full steps in a turn of a [stepper motor](#stepper-motors), and "
                            "microsteps in a step; instead of the keys above",
                 .standard = "200, 16"});
  keys.optional("microsteps", count, stepper.microsteps, yaml::same);
  const yaml::Number ratio{yaml::Dimension::number, {.at_least = 0.001, .at_most = 1000}};
  keys.optional("gear", ratio, stepper.gear,
                {"turns of the motor in a turn of its shaft behind the gear"});
  keys.optional("torque", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.4"},
                stepper.torque,
                {.meaning = "greatest torque of the motor, beyond which it [loses "
                            "steps](#stepper-motors); with `inertia`; a plain number",
                 .unit = "N m",
                 .standard = "never loses any"});
  keys.optional("inertia", yaml::Number{yaml::Dimension::number, {.above = 0}, "1e-5"},
                stepper.inertia,
                {.meaning = "moment of inertia that the motor turns: its rotor's, and the plate's "
                            "share divided by gear²; a plain number",
                 .unit = "kg m²",
                 .standard = "required with `torque`"});
  const yaml::Number speed{yaml::Dimension::angular_rate, {.above = 0}};
  keys.optional("corner_speed", speed, stepper.corner_speed,
                {"speed of the motor beyond which its torque falls as 1/speed"});
  constexpr double one_hertz = 2 * std::numbers::pi, any = std::numeric_limits<double>::max();
  const yaml::Number frequency{yaml::Dimension::angular_rate, {.at_least = 1}};
  keys.optional(
      "natural_frequency", yaml::Usual{frequency, "Hz", any, one_hertz}, stepper.natural_frequency,
      {.meaning = "of the [swings](#stepper-motors) of the shaft about the driver's angle",
       .standard = "no swings"});
  keys.optional("damping", yaml::Number{yaml::Dimension::number, {.at_least = 0}}, stepper.damping,
                {"damping ratio of these swings"});
  keys.needs("damping", "natural_frequency");
}

// Reads the keys into `servo`, over its existing values. Does not report missing keys.
void read_servo_keys(yaml::Keys& keys, Servo& servo) {
  const yaml::NameOf<Servo> models = servo_models();
  if (const auto given = keys.find(
          "model", models, {"values for all keys below; a key that is given replaces its value"})) {
    models.read(*given, servo);
  }
  const yaml::Number time{yaml::Dimension::time, {.above = 0}};
  const yaml::Number frequency{yaml::Dimension::angular_rate, {.above = 0}};
  const yaml::Number damping{yaml::Dimension::number, {.at_least = 0}};
  keys.exclusive({{"time_constant"}, {"natural_frequency", "damping"}, {"stepper"}});
  keys.optional("stepper", yaml::MappingOf(read_stepper), servo.stepper);
  keys.optional("time_constant", time, servo.time_constant,
                {"T of a first-order servo, instead of the two keys above"});
  if (keys.find("time_constant")) {
    servo.natural_frequency = servo.damping = 0;
    for (const char* key : {"natural_frequency", "damping"}) {
      if (const auto given = keys.find(key)) {
        given->report(
            "given together with time_constant, of a servo of first order; allowed: "
            "natural_frequency and damping, or time_constant");
      }
    }
  } else {
    // An axis's own natural_frequency overrides a common time_constant.
    if (keys.find("natural_frequency")) servo.time_constant.reset();
    constexpr double one_hertz = 2 * std::numbers::pi, any = std::numeric_limits<double>::max();
    keys.optional("natural_frequency", yaml::Usual{frequency, "Hz", any, one_hertz},
                  servo.natural_frequency,
                  {.meaning = "$\\omega_n$ of a second-order servo",
                   .standard = "required without `time_constant`, `stepper` and `model`"});
    keys.optional("damping", damping, servo.damping,
                  {.meaning = "$\\zeta$ of a second-order servo",
                   .standard = "required without `time_constant`, `stepper` and `model`"});
  }
  keys.optional("angle_limit", yaml::angle_limit({.above = 0}), servo.angle_limit,
                {"hard stops at ± this angle"});
  const yaml::Number rate{yaml::Dimension::angular_rate, {.above = 0}};
  keys.optional("rate_limit", yaml::Usual{rate, "deg/s", 60}, servo.rate_limit, {"largest rate"});
  keys.optional("acceleration_limit", yaml::Number{yaml::Dimension::number, {.above = 0}, "200"},
                servo.acceleration_limit, {"largest acceleration; a plain number", "rad/s²"});
  keys.exclusive({{"speed"}, {"rate_limit"}});
  keys.optional("speed", Speed{}, servo.rate_limit,
                {"the same, as data sheets give it: `\"0.17 s/60deg\"`"});
  if (keys.find("speed") && keys.find("rate_limit")) {
    keys.find("speed")->report("given together with rate_limit; allowed: one of the two");
  }
  // As in Arduino's Servo.h: 180 degrees from 544 to 2400 us.
  double scale = std::numbers::pi / 1856;
  const yaml::Number angle{yaml::Dimension::angle, {.above = 0}, "\"0.1 deg\""};
  if (const auto given =
          keys.find("scale", angle,
                    {.meaning = "angle per microsecond of the pulse, for such a `dead_band`",
                     .standard = "180°/1856"}))
    angle.read(*given, scale);
  keys.optional(
      "dead_band", DeadBand{scale}, servo.dead_band,
      {"smaller changes of the command have no effect; also as a width of the pulse: `\"4 us\"`"});
  keys.optional(
      "backlash", Backlash{}, servo.backlash,
      {.meaning = "full width of the gap between servo and plate", .range = "0, or ≥ 1e-6"});
}

struct BothServos {
  Servo phi;
  std::optional<Servo> theta{};
};

// Reads keys for both axes, and keys for each axis, which override the common ones.
void read_servo(yaml::Keys& keys, BothServos& both) {
  const auto require = [](yaml::Keys& at, std::string_view key, auto given) {
    const auto allowed = key == "natural_frequency"
                             ? yaml::Number{yaml::Dimension::angular_rate, {.above = 0}}.allowed()
                             : yaml::Number{yaml::Dimension::number, {.at_least = 0}}.allowed();
    if (!at.find("time_constant") && !at.find("stepper") && !at.find("model") && !given(key)) {
      at.missing(key, allowed);
    }
  };
  keys.needs_one({{"model"},
                  {"time_constant"},
                  {"stepper"},
                  {"natural_frequency", "damping"},
                  {"phi", "theta"}});
  Servo common;
  read_servo_keys(keys, common);
  const yaml::MappingOf axis(read_servo_keys);
  const auto phi = keys.find("phi", axis, {"any of the keys above, for one axis"});
  const auto theta = keys.find("theta", axis, yaml::same);
  const auto in_common = [&](std::string_view key) { return keys.find(key).has_value(); };
  if (!phi || !theta) {
    for (const char* key : {"natural_frequency", "damping"}) require(keys, key, in_common);
  }
  both.phi = common;
  if (phi || theta) both.theta = common;
  const auto read_axis = [&](const std::optional<yaml::Value>& entry, Servo& servo) {
    if (!entry) return;
    if (entry->node->kind != yaml::Node::Kind::mapping) {
      entry->refuse("", axis.allowed());
      return;
    }
    yaml::Keys own(*entry);
    read_servo_keys(own, servo);
    const bool is_first_order_or_stepper = servo.time_constant || servo.stepper;
    for (const char* key : {"natural_frequency", "damping"}) {
      if (!is_first_order_or_stepper) {
        require(own, key, [&](std::string_view of) {
          return own.find(of) || in_common(of) || in_common("model");
        });
      }
    }
    own.finish();
  };
  read_axis(phi, both.phi);
  if (both.theta) read_axis(theta, *both.theta);
}

// Reads the (servo angle, plane angle) rows of a curve.
void read_curve(yaml::Keys& keys, CurveLinkage& curve) {
  keys.about({"file"}, {"a measured curve instead of rods: a CSV or HDF5 file"});
  keys.about({"servo", "plate"}, {"its columns: the servo's angle and the plate's", "rad"});
  keys.about({"unit"}, {.meaning = "unit of both columns", .standard = "rad"});
  FileColumns read;
  if (!read_columns(keys, {"servo", "plate"}, yaml::Dimension::angle, read)) return;
  curve = {std::move(read.file), std::move(read.columns[0]), std::move(read.columns[1])};
  const double largest = std::max(largest_size(curve.servo), largest_size(curve.plate));
  if (const auto doubt = doubt_of(largest, yaml::Dimension::angle); doubt && !read.has_unit) {
    warn_of_unit(keys.mapping(), curve.file, "an angle is " + number_text(largest),
                 yaml::Dimension::angle, *doubt, "unit");
  }
  const std::size_t given = curve.servo.size();
  const Calibration calibration = calibrate(curve);
  constexpr std::size_t fewest = 4;  // a C2 interpolant needs four without extra end conditions
  if (curve.servo.size() < fewest) {
    const std::string left = curve.servo.size() < given
                                 ? ", of which " + std::to_string(curve.servo.size()) +
                                       " are left (" + calibration.done + ")"
                                 : "";
    keys.mapping().report(yaml::shown(curve.file) + ": found " + std::to_string(given) + " rows" +
                          left + "; allowed: at least 4");
    curve = {};
    return;
  }
  if (calibration.done.empty()) return;
  const std::string text = yaml::shown(curve.file) + ": " + calibration.done;
  calibration.changes ? keys.mapping().warn(text) : keys.mapping().mention(text);
}

void read_rods(yaml::Keys& keys, RodLinkage& rods) {
  const yaml::Number length{yaml::Dimension::length, {.above = 0}};
  keys.required("horn", length, rods.horn,
                {"length of the bar on the servo, and of the bar on the plate"});
  keys.required("arm", length, rods.arm, yaml::same);
  keys.optional("rod", length, rods.rod,
                {.meaning = "length of the push rod; the default is the length that fits at home. "
                            "With another length, the plate is tilted when the servo is at zero",
                 .standard = "closes at home"});
  keys.required("offset", yaml::PairOf{yaml::Dimension::length}, rods.offset,
                {"$[d_x, d_z]$, the gimbal's axis from the servo's; both bars lie along +x at "
                 "home. The rod is upright there if $d_x$ is horn − arm"});
}

void read_curve_or_rods(yaml::Keys& keys, std::optional<AxisLinkage>& linkage) {
  const yaml::MappingOf table(read_curve);
  if (const auto given = keys.find("table", table)) {
    CurveLinkage curve;
    table.read(*given, curve);
    if (!curve.servo.empty()) linkage = std::move(curve);
    return;
  }
  RodLinkage rods;
  read_rods(keys, rods);
  linkage = rods;
}

void read_axis_linkage(yaml::Keys& keys, std::optional<AxisLinkage>& linkage) {
  keys.exclusive({{"table"}, {"horn", "arm", "rod", "offset"}}, true);
  read_curve_or_rods(keys, linkage);
}

using BothLinkages = std::array<std::optional<AxisLinkage>, 2>;

void read_linkage(yaml::Keys& keys, BothLinkages& both) {
  keys.exclusive({{"phi", "theta"}, {"table"}, {"horn", "arm", "rod", "offset"}}, true);
  const yaml::MappingOf axis(read_axis_linkage);
  const auto phi =
      keys.find("phi", axis, {"rods or a curve for one axis; an axis that you leave out is ideal"});
  const auto theta = keys.find("theta", axis, yaml::same);
  if (!phi && !theta) {
    read_curve_or_rods(keys, both[0]);
    both[1] = both[0];
    return;
  }
  if (phi) axis.read(*phi, both[0]);
  if (theta) axis.read(*theta, both[1]);
}

const yaml::Number leg_length{yaml::Dimension::length, {.above = 0}};

struct LegLength {
  const char* key;
  double LegLengths::*length;
  const char* meaning;
};
constexpr LegLength leg_lengths[] = {
    {"radius_base", &LegLengths::radius_base, "radius of the servos' axes"},
    {"radius_plate", &LegLengths::radius_plate, "radius of the joints under the plate"},
    {"horn", &LegLengths::horn, "lengths of horn and rod"},
    {"rod", &LegLengths::rod, "lengths of horn and rod"},
    {"height", &LegLengths::height,
     "height of the joints above the servos' axes where the plate is level"}};

// Reads lengths of all legs or of one leg.
void read_leg_lengths(yaml::Keys& keys, LegLengths& leg) {
  for (const auto& [key, length, meaning] : leg_lengths) {
    const yaml::About about{meaning, {}, "required, or in each leg"};
    if (const auto given = keys.find(key, leg_length, about)) leg_length.read(*given, leg.*length);
  }
}

// Reads the keys of a leg over the common values.
void read_leg(yaml::Keys& keys, ServoLeg& leg) {
  const yaml::Number azimuth{yaml::Dimension::angle};
  if (const auto given =
          keys.find("angle", azimuth,
                    {.meaning = "azimuth of the leg's plane, from the plate's x axis towards y",
                     .standard = "0, 2π/3, 4π/3"}))
    azimuth.read(*given, leg.angle);
  if (const auto given = keys.find("radius", leg_length, {"both radii of the leg"})) {
    leg_length.read(*given, leg.radius_base);
    leg.radius_plate = leg.radius_base;
  }
  keys.exclusive({{"radius"}, {"radius_base", "radius_plate"}});
  for (const char* key : {"radius_base", "radius_plate"}) {
    const auto given = keys.find("radius") ? keys.find(key) : std::nullopt;
    if (given) {
      given->report(
          "found beside radius, which is both radii; allowed: radius, or radius_base and "
          "radius_plate");
    }
  }
  keys.about({"radius_base", "radius_plate", "horn", "rod", "height"},
             {.meaning = "as above, of the leg", .standard = "as for all legs"});
  read_leg_lengths(keys, leg);
  keys.optional("joint_height", yaml::Number{yaml::Dimension::length}, leg.joint_height,
                {"height of the joint in the plate, from any level that all three share"});
  keys.optional("offset", yaml::Number{yaml::Dimension::angle}, leg.offset,
                {"angle of the horn from home where the servo is at zero"});
  keys.optional("direction", yaml::Sign{}, leg.direction,
                {.meaning = "-1: the horn falls as the servo's angle grows", .range = "1, -1"});
  const yaml::MappingOf servo(read_servo_keys);
  if (const auto given =
          keys.find("servo", servo,
                    {"[servo](#servos) of the leg: its keys replace those of `gimbal.servo`"})) {
    if (!leg.servo) leg.servo.emplace();
    servo.read(*given, *leg.servo);
  } else {
    leg.servo.reset();
  }
}

}  // namespace

void read_three_servos(yaml::Keys& keys, ThreeServos& of) {
  ThreeServoPlate& plate = of.plate;
  keys.needs_one({{"legs"}, {"radius_base", "radius_plate", "horn", "rod", "height"}});
  read_leg_lengths(keys, plate);
  const yaml::ArrayOf<3, yaml::MappingOf<ServoLeg>> each_leg{
      yaml::MappingOf(read_leg),
      "a list of three mappings, such as {angle: \"120 deg\", radius: \"9 cm\"}"};
  const auto given =
      keys.find("legs", each_leg, {"a list of three mappings, for legs that differ"});
  std::array<ServoLeg, 3> legs;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    legs[i] = plate.leg(i);
    legs[i].servo = of.servo;
  }
  if (given && each_leg.read(*given, legs)) plate.legs = legs;
  for (const LegLength& known : leg_lengths) {
    const auto lacks = [&](const ServoLeg& leg) { return !(leg.*known.length > 0); };
    if (!keys.find(known.key) && std::ranges::any_of(legs, lacks)) {
      keys.missing(known.key, leg_length.allowed());
    }
  }
}

namespace {

void read_mounting(yaml::Keys& keys, Mounting& mounting) {
  keys.optional("height", yaml::Number{yaml::Dimension::length}, mounting.height,
                {"height of the contact plane above the gimbal's center; negative below"});
  keys.optional("phi_offset", yaml::Number{yaml::Dimension::angle}, mounting.phi_offset,
                {"angle of the plate where the servo, or the prescribed motion, is at zero"});
  keys.optional("theta_offset", yaml::Number{yaml::Dimension::angle}, mounting.theta_offset,
                yaml::same);
  // At 90 degrees the two axes would coincide.
  keys.optional(
      "skew", yaml::Number{yaml::Dimension::angle, {.at_least = -1.4, .at_most = 1.4}},
      mounting.skew,
      {"deviation of the angle between theta's and phi's axes from 90 degrees, about the normal"});
  keys.optional("yaw", yaml::Number{yaml::Dimension::angle}, mounting.yaw,
                {"angle of the plate's x axis from theta's unskewed axis, about the normal"});
  keys.optional("base_tilt", yaml::Number{yaml::Dimension::angle}, mounting.base_tilt,
                {"tilt of the whole gimbal about the base's x axis"});
}

}  // namespace

yaml::Declared declared_servo(const Servo& servo) {
  return yaml::MappingOf(read_servo_keys).declared(servo);
}

void read_gimbal(yaml::Keys& keys, Gimbal& gimbal) {
  keys.optional("motion", yaml::MappingOf(read_motion), gimbal.motion);
  keys.optional("torque", yaml::MappingOf(read_torque), gimbal.torque);
  keys.optional("start", yaml::MappingOf(read_start), gimbal.start);
  std::optional<BothServos> servos;
  keys.optional("servo", yaml::MappingOf(read_servo), servos,
                {.meaning = "[servos](#servos): required under `drives: legs`, and under `drives: "
                            "angle` without `gimbal.motor`, otherwise refused",
                 .standard = "-"});
  if (servos) {
    gimbal.servo = servos->phi;
    gimbal.theta_servo = servos->theta;
  }
  keys.optional("linkage", yaml::MappingOf(read_linkage), gimbal.linkage,
                {"[linkages](#linkages) between servos and plate"});
  const yaml::MappingOf three_servos(read_three_servos);
  if (const auto given = keys.find("three_servos", three_servos,
                                   {"[three servos](#three-servos) under the plate"})) {
    ThreeServos read{{}, gimbal.servo};
    three_servos.read(*given, read);
    gimbal.three_servos = read.plate;
  }
  keys.optional("ring_inertia", yaml::Number{yaml::Dimension::number, {.at_least = 0}, "1e-3"},
                gimbal.ring_inertia,
                {.meaning = "inertia, about phi's axis, of the parts that turn with phi alone; "
                            "only where torques move the gimbal",
                 .unit = "kg m²"});
  keys.optional("motor", yaml::MappingOf(read_motor), gimbal.motor,
                {"[torques and motors](#torques-and-motors)"});
  keys.section("mounting", read_mounting, gimbal.mounting,
               {.meaning = "[mounting](#mounting) errors"});
}

}  // namespace bbsim::scenario
