// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// YAML text -> Scenario. The door: what passes is complete, finite, in range, and in SI units.
#pragma once

#include <string>
#include <vector>

#include "file/table_writer.hpp"
#include "scenario/scenario.hpp"

namespace bbsim {

// Reads the scenario in `file`, after setting each "key.path=value" of `overrides` in turn; "-" is
// standard input, which the source then names so.
//
// Table files are named relative to the scenario's folder, those of standard input relative to the
// current one. Throws InputError with every problem
// found, in the order of the file; "file:line:column: key.path: found ..., allowed ...".
//
// `inputs`, if it is given, gets the tables that were read, as the scenario names them.
[[nodiscard]] Scenario read_scenario(const std::string& file,
                                     const std::vector<std::string>& overrides = {},
                                     std::vector<file::InputTable>* inputs = nullptr);

// Reads a scenario from text already in memory. `name` stands for the file in errors, and its
// folder is where table files are looked for.
[[nodiscard]] Scenario parse_scenario(const std::string& text, const std::string& name,
                                      const std::vector<std::string>& overrides = {},
                                      std::vector<file::InputTable>* inputs = nullptr);

// The table files that a scenario names, as they are opened.
[[nodiscard]] std::vector<std::string> table_files(const Scenario& scenario);

// What can be read of it; the rest keeps its defaults. For those who show what a run was and run
// nothing: its tables may be gone, and another version may have known other keys.
[[nodiscard]] Scenario parse_sound_parts(const std::string& text, const std::string& name,
                                         const std::vector<std::string>& overrides = {});

}  // namespace bbsim
