// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The text of a progress bar, for a terminal of any width.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace bbsim::app {

struct ProgressState {
  std::string label, detail;             // printable
  double done = 0;                       // 0 to 1
  std::optional<double> seconds_left{};  // nothing if it cannot be told yet
};

// "fig2b.yaml [#######.......]  47%, 130 cases/s, 12 s left", in at most `columns` columns, down to
// ten: what matters least is left out first, and the bar takes what room there is.
[[nodiscard]] std::string progress_line(const ProgressState& state, std::size_t columns);

// The same as a line of a log: "fig2b.yaml: 47.2%, 130 cases/s, 12 s left".
[[nodiscard]] std::string log_line(const ProgressState& state);

// Columns that a text takes at most: two for each character that is no ASCII.
[[nodiscard]] std::size_t widest(const std::string& text);

}  // namespace bbsim::app
