// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/free_key.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "base/text.hpp"
#include "scenario/key_value.hpp"
#include "scenario/value_in.hpp"

namespace bbsim::fit {
namespace {

constexpr double usual_delay = 0.2;  // s; a camera's delay is at most that

// Typical magnitude for a dimension; empty if magnitudes span orders of magnitude, such as those of
// friction torques.
std::optional<double> usual(yaml::Dimension dimension) {
  switch (dimension) {
    case yaml::Dimension::length:
    case yaml::Dimension::time:
    case yaml::Dimension::angle:
    case yaml::Dimension::velocity:
    case yaml::Dimension::force:
      return 0.01;
    default:
      return {};
  }
}

// A change of a key that probably has a visible effect.
double scale_from(double start, yaml::Dimension dimension) {
  constexpr double unknown = 0.1;
  const std::optional<double> size = usual(dimension);
  if (size) return std::max(std::abs(start), *size);
  return start == 0 ? unknown : std::abs(start);
}

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("--free: " + what);
}

// Text after the leading number of `text`; empty if there is no such number.
std::optional<std::string_view> after_number(std::string_view text) {
  text = trimmed(text);
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return {};
  return trimmed(text.substr(static_cast<std::size_t>(rest - text.data())));
}

// Reads FROM:TO. If only TO has a unit, it applies to FROM, too.
void read_bounds(std::string_view text, FreeKey& key) {
  const std::string name = shown(key.name);
  const std::size_t colon = text.find(':');
  std::optional<double> from, to;
  if (colon != std::string_view::npos) {
    const std::string_view last = text.substr(colon + 1);
    std::string first(text.substr(0, colon));
    const auto unit = after_number(last);
    if (unit && after_number(first) == "") first += " " + std::string(*unit);
    from = scenario::value_in(first, key.unit);
    to = scenario::value_in(last, key.unit);
  }
  if (!from || !to || !(*from < *to)) {
    refuse(name + ": found " + quoted(text) +
           "; allowed: FROM:TO with FROM below TO, numbers in SI units or with a unit" +
           (key.unit.empty() ? "" : " of " + key.unit));
  }
  if (*from < key.lower || *to > key.upper) {
    refuse(name + ": found " + quoted(text) + "; allowed: values from " + number_text(key.lower) +
           " to " + number_text(key.upper));
  }
  key.lower = *from;
  key.upper = *to;
}

void refuse_starts(std::string_view text) {
  const std::string_view key = trimmed(text.substr(0, text.find('=')));
  for (const std::string_view of_start : {"ball.position", "ball.velocity"}) {
    if (!key.starts_with(of_start)) continue;
    refuse(shown(key) +
           ": each window's start is fitted anyway; allowed: any other key that is a number");
  }
}

}  // namespace

double FreeKey::value(double u) const {
  const double raw = logarithmic ? start * std::exp(u) : start + scale * u;
  // value(number(bound)) equals the bound only within rounding.
  constexpr double rounding = 1e-12;
  if (raw >= upper - rounding * std::abs(upper)) return upper;
  if (raw <= lower + rounding * std::abs(lower)) return lower;
  return raw;
}

double FreeKey::number(double value) const {
  return logarithmic ? std::log(value / start) : (value - start) / scale;
}

double FreeKey::slope(double u) const {
  return logarithmic ? value(u) : scale;
}

ScenarioFamily::Setting FreeKey::setting(double value) const {
  return scenario::NamedNumber{name, {}, unit}.setting(value);
}

FreeKey read_free_key(std::string_view text, const ScenarioFamily& family) {
  const std::size_t equals = text.find('=');
  FreeKey key;
  key.name = trimmed(text.substr(0, equals));
  const std::string name = shown(key.name);
  const scenario::NamedNumber number = scenario::number_named("--free", key.name, family);
  key.unit = number.unit;
  const yaml::Range& range = number.key.range;
  key.lower = range.above.value_or(range.at_least.value_or(-unlimited));
  key.upper = range.at_most.value_or(unlimited);
  if (equals != std::string_view::npos) read_bounds(trimmed(text.substr(equals + 1)), key);
  const bool bounded = std::isfinite(key.lower) && std::isfinite(key.upper);

  std::optional<double> start = number.value;
  if (equals != std::string_view::npos && (!start || *start < key.lower || *start > key.upper)) {
    start = key.lower > 0 ? std::sqrt(key.lower * key.upper) : (key.lower + key.upper) / 2;
  }
  if (!start) {
    // The reader reports a misspelled key or a key of another law.
    static_cast<void>(family.read({key.setting(1)}));
    refuse(name + ": the scenario gives no value to start from; allowed: " + name +
           "=FROM:TO, or a value in the scenario");
  }
  key.start = *start;
  key.logarithmic = key.start > 0 && (range.above >= 0.0 || key.lower > 0);
  const bool given = equals != std::string_view::npos && bounded;
  key.scale = given ? (key.upper - key.lower) / 10 : scale_from(key.start, number.key.dimension);
  // Throws if the scene does not take the key.
  static_cast<void>(family.read({key.setting(key.start)}));
  return key;
}

bool is_of_log(std::string_view text) {
  return trimmed(text.substr(0, text.find('='))).starts_with("log.");
}

FreeKey read_log_key(std::string_view text, const std::vector<const scenario::Column*>& columns) {
  const std::size_t equals = text.find('=');
  FreeKey key;
  key.name = trimmed(text.substr(0, equals));
  key.lower = -unlimited;
  key.upper = unlimited;
  const auto is = [&](std::string_view column, std::string_view property) {
    return key.name == "log." + std::string(column) + "." + std::string(property);
  };
  if (key.name == "log.delay") {
    key.of = FreeKey::Of::delay;
    key.unit = "s";
    key.lower = 0;
    key.upper = usual_delay;
  }
  std::string names;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string_view column = columns[c]->name;
    names += ", log." + std::string(column) + ".scale, log." + std::string(column) + ".offset";
    if (is(column, "scale")) {
      key.of = FreeKey::Of::scale;  // negative: a mirrored axis
    } else if (is(column, "offset")) {
      key.of = FreeKey::Of::offset;
      key.unit = columns[c]->unit;
    } else {
      continue;
    }
    key.column = c;
  }
  const std::string name = shown(key.name);
  if (key.of == FreeKey::Of::scenario) refuse(name + ": allowed for a log: log.delay" + names);
  if (equals != std::string_view::npos) {
    if (key.of == FreeKey::Of::delay) key.upper = unlimited;
    read_bounds(trimmed(text.substr(equals + 1)), key);
  }
  const bool bounded = std::isfinite(key.lower) && std::isfinite(key.upper);
  const bool is_scale = key.of == FreeKey::Of::scale;
  key.logarithmic = is_scale && key.lower > 0;
  key.start = is_scale ? 1 : 0;
  if (key.of == FreeKey::Of::delay || key.start < key.lower || key.start > key.upper) {
    key.start = (key.lower + key.upper) / 2;
  }
  key.scale =
      bounded ? (key.upper - key.lower) / 10
              : scale_from(key.start, is_scale ? yaml::Dimension::number : yaml::Dimension::length);
  return key;
}

void add_free_key(std::vector<FreeKey>& keys, FreeKey key) {
  if (std::ranges::find(keys, key.name, &FreeKey::name) != keys.end()) {
    refuse(shown(key.name) + " is given twice");
  }
  keys.push_back(std::move(key));
}

std::vector<FreeKey> read_free_keys(const std::vector<std::string>& texts,
                                    const ScenarioFamily& family) {
  std::vector<FreeKey> keys;
  for (const std::string& text : texts) {
    if (is_of_log(text)) continue;
    refuse_starts(text);
    add_free_key(keys, read_free_key(text, family));
  }
  return keys;
}

}  // namespace bbsim::fit
