// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sketch/wiring.hpp"

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/real.hpp"
#include "file/descriptor.hpp"
#include "sketch/wiring_rules.hpp"
#include "yaml/document.hpp"
#include "yaml/text_file.hpp"

namespace bbsim::sketch {
namespace {

using yaml::Dimension;
using yaml::Keys;
using yaml::MappingOf;
using yaml::Number;

constexpr double degree = 3.14159265358979323846 / 180;

using Read = Wiring::Content;

// Reports those of the keys that are given.
void refuse_any(Keys& keys, std::initializer_list<const char*> names, std::string_view why) {
  for (const char* name : names) {
    if (const auto given = keys.find(name)) given->report(why);
  }
}

// Servo.h's pulse for 90 degrees, in s, and its angle per duration of the pulse, in rad/s.
constexpr bbsim_wired_servo usual_servo{-1, -1, 1472e-6, 180 * degree / 1856e-6};

constexpr bbsim_wired_stepper no_stepper{-1, -1, -1, -1, 1, no_number, 0, 0};

bbsim_wiring by_default() {
  bbsim_wiring c{};
  c.version = BBSIM_WIRING_VERSION;
  std::ranges::fill(c.servos, usual_servo);
  std::ranges::fill(c.steppers, no_stepper);
  c.oscillator = 25e6;
  c.screen = {bbsim_no_screen, {-1, -1, -1, -1, -1}, {}, {}, 0, {300, 300}, 300, 0.01};
  c.camera.port = -1;
  std::ranges::fill(c.distances, bbsim_wired_distance{-1, -1, 0, 0, 0, 0.02, 4});
  c.costs = {2e-6, 4e-6, 112e-6, 5e-6, 5e-6, 20e-6, 5e-6, 3.3e-3, 1e-6};
  return c;
}

void read_servo(Keys& keys, bbsim_wired_servo& servo) {
  if (keys.exactly_one({"pin", "channel"})) {
    keys.optional("pin", Pin{}, servo.pin);
    keys.optional("channel", Whole{0, 15}, servo.channel);
  }
  keys.optional("level", Number{Dimension::time, {.above = 0}, "\"1500 us\""}, servo.level);
  double per_microsecond = servo.scale * 1e-6;
  if (keys.optional("scale", Number{Dimension::angle, {.above = 0}, "\"0.1 deg\""},
                    per_microsecond)) {
    servo.scale = per_microsecond * 1e6;
  }
  int direction = 1;
  keys.optional("direction", yaml::Sign{}, direction);
  servo.scale *= direction;
}

struct LegServo {
  [[nodiscard]] static std::string allowed() { return MappingOf(read_servo).allowed(); }
  [[nodiscard]] static yaml::Declared declared() { return MappingOf(read_servo).declared(); }
  static bool read(const yaml::Value& value, bbsim_wired_servo& servo) {
    servo = usual_servo;
    return MappingOf(read_servo).read(value, servo);
  }
};

void read_servos(Keys& keys, Read& read) {
  keys.exclusive({{"phi", "theta"}, {"legs"}});
  keys.optional("phi", MappingOf(read_servo), read.c.servos[0]);
  keys.optional("theta", MappingOf(read_servo), read.c.servos[1]);
  std::vector<bbsim_wired_servo> legs;
  if (keys.optional("legs", yaml::ListOf<LegServo, bbsim_wired_servo>{{}, 3, 3, "servos"}, legs) &&
      !legs.empty()) {
    std::ranges::copy(legs, read.c.servos);
    refuse_any(keys, {"phi", "theta"},
               "found beside legs; allowed: phi and theta, or the servos of three legs");
  }
  if (!keys.find("phi") && !keys.find("theta") && !keys.find("legs"))
    keys.missing("phi", MappingOf(read_servo).allowed());
  keys.optional("ignored", yaml::ListOf<Pin, int>{{}, 1, 70, "pins"}, read.ignored);
  std::vector<int> channels;
  keys.optional("ignored_channels", yaml::ListOf<Whole, int>{Whole{0, 15}, 1, 16, "channels"},
                channels);
  for (const int channel : channels) read.c.ignored_channels |= 1U << channel;
  keys.optional("oscillator", Number{Dimension::number, {.above = 0}, "25e6"}, read.c.oscillator);
}

void read_home(Keys& keys, bbsim_wired_stepper& stepper) {
  keys.required("pin", Pin{}, stepper.home);
  keys.required("angle", Number{Dimension::angle, {}, "\"-30 deg\""}, stepper.home_angle);
  int level = 0;
  keys.optional("closed", Whole{0, 1}, level);
  stepper.home_level = static_cast<std::uint32_t>(level);
}

void read_stepper(Keys& keys, bbsim_wired_stepper& stepper) {
  keys.required("step", Pin{}, stepper.step);
  keys.required("dir", Pin{}, stepper.dir);
  keys.optional("enable", Pin{}, stepper.enable);
  int direction = 1;
  keys.optional("direction", yaml::Sign{}, direction);
  stepper.angle = direction;  // times the microstep's, which the scenario gives
  keys.optional("start", Number{Dimension::angle, {}, "\"-30 deg\""}, stepper.start);
  keys.optional("home", MappingOf(read_home), stepper);
  const auto home = keys.find("home");
  if (home && !keys.find("start")) {
    home->report(
        "found without start; allowed: beside start, the angle at which the board is switched on");
  } else if (home && stepper.start == stepper.home_angle) {
    home->report("found at start; allowed: a switch at another angle");
  }
}

void read_steppers(Keys& keys, Read& read) {
  constexpr const char* axes[] = {"phi", "theta"};
  constexpr const char* legs[] = {"1", "2", "3"};
  keys.exclusive({{axes[0], axes[1]}, {legs[0], legs[1], legs[2]}});
  bool found_legs = false;
  for (int i = 0; i < 2; ++i) {
    keys.optional(axes[i], MappingOf(read_stepper), read.c.steppers[i]);
  }
  for (int i = 0; i < 3; ++i) {
    found_legs = found_legs || keys.find(legs[i]);
    keys.optional(legs[i], MappingOf(read_stepper), read.c.steppers[i]);
  }
  if (found_legs) {
    refuse_any(keys, {axes[0], axes[1]},
               "found beside legs; allowed: phi and theta, or 1, 2 and 3 of three legs");
    for (const char* leg : legs) {
      if (!keys.find(leg)) keys.missing(leg, MappingOf(read_stepper).allowed());
    }
  } else if (!keys.find("phi") && !keys.find("theta")) {
    keys.missing("phi", MappingOf(read_stepper).allowed());
  }
  keys.optional("ignored", yaml::ListOf<Pin, int>{{}, 1, 70, "pins"}, read.ignored);
}

// Reads the screen's pins by the names of its electrodes, the first `needed` of which must be
// given. Returns whether the key is given.
template <std::size_t count>
bool read_pins(Keys& keys, const char* key, const std::string_view (&names)[count],
               bbsim_screen_kind kind, bbsim_wired_screen& screen, std::size_t needed = count) {
  const auto value = keys.find(key);
  if (!value) return false;
  screen.kind = kind;
  if (value->node->kind != yaml::Node::Kind::mapping) {
    value->refuse("", "a mapping with " + bbsim::joined(names));
    return true;
  }
  Keys pins(*value);
  for (std::size_t i = 0; i < count; ++i) {
    if (i < needed)
      pins.required(names[i], Pin{}, screen.pins[i]);
    else
      pins.optional(names[i], Pin{}, screen.pins[i]);
  }
  pins.finish();
  return true;
}

void read_screen(Keys& keys, bbsim_wired_screen& screen) {
  keys.exactly_one({"four_wire", "five_wire", "voltages", "chip"});
  read_pins(keys, "four_wire", {"x_plus", "x_minus", "y_plus", "y_minus"}, bbsim_four_wires,
            screen);
  read_pins(keys, "five_wire", {"upper_left", "upper_right", "lower_left", "lower_right", "sense"},
            bbsim_five_wires, screen);
  // A beam's has no y.
  const bool beam =
      read_pins(keys, "voltages", {"x", "y"}, bbsim_voltages, screen, 1) && screen.pins[1] < 0;
  if (const auto chip = keys.find("chip")) {
    bbsim_screen_kind kind = bbsim_stmpe610;
    yaml::NameOf<bbsim_screen_kind>{{{bbsim_stmpe610, "stmpe610"}}}.read(*chip, kind);
    screen.kind = kind;
  }
  keys.required("x", CountMap{}, screen.x);
  if (!beam || keys.find("y")) keys.required("y", CountMap{}, screen.y);
  keys.optional("untouched", Number{Dimension::number, {.at_least = 0, .at_most = 65535}, "0"},
                screen.untouched);
  const Number ohms{Dimension::number, {.above = 0}, "300"};
  keys.optional("x_resistance", ohms, screen.resistance[0]);
  keys.optional("y_resistance", ohms, screen.resistance[1]);
  keys.optional("contact_resistance", ohms, screen.contact);
  keys.optional("interval", Number{Dimension::time, {.above = 0}, "\"10 ms\""}, screen.interval);
}

void read_camera(Keys& keys, Read& read) {
  bbsim_wired_camera& camera = read.c.camera;
  camera.port = 0;
  enum Port { serial, serial1, serial2, serial3, serial_usb } port = serial;
  keys.optional("port",
                yaml::NameOf<Port>{{{serial, "Serial"},
                                    {serial1, "Serial1"},
                                    {serial2, "Serial2"},
                                    {serial3, "Serial3"},
                                    {serial_usb, "SerialUSB"}}},
                port);
  camera.port = port;
  camera.period = 1;
  keys.required("period", Number{Dimension::time, {.above = 0}, "\"33 ms\""}, camera.period);
  keys.optional("delay", Number{Dimension::time, {.at_least = 0}, "\"20 ms\""}, camera.delay);
  keys.required("x", CountMap{}, camera.x);
  keys.required("y", CountMap{}, camera.y);
  int decimals = 0;
  keys.optional("decimals", Whole{0, 9}, decimals);
  camera.decimals = static_cast<std::uint32_t>(decimals);
  const yaml::Text text{"a text such as \"{x},{y}\\n\"", true};
  if (keys.required("frame", text, read.frame) && read.frame.find("{x}") == std::string::npos &&
      read.frame.find("{y}") == std::string::npos && keys.find("frame")) {
    keys.find("frame")->refuse(", without a number", "a text with {x} and {y}");
  }
  keys.optional("lost", text, read.lost);
}

void read_distance(Keys& keys, bbsim_wired_distance& sensor) {
  const Number length{Dimension::length, {.at_least = 0}, "\"2 cm\""};
  keys.exclusive({{"trigger", "echo"}, {"chip"}});
  if (const auto given = keys.find("chip")) {
    enum class Chip { vl53l0x } chip{};
    yaml::NameOf<Chip>{{{Chip::vl53l0x, "vl53l0x"}}}.read(*given, chip);
    sensor.chip = 1;
    sensor.range = 2;
    refuse_any(keys, {"trigger", "echo"},
               "found beside chip; allowed: trigger and echo of an ultrasonic sensor, or chip");
  } else {
    keys.required("trigger", Pin{}, sensor.trigger);
    keys.required("echo", Pin{}, sensor.echo);
  }
  keys.required("offset", Number{Dimension::length, {}, "\"20 cm\""}, sensor.offset);
  keys.optional("noise", length, sensor.noise);
  keys.optional("blind", length, sensor.blind);
  keys.optional("range", Number{Dimension::length, {.above = 0}, "\"4 m\""}, sensor.range);
}

void read_distances(Keys& keys, bbsim_wiring& wiring) {
  keys.optional("x", MappingOf(read_distance), wiring.distances[0]);
  keys.optional("y", MappingOf(read_distance), wiring.distances[1]);
  if (wiring.distances[0].chip != 0 && wiring.distances[1].chip != 0) {
    keys.find("y")->report("found a second chip; allowed: one, since both answer at one address");
  }
}

void read_eeprom(Keys& keys, Read& read) {
  keys.optional("size", Whole{1, 65536}, read.eeprom_size);
  keys.optional("file", yaml::Text{"the name of a file"}, read.eeprom_file);
}

void read_costs(Keys& keys, bbsim_call_costs& costs) {
  const Number time{Dimension::time, {.at_least = 0, .at_most = 1}, "\"100 us\""};
  // Above 0, so that time passes for a sketch that only asks for the time.
  const Number some{Dimension::time, {.at_least = 1e-7, .at_most = 1}, "\"2 us\""};
  keys.optional("clock", some, costs.clock);
  keys.optional("digital", time, costs.digital);
  keys.optional("analog", time, costs.analog);
  keys.optional("servo", time, costs.servo);
  keys.optional("serial", time, costs.serial);
  keys.optional("wire", time, costs.wire);
  keys.optional("spi", time, costs.spi);
  keys.optional("eeprom_write", time, costs.eeprom_write);
  keys.optional("loop", some, costs.loop);
}

void read_wiring(Keys& keys, Read& read) {
  read.c = by_default();
  keys.exclusive({{"servos"}, {"steppers"}});
  if (const auto steppers = keys.find("steppers")) {
    keys.optional("steppers", MappingOf(read_steppers), read);
    if (keys.find("servos")) {
      steppers->report("found beside servos; allowed: one of the two");
    }
  } else {
    keys.section("servos", read_servos, read);
  }
  keys.optional("screen", MappingOf(read_screen), read.c.screen);
  keys.optional("camera", MappingOf(read_camera), read);
  keys.optional("distances", MappingOf(read_distances), read.c);
  keys.optional("inputs", Inputs{}, read.inputs);
  keys.optional("eeprom", MappingOf(read_eeprom), read);
  enum Setup { during, before } setup = before;
  keys.optional("setup", yaml::NameOf<Setup>{{{before, "before"}, {during, "during"}}}, setup);
  read.c.setup_before = setup;
  keys.optional("print",
                yaml::NameOf<Wiring::Print>{{{Wiring::Print::first, "first"},
                                             {Wiring::Print::all, "all"},
                                             {Wiring::Print::all, "stderr"},
                                             {Wiring::Print::off, "off"}}},
                read.print);
  keys.optional("costs", MappingOf(read_costs), read.c.costs);
}

// The parts' pins, each with its place.
struct UsedPin {
  int pin;
  yaml::Value at;
};
void find_pins(const yaml::Value& value, std::vector<UsedPin>& pins) {
  constexpr std::string_view names[] = {"pin",        "step",        "dir",        "enable",
                                        "trigger",    "echo",        "x_plus",     "x_minus",
                                        "y_plus",     "y_minus",     "upper_left", "upper_right",
                                        "lower_left", "lower_right", "sense"};
  for (std::size_t i = 0; i < value.node->items.size(); ++i) {
    const yaml::Value item = value.item(i);
    if (value.name() == "ignored") pins.push_back({pin_of(item.node->text), item});
    find_pins(item, pins);
  }
  for (const yaml::Entry& entry : value.node->entries) {
    const yaml::Value part{entry.value, value.path_of(entry.key), entry.position, value.context};
    const bool is_pin =
        std::ranges::find(names, entry.key) != std::end(names) || value.name() == "voltages";
    if (is_pin) pins.push_back({pin_of(part.node->text), part});
    if (value.name() == "inputs") pins.push_back({pin_of(entry.key), part});
    find_pins(part, pins);
  }
}

// Reports a pin with two roles. Drivers of steppers may share the pin that enables them.
void check_pins(const yaml::Value& wiring) {
  std::vector<UsedPin> pins;
  find_pins(wiring, pins);
  for (std::size_t i = 0; i < pins.size(); ++i) {
    for (std::size_t j = 0; j < i && pins[i].pin >= 0; ++j) {
      if (pins[j].pin != pins[i].pin) continue;
      if (pins[i].at.name() == "enable" && pins[j].at.name() == "enable") continue;
      pins[i].at.report("found pin " + pin_name(pins[i].pin) + ", which " + pins[j].at.path +
                        " uses; allowed: a pin that nothing else uses");
      break;
    }
  }
}

}  // namespace

std::string pin_name(int pin) {
  constexpr int first_analog = 54;
  return pin < first_analog ? std::to_string(pin) : "A" + std::to_string(pin - first_analog);
}

Wiring::Wiring(const std::string& file) : files_{file} {
  const std::string text = yaml::read_text(file);
  yaml::Problems problems(yaml::name_in_messages(file), yaml::without_byte_order_mark(text), {});
  yaml::Nodes nodes;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  try {
    const yaml::Node* const root = yaml::parse_yaml(yaml::check_text(text, 0), 0, nodes);
    if (root == nullptr) {
      throw yaml::TextFault({},
                            "found an empty file; allowed: " + MappingOf(read_wiring).allowed());
    }
    yaml::Context context{problems, folder};
    MappingOf(read_wiring).read({root, "", {}, &context}, content_);
    check_pins({root, "", {}, &context});
  } catch (const yaml::TextFault& fault) {
    problems.add(fault.position, fault.what());
  }
  problems.throw_if_any();

  std::string& eeprom = content_.eeprom;
  std::size_t size = static_cast<std::size_t>(content_.eeprom_size.value_or(1024));
  if (!content_.eeprom_file.empty()) {
    files_.push_back((folder / content_.eeprom_file).string());
    eeprom = file::read_whole(files_.back(), {}, content_.eeprom_size ? size : 65536);
    if (!content_.eeprom_size) size = std::max<std::size_t>(eeprom.size(), 1);
  }
  eeprom.resize(size, '\xFF');  // as in a new chip
  bbsim_wiring& c = content_.c;
  c.camera.frame = content_.frame.c_str();
  c.camera.lost = content_.lost.c_str();
  c.input_count = content_.inputs.size();
  c.inputs = content_.inputs.data();
  c.ignored_count = content_.ignored.size();
  c.ignored = content_.ignored.data();
  c.eeprom_size = eeprom.size();
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes as C has them
  c.eeprom = reinterpret_cast<const unsigned char*>(eeprom.data());
}

}  // namespace bbsim::sketch
