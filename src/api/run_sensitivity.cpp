// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/run_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "api/assemble.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "base/text.hpp"
#include "model/model.hpp"
#include "scenario/keys.hpp"
#include "yaml/quantity.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::api {
namespace {

// States, by the names of their output columns.
constexpr std::array state_columns = {
    "x",     "y",        "vx",         "vy",        "spin",        "gamma",      "phi",
    "theta", "phi_rate", "theta_rate", "servo_phi", "servo_theta", "servo_third"};

// The neighbors of a key are at these many steps from its value.
constexpr std::array offsets = {-2, -1, 1, 2};

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("--sensitivity: " + what);
}

std::string ratio(std::string_view above, const std::string& below) {
  if (below.empty()) return std::string(above);
  if (above == below) return "1";
  const bool plain = below.find_first_of(" /^") == std::string::npos;
  return std::string(above) + "/" + (plain ? below : "(" + below + ")");
}

// Whether positions or commands are rounded.
bool rounds(const model::Model& model) {
  return model.rig && model.rig->sampled &&
         (model.rig->sampled->sensor.resolution > 0 || model.rig->sampled->sampling.resolution > 0);
}

// The distance of neighboring values, a power of two. It is as wide as curvature allows, because
// runs have rounding errors of some 1e-15 of the motion. In scenes that switch it is narrower, so
// that hardly any row lies between the switches of two neighbors; a time moves them most. Where
// numbers are rounded, only a wide step sees the trend across their jumps.
double step_of(const scenario::NamedNumber& number, const model::Model& model, double end) {
  const double value = std::abs(number.value.value_or(0));
  const bool is_time = number.key.dimension == yaml::Dimension::time;
  const double share = rounds(model)    ? 0x1p-7
                       : is_time        ? 0x1p-16
                       : model.hybrid() ? 0x1p-13
                                        : 0x1p-11;
  double step = share * (value == 0 ? 0x1p-4 : value);
  // The phase of a wave, and the instants of samples, move more and more as time passes.
  const std::string_view name = number.name;
  if (name.ends_with(".frequency") || name.ends_with(".rate")) step = std::min(step, 0x1p-7 / end);
  if (name.ends_with(".period") && value > 0) {
    step = std::min(step, 0x1p-13 * value * value / end);
  }
  return std::exp2(std::floor(std::log2(step)));
}

SensitivityKey read_key(const std::string& name, const ScenarioFamily& family,
                        const model::Model& model, double end) {
  for (const std::string_view section : {"time.", "solver.", "output.", "sweep."}) {
    if (!name.starts_with(section)) continue;
    refuse(shown(name) +
           ": found a key of the computation; allowed: keys of the scenario, such as ball.radius");
  }
  const scenario::NamedNumber number = scenario::number_named("--sensitivity", name, family);
  if (!number.value) {
    static_cast<void>(family.read({number.setting(1)}));
    refuse(shown(name) +
           ": the scenario gives it no single number; allowed: a key with a number, such "
           "as ball.radius");
  }
  const double value = *number.value;
  static_cast<void>(family.read({number.setting(value)}));
  const auto fits = [&](double step) {
    try {
      static_cast<void>(family.read({number.setting(value + offsets.front() * step)}));
      static_cast<void>(family.read({number.setting(value + offsets.back() * step)}));
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  double step = step_of(number, model, end);
  for (int halvings = 0; !fits(step); ++halvings, step /= 2) {
    constexpr int most_halvings = 20;
    if (halvings < most_halvings) continue;
    refuse(
        shown(name) + ": found " + number_text(value) +
        ", but a derivative needs valid values on both sides; allowed: a value inside its range");
  }
  return {name, value, step};
}

using Five = std::array<double, 5>;  // the values of a number at -2, -1, 0, 1 and 2 steps

struct Derivative {
  double value;
  double apart;  // distance of estimates that agree where the number is smooth
};

// Of fourth order. If neighbors on one side have no value, of second order from the other side.
Derivative derivative(const Five& f, double step) {
  const double near = (f[3] - f[1]) / (2 * step), far = (f[4] - f[0]) / (4 * step);
  const double ahead = (4 * f[3] - f[4] - 3 * f[2]) / (2 * step);
  const double behind = (3 * f[2] - 4 * f[1] + f[0]) / (2 * step);
  if (std::isfinite(ahead) && std::isfinite(behind)) {
    return {(4 * near - far) / 3, std::max(std::abs(near - far), std::abs(ahead - behind))};
  }
  return {std::isfinite(ahead) ? ahead : behind, 0};
}

// `largest`: the greatest derivative; `size`: the greatest absolute value of the number. Rounding
// of the runs disturbs derivatives by a small part of size / step.
bool is_reliable(const Derivative& found, double largest, double size, double step) {
  constexpr double close = 1e-4, rounding = 1e-11, least_size = 1e-2;
  return std::isfinite(found.value) &&
         found.apart <= close * largest + rounding * std::max(size, least_size) / step;
}

// A number of the run, among those at the neighbors of a key. The run itself comes first, then the
// neighbors of each key, each with `per_run` numbers.
Five around(const std::vector<double>& numbers, std::size_t per_run, std::size_t at,
            std::size_t key) {
  const auto of = [&](std::size_t run) { return numbers[run * per_run + at]; };
  const std::size_t first = 1 + offsets.size() * key;
  return {of(first), of(first + 1), of(0), of(first + 2), of(first + 3)};
}

// Why a neighbor of the key ends differently; empty if none does.
std::string trouble(const std::vector<sweep::CaseStatus>& status, std::size_t key) {
  for (std::size_t i = 1; i <= offsets.size(); ++i) {
    const sweep::CaseStatus& neighbor = status[offsets.size() * key + i];
    if (neighbor.word == status[0].word) continue;
    return "; a run at a neighboring value is " + neighbor.word +
           (neighbor.reason.empty() ? "" : ": " + neighbor.reason);
  }
  return "";
}

}  // namespace

Sensitivity::Sensitivity(const RunRequest& request,
                         const std::vector<const scenario::Column*>& columns,
                         std::vector<scenario::Measure> measures)
    : measures_(std::move(measures)), grid_(request.scenario.time) {
  if (request.sensitivity.empty()) return;
  if (request.scenario.solver.error) {
    refuse(
        "found with solver.error, which repeats the run several times; allowed: with tolerances");
  }
  for (const scenario::Measure& measure : measures_) {
    if (measure.kind != scenario::Measure::Kind::loop) continue;
    refuse("found " + measure.name +
           " in --measure, which is of the loop; allowed: measures of the motion");
  }
  const model::Model model = assemble(request.scenario, columns);
  Source source = request.scenario.source;
  // Steps through switches are short anyway, and a smaller atol only makes more of them.
  for (const char* const solver : {"solver.method=auto", "solver.rtol=3e-14",
                                   model.hybrid() ? "solver.atol=1e-15" : "solver.atol=1e-18"}) {
    source.overrides.emplace_back(solver);
  }
  family_ = std::make_unique<const ScenarioFamily>(source);
  for (const std::string& name : scenario::split_measures(request.sensitivity)) {
    for (const SensitivityKey& key : keys_) {
      const std::string path = yaml::american(name) + '.',
                        key_path = yaml::american(key.name) + '.';
      if (path == key_path) refuse(shown(name) + " is given twice");
      if (!path.starts_with(key_path) && !key_path.starts_with(path)) continue;
      refuse(shown(name) + ": found beside " + shown(key.name) +
             "; allowed: keys that do not overlap");
    }
    keys_.push_back(read_key(name, *family_, model, grid_.end()));
  }
  for (const scenario::Column* const column : columns) {
    if (std::ranges::find(state_columns, column->name) == state_columns.end()) continue;
    columns_.push_back(column);
    for (const SensitivityKey& key : keys_) {
      const auto known = scenario::number_key(key.name);
      names_.push_back("d(" + std::string(column->name) + ")/d(" + key.name + ")");
      units_.push_back(
          ratio(column->unit, known ? std::string(yaml::si_unit(known->dimension)) : ""));
      meanings_.push_back("derivative by " + key.name + " of: " + std::string(column->meaning));
    }
  }
}

void Sensitivity::add_headers(std::vector<file::ColumnHeader>& headers) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    headers.push_back({names_[i], units_[i], meanings_[i]});
  }
}

CasesResult Sensitivity::run_neighbors(Watch& watch) const {
  CasesRequest request{*family_, 1 + offsets.size() * keys_.size()};
  request.in_lanes = false;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    std::vector<double> values(request.count, keys_[k].value);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      values[1 + offsets.size() * k + i] += offsets[i] * keys_[k].step;
    }
    request.keys.push_back({keys_[k].name, std::move(values)});
  }
  for (const scenario::Column* const column : columns_) request.columns.emplace_back(column->name);
  for (const scenario::Measure& measure : measures_) request.measures.push_back(measure.name);
  return run_cases(request, watch);
}

std::vector<std::vector<double>> Sensitivity::find(RunResult& run, Watch& watch) const {
  record::RunSummary& summary = run.summary;
  const CasesResult runs = run_neighbors(watch);
  if (runs.code == ExitCode::interrupted && run.code != ExitCode::interrupted) {
    run.code = ExitCode::interrupted;
    summary.status = summary.reason_code = "interrupted";
    summary.reason = "interrupted before all derivatives were known; the rows are complete.";
  }
  for (const scenario::Measure& measure : measures_) {
    summary.gradients.emplace_back(measure.name, record::RunSummary::Numbers{});
  }
  summary.unreliable.emplace();
  std::vector<std::vector<double>> found(names_.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const std::string& key = keys_[k].name;
    const double step = keys_[k].step;
    std::string doubts;
    const auto doubt = [&](const std::string& of, double time) {
      summary.unreliable->push_back({key, of, time});
      doubts += (doubts.empty() ? "" : ", ") + of +
                (std::isnan(time) ? " (null)" : " (from t = " + short_number(time) + " s)");
    };
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      std::vector<Derivative> rows;
      double largest = 0, size = 0;
      for (std::size_t row = 0; row < summary.rows; ++row) {
        const Five f = around(runs.columns[c], runs.times, row, k);
        rows.push_back(derivative(f, step));
        found[c * keys_.size() + k].push_back(rows.back().value);
        largest = std::fmax(largest, std::abs(rows.back().value));  // not NaN
        size = std::fmax(size, std::abs(f[2]));
      }
      const auto first = std::ranges::find_if(rows, [&](const Derivative& estimate) {
        return !is_reliable(estimate, largest, size, step);
      });
      if (first == rows.end()) continue;
      doubt(std::string(columns_[c]->name), grid_[static_cast<std::size_t>(first - rows.begin())]);
    }
    for (std::size_t m = 0; m < measures_.size(); ++m) {
      const Five f = around(runs.measures[m], 1, 0, k);
      const Derivative estimate = derivative(f, step);
      const bool all = std::ranges::all_of(f, [](double of) { return std::isfinite(of); });
      double largest = 0;  // slope; where it changes its sign, the derivative is no measure
      for (std::size_t i = 1; i < f.size(); ++i) {
        largest = std::max(largest, std::abs(f[i] - f[i - 1]) / step);
      }
      const bool good = all && is_reliable(estimate, largest, std::abs(f[2]), step);
      summary.gradients[m].second.emplace_back(key, good ? estimate.value : no_number);
      if (!good) doubt(measures_[m].name, no_number);
    }
    if (doubts.empty()) continue;
    summary.warnings.push_back(
        "note: unreliable derivatives by " + key + ": " + doubts +
        "; differences of runs disagree there, as at a kink, a grazing event or a rounded command" +
        trouble(runs.status, k));
  }
  return found;
}

}  // namespace bbsim::api
