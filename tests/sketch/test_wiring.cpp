// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The wiring file.
#include <yaml-cpp/yaml.h>

#include <string>

#include "app/process.hpp"
#include "base/error.hpp"
#include "catch.hpp"
#include "sketch/wiring.hpp"

namespace bbsim_test::test_wiring {

using bbsim::sketch::Wiring;

namespace {

// The faults of a wiring with the given text.
std::string fault_of(const std::string& text) {
  const bbsim_test::Folder folder;
  return message_of<bbsim::InputError>([&] { const Wiring wiring(folder.write("w.yaml", text)); });
}

}  // namespace

TEST_CASE("a wiring has defaults") {
  const bbsim_test::Folder folder;
  const Wiring wiring(folder.write("w.yaml", "servos: {phi: {pin: A3}}\n"));
  const bbsim_wiring& c = *wiring.get();
  CHECK(c.version == BBSIM_WIRING_VERSION);
  CHECK(c.servos[0].pin == 57);
  CHECK(c.servos[1].pin == -1);
  CHECK(c.servos[0].level == 1472e-6);
  // 180 degrees are 544 to 2400 us.
  CHECK(c.servos[0].scale * 1856e-6 == Approx(3.14159265358979).epsilon(1e-14));
  CHECK(c.setup_before == 1);
  CHECK(wiring.print() == bbsim::sketch::Wiring::Print::first);
  CHECK(c.screen.kind == bbsim_no_screen);
  CHECK(c.camera.port == -1);
  CHECK(c.eeprom_size == 1024);
  CHECK(c.eeprom[1023] == 255);
  CHECK(c.costs.analog == 112e-6);
}

TEST_CASE("a wiring is read in SI units") {
  const bbsim_test::Folder folder;
  folder.write("cells", "abc");
  const Wiring wiring(folder.write("w.yaml", R"(
servos:
  phi: {channel: 3, level: "1510 us", scale: "0.1 deg", direction: -1}
  theta: {pin: 4}
  ignored: [5, A6]
  ignored_channels: [2, 15]
  oscillator: 27e6
screen:
  four_wire: {x_plus: A0, x_minus: A2, y_plus: A1, y_minus: 8}
  x: {counts: [100, 900], position: ["-16 cm", 0.16]}
  y: {counts: [900, 100], position: ["-12 cm", "12 cm"]}
camera: {port: SerialUSB, period: "33 ms", x: {counts: [0, 1], position: [0, 1]},
         y: {counts: [0, 1], position: [0, 1]}, frame: "{x} {y}\n", decimals: 2}
inputs: {A5: 300, 7: 1}
eeprom: {file: cells}
setup: during
print: off
costs: {analog: "20 us"}
)"));
  const bbsim_wiring& c = *wiring.get();
  CHECK(c.servos[0].channel == 3);
  CHECK(c.servos[0].pin == -1);
  CHECK(c.servos[0].scale == Approx(-0.1 * 3.14159265358979 / 180 * 1e6).epsilon(1e-14));
  CHECK(c.ignored_count == 2);
  CHECK(c.ignored[1] == 60);
  CHECK(c.ignored_channels == 0x8004);
  CHECK(c.screen.kind == bbsim_four_wires);
  CHECK(c.screen.pins[3] == 8);
  CHECK(c.screen.x.position[1] == 0.16);
  CHECK(c.camera.port == 4);
  CHECK(c.camera.decimals == 2);
  CHECK(std::string(c.camera.frame) == "{x} {y}\n");
  CHECK(c.inputs[1].pin == 7);
  CHECK(c.eeprom_size == 3);
  CHECK(c.eeprom[2] == 'c');
  CHECK(wiring.files().size() == 2);
  CHECK(c.setup_before == 0);
  CHECK(wiring.print() == bbsim::sketch::Wiring::Print::off);
  CHECK(c.costs.analog == 20e-6);
}

TEST_CASE("a wiring has steppers in place of servos") {
  const bbsim_test::Folder folder;
  const Wiring wiring(folder.write("w.yaml", R"(
steppers:
  phi: {step: 2, dir: 3, enable: 8, direction: -1, start: "-20 deg",
        home: {pin: 9, angle: "-25 deg", closed: 1}}
  ignored: [A0]
screen: {voltages: {x: A1}, x: {counts: [448, 3648], position: [-0.16, 0.16]}}
inputs: {A5: 4000}
)"));
  const bbsim_wired_stepper& phi = wiring.get()->steppers[0];
  CHECK(phi.step == 2);
  CHECK(phi.dir == 3);
  CHECK(phi.enable == 8);
  CHECK(phi.angle == -1);
  CHECK(phi.start == Approx(-20 * 3.14159265358979 / 180).epsilon(1e-14));
  CHECK(phi.home == 9);
  CHECK(phi.home_level == 1);
  CHECK(wiring.get()->steppers[1].step == -1);
  CHECK(wiring.get()->servos[0].pin == -1);
  CHECK(wiring.get()->ignored_count == 1);
  CHECK(wiring.get()->screen.pins[1] == -1);
}

TEST_CASE("all faults of a wiring are reported together, each with its place") {
  for (const YAML::Node& row : YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/sketch/wirings.yaml")) {
    const std::string fault = fault_of(row[0].as<std::string>());
    CAPTURE(row[0].as<std::string>(), fault);
    CHECK(fault.empty() == (row.size() == 1));
    for (std::size_t i = 1; i < row.size(); ++i) CHECK(contains(fault, row[i].as<std::string>()));
  }
}

}  // namespace bbsim_test::test_wiring
