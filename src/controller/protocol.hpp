// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What bbsim and a controller that is a program say to each other: lines of JSON, one each way a
// sample (docs/reference/controllers.md).
//
//     bbsim       {"protocol":1,"bbsim":"0.3.0","period":0.02,...,"parameters":{"kp":0.7},...}
//     controller  {"protocol": 1, "reset": true, "save": true, "columns": {"x_integral": "rad"}}
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

// The line that begins a run, with its line break; one that goes on has what a controller answered
// to the save_line.
[[nodiscard]] std::string hello_line(const Setup& setup, const std::string& memory = {});

// What a sample has beside its number, each with its unit.
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
using Fields = std::bitset<fields.size()>;  // some of them

// What the controller says of itself.
struct Ready {
  bool reset = false;  // another hello begins another run
  bool save = false;   // it answers the save_line
  // The numbers that it gives beside its commands, with their units, if it names them.
  std::optional<std::vector<std::pair<std::string, std::string>>> columns{};
  Fields fields = Fields().set();  // those that it wants to be told
  std::string fault;               // what is wrong with the answer; empty if nothing is
};

// Reads the answer to a hello, a line without its break.
[[nodiscard]] Ready read_ready(std::string_view line);

// Asks for what the controller remembers.
inline constexpr std::string_view save_line = "{\"save\":true}\n";

// Reads the answer to that, a line without its break. Returns what is wrong with it; empty if
// nothing is.
[[nodiscard]] std::string read_memory(std::string_view line, std::string& memory);

// No line of a sample is longer.
inline constexpr std::size_t longest_sample = 1024;

// Writes the line of a sample, with its break; returns its length.
[[nodiscard]] std::size_t write_sample(const model::ControllerSample& sample, Fields wanted,
                                       char (&line)[longest_sample]);

// Reads an answer, a line without its break: as many commands as there is room for, two or three,
// and the numbers of these names into
// `own`. Returns what is wrong with it, "its answer ..."; empty if nothing is. Takes no memory
// unless something is wrong.
[[nodiscard]] std::string read_answer(std::string_view line, std::span<const std::string> names,
                                      std::span<double> command, double* own);

}  // namespace bbsim::controller
