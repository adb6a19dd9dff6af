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
    : measures_(std::move(measures)), sums_(measures_.size()) {
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    const Needs needs = measures_[m].column->needs;
    const bool dynamics = needs == Needs::dynamics || needs == Needs::plate;
    switch (measures_[m].kind) {
      case Kind::end:
        end_needs_dynamics_ = end_needs_dynamics_ || dynamics;
        break;
      case Kind::rms:
        of_rows_.push_back(m);
        rows_need_dynamics_ = rows_need_dynamics_ || dynamics;
        break;
      default:
        of_motion_.push_back(m);
        motion_needs_dynamics_ = motion_needs_dynamics_ || dynamics;
    }
  }
  extremes_.emplace(of_motion_.size(), [this](const model::Sample& sample, double* numbers) {
    const model::Dynamics dynamics = dynamics_at(sample, motion_needs_dynamics_);
    for (const std::size_t m : of_motion_) {
      const double value = measures_[m].column->value({sample, &dynamics});
      *numbers++ = measures_[m].kind == Kind::least ? -value : value;
    }
  });
}

void Meter::begin(const model::Model& model, const model::BallConstants& constants,
                  const solve::OutputGrid& grid) {
  model_ = &model;
  constants_ = &constants;
  grid_ = &grid;
  std::fill(sums_.begin(), sums_.end(), Sum{});
  extremes_->begin(model);
}

solve::PieceSink* Meter::pieces() {
  return of_motion_.empty() ? nullptr : &*extremes_;
}

model::Dynamics Meter::dynamics_at(const model::Sample& sample, bool needed) const {
  return needed ? model::dynamics(sample, *constants_) : model::Dynamics{};
}

void Meter::accept(std::size_t first, std::size_t count, const double* values) {
  const auto sample = [&](std::size_t i) {
    return model_->sample((*grid_)[first + i], values + i * model_->row_size());
  };
  // A run may end before its first step.
  if (first == 0 && !of_motion_.empty()) extremes_->note(sample(0));
  if (count > 0) last_ = sample(count - 1);
  if (of_rows_.empty()) return;
  for (std::size_t i = 0; i < count; ++i) {
    const model::Sample row = sample(i);
    const model::Dynamics dynamics = dynamics_at(row, rows_need_dynamics_);
    for (const std::size_t m : of_rows_) {
      const double value = measures_[m].column->value({row, &dynamics});
      if (std::isnan(value)) continue;
      sums_[m].squares.add(value);
      ++sums_[m].rows;
    }
  }
}

void Meter::finish(const solve::Outcome& outcome, double* results) {
  const bool stopped = outcome.ending == solve::Ending::stopped;
  const model::Sample& last = stopped ? outcome.occurrences.back().sample : last_;
  const model::Dynamics dynamics = dynamics_at(last, end_needs_dynamics_);
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    if (measures_[m].kind == Kind::end) results[m] = measures_[m].column->value({last, &dynamics});
  }
  for (const std::size_t m : of_rows_) {
    results[m] = sums_[m].rows == 0 ? std::numeric_limits<double>::quiet_NaN()
                                    : sums_[m].squares.root_mean(sums_[m].rows);
  }
  for (std::size_t i = 0; i < of_motion_.size(); ++i) {
    const std::size_t m = of_motion_[i];
    const double greatest = (*extremes_)[i].value;
    results[m] = measures_[m].kind == Kind::least ? -greatest : greatest;
  }
}

}  // namespace bbsim::record
