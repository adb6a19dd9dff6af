// What a sweep keeps of a run: one number of a column over the run.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/columns.hpp"

namespace bbsim::scenario {

struct Measure {
  // least, greatest: over the continuous motion, both sides of every switch included; rms: the root
  // of the mean square over the rows; end: at the last instant reached, the row at time.end or
  // where the scene stopped.
  enum class Kind { least, greatest, rms, end } kind = Kind::end;
  const Column* column = nullptr;
  std::string name;  // max_tilt, end_phi, x_end

  [[nodiscard]] std::string meaning() const;
};

// min_, max_, rms_ or end_ and the name of a column; x_end and y_end are end_x and end_y.
[[nodiscard]] std::optional<Measure> find_measure(std::string_view name);

// What the message about an unknown name lists.
[[nodiscard]] std::string allowed_measures();

// x_end, y_end, max_tilt, max_tilt_rate, max_distance, and with a controller rms_tracking_error and
// max_tracking_error.
[[nodiscard]] std::vector<std::string> default_measures(bool closed_loop);

// What the columns of these measures are computed from.
[[nodiscard]] bool any_needs(const std::vector<Measure>& measures, Needs what);

// Why some of the measures of a run that came to its end are no finite numbers; empty if all are.
[[nodiscard]] std::string why_not_finite(const std::vector<Measure>& measures,
                                         const double* results, const Scenario& scenario);

}  // namespace bbsim::scenario
