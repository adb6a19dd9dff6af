#include "record/measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bbsim::record {
namespace {

using Kind = Measure::Kind;

struct Prefix {
  std::string_view text;
  Kind kind;
  std::string_view meaning;
};
constexpr Prefix prefixes[] = {{"min_", Kind::least, "least over the rows of: "},
                               {"max_", Kind::greatest, "greatest over the rows of: "},
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
    if (column != nullptr) return Measure{prefix.kind, column, std::string(name)};
  }
  return {};
}

std::string allowed_measures() {
  return "min_, max_, rms_ or end_ and one of bbsim columns, such as max_tilt, rms_x, end_phi";
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

const char* why_missing(const Column& column, const Scenario& scenario) {
  switch (column.needs) {
    case Needs::reference:
      return scenario.controller ? nullptr : "there is no controller";
    case Needs::samples:
      return scenario.controller && scenario.controller->sampling
                 ? nullptr
                 : "the controller takes no samples";
    case Needs::plate:
      return scenario.plate.inertia ? nullptr : "plate.inertia is not known";
    default:
      return nullptr;
  }
}

std::string why_not_finite(const std::vector<Measure>& measures, const double* results,
                           const Scenario& scenario) {
  std::string text;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (std::isfinite(results[m])) continue;
    const char* const missing = why_missing(*measures[m].column, scenario);
    text += (text.empty() ? "" : "; ") + measures[m].name +
            (std::isnan(results[m]) ? " is no number" : " is infinite");
    if (missing != nullptr) text += std::string(": ") + missing;
  }
  return text;
}

Meter::Meter(std::vector<Measure> measures)
    : measures_(std::move(measures)),
      needs_dynamics_(any_needs(measures_, Needs::dynamics) || any_needs(measures_, Needs::plate)),
      sums_(measures_.size()) {}

void Meter::begin(const model::Model& model, const model::BallConstants& constants,
                  const solve::OutputGrid& grid) {
  model_ = &model;
  constants_ = &constants;
  grid_ = &grid;
  std::fill(sums_.begin(), sums_.end(), Sum{});
}

model::Dynamics Meter::dynamics_at(const model::Sample& sample) const {
  return needs_dynamics_ ? model::dynamics(sample, *constants_) : model::Dynamics{};
}

void Meter::accept(std::size_t first, std::size_t count, const double* values) {
  const std::size_t row_size = model_->row_size();
  for (std::size_t i = 0; i < count; ++i) {
    const model::Sample sample = model_->sample((*grid_)[first + i], values + i * row_size);
    const model::Dynamics dynamics = dynamics_at(sample);
    for (std::size_t m = 0; m < measures_.size(); ++m) {
      const double value = measures_[m].column->value({sample, &dynamics});
      Sum& sum = sums_[m];
      if (measures_[m].kind == Kind::end) {
        sum = {value, 1};
        continue;
      }
      if (std::isnan(value)) continue;
      const bool fresh = sum.rows++ == 0;
      switch (measures_[m].kind) {
        case Kind::least:
          sum.value = fresh ? value : std::min(sum.value, value);
          break;
        case Kind::greatest:
          sum.value = fresh ? value : std::max(sum.value, value);
          break;
        default:
          sum.squares.add(value);
      }
    }
  }
}

void Meter::finish(const solve::Outcome& outcome, double* results) {
  const bool stopped = outcome.ending == solve::Ending::stopped;
  model::Dynamics dynamics;
  if (stopped) dynamics = dynamics_at(outcome.occurrences.back().sample);
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    const Sum& sum = sums_[m];
    if (stopped && measures_[m].kind == Kind::end) {
      results[m] = measures_[m].column->value({outcome.occurrences.back().sample, &dynamics});
    } else if (sum.rows == 0) {
      results[m] = std::numeric_limits<double>::quiet_NaN();
    } else if (measures_[m].kind == Kind::rms) {
      results[m] = sum.squares.root_mean(sum.rows);
    } else {
      results[m] = sum.value;
    }
  }
}

}  // namespace bbsim::record
