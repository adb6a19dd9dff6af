// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is read with a scenario: nothing that is written may be among it.
#pragma once

#include <string>

#include "file/outputs.hpp"
#include "results/result.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

// Says that a scenario is read, and with it its tables and what its own controller is made of.
void reads_scenario(file::Outputs& outputs, const std::string& file, const Scenario& scenario);

// The same of what was read with a result: its summary, and what its scenario names.
void reads_with_result(file::Outputs& outputs, const results::Result& result);

}  // namespace bbsim::api
