// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The messages of a program at a sketch's serial line (docs/reference/controllers.md): samples with
// what the sketch printed, and answers with bytes for it. The rest is as in protocol.hpp.
//
//     bbsim    {"sample":1,"t":0.033,"ball":[-0.03,0.0],...,"serial":"ok\r\n"}
//     program  {"serial": "93,87\n"}
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace bbsim::controller {

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
