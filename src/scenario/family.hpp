// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One scenario with other values at some of its keys, again and again: what a sweep reads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file/table_writer.hpp"
#include "scenario/scenario.hpp"

namespace bbsim {

// The file's text is parsed once; each scenario passes all checks of read_scenario(). May be read
// by several threads at a time.
class ScenarioFamily {
 public:
  // Reads `file`, or standard input for "-", and sets each "key.path=value" of `overrides`. Throws
  // InputError where that is no tree of keys; what the keys hold is checked by read().
  ScenarioFamily(const std::string& file, const std::vector<std::string>& overrides);
  // Does the same with a text that has been read.
  explicit ScenarioFamily(const Source& source);
  ~ScenarioFamily();
  ScenarioFamily(ScenarioFamily&&) noexcept;
  ScenarioFamily& operator=(ScenarioFamily&&) = delete;

  // A value, in YAML as after --set, for the key at that path.
  struct Setting {
    std::string key, value;
  };

  // The scenario with these settings, in their order. Its source has the overrides alone.
  // Throws InputError with all problems; those of a setting begin with "KEY=VALUE".
  [[nodiscard]] Scenario read(const std::vector<Setting>& settings) const;

  // Reads as read() does, and returns the number in SI units that stands at the key of the last
  // setting; nothing if what stands there is no single number.
  [[nodiscard]] std::optional<double> read_number(const std::vector<Setting>& settings) const;

  // The unit of the single number at that key, with these settings: "m"; empty of one whose unit
  // depends on more than the key, such as a gain, and of what is no single number.
  [[nodiscard]] std::string_view unit_of(const std::string& key,
                                         const std::vector<Setting>& settings) const;

  // The `sweep` block of the file. Throws InputError if something is wrong with it.
  [[nodiscard]] Sweep read_sweep() const;

  // A number for each table file that was read so far, which tells its content.
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> table_hashes() const;

  // These tables, as the scenario names them.
  [[nodiscard]] std::vector<file::InputTable> inputs() const;

  [[nodiscard]] const Source& source() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bbsim
