// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/run_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "scenario/family.hpp"
#include "scenario/key_value.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::api {
namespace {

// States, by the names of their output columns.
constexpr std::array state_columns = {
    "x",     "y",        "vx",         "vy",        "spin",        "gamma",      "phi",
    "theta", "phi_rate", "theta_rate", "servo_phi", "servo_theta", "servo_third"};

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("--sensitivity: " + what);
}

std::string unit_of(std::string_view key) {
  const auto known = scenario::number_key(key);
  return known ? std::string(yaml::si_unit(known->dimension)) : "";
}

study::VariedKey read_key(const std::string& key,
                          const std::shared_ptr<const ScenarioFamily>& family) {
  const std::string name = shown(key);
  for (const std::string_view section : {"time.", "solver.", "output.", "sweep."}) {
    if (!key.starts_with(section)) continue;
    refuse(name +
           ": found a key of the computation; allowed: keys of the scene, such as ball.radius");
  }
  const scenario::NamedNumber number = scenario::number_named("--sensitivity", key, *family);
  const std::optional<double>& value = number.value;
  if (!value) {
    static_cast<void>(family->read({number.setting(1)}));
    refuse(name +
           ": the scenario gives it no single number; allowed: a key with a number, such "
           "as ball.radius");
  }
  // Wide enough for little rounding, and within what the scene accepts.
  study::VariedKey varied{key, *value, 0x1p-9, [family, number](double at) {
                            return family->read({number.setting(at)});
                          }};
  if (*value != 0) varied.step = std::exp2(std::floor(std::log2(std::abs(*value))) - 6);
  static_cast<void>(varied.scenario(*value));
  const auto fits = [&] {
    try {
      static_cast<void>(varied.scenario(*value - 4 * varied.step));
      static_cast<void>(varied.scenario(*value + 4 * varied.step));
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  for (int halvings = 0; !fits(); ++halvings) {
    constexpr int most_halvings = 20;
    if (halvings == most_halvings) {
      refuse(
          name + ": found " + number_text(*value) +
          ", but a derivative needs valid values on both sides; allowed: a value inside its range");
    }
    varied.step /= 2;
  }
  return varied;
}

std::string ratio(std::string_view above, const std::string& below) {
  if (below.empty()) return std::string(above);
  if (above == below) return "1";
  const bool plain = below.find_first_of(" /^") == std::string::npos;
  return std::string(above) + "/" + (plain ? below : "(" + below + ")");
}

std::string name_of_gradient(std::string_view of, const std::string& key) {
  return "d(" + std::string(of) + ")/d(" + key + ")";
}

}  // namespace

std::vector<study::VariedKey> sensitivity_keys(const RunRequest& request) {
  std::vector<study::VariedKey> keys;
  if (request.sensitivity.empty()) return keys;
  if (request.scenario.solver.error) {
    refuse(
        "found with solver.error, which repeats the run several times; allowed: with tolerances");
  }
  const auto family = std::make_shared<const ScenarioFamily>(request.scenario.source);
  for (const std::string& key : scenario::split_measures(request.sensitivity)) {
    if (std::ranges::find(keys, key, &study::VariedKey::name) != keys.end()) {
      refuse(shown(key) + " is given twice");
    }
    keys.push_back(read_key(key, family));
  }
  return keys;
}

GradientColumns::GradientColumns(const std::vector<const scenario::Column*>& columns,
                                 const std::vector<study::VariedKey>& varied) {
  for (const scenario::Column* const column : columns) {
    if (std::ranges::find(state_columns, column->name) == state_columns.end()) continue;
    for (std::size_t k = 0; k < varied.size(); ++k) {
      const std::string& key = varied[k].name;
      of.push_back(column);
      keys.push_back(k);
      names.push_back(name_of_gradient(column->name, key));
      units.push_back(ratio(column->unit, unit_of(key)));
      meanings.push_back("derivative by " + key + " of: " + std::string(column->meaning));
    }
  }
}

void GradientColumns::add_headers(std::vector<file::ColumnHeader>& headers) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    headers.push_back({names[i], units[i], meanings[i]});
  }
}

std::vector<std::vector<double>> GradientColumns::values(
    const study::Sensitivity& sensitivity) const {
  std::vector<std::vector<double>> values;
  for (std::size_t i = 0; i < of.size(); ++i) {
    values.push_back(sensitivity.column_gradient(*of[i], keys[i]));
  }
  return values;
}

void add_gradients(const Simulation& made, const std::vector<scenario::Measure>& measures,
                   const std::vector<study::VariedKey>& keys, record::RunSummary& summary) {
  for (std::size_t m = 0; m < measures.size(); ++m) {
    auto& [name, by_key] =
        summary.gradients.emplace_back(measures[m].name, record::RunSummary::Numbers{});
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const double gradient = made.gradients[k][m];
      by_key.emplace_back(keys[k].name, gradient);
      if (std::isnan(gradient)) {
        summary.warnings.push_back("note: " + name_of_gradient(name, keys[k].name) +
                                   " is not a number: the measure has no value, or has a jump or a "
                                   "kink at this value of the key");
      }
    }
  }
}

}  // namespace bbsim::api
