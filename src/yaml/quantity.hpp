// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads numbers and quantities ("10 cm") as doubles in SI units and radians.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace bbsim::yaml {

// The dimension of a quantity. Its SI unit is m, kg, s, rad, rad/s, m/s, m/s^2, N or N m; `number`
// has no unit.
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

// The dimension with its article: "a length".
[[nodiscard]] std::string_view noun(Dimension dimension);

// The dimension in the plural: "lengths".
[[nodiscard]] std::string_view plural(Dimension dimension);

// The SI unit: "rad/s"; empty for a number.
[[nodiscard]] std::string_view si_unit(Dimension dimension);

// The dimension with this SI unit; `number` if there is none.
[[nodiscard]] Dimension dimension_of(std::string_view si_unit);

// The names of the dimension's units, SI first: "m, km, cm, mm, um, nm".
[[nodiscard]] std::string unit_names(Dimension dimension);

// The factor from a unit to SI: 10^power (factor + rest). `rest` is the rounding error of `factor`.
struct UnitScale {
  int power = 0;
  double factor = 1, rest = 0;

  // Rounds once if the factor is 1 and |power| <= 22, otherwise twice.
  [[nodiscard]] double in_si(double number) const;
};
// The dimension's unit with this name, if there is one.
[[nodiscard]] std::optional<UnitScale> unit_scale(std::string_view name, Dimension dimension);

// An example value of the dimension: 0.01 or "1 cm".
[[nodiscard]] std::string_view example(Dimension dimension);

// A value in SI units, or a fault. A fault is a phrase for the middle of a sentence, such as ", a
// length"; it may be empty.
struct Quantity {
  std::optional<double> value;
  std::string fault;
};

// Reads a number (in SI) or a number with a unit of `dimension`. Independent of the locale. Powers
// of ten scale the decimal text, so "10 cm" is exactly the double 0.1. A quoted number without a
// unit is text, which is a fault.
[[nodiscard]] Quantity read_quantity(std::string_view text, bool quoted, Dimension dimension);

// The finite number in SI units, or the quantity with a unit of the same dimension: "5 cm" for "m".
// A unit without a dimension of its own, such as "%", may follow the number.
[[nodiscard]] std::optional<double> value_in(std::string_view text, std::string_view unit);

// The decimal number at the start of a text.
// [+-] digits [. digits] [e [+-] digits], with a digit on at least one side of the point.
struct Decimal {
  std::string_view mantissa;  // with a minus sign, without a plus sign
  long exponent = 0;          // after the e, within 1e8
  std::size_t length = 0;     // of the number in the text; 0 if the text starts with no number
};

[[nodiscard]] Decimal leading_decimal(std::string_view text);

// The double nearest to decimal * 10^shift. A fault if it is too large, or too small: a double
// would lose digits (a denormal) or become zero.
[[nodiscard]] Quantity to_double(const Decimal& decimal, int shift);

}  // namespace bbsim::yaml
