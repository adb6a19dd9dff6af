// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Units and axes that fit a range of values and keep labels short.
#pragma once

#include <string>
#include <vector>

#include "plot/picture.hpp"

namespace bbsim::plot {

// The interval that values cover; empty (low above high) before the first one.
struct Range {
  double low = 1, high = 0;

  [[nodiscard]] bool empty() const { return low > high; }
  [[nodiscard]] double width() const { return empty() ? 0 : high - low; }
  [[nodiscard]] double middle() const { return low / 2 + high / 2; }
  [[nodiscard]] double largest() const;  // largest absolute value; 0 if empty
  // Whether the range is wider than the rounding of its values.
  [[nodiscard]] bool wide() const;
  void include(double value);  // ignores values that are not finite
  void include(const std::vector<double>& values);
  void include(const Range& other);
};

// The unit in which a column is drawn, such as degrees for "rad".
struct Unit {
  std::string text;   // "°"; empty for a plain number or an unknown unit
  double factor = 1;  // times a value in SI units
  friend bool operator==(const Unit&, const Unit&) = default;
};

// The drawn value is (value - offset) * factor.
struct Scale {
  double factor = 1, offset = 0;
  std::string unit;     // with its prefix or power of ten: "cm", "10⁶ rad"; may be empty
  std::string shift{};  // follows the quantity's name: " − 0.1 m", or empty

  [[nodiscard]] double operator()(double value) const { return (value - offset) * factor; }
  [[nodiscard]] Range operator()(const Range& range) const;
  // "x (cm)", "x − 0.1 m (µm)"
  [[nodiscard]] std::string heading(const std::string& name) const;
};

// Below this width relative to the values' size, tics need more than four digits to differ.
inline constexpr double close_together = 1e-3;

// Takes values in SI units. Draws them as differences from a round value if their range is at most
// the part `close` of their size.
[[nodiscard]] Scale choose_scale(const Unit& unit, const Range& range,
                                 double close = close_together);

// The scales of the two axes of a plane, with the same factor.
struct PlaneScales {
  Scale x, y;
};
[[nodiscard]] PlaneScales choose_scales(const Unit& unit, const Range& x, const Range& y);

enum class Along { x, y };

// An axis over a range in drawn units, this many pixels long, with free space at both ends. Its
// labels do not overlap: they stand side by side along x and above each other along y.
[[nodiscard]] Axis linear_axis(const Range& range, Along along, double pixels, double air = 0.06);

// A logarithmic axis over a range of positive values.
[[nodiscard]] Axis log_axis(const Range& range, Along along, double pixels, double air);

// Whether positive values need a logarithmic axis: they span more than three decades.
[[nodiscard]] bool better_by_log(const Range& range);

}  // namespace bbsim::plot
