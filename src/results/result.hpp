// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A result as pictures need it: its columns, and what is known of the scene that gave them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::results {

// Numbers in SI units. A field that is no number is NaN; where one of them is not empty, all
// fields are in `texts` as well.
struct Column {
  std::string name;
  std::vector<double> numbers;
  std::vector<std::string> texts{};
  std::string unit{};  // as its file says; empty if it does not

  [[nodiscard]] bool is_text() const { return !texts.empty(); }
};

struct Event {
  std::string name;
  bool stopped = false;
  double t = 0, x = 0, y = 0;             // s, m
  std::map<std::string, double> state{};  // columns of `bbsim columns` at that instant, if told
};

struct Result {
  std::string file;  // as the user named it
  std::vector<Column> columns;
  std::size_t rows = 0;

  // What a CSV cannot tell; empty where nothing else does.
  std::string title, status;
  std::string reason, version;       // why a run ended early; of the bbsim that ran it
  std::string summary;               // JSON, as `run --summary` writes it, without scenario_text
  std::string beside;                // the file that was looked at for its summary, unasked
  std::string left_out;              // what to tell of a summary beside it that is another run's
  std::optional<double> end_time{};  // that the run reached, s
  std::vector<Event> events{};
  std::optional<Scenario> scenario{};
  std::vector<std::string> drawn_keys{};  // of a sweep: keys whose values were drawn by chance
  bool tells_drawn = false;               // whether drawn_keys is known
  // Whether columns of `bbsim columns` are in its units where the file does not say: not in a table
  // of which nothing tells that bbsim wrote it.
  bool units_known = true;
  bool has_end_row = false;  // that add_end_row() added

  [[nodiscard]] const Column* find(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> names() const;  // of the columns
  // How a picture calls its file.
  [[nodiscard]] std::string shown_file() const;
  // A row a case, as `bbsim sweep` writes them.
  [[nodiscard]] bool is_sweep() const;
};

// Where an event stopped a run between two rows, its instant becomes the last row: with what the
// event tells, and NaN, or an empty text, in all other columns.
void add_end_row(Result& result);

}  // namespace bbsim::results
