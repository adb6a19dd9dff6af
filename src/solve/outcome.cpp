// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/outcome.hpp"

#include <utility>

namespace bbsim::solve {

const char* name_of(Why why) {
  switch (why) {
    case Why::none:
      return "none";
    case Why::event:
      return "event";
    case Why::unbounded:
      return "unbounded";
    case Why::singular:
      return "singular";
    case Why::too_slow:
      return "too_slow";
    case Why::controller:
      return "controller";
    case Why::not_finite:
      return "not_finite";
    case Why::error_out_of_reach:
      return "error_out_of_reach";
    case Why::interrupted:
      return "interrupted";
  }
  return "";
}

Outcome with_all_rows(Outcome outcome, std::size_t rows) {
  if (outcome.ending != Ending::done || outcome.rows == rows) return outcome;
  outcome.ending = Ending::failed;
  outcome.reason = "bbsim has lost rows by a defect of its own code: it reached the end with " +
                   std::to_string(outcome.rows) + " of " + std::to_string(rows);
  return outcome;
}

}  // namespace bbsim::solve
