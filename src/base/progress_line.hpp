// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Text of a progress bar, for terminals of any width.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace bbsim {

struct ProgressState {
  std::string label, detail;             // printable
  double done = 0;                       // 0 to 1
  std::optional<double> seconds_left{};  // empty if not known yet
};

// "fig2b.yaml [#######.......]  47%, 130 cases/s, 12 s left", in at most `columns` columns, at
// least ten. Leaves out the least important parts first; the bar fills the room left.
[[nodiscard]] std::string progress_line(const ProgressState& state, std::size_t columns);

// The same as a line of a log: "fig2b.yaml: 47.2%, 130 cases/s, 12 s left".
[[nodiscard]] std::string log_line(const ProgressState& state);

// Upper bound on the columns of a text: two for each character that is not ASCII.
[[nodiscard]] std::size_t widest(const std::string& text);

}  // namespace bbsim
