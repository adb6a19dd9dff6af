// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads logs of real rigs: any CSV, with any names, units and clocks.
#pragma once

#include <string>
#include <vector>

#include "results/result.hpp"

namespace bbsim::results {

// The user's options for a log.
struct LogChoice {
  // "NAME=[FACTOR*]COLUMN[+OFFSET|-OFFSET][:UNIT]", or a list of these with commas. Each makes a
  // column of `bbsim columns` from a column of the log.
  std::vector<std::string> maps{};
  std::vector<std::string> header{};  // the columns' names, if the file has none
  std::string period{};               // time between rows, if they have no clock
  std::string time_offset{};          // a time, "start", or "auto"
  std::string missing{};              // the number in place of a position that was not seen

  [[nodiscard]] bool given() const {
    return !maps.empty() || !header.empty() || !period.empty() || !time_offset.empty() ||
           !missing.empty();
  }
  [[nodiscard]] bool aligns() const { return time_offset == "auto"; }
};

// Reads a log. Its columns get names of bbsim and SI units, as far as `choice` or their own names
// define them; times are made to increase. Its notes tell the changes. Keeps unmapped columns,
// unless `only_mapped`. "auto" leaves the times unchanged, for time_offset() in
// record/log_distance.hpp. Throws InputError with the place in the log or in the map, the text
// found and the texts allowed.
[[nodiscard]] Result read_log(const std::string& file, const LogChoice& choice,
                              bool only_mapped = false);

// Does the same to a log already read.
void make_log(Result& log, const LogChoice& choice, bool only_mapped);

// What is wrong with a log that lacks times: its columns, also those of text, and the remedy.
[[nodiscard]] std::string without_clock(const Result& log);

// Throws InputError if "auto" is requested without a run to align with.
void refuse_auto(const LogChoice& choice);

}  // namespace bbsim::results
