// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Units and axes that suit a range of values, so that labels are short whatever its size.
#pragma once

#include <string>
#include <vector>

#include "plot/picture.hpp"

namespace bbsim::plot {

// What values span; empty (low above high) before the first one.
struct Range {
  double low = 1, high = 0;

  [[nodiscard]] bool empty() const { return low > high; }
  [[nodiscard]] double width() const { return empty() ? 0 : high - low; }
  [[nodiscard]] double middle() const { return low / 2 + high / 2; }
  [[nodiscard]] double largest() const;  // size, 0 if empty
  // Wide enough to be seen: more than the rounding of its values.
  [[nodiscard]] bool wide() const;
  void include(double value);  // what is not finite is passed over
  void include(const std::vector<double>& values);
  void include(const Range& other);
};

// A unit of the catalogue of columns as it is drawn: "rad" as degrees, for instance.
struct Unit {
  std::string text;   // "°"; empty for a plain number, or where the unit is not known
  double factor = 1;  // times a value in SI units
  friend bool operator==(const Unit&, const Unit&) = default;
};

// What is drawn is (value - offset) * factor.
struct Scale {
  double factor = 1, offset = 0;
  std::string unit;     // with its prefix or power of ten: "cm", "10⁶ rad"; may be empty
  std::string shift{};  // what to write after the quantity's name: " − 0.1 m", or nothing

  [[nodiscard]] double operator()(double value) const { return (value - offset) * factor; }
  [[nodiscard]] Range operator()(const Range& range) const;
  // "x (cm)", "x − 0.1 m (µm)"
  [[nodiscard]] std::string heading(const std::string& name) const;
};

// Below this part of the values' size, tics would need more than four digits to differ.
inline constexpr double close_together = 1e-3;

// For values in SI units. Those that differ by no more than the part `close` of their size are
// drawn as differences from a round one.
[[nodiscard]] Scale choose_scale(const Unit& unit, const Range& range,
                                 double close = close_together);

// The scales of the two axes of a plane, of one factor.
struct PlaneScales {
  Scale x, y;
};
[[nodiscard]] PlaneScales choose_scales(const Unit& unit, const Range& x, const Range& y);

enum class Along { x, y };

// An axis of so many pixels over a range in drawn units, with air at both ends. Its labels have
// room: beside each other along x, one above the other along y.
[[nodiscard]] Axis linear_axis(const Range& range, Along along, double pixels, double air = 0.06);

// A logarithmic axis over a range above 0.
[[nodiscard]] Axis log_axis(const Range& range, Along along, double pixels, double air);

// Whether values above 0 are better seen by their logarithm: they span more than three decades.
[[nodiscard]] bool better_by_log(const Range& range);

}  // namespace bbsim::plot
