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
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/pair.hpp"
#include "controller/setup.hpp"
#include "model/control/external_controller.hpp"

namespace bbsim::controller {

inline constexpr int protocol_version = 1;

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

// " (did you mean command?)" if another one of the names is near; otherwise empty.
[[nodiscard]] std::string hint(std::string_view found, std::span<const std::string_view> names);

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

}  // namespace bbsim::controller
