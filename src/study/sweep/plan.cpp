#include "study/sweep/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "model/rig/noise.hpp"
#include "scenario/independent.hpp"
#include "scenario/problems.hpp"
#include "scenario/quantity.hpp"

namespace bbsim::study {
namespace {

using Kind = input::VariationSpec::Kind;
using Setting = ScenarioFamily::Setting;

constexpr double most_cases = 1e12;

// SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): a bijection that leaves no pattern of its
// argument, so that counting through arguments is as good as a generator with a state.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31U);
}

// FNV-1a
std::uint64_t hash(const std::string& text) {
  std::uint64_t value = 0xCBF29CE484222325U;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  return value;
}

// a b + c d, rounded once or twice: round numbers stay round.
double sum_of_products(double a, double b, double c, double d) {
  const double ab = a * b, cd = c * d, sum = ab + cd;
  const double lost_in_sum = std::abs(ab) > std::abs(cd) ? (ab - sum) + cd : (cd - sum) + ab;
  return sum + (lost_in_sum + std::fma(a, b, -ab) + std::fma(c, d, -cd));
}

// Value i of `count`; the first and the last are exact.
double spaced(const Axis& axis, std::size_t i) {
  if (i == 0) return axis.from;
  if (i + 1 == axis.count) return axis.to;
  const double before = static_cast<double>(i), after = static_cast<double>(axis.count - 1 - i);
  const double all = static_cast<double>(axis.count - 1);
  if (axis.kind == Kind::log) {
    const double first = std::log(std::abs(axis.from)), last = std::log(std::abs(axis.to));
    return std::copysign(std::exp((first * after + last * before) / all), axis.from);
  }
  return sum_of_products(axis.from, after, axis.to, before) / all;
}

double listed(const Axis& axis, std::size_t i) {
  if (axis.kind != Kind::list) return spaced(axis, i);
  return axis.numeric ? axis.numbers[i] : static_cast<double>(i);
}

std::string value_text(const Axis& axis, double value) {
  return axis.numeric ? input::number_text(value) : axis.texts[static_cast<std::size_t>(value)];
}

// Whether the path goes on from another one.
bool within(const std::string& path, const std::string& other) {
  return path.starts_with(other + '.');
}

[[noreturn]] void fail(const std::string& key, const std::string& message) {
  throw InputError(input::shown(key) + ": " + message);
}

}  // namespace

Axis SweepPlan::read_axis(const ScenarioFamily& family, const Variation& variation,
                          std::vector<Setting>& others) const {
  const input::VariationSpec spec = input::parse_variation(variation);
  Axis axis;
  axis.key = variation.key;
  axis.kind = spec.kind;
  axis.count = spec.random() ? 1 : spec.count;
  axis.stream = mixed(mixed(seed_) ^ hash(axis.key));
  std::vector<double> numbers;
  for (const std::string& value : spec.values) {
    others.push_back({variation.key, value});
    const std::optional<double> number = family.read_number(others);
    others.pop_back();
    if (number) numbers.push_back(*number);
  }
  axis.numeric = numbers.size() == spec.values.size();
  if (spec.kind == Kind::list) {
    axis.numeric ? void(axis.numbers = std::move(numbers)) : void(axis.texts = spec.values);
    return axis;
  }
  if (!axis.numeric) {
    fail(variation.key, "found " + input::shown(variation.spec) +
                            ", but the key holds no single number; allowed: list:A,B,C");
  }
  axis.from = numbers[0];
  axis.to = numbers[1];
  if (spec.kind == Kind::log &&
      (axis.from == 0 || axis.to == 0 || (axis.from < 0) != (axis.to < 0))) {
    fail(variation.key, "found " + input::shown(variation.spec) +
                            "; allowed: log from and to numbers of one sign, neither 0");
  }
  if (spec.kind == Kind::normal && !(axis.to >= 0)) {
    fail(variation.key, "found " + input::shown(variation.spec) +
                            "; allowed: normal with a standard deviation of at least 0");
  }
  return axis;
}

SweepPlan::SweepPlan(const ScenarioFamily& family, const Sweep& sweep)
    : combine_(sweep.combine), seed_(static_cast<std::uint64_t>(sweep.seed)) {
  if (sweep.vary.empty()) {
    throw InputError(
        "found no key to vary; allowed: --vary KEY=SPEC, or a sweep block in the scenario");
  }
  // Each key is read with the others at their first values, since the scenario need not be complete
  // without.
  std::vector<Setting> firsts;
  for (const Variation& variation : sweep.vary) {
    for (const Setting& other : firsts) {
      if (other.key == variation.key) fail(variation.key, "found twice; allowed: each key once");
      if (within(other.key, variation.key) || within(variation.key, other.key)) {
        fail(variation.key, "found beside " + other.key + "; allowed: keys apart from each other");
      }
    }
    if (variation.key == "sweep" || within(variation.key, "sweep")) {
      fail(variation.key, "found, but a sweep does not vary itself; allowed: any other key");
    }
    firsts.push_back({variation.key, input::parse_variation(variation).values[0]});
  }
  for (std::size_t i = 0; i < sweep.vary.size(); ++i) {
    std::vector<Setting> others = firsts;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    axes_.push_back(read_axis(family, sweep.vary[i], others));
  }

  double cases = 1;
  bool random = false;
  std::size_t longest = 1;
  for (const Axis& axis : axes_) {
    random = random || axis.random();
    longest = std::max(longest, axis.count);
    cases *= static_cast<double>(axis.count);
  }
  if (combine_ == Combine::zip) {
    for (const Axis& axis : axes_) {
      if (axis.random() || axis.count == longest) continue;
      fail(axis.key, "found " + std::to_string(axis.count) + " values, and " +
                         std::to_string(longest) +
                         " of another key; allowed with zip: as many of each");
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

  Scenario first = family.read(settings(0));
  // All of them or none: a key of another sort may change what the others mean.
  const bool independent = std::all_of(axes_.begin(), axes_.end(), [&](const Axis& axis) {
    return axis.numeric && !independent_number(first, axis.key).empty();
  });
  for (Axis& axis : axes_) axis.independent = independent;
}

double SweepPlan::drawn(const Axis& axis, std::size_t number) {
  const std::uint64_t bits = mixed(axis.stream + number);
  const double p = (static_cast<double>(bits >> 12U) + 0.5) * 0x1p-52;
  if (axis.kind == Kind::uniform) return axis.from + p * (axis.to - axis.from);
  return axis.from + axis.to * model::normal_quantile(p);
}

void SweepPlan::values(std::size_t number, double* values) const {
  std::size_t rest = number / samples_;
  for (std::size_t a = axes_.size(); a-- > 0;) {
    const Axis& axis = axes_[a];
    if (axis.random()) {
      values[a] = drawn(axis, number);
    } else if (combine_ == Combine::zip) {
      values[a] = listed(axis, rest);
    } else {
      values[a] = listed(axis, rest % axis.count);
      rest /= axis.count;
    }
  }
}

std::vector<Setting> SweepPlan::settings(std::size_t number) const {
  std::vector<double> at(axes_.size());
  values(number, at.data());
  std::vector<Setting> settings;
  settings.reserve(axes_.size());
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    settings.push_back({axes_[a].key, value_text(axes_[a], at[a])});
  }
  return settings;
}

bool SweepPlan::check(const ScenarioFamily& family, std::size_t first, std::size_t last,
                      const std::function<bool(double)>& goes_on) const {
  const auto told = [&](std::size_t number, std::size_t every) {
    return (number - first) % every != 0 ||
           goes_on(static_cast<double>(number - first) / static_cast<double>(last - first));
  };
  if (!axes_.front().independent) {
    for (std::size_t i = first; i < last; ++i) {
      if (!told(i, 64)) return false;
      static_cast<void>(family.read(settings(i)));
    }
    return true;
  }
  // Ranges have no holes, and the ends of what is listed or drawn between bounds have been read.
  for (const Axis& axis : axes_) {
    if (axis.kind != Kind::normal) continue;
    std::size_t least = first, greatest = first;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = first; i < last; ++i) {
      if (!told(i, 65536)) return false;
      const double value = drawn(axis, i);
      if (value < low) low = value, least = i;
      if (value > high) high = value, greatest = i;
    }
    if (first == last) continue;
    static_cast<void>(family.read(settings(least)));
    static_cast<void>(family.read(settings(greatest)));
  }
  return true;
}

}  // namespace bbsim::study
