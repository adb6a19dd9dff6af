// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.hpp"
#include "base/fnv1a.hpp"
#include "base/noise.hpp"
#include "base/number_text.hpp"
#include "scenario/independent.hpp"
#include "yaml/problems.hpp"
#include "yaml/quantity.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::sweep {
namespace {

using Way = scenario::VariationSpec::Kind;
using Setting = ScenarioFamily::Setting;

constexpr double most_cases = 1e12;

// SplitMix64 (Steele, Lea and Flood, OOPSLA 2014). It is a bijection that hides every pattern of
// its argument, so hashing a counter is as good as a generator with a state.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31U);
}

// a b + c d with one or two roundings, so that round numbers stay round.
double sum_of_products(double a, double b, double c, double d) {
  const double ab = a * b, cd = c * d, sum = ab + cd;
  const double lost_in_sum = std::abs(ab) > std::abs(cd) ? (ab - sum) + cd : (cd - sum) + ab;
  return sum + (lost_in_sum + std::fma(a, b, -ab) + std::fma(c, d, -cd));
}

// Value i of `count`; the first and the last are exact.
double spaced(const PlanAxis& axis, std::size_t i) {
  if (i == 0) return axis.from;
  if (i + 1 == axis.count) return axis.to;
  const double before = static_cast<double>(i), after = static_cast<double>(axis.count - 1 - i);
  const double all = static_cast<double>(axis.count - 1);
  if (axis.kind == Way::log) {
    // To base 10, so that powers of ten stay round.
    const double first = std::log10(std::abs(axis.from)), last = std::log10(std::abs(axis.to));
    return std::copysign(std::pow(10, (first * after + last * before) / all), axis.from);
  }
  const double sum = sum_of_products(axis.from, after, axis.to, before);
  // The products may overflow although the value does not.
  return std::isfinite(sum) ? sum / all : axis.from * (after / all) + axis.to * (before / all);
}

double listed(const PlanAxis& axis, std::size_t i) {
  if (axis.kind != Way::list) return spaced(axis, i);
  return axis.numeric ? axis.numbers[i] : static_cast<double>(i);
}

// A nonzero value of the axis, if it has one. At least one of two evenly spaced values is nonzero.
// One of a distribution's two parameters represents it.
double not_zero(const PlanAxis& axis) {
  if (axis.random()) return axis.from != 0 ? axis.from : axis.to;
  const std::size_t look_at =
      axis.kind == Way::list ? axis.count : std::min<std::size_t>(axis.count, 2);
  for (std::size_t i = 0; i < look_at; ++i) {
    if (listed(axis, i) != 0) return listed(axis, i);
  }
  return 0;
}

std::string value_text(const PlanAxis& axis, double value) {
  return axis.numeric ? number_text(value) + axis.unit
                      : axis.texts[static_cast<std::size_t>(value)];
}

// Whether `path` is a key below `ancestor`.
bool within(const std::string& path, const std::string& ancestor) {
  return yaml::american(path).starts_with(yaml::american(ancestor) + '.');
}

[[noreturn]] void fail(const std::string& key, const std::string& message) {
  throw InputError(yaml::shown(key) + ": " + message);
}

// A key that varies must not be, contain or lie within another one.
void check_apart(const std::string& key, const std::vector<Setting>& others) {
  for (const Setting& setting : others) {
    if (yaml::american(setting.key) == yaml::american(key)) {
      fail(key, "found twice; allowed: each key once");
    }
    if (within(setting.key, key) || within(key, setting.key)) {
      fail(key, "found beside " + setting.key + "; allowed: keys that do not overlap");
    }
  }
  if (key == "sweep" || within(key, "sweep")) {
    fail(key, "found, but a sweep does not vary itself; allowed: any other key");
  }
}

// No case would have the value that --set gives to a varied key.
void check_overrides(const std::string& key, const Source& source) {
  for (const std::string& set : source.overrides) {
    const std::string set_key = set.substr(0, set.find('='));
    if (yaml::american(set_key) != yaml::american(key) && !within(set_key, key)) continue;
    throw InputError("--set " + yaml::shown(set) + ": found, but the sweep varies " +
                     yaml::shown(key) +
                     ", and its values would replace this one; allowed: one of the two");
  }
}

// A variation, parsed.
struct ParsedVariation {
  scenario::VariationSpec spec;
  std::vector<scenario::TiedKey> keys;
};

std::vector<ParsedVariation> parse_variations(const Sweep& sweep, const Source& source) {
  std::vector<ParsedVariation> all;
  std::vector<Setting> seen;
  for (const Variation& variation : sweep.vary) {
    all.push_back({scenario::parse_variation(variation), scenario::tied_keys(variation)});
    const ParsedVariation& parsed = all.back();
    for (const scenario::TiedKey& key : parsed.keys) {
      check_apart(key.path, seen);
      check_overrides(key.path, source);
      for (const std::string& value : parsed.spec.values) {
        if (!scenario::scaled(value, key.factor).empty()) continue;
        fail(variation.key, "found the value " + yaml::shown(value) +
                                ", which is not a number, so a factor cannot scale it; allowed: "
                                "numbers, or keys without factors");
      }
      seen.push_back({key.path, ""});
    }
  }
  return all;
}

// Index of the written value of `other` that occurs with value i of `own` in some case. In a grid
// this is the first one. In a zip it is that of the same case, or of the nearer end if either is a
// range.
std::size_t beside(const scenario::VariationSpec& other, const scenario::VariationSpec& own,
                   std::size_t i, Combine combine) {
  if (combine != Combine::zip || other.random() || own.random()) return 0;
  const std::size_t last = other.values.size() - 1;
  if (other.kind == Way::list && own.kind == Way::list) return std::min(i, last);
  return 2 * i >= own.values.size() ? last : 0;
}

// Problems of the scenario without any settings.
std::vector<Problem> own_problems(const ScenarioFamily& family) {
  try {
    static_cast<void>(family.read({}));
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

// Calls read() for a case with these settings. Adds the case's number to its problems, and all of
// its values unless the problem names one. Leaves the scenario's own problems unchanged.
template <class Read>
auto read_case(const ScenarioFamily& family, std::size_t number,
               const std::vector<Setting>& settings, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    std::string values;
    for (const Setting& setting : settings) {
      values += (values.empty() ? "" : ", ") + yaml::shown(setting.key + '=' + setting.value);
    }
    const std::string name = "case " + std::to_string(number);
    const std::vector<Problem> own = own_problems(family);
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      const bool is_own = std::any_of(own.begin(), own.end(), [&](const Problem& own_problem) {
        return own_problem.where == problem.where && own_problem.message == problem.message;
      });
      if (is_own) continue;
      const bool names_value = problem.where.starts_with("with ");
      problem.where = name + (names_value ? ", " : " (" + values + "), ") + problem.where;
    }
    throw InputError(std::move(problems));
  }
}

// The standard deviation of the first key, in SI: at least 0, whatever values the key may have.
double deviation_of(const ScenarioFamily& family, const Variation& variation,
                    const scenario::VariationSpec& spec, const scenario::TiedKey& key,
                    const std::vector<Setting>& settings) {
  std::string text = scenario::scaled(spec.values[1], std::abs(key.factor));
  std::erase_if(text, [](char c) { return c == '"' || c == '\''; });
  const std::string unit(family.unit_of(key.path, settings));
  const std::optional<double> deviation = yaml::value_in(text, unit);
  if (!deviation || *deviation < 0) {
    fail(variation.key, "found " + yaml::shown(variation.spec) +
                            "; allowed: normal with a standard deviation of at least 0" +
                            (unit == "1" ? "" : ", in " + unit + " or another unit of that kind"));
  }
  return *deviation;
}

}  // namespace

struct SweepPlan::Variations {
  std::vector<ParsedVariation> all;

  // The first case in which variation `which` has its written value i. Empty if that value is a
  // parameter of a distribution.
  [[nodiscard]] std::optional<std::size_t> first_case(std::size_t which, std::size_t i,
                                                      const Sweep& sweep) const {
    const auto count = [](const ParsedVariation& variation) {
      return variation.spec.random() ? std::size_t{1} : variation.spec.count;
    };
    const scenario::VariationSpec& spec = all[which].spec;
    if (spec.random()) return {};
    std::size_t number = spec.kind == Way::list || i == 0 ? i : spec.count - 1;
    for (std::size_t k = which + 1; k < all.size() && sweep.combine == Combine::grid; ++k) {
      number *= count(all[k]);
    }
    return number * static_cast<std::size_t>(sweep.samples.value_or(1));
  }

  // Settings of all keys, with variation `which` at its written value i and the others beside it.
  // The scenario may be incomplete without the others.
  [[nodiscard]] std::vector<Setting> settings(std::size_t which, std::size_t i,
                                              Combine combine) const {
    std::vector<Setting> settings;
    for (const ParsedVariation& variation : all) {
      const bool own = &variation == &all[which];
      const std::size_t at = own ? i : beside(variation.spec, all[which].spec, i, combine);
      for (const scenario::TiedKey& key : variation.keys) {
        settings.push_back({key.path, scenario::scaled(variation.spec.values[at], key.factor)});
      }
    }
    return settings;
  }
};

// Reads the values of the keys of one variation.
void SweepPlan::add_axes(const ScenarioFamily& family, const Sweep& sweep,
                         const Variations& variations, std::size_t which) {
  const Variation& variation = sweep.vary[which];
  const scenario::VariationSpec& spec = variations.all[which].spec;
  const std::vector<scenario::TiedKey>& keys = variations.all[which].keys;
  const std::size_t lead = axes_.size();
  PlanAxis axis;
  axis.kind = spec.kind;
  axis.count = spec.random() ? 1 : spec.count;
  axis.lead = lead;
  // The British and the American spelling of a key draw the same values.
  axis.stream = mixed(mixed(seed_) ^ fnv1a(yaml::british(keys[0].path)));
  std::vector<double> numbers;  // of the first key
  for (std::size_t i = 0; i < (spec.kind == Way::normal ? 1 : spec.values.size()); ++i) {
    const std::vector<Setting> settings = variations.settings(which, i, combine_);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      std::vector<Setting> read = settings;
      std::rotate(read.begin() + static_cast<std::ptrdiff_t>(lead + k),
                  read.begin() + static_cast<std::ptrdiff_t>(lead + k + 1), read.end());
      const auto read_it = [&] { return family.number_at(read.back().key, read); };
      const std::optional<std::size_t> at = variations.first_case(which, i, sweep);
      const auto number = at ? read_case(family, *at, settings, read_it) : read_it();
      axis.numeric = axis.numeric && number;
      if (k == 0 && number) numbers.push_back(*number);
    }
  }
  if (spec.kind == Way::normal && axis.numeric) {
    numbers.push_back(
        deviation_of(family, variation, spec, keys[0], variations.settings(which, 0, combine_)));
  }
  const auto plain = [](const scenario::TiedKey& key) { return key.factor == 1; };
  if (!axis.numeric && !std::all_of(keys.begin(), keys.end(), plain)) {
    fail(variation.key, "found " + yaml::shown(variation.spec) +
                            ", but not all of the keys hold a single number; allowed: numbers, or "
                            "keys without factors");
  }
  const auto tie = [&] {
    for (std::size_t k = 0; k < keys.size(); ++k) {
      axes_.push_back(axis);
      axes_.back().key = keys[k].path;
      axes_.back().factor = keys[k].factor / keys[0].factor;
    }
  };
  if (spec.kind == Way::list) {
    axis.numeric ? void(axis.numbers = std::move(numbers)) : void(axis.texts = spec.values);
    return tie();
  }
  if (!axis.numeric) {
    fail(variation.key, "found " + yaml::shown(variation.spec) +
                            ", but the key holds no single number; allowed: list:A,B,C");
  }
  axis.from = numbers[0];
  axis.to = numbers[1];
  if (spec.kind == Way::log &&
      (axis.from == 0 || axis.to == 0 || (axis.from < 0) != (axis.to < 0))) {
    fail(variation.key, "found " + yaml::shown(variation.spec) +
                            "; allowed: log from and to numbers of one sign, neither 0");
  }
  tie();
}

SweepPlan::SweepPlan(const ScenarioFamily& family, const Sweep& sweep) : combine_(sweep.combine) {
  if (sweep.samples) require_whole("samples", *sweep.samples, 1);
  require_whole("seed", sweep.seed, 0);
  seed_ = static_cast<std::uint64_t>(sweep.seed);
  if (sweep.vary.empty()) {
    throw InputError(
        "found no key to vary; allowed: --vary KEY=SPEC, or a sweep block in the scenario");
  }
  const Variations variations{parse_variations(sweep, family.source())};
  for (std::size_t i = 0; i < sweep.vary.size(); ++i) {
    add_axes(family, sweep, variations, i);
  }

  double cases = 1;
  bool random = false;
  std::size_t longest = 1;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (!is_lead(a)) continue;
    const PlanAxis& axis = axes_[a];
    random = random || axis.random();
    longest = std::max(longest, axis.count);
    cases *= static_cast<double>(axis.count);
  }
  if (combine_ == Combine::zip) {
    for (const PlanAxis& axis : axes_) {
      if (axis.random() || axis.count == longest) continue;
      fail(axis.key, "found " + std::to_string(axis.count) + " values, and " +
                         std::to_string(longest) +
                         " of another key; allowed with zip: equally many of each");
    }
    cases = static_cast<double>(longest);
  }
  if (random && !sweep.samples) {
    throw InputError(
        "samples: missing, but values are drawn; allowed: --samples N, the number of cases to "
        "draw");
  }
  if (!random && sweep.samples) {
    throw InputError("samples: found, but no value is drawn; allowed: only with uniform or normal");
  }
  if (sweep.samples) cases *= *sweep.samples;
  if (cases > most_cases) throw InputError("found more than 1e12 cases; allowed: at most that");
  samples_ = static_cast<std::size_t>(sweep.samples.value_or(1));
  cases_ = static_cast<std::size_t>(cases);

  relate(family);
}

SweepPlan::SweepPlan(const ScenarioFamily& family, std::vector<ListedKey> keys, std::size_t cases)
    : combine_(Combine::zip), cases_(cases) {
  std::vector<Setting> seen;
  for (ListedKey& listed : keys) {
    check_apart(listed.key, seen);
    PlanAxis& axis = axes_.emplace_back();
    axis.key = std::move(listed.key);
    axis.lead = axes_.size() - 1;
    axis.numeric = listed.texts.empty();
    axis.count = cases;
    axis.numbers = std::move(listed.numbers);
    axis.texts = std::move(listed.texts);
    seen.push_back({axis.key, ""});
  }
  if (cases == 0) return;
  find_first(family);
  relate(family);
  // Independent numbers are not read again, so that a wrong one would pass.
  if (independent() && !can_read_extremes(family)) {
    for (PlanAxis& axis : axes_) axis.independent = false;
  }
}

void SweepPlan::find_first(const ScenarioFamily& family) {
  constexpr std::size_t most_tried = 64;
  for (std::size_t i = 0; i < std::min(cases_, most_tried); ++i) {
    first_ = cases_ > most_tried ? sampled(i) : i;
    try {
      static_cast<void>(family.read(settings(first_)));
      return;
    } catch (const InputError&) {  // the last lines report the first case's
    }
  }
  const std::vector<Setting> values = settings(0);
  static_cast<void>(read_case(family, 0, values, [&] { return family.read(values); }));
}

bool SweepPlan::can_read_extremes(const ScenarioFamily& family) const {
  std::vector<double> at(axes_.size());
  values(first_, at.data());
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const auto [least, most] = std::ranges::minmax(axes_[a].numbers);
    for (const double value : {least, most}) {
      std::vector<double> moved = at;
      moved[a] = value;
      try {
        static_cast<void>(family.read(settings_of(moved)));
      } catch (const InputError&) {
        return false;
      }
    }
  }
  return true;
}

void SweepPlan::relate(const ScenarioFamily& family) {
  for (PlanAxis& axis : axes_) {  // a table's offset without a unit is in the unit of the table
    if (!axis.numeric || axis.key.find(".table.offset") == std::string::npos) continue;
    axis.unit = " " + std::string(family.unit_of(axis.key, first_settings()));
  }
  Scenario first = family.read(first_settings());
  // Holds for all axes or for none: a key of another kind may change the meaning of the others.
  const bool independent = std::all_of(axes_.begin(), axes_.end(), [&](const PlanAxis& axis) {
    return axis.numeric && !independent_number(first, axis.key).empty();
  });
  for (PlanAxis& axis : axes_) axis.independent = independent;
}

double SweepPlan::drawn(const PlanAxis& axis, std::size_t number) {
  const std::uint64_t bits = mixed(axis.stream + number);
  const double p = (static_cast<double>(bits >> 12U) + 0.5) * 0x1p-52;
  if (axis.kind == Way::uniform) {
    const double width = axis.to - axis.from;
    return std::isfinite(width) ? axis.from + p * width : (1 - p) * axis.from + p * axis.to;
  }
  return axis.from + axis.to * normal_quantile(p);
}

std::size_t SweepPlan::sampled(std::size_t i) const {
  const double whole = static_cast<double>(i) / std::numbers::phi, part = whole - std::floor(whole);
  return static_cast<std::size_t>(part * static_cast<double>(cases_));
}

std::vector<SweepPlan::ListedKey> SweepPlan::values() const {
  std::vector<ListedKey> keys;
  for (const PlanAxis& axis : axes_) keys.push_back({axis.key});
  std::vector<double> row(axes_.size());
  for (std::size_t number = 0; number < cases_; ++number) {
    values(number, row.data());
    for (std::size_t a = 0; a < row.size(); ++a) {
      const PlanAxis& axis = axes_[a];
      if (axis.numeric) keys[a].numbers.push_back(row[a]);
      if (!axis.numeric) keys[a].texts.push_back(axis.texts[static_cast<std::size_t>(row[a])]);
    }
  }
  return keys;
}

void SweepPlan::values(std::size_t number, double* values) const {
  std::size_t rest = number / samples_;
  for (std::size_t a = axes_.size(); a-- > 0;) {
    const PlanAxis& axis = axes_[a];
    if (!is_lead(a)) continue;
    if (axis.random()) {
      values[a] = drawn(axis, number);
    } else if (combine_ == Combine::zip) {
      values[a] = listed(axis, rest);
    } else {
      values[a] = listed(axis, rest % axis.count);
      rest /= axis.count;
    }
  }
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    // Adding 0 turns -0 into +0.
    if (!is_lead(a)) values[a] = axes_[a].factor * values[axes_[a].lead] + 0.0;
  }
}

std::vector<Setting> SweepPlan::settings(std::size_t number) const {
  std::vector<double> at(axes_.size());
  values(number, at.data());
  return settings_of(at);
}

std::vector<Setting> SweepPlan::settings_of(const std::vector<double>& values) const {
  std::vector<Setting> settings;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    std::string text = value_text(axes_[a], values[a]);
    if (!text.empty()) settings.push_back({axes_[a].key, std::move(text)});
  }
  return settings;
}

std::vector<Setting> SweepPlan::general_settings() const {
  std::vector<double> at;
  for (const PlanAxis& axis : axes_) at.push_back(axis.factor * not_zero(axes_[axis.lead]));
  return settings_of(at);
}

bool SweepPlan::check(const ScenarioFamily& family, std::size_t first, std::size_t last,
                      const std::function<bool(double)>& goes_on) const {
  const auto goes_on_at = [&](std::size_t number, std::size_t every) {
    return (number - first) % every != 0 ||
           goes_on(static_cast<double>(number - first) / static_cast<double>(last - first));
  };
  const auto read = [&](std::size_t number) {
    const std::vector<Setting> values = settings(number);
    static_cast<void>(read_case(family, number, values, [&] { return family.read(values); }));
  };
  if (!independent()) {
    for (std::size_t i = first; i < last; ++i) {
      if (!goes_on_at(i, 64)) return false;
      read(i);
    }
    return true;
  }
  // Ranges have no holes, and the constructor has read all bounds. Normal draws have no bounds, so
  // read their extremes.
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const PlanAxis& axis = axes_[a];
    if (axis.kind != Way::normal || !is_lead(a)) continue;
    std::size_t least = first, greatest = first;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = first; i < last; ++i) {
      if (!goes_on_at(i, 65536)) return false;
      const double value = drawn(axis, i);
      if (value < low) low = value, least = i;
      if (value > high) high = value, greatest = i;
    }
    if (first == last) continue;
    read(least);
    read(greatest);
  }
  return true;
}

}  // namespace bbsim::sweep
