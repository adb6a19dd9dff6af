// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The protocol between bbsim and a controller program: lines of JSON, one each way per sample
// (docs/reference/controllers.md).
//
//     bbsim       {"protocol":1,"bbsim":"0.4.0","period":0.02,...,"parameters":{"kp":0.7},...}
//     controller  {"protocol": 1, "reset": true, "columns": {"x_integral": "rad"}}
//     bbsim       {"sample":0,"t":0.0,"ball":[-0.03,0.0],"reference":[0.03,0.0],...}
//     controller  {"command": [0.042, 0.0], "x_integral": 0.0012}
//
// Numbers read back to the same double.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/pair.hpp"
#include "model/control/external_controller.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::controller {

inline constexpr int protocol_version = 1;

// The facts about a run that your own controller receives before its first sample. SI units and
// radians.
struct Setup {
  Drives drives = Drives::angle;
  double period = 0, delay = 0, resolution = 0, derivative_filter = 0;  // as in Sampling
  double limit = 0;  // of the command; infinite if there is none
  double end = 0;    // of the run, s
  std::vector<Parameter> parameters;
  // The number of commands that it gives, and of servos whose state it receives.
  [[nodiscard]] std::size_t commands() const { return drives == Drives::legs ? 3 : 2; }
  std::uint64_t seed = 1;             // of random parts beside the controller's sensor
  std::array<double, 3> microstep{};  // of each axis or leg, rad; 0: not a stepper
  std::vector<std::string> columns;   // names of the numbers that bbsim wants from it
  bool serial = false;                // a program at a sketch's serial line
};

// The line that begins a run, with its line break.
[[nodiscard]] std::string hello_line(const Setup& setup);

// The fields of a sample beside its number, with their units.
struct Field {
  std::string_view name, unit;
};
inline constexpr std::array fields = {
    Field{"t", "s"},
    Field{"ball", "m"},
    Field{"reference", "m"},
    Field{"reference_rate", "m/s"},
    Field{"reference_acceleration", "m/s^2"},
    Field{"servo", "rad"},
    Field{"servo_rate", "rad/s"},
};
using Fields = std::bitset<fields.size()>;  // a subset of them

// The controller's answer to the hello.
struct Ready {
  bool reset = false;  // another hello begins another run
  // The names and units of the numbers that it gives beside its commands, if it lists them.
  std::optional<std::vector<std::pair<std::string, std::string>>> columns{};
  Fields fields = Fields().set();  // those that it wants to receive
  std::string fault;               // what is wrong with the answer; empty if nothing is
};

// Reads the answer to a hello, a line without its line break.
[[nodiscard]] Ready read_ready(std::string_view line);

// The longest line of a sample, in bytes.
inline constexpr std::size_t longest_sample = 1024;

// Writes the line of a sample, with its line break. Returns its length.
[[nodiscard]] std::size_t write_sample(const model::ControllerSample& sample, Fields wanted,
                                       char (&line)[longest_sample]);

// What is wrong with an answer: `why`, or the reason with which the controller gave up.
[[nodiscard]] std::string refusal(std::string_view line, const std::string& why);

// For a line that is not a JSON object, where to print other text; else empty.
[[nodiscard]] std::string advice_on_text(std::string_view line);

// Reads an answer, a line without its line break. Reads as many commands as `command` has room for,
// two or three, and the numbers of these names into `own`. Returns what is wrong with the answer;
// empty if nothing is. Allocates no memory unless something is wrong. `first`: it is the first
// answer, which shows what the controller gives; throws KeyError for a name that it lacks.
[[nodiscard]] std::string read_answer(std::string_view line, std::span<const std::string> names,
                                      std::span<double> command, double* own, bool first = false);

// The messages of a program at a sketch's serial line (docs/reference/controllers.md): samples with
// what the sketch printed, and answers with bytes for it. The rest is as in protocol.hpp.
//
//     bbsim    {"sample":1,"t":0.033,"ball":[-0.03,0.0],...,"serial":"ok\r\n"}
//     program  {"serial": "93,87\n"}
struct SerialAnswer {
  std::string bytes;             // for the sketch
  std::optional<double> baud{};  // at which the program opened the line, if it says so
  std::string fault;             // what is wrong with the answer; empty if nothing is
};

// Adds the bytes that arrived from the sketch to the line of a sample, each as a character U+0000
// to U+00FF.
[[nodiscard]] std::string with_serial(std::string_view sample_line, std::string_view bytes);

// Reads an answer, a line without its line break, and the numbers of these names into `own`.
// Numbers that the answer lacks stay.
[[nodiscard]] SerialAnswer read_serial_answer(std::string_view line,
                                              std::span<const std::string> names, double* own);

}  // namespace bbsim::controller
