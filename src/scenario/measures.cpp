#include "scenario/measures.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::scenario {
namespace {

using Kind = Measure::Kind;

struct Prefix {
  std::string_view text;
  Kind kind;
  std::string_view meaning;
};
constexpr Prefix prefixes[] = {{"min_", Kind::least, "least over the continuous motion of: "},
                               {"max_", Kind::greatest, "greatest over the continuous motion of: "},
                               {"rms_", Kind::rms, "root mean square over the rows of: "},
                               {"end_", Kind::end, "at the end of the run: "}};

}  // namespace

std::string Measure::meaning() const {
  for (const Prefix& prefix : prefixes) {
    if (prefix.kind == kind) return std::string(prefix.meaning) + std::string(column->meaning);
  }
  return "";
}

std::optional<Measure> find_measure(std::string_view name) {
  if (name == "x_end" || name == "y_end") {
    return Measure{Kind::end, find_column(name.substr(0, 1)), std::string(name)};
  }
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.text)) continue;
    const Column* const column = find_column(name.substr(prefix.text.size()));
    // A quaternion has no extremes that mean anything.
    if (column != nullptr && column->needs == Needs::orientation) return {};
    if (column != nullptr) return Measure{prefix.kind, column, std::string(name)};
  }
  return {};
}

std::string allowed_measures() {
  return "min_, max_, rms_ or end_ and one of bbsim columns but ball_q..., such as max_tilt, "
         "rms_x, end_phi";
}

std::vector<std::string> default_measures(bool closed_loop) {
  std::vector<std::string> names{"x_end", "y_end", "max_tilt", "max_tilt_rate", "max_distance"};
  if (closed_loop) names.insert(names.end(), {"rms_tracking_error", "max_tracking_error"});
  return names;
}

bool any_needs(const std::vector<Measure>& measures, Needs what) {
  return std::any_of(measures.begin(), measures.end(),
                     [what](const Measure& measure) { return measure.column->needs == what; });
}

std::string why_not_finite(const std::vector<Measure>& measures, const double* results,
                           const Scenario& scenario) {
  std::string text;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (std::isfinite(results[m])) continue;
    const Missing lacks = missing(*measures[m].column, scenario);
    text += (text.empty() ? "" : "; ") + measures[m].name +
            (std::isnan(results[m]) ? " is no number" : " is infinite");
    if (lacks) text += std::string(": ") + lacks.why;
  }
  return text;
}

}  // namespace bbsim::scenario
