// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads one scenario many times with different values of some keys, for sweeps.
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

// Parses the file's text once. Each scenario passes all checks of read_scenario(). Several threads
// may call read() at the same time.
class ScenarioFamily {
 public:
  // Reads `file` ("-" is standard input) and sets each "key.path=value" of `overrides`. Throws
  // InputError if the result is not a tree of keys. read() checks the values.
  ScenarioFamily(const std::string& file, const std::vector<std::string>& overrides);
  // The same for text in memory.
  explicit ScenarioFamily(const Source& source);
  ~ScenarioFamily();
  ScenarioFamily(ScenarioFamily&&) noexcept;
  ScenarioFamily& operator=(ScenarioFamily&&) = delete;

  // Replaces the program or library in the text with this controller, for scenarios read from now
  // on. Must not run while another thread reads.
  void give_controller(ControllerFactory factory);

  // A value for the key at a path, in YAML as after --set.
  struct Setting {
    std::string key, value;
  };

  // The scenario with these settings, applied in order. Its source lists only the overrides. Throws
  // InputError with all problems; those of a setting begin with "KEY=VALUE".
  [[nodiscard]] Scenario read(const std::vector<Setting>& settings) const;
  // The scenario without settings, with its whole source.
  [[nodiscard]] Scenario itself() const;

  // The unit of the single number at the key, with these settings: "m". Empty if the value is not a
  // single number, or if its unit depends on more than the key, as for a gain.
  [[nodiscard]] std::string_view unit_of(const std::string& key,
                                         const std::vector<Setting>& settings) const;

  // The number in SI units at the key, with these settings. Empty if the text has no single number
  // there.
  [[nodiscard]] std::optional<double> number_at(const std::string& key,
                                                const std::vector<Setting>& settings) const;

  // The value at the key, such as gimbal.motion, in the text with its overrides: YAML in one line,
  // without comments. Empty if there is none.
  [[nodiscard]] std::string text_at(const std::string& key) const;

  // The file's `sweep` section. Throws InputError if it is invalid.
  [[nodiscard]] Sweep read_sweep() const;

  // A hash of the content of each table file read so far.
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> table_hashes() const;

  // The tables read so far, under their file names in the scenario.
  [[nodiscard]] std::vector<file::InputTable> inputs() const;

  [[nodiscard]] const Source& source() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bbsim
