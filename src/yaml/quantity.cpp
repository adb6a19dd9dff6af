// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/quantity.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "base/text.hpp"

namespace bbsim::yaml {
namespace {

// A normal double is a value; so is zero if the exact value is zero.
Quantity checked(double value, bool zero) {
  if (!std::isfinite(value)) return {{}, ", too large for a double (at most 1.8e308)"};
  const bool lossy = std::abs(value) < std::numeric_limits<double>::min();
  if (!lossy || zero) return {value, {}};
  return {{}, ", too small for a double (0, or at least 2.3e-308 in size)"};
}

// 1 unit = 10^power (factor + rest) in SI. `rest` is the rounding error of `factor`; with it, one
// fused multiplication rounds the converted value correctly in all but rare cases.
struct Unit {
  std::string_view name;
  int power = 0;
  double factor = 1, rest = 0;
};

constexpr Unit degree(std::string_view name) {
  return {name, 0, 0.017453292519943295, 2.9486522708701687e-19};  // pi / 180
}
constexpr Unit per_minute(std::string_view name) {
  return {name, 0, 0.10471975511965978, -5.1697025413851275e-18};  // 2 pi / 60
}
constexpr Unit turns(std::string_view name, int power) {
  return {name, power, 6.283185307179586, 2.4492935982947064e-16};  // 2 pi
}
constexpr Unit per_hour(std::string_view name) {
  return {name, 0, 0.2777777777777778, -1.2335811384723961e-17};  // 1000 / 3600
}

constexpr std::array length_units = {Unit{"m"},      Unit{"km", 3},  Unit{"cm", -2},
                                     Unit{"mm", -3}, Unit{"um", -6}, Unit{"nm", -9}};
constexpr std::array mass_units = {Unit{"kg"}, Unit{"g", -3}, Unit{"mg", -6}};
constexpr std::array time_units = {Unit{"s"},      Unit{"ms", -3},     Unit{"us", -6},
                                   Unit{"ns", -9}, Unit{"min", 0, 60}, Unit{"h", 0, 3600}};
constexpr std::array angle_units = {Unit{"rad"}, Unit{"mrad", -3}, degree("deg")};
constexpr std::array angular_rate_units = {Unit{"rad/s"},    Unit{"mrad/s", -3}, degree("deg/s"),
                                           turns("Hz", 0),   turns("mHz", -3),   turns("kHz", 3),
                                           per_minute("rpm")};
constexpr std::array velocity_units = {Unit{"m/s"}, Unit{"cm/s", -2}, Unit{"mm/s", -3},
                                       per_hour("km/h")};
constexpr std::array acceleration_units = {Unit{"m/s^2"}, Unit{"cm/s^2", -2}, Unit{"mm/s^2", -3}};
constexpr std::array force_units = {Unit{"N"}, Unit{"mN", -3}, Unit{"kN", 3}};
constexpr std::array torque_units = {Unit{"N m"}, Unit{"mN m", -3}, Unit{"N cm", -2},
                                     Unit{"N mm", -3}};

struct Description {
  Dimension dimension;
  std::string_view noun, plural, example;
  std::span<const Unit> units;
};

constexpr std::array descriptions = {
    Description{Dimension::number, "a number", "numbers", "1", {}},
    Description{Dimension::length, "a length", "lengths", "0.01 or \"1 cm\"", length_units},
    Description{Dimension::mass, "a mass", "masses", "0.1 or \"100 g\"", mass_units},
    Description{Dimension::time, "a time", "times", "0.02 or \"20 ms\"", time_units},
    Description{Dimension::angle, "an angle", "angles", "0.1 or \"4 deg\"", angle_units},
    Description{Dimension::angular_rate, "an angular rate", "angular rates", "3 or \"0.5 Hz\"",
                angular_rate_units},
    Description{Dimension::velocity, "a velocity", "velocities", "0.1 or \"10 cm/s\"",
                velocity_units},
    Description{Dimension::acceleration, "an acceleration", "accelerations",
                "9.81 or \"9.81 m/s^2\"", acceleration_units},
    Description{Dimension::force, "a force", "forces", "0.01 or \"10 mN\"", force_units},
    Description{Dimension::torque, "a torque", "torques", "0.01 or \"10 mN m\"", torque_units},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    if (descriptions[i].dimension != static_cast<Dimension>(i)) return false;
  }
  return true;
}
static_assert(in_order(), "descriptions stand in the order of enum Dimension");

const Description& description(Dimension dimension) {
  return descriptions[static_cast<std::size_t>(dimension)];
}

const Unit* find_unit(std::span<const Unit> units, std::string_view name) {
  for (const Unit& unit : units) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

struct Spelling {
  std::string_view typographic, plain;
};
constexpr std::array spellings = {Spelling{"\u00b5", "u"},     // micro sign
                                  Spelling{"\u03bc", "u"},     // Greek mu
                                  Spelling{"\u00b2", "^2"},    // superscript two
                                  Spelling{"\u00b0", "deg"}};  // degree sign

std::string plain_spelling(std::string_view unit) {
  std::string result;
  while (!unit.empty()) {
    const auto* const known = std::ranges::find_if(spellings, [&](const Spelling& spelling) {
      return unit.starts_with(spelling.typographic);
    });
    result += known == spellings.end() ? unit.substr(0, 1) : known->plain;
    unit.remove_prefix(known == spellings.end() ? 1 : known->typographic.size());
  }
  return result;
}

Quantity convert(const Decimal& decimal, const Unit& unit) {
  const Quantity read = to_double(decimal, unit.power);
  if (!read.value) return read;
  const double number = *read.value;
  return checked(std::fma(number, unit.factor, number * unit.rest), number == 0);
}

bool is_infinite_or_nan(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  if (!text.empty() && text.front() == '.') text.remove_prefix(1);
  const std::string word = lower(text);
  return word == "nan" || word == "inf" || word == "infinity";
}

std::string unit_fault(std::string_view unit, Dimension dimension) {
  if (unit.front() == ',') return ", with a comma in place of the decimal point";
  const std::string name = plain_spelling(unit);
  for (const Description& description : descriptions) {
    if (find_unit(description.units, name) != nullptr)
      return std::string(", ").append(description.noun);
  }
  if (dimension == Dimension::number) return "";
  const Description& wanted = description(dimension);
  return ", in an unknown unit (units of " + std::string(wanted.noun) +
         " are: " + joined(wanted.units, &Unit::name) + ")";
}

// Larger exponents overflow or underflow with every mantissa that a file of bounded size can hold.
constexpr long exponent_limit = 100'000'000;

// The power of ten just above the decimal mantissa: 2 for 12.3, -1 for 0.012.
long leading_power(std::string_view mantissa) {
  const auto first = static_cast<long>(mantissa.find_first_of("123456789"));
  const auto point = static_cast<long>(std::min(mantissa.find('.'), mantissa.size()));
  return first < point ? point - first : point + 1 - first;
}

}  // namespace

std::string_view noun(Dimension dimension) {
  return description(dimension).noun;
}
std::string_view plural(Dimension dimension) {
  return description(dimension).plural;
}
std::string_view si_unit(Dimension dimension) {
  const std::span<const Unit> units = description(dimension).units;
  return units.empty() ? "" : units.front().name;  // the SI unit is the first
}

Dimension dimension_of(std::string_view unit) {
  for (const Description& description : descriptions) {
    if (!description.units.empty() && description.units.front().name == unit)
      return description.dimension;
  }
  return Dimension::number;
}

std::string unit_names(Dimension dimension) {
  return joined(description(dimension).units, &Unit::name);
}

double UnitScale::in_si(double number) const {
  const double ten = std::pow(10.0, std::abs(power));  // exact
  const double scaled = power < 0 ? number / ten : number * ten;
  return std::fma(scaled, factor, scaled * rest);
}

std::optional<UnitScale> unit_scale(std::string_view name, Dimension dimension) {
  const Unit* const unit = find_unit(description(dimension).units, plain_spelling(trimmed(name)));
  if (unit == nullptr) return {};
  return UnitScale{unit->power, unit->factor, unit->rest};
}

std::string_view example(Dimension dimension) {
  return description(dimension).example;
}

Quantity read_quantity(std::string_view text, bool quoted, Dimension dimension) {
  text = trimmed(text);
  if (is_infinite_or_nan(text)) return {{}, ", which is not finite"};
  const Decimal decimal = leading_decimal(text);
  if (decimal.length == 0) return {};

  const std::string_view unit = trimmed(text.substr(decimal.length));
  if (unit.empty()) {
    if (!quoted) return convert(decimal, Unit{});
    const bool takes_unit = dimension != Dimension::number;
    return {{},
            takes_unit ? ", a text (drop the quotes or add a unit)" : ", a text (drop the quotes)"};
  }
  if (const Unit* known = find_unit(description(dimension).units, plain_spelling(unit))) {
    return convert(decimal, *known);
  }
  return {{}, unit_fault(unit, dimension)};
}

std::optional<double> value_in(std::string_view text, std::string_view unit) {
  text = trimmed(text);
  const Dimension dimension = dimension_of(unit);
  if (dimension == Dimension::number && unit != "1" && text.ends_with(unit)) {
    text = trimmed(text.substr(0, text.size() - unit.size()));
  }
  const std::optional<double> value = read_quantity(text, false, dimension).value;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

Decimal leading_decimal(std::string_view text) {
  // from_chars takes no plus sign, and reads words such as "inf", too.
  const bool plus = text.starts_with('+');
  const std::string_view digits = text.substr(plus || text.starts_with('-') ? 1 : 0);
  if (digits.find_first_of("0123456789.") != 0) return {};
  const char *const begin = text.data() + (plus ? 1 : 0), *const end = text.data() + text.size();
  double value = 0;
  const auto [point, error] = std::from_chars(begin, end, value, std::chars_format::fixed);
  if (error == std::errc::invalid_argument) return {};
  const char* const last = std::from_chars(begin, end, value).ptr;

  Decimal decimal{{begin, static_cast<std::size_t>(point - begin)},
                  0,
                  static_cast<std::size_t>(last - text.data())};
  if (last == point) return decimal;
  const char* const exponent = point + (point[1] == '+' ? 2 : 1);
  if (std::from_chars(exponent, last, decimal.exponent).ec != std::errc{}) {
    decimal.exponent = *exponent == '-' ? -exponent_limit : exponent_limit;
  }
  decimal.exponent = std::clamp(decimal.exponent, -exponent_limit, exponent_limit);
  return decimal;
}

Quantity to_double(const Decimal& decimal, int shift) {
  if (decimal.mantissa.find_first_of("123456789") == std::string_view::npos) {
    return {decimal.mantissa.front() == '-' ? -0.0 : 0.0, {}};
  }
  const long exponent = decimal.exponent + shift;
  const std::string text = std::string(decimal.mantissa) + 'e' + std::to_string(exponent);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) {
    value = exponent + leading_power(decimal.mantissa) > 0 ? HUGE_VAL : 0;
  }
  return checked(value, false);
}

}  // namespace bbsim::yaml
