// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Shared by the tests of the scenario reader.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "scenario/reader.hpp"
#include "support/folder.hpp"

namespace bbsim::test {

inline Scenario parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scenario(text, "scenario.yaml", overrides);
}

// All problems of the text, one per line; empty if there are none.
inline std::string errors(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return message_of<InputError>([&] { static_cast<void>(parse(text, overrides)); });
}

// The shortest open-loop scenario, on lines 1 to 3.
inline const std::string open_loop =
    "ball: {radius: 0.01}\n"
    "time: {end: 10, step: 0.1}\n"
    "gimbal: {motion: {}}\n";

// The shortest closed-loop scenario, on lines 1 to 3.
inline const std::string closed_loop =
    "ball: {radius: 0.01}\n"
    "time: {end: 10, step: 0.1}\n"
    "controller: {pd: {kv: 100, kp: 0.1}, reference: {point: [0, 0]}}\n";

}  // namespace bbsim::test
