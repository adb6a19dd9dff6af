// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "gnuplot.hpp"

#include <optional>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "file/external.hpp"

namespace bbsim::app {

void require_gnuplot() {
  static_cast<void>(run_gnuplot(""));
}

std::string run_gnuplot(const std::string& script) {
  // Ignore the user's settings, which are for their own plots.
  std::optional<file::Finished> finished =
      file::run_program({"gnuplot", "--default-settings", "-"}, script, "draw the plot");
  if (!finished) {
    throw OutputError(
        "cannot draw the plot: gnuplot is not on the PATH; install it (Debian: apt install "
        "gnuplot-nox)");
  }
  if (finished->well()) return std::move(finished->output);
  const std::size_t start = finished->complaint.find_first_not_of(" \n\t");
  const std::string_view all = finished->complaint;
  const std::string_view rest = start == std::string::npos ? "" : all.substr(start);
  throw OutputError("cannot draw the plot: gnuplot failed: " +
                    std::string(rest.substr(0, rest.find('\n'))));
}

}  // namespace bbsim::app
