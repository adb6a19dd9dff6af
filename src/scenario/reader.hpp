// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads YAML text into a Scenario, which is complete, finite, in range, and in SI units.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "file/table_writer.hpp"
#include "scenario/scenario.hpp"
#include "yaml/quantity.hpp"

namespace bbsim {

// Reads the scenario in `file` with each "key.path=value" of `overrides` set in turn. "-" is
// standard input, which is then also the name of the scenario's source.
//
// Table files are relative to the scenario's folder, or to the current folder for standard input.
// Throws InputError with all problems in the file's order: "file:line:column: key.path: found ...,
// allowed ...".
//
// `inputs`, if not null, receives the tables that were read, under their names in the scenario.
[[nodiscard]] Scenario read_scenario(const std::string& file,
                                     const std::vector<std::string>& overrides = {},
                                     std::vector<file::InputTable>* inputs = nullptr);

// Reads a scenario from text in memory. `name` is the file's name in errors, and its folder
// contains the table files.
[[nodiscard]] Scenario parse_scenario(const std::string& text, const std::string& name,
                                      const std::vector<std::string>& overrides = {},
                                      std::vector<file::InputTable>* inputs = nullptr);

// The place of the key: "file:line:column", or the override that sets it. For a missing key, the
// place of the nearest key above it. Reads no other keys, as number_at().
[[nodiscard]] std::string place_of(const Source& source, std::string_view key);

// The number at the key in SI units, or nothing.
[[nodiscard]] std::optional<double> number_at(const Source& source, std::string_view key,
                                              yaml::Dimension dimension);

// Reads the valid parts; the rest keeps its defaults. For commands that describe a past run without
// running it: its tables may be gone, and another version may have known other keys.
[[nodiscard]] Scenario parse_sound_parts(const std::string& text, const std::string& name,
                                         const std::vector<std::string>& overrides = {});

}  // namespace bbsim
