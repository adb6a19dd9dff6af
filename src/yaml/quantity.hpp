// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers and quantities ("10 cm") as text -> doubles in SI units and radians.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bbsim::yaml {

// What a quantity measures; its SI unit is m, kg, s, rad, rad/s, m/s, m/s^2, N or N m. `number` has
// none.
enum class Dimension {
  number,
  length,
  mass,
  time,
  angle,
  angular_rate,
  velocity,
  acceleration,
  force,
  torque
};

// The quantity with its article: "a length".
[[nodiscard]] std::string_view noun(Dimension dimension);

// The quantity in the plural: "lengths".
[[nodiscard]] std::string_view plural(Dimension dimension);

// The SI unit, in which values are: "rad/s"; empty of a number.
[[nodiscard]] std::string_view si_unit(Dimension dimension);

// The quantity that has this SI unit; `number` where none has.
[[nodiscard]] Dimension dimension_of(std::string_view si_unit);

// The names of a dimension's units, SI first: "m, km, cm, mm, um, nm".
[[nodiscard]] std::string unit_names(Dimension dimension);

// A unit, by what makes SI of numbers in it: 10^power times (factor + rest), `rest` being what
// rounding took from the factor.
struct UnitScale {
  int power = 0;
  double factor = 1, rest = 0;

  // Rounded once, where the factor is 1 and the power within 22; twice otherwise.
  [[nodiscard]] double in_si(double number) const;
};
// That unit of the dimension, if it has one of that name.
[[nodiscard]] std::optional<UnitScale> unit_scale(std::string_view name, Dimension dimension);

// A value of that kind as one may write it: 0.01 or "1 cm".
[[nodiscard]] std::string_view example(Dimension dimension);

// A value in SI units, or what is wrong with the text: a phrase to follow it in a sentence, such
// as ", a length", possibly empty.
struct Quantity {
  std::optional<double> value;
  std::string fault;
};

// Reads a number (SI) or a number and a unit of `dimension`. Independent of the locale. Powers of
// ten between a unit and SI are applied to the decimal text, so "10 cm" is exactly the double 0.1.
// A quoted plain number is text, hence a fault.
[[nodiscard]] Quantity read_quantity(std::string_view text, bool quoted, Dimension dimension);

}  // namespace bbsim::yaml
