// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Options that describe the columns and the clock of a log.
#include "commands.hpp"
#include "results/log.hpp"

namespace bbsim::app {

void add_log_options(Command& command, results::LogChoice& choice) {
  command
      .option("--map", choice.maps,
              "COLUMN=[FACTOR*]NAME[+OFFSET][:UNIT],...: bbsim's COLUMN is FACTOR times the log's "
              "column NAME plus OFFSET, in UNIT; -NAME changes its sign; default: columns match by "
              "name, in SI units or in the unit that the name gives; repeatable")
      .takes("MAP")
      .may_be_repeated();
  command.option("--header", choice.header, "the names of the columns of a log without a header")
      .takes("NAME,...")
      .parted_by_commas();
  command
      .option("--period", choice.period,
              "the time between rows of a log without a clock: 0.1, "
              "\"100 ms\"")
      .takes("TIME");
  command
      .option("--time-offset", choice.time_offset,
              "a time to add to the log's times; or start, so that its first row is t = 0; or, in "
              "compare and replay, auto, by cross-correlation with the run")
      .takes("TIME|start|auto");
  command
      .option("--missing", choice.missing,
              "leave out rows in which x, y or another position is VALUE: what the log has where "
              "it does not see the ball, such as -1")
      .takes("VALUE");
}

}  // namespace bbsim::app
