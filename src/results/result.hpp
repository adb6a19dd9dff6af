// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A result for pictures: its columns, and the known facts of its scene.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "file/table.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::results {

using file::Column;

struct Event {
  std::string name;
  bool stopped = false;
  double t = 0, x = 0, y = 0;             // s, m
  std::map<std::string, double> state{};  // columns of `bbsim columns` at that time, if known
};

// Its numbers are in SI units.
struct Result : file::Table {
  // Facts that a CSV cannot hold; empty if unknown.
  std::string title, status;
  std::string reason, version;       // why a run ended early; bbsim that ran it
  std::string summary;               // JSON, as `run --summary` writes it, without scenario_text
  std::string beside;                // the file beside it that was tried as its summary
  std::string left_out;              // message about a summary beside it of another run
  std::optional<double> end_time{};  // time that the run reached, s
  std::vector<Event> events{};
  std::optional<Scenario> scenario{};
  std::vector<std::string> drawn_keys{};  // keys of a sweep with random values
  bool drawn_keys_known = false;          // whether drawn_keys is known
  // Whether columns of `bbsim columns` have its units if the file gives none. False for tables that
  // nothing identifies as results of bbsim.
  bool units_known = true;
  bool has_end_row = false;        // added by add_end_row()
  std::vector<std::string> raw{};  // columns of a log from which others were made

  // The name of its file in a picture.
  [[nodiscard]] std::string shown_file() const;
  // Whether each row is a case, as `bbsim sweep` writes them.
  [[nodiscard]] bool is_sweep() const;
};

// Adds the instant at which an event stopped a run as the last row, if it lies after the last one.
// The row has the event's values, and NaN or an empty text in all other columns.
void add_end_row(Result& result);

}  // namespace bbsim::results
