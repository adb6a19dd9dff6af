// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/log.hpp"

#include <utility>

#include "replay/sources.hpp"

namespace bbsim::replay {

Run run_of_log(results::Result log, const results::LogChoice& choice, const std::string& name,
               std::vector<std::string>& notes) {
  results::make_log(log, choice, true, notes);
  log.units_known = true;  // as --data or the map states
  Run run = run_of_result(std::move(log), name);
  if (!choice.maps.empty()) run.rolls = false;
  return run;
}

}  // namespace bbsim::replay
