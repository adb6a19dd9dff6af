// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Files read with a scenario, which no output may overwrite.
#pragma once

#include <string>

#include "file/outputs.hpp"
#include "results/result.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

// Declares the scenario, its tables and the files of its controller as read.
void reads_scenario(file::Outputs& outputs, const std::string& file, const Scenario& scenario);

// Declares the files read with a result: its summary, and those that its scenario names.
void reads_with_result(file::Outputs& outputs, const results::Result& result);

}  // namespace bbsim::api
