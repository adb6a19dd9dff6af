// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "measure_text.hpp"

#include "base/number_text.hpp"

namespace bbsim::app {

std::string measure_text(const std::vector<std::pair<std::string, double>>& measures) {
  std::string text = "measure,value\n";
  for (const auto& [name, value] : measures) text += name + ',' + number_text(value) + '\n';
  return text;
}

Option add_measures(Command& command, std::vector<std::string>& lists, const std::string& what) {
  return command.option("--measure", lists, what).takes("NAME,...").may_be_repeated();
}

std::string measures_footer() {
  return "Measures of any column x:\n"
         "  extremes      min_x, max_x, rms_x, end_x\n"
         "  step metrics  x.RiseTime, SettlingTime, SettlingMin, SettlingMax, Overshoot,\n"
         "                Undershoot, Peak, PeakTime, SteadyStateValue\n"
         "  instants      \"when x=0.05\", with rise=N, fall=N or cross=N (N may be last);\n"
         "                \"when x stays below 0.05\", or above\n"
         "  values        \"find y when x=0.05\", \"find y at 2\"\n"
         "A step goes from x at the start to x_reference at the end, or to x at the end if x has "
         "no reference. Append \"from 5 s\", \"to 20 s\" or both to measure a part of the run.";
}

}  // namespace bbsim::app
