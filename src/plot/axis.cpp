// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>

#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

// A range below this part of its values' size counts as rounding.
constexpr double rounding = 1e-9;

// Smaller values count as zero: no factor turns them into numbers that a label can show.
constexpr double smallest = 1e-290;

struct Prefix {
  const char* text;
  double size;
  double from;  // values of at least this size take it
};
constexpr std::array no_prefix = {Prefix{"", 1, 0}};
constexpr std::array of_lengths = {Prefix{"n", 1e-9, 0},    Prefix{"µ", 1e-6, 1e-7},
                                   Prefix{"m", 1e-3, 1e-4}, Prefix{"c", 1e-2, 1e-2},
                                   Prefix{"", 1, 1},        Prefix{"k", 1e3, 1e4}};
constexpr std::array of_times = {Prefix{"n", 1e-9, 0}, Prefix{"µ", 1e-6, 1e-6},
                                 Prefix{"m", 1e-3, 1e-3}, Prefix{"", 1, 0.1}};
constexpr std::array of_others = {Prefix{"n", 1e-9, 0},    Prefix{"µ", 1e-6, 1e-6},
                                  Prefix{"m", 1e-3, 1e-3}, Prefix{"", 1, 1},
                                  Prefix{"k", 1e3, 1e3},   Prefix{"M", 1e6, 1e6}};

std::span<const Prefix> prefixes_of(const std::string& unit) {
  if (unit == "m" || unit == "m/s") return of_lengths;
  if (unit == "s") return of_times;
  if (unit == "N" || unit == "N m" || unit == "J" || unit == "W") return of_others;
  return no_prefix;
}

double power(int exponent) {
  return std::pow(10.0, exponent);
}

// The scale for values in `unit` of at most this size. Adds a power of ten if labels would still be
// long.
Scale prefixed(const Unit& unit, double largest) {
  constexpr double usual_length = 0.1;  // for zero lengths: centimeters suit a plate
  if (largest < smallest && unit.text == "m") largest = usual_length;
  if (largest < smallest) return {unit.factor, 0, unit.text};
  Prefix chosen = no_prefix.front();
  for (const Prefix& prefix : prefixes_of(unit.text)) {
    if (largest >= prefix.from) chosen = prefix;
  }
  Scale scale{unit.factor / chosen.size, 0, chosen.text + unit.text};
  constexpr double most = 1e5, least = 1e-2;
  const double drawn = largest * scale.factor;
  if (drawn < most && drawn >= least) return scale;
  const double size = std::log10(largest) + std::log10(scale.factor);
  const int exponent = static_cast<int>(std::floor(size / 3)) * 3;
  // In two factors, because one could overflow.
  scale.factor = scale.factor * power(-exponent / 2) * power(-exponent - (-exponent / 2));
  scale.unit = power_of_ten(exponent) + (scale.unit.empty() ? "" : " " + scale.unit);
  return scale;
}

// A scale whose labels are differences from a round value near the middle of the range.
Scale shifted(const Unit& unit, const Range& range, double width) {
  Scale scale = prefixed(unit, width);
  // Rounds in the unit without a prefix, to the power of ten above the width.
  const double step = power(static_cast<int>(std::ceil(std::log10(width * unit.factor))));
  const double round = std::round(range.middle() * unit.factor / step) * step;
  scale.offset = round / unit.factor;
  scale.shift = (round < 0 ? " + " : " − ") + number(std::abs(round), 12) +
                (unit.text.empty() ? "" : " " + unit.text);
  return scale;
}

// Widens a constant range, with its value in the middle.
Range around(const Range& range) {
  if (range.wide()) return range;
  if (range.empty()) return {0, 1};
  const double half = range.largest() > smallest ? range.largest() / 2 : 1;
  return {range.low - half, range.high + half};
}

double nice_step(double rough) {
  const double size = power(static_cast<int>(std::floor(std::log10(rough))));
  const double digits = rough / size;
  return size * (digits < 1.5 ? 1 : digits < 3.5 ? 2 : digits < 7.5 ? 5 : 10);
}

double widest_label(const Axis& axis) {
  constexpr double font_size = 13;
  double widest = 0;
  for (const double end : {axis.low, axis.high}) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", axis.decimals(), end);
    widest = std::max(widest, width_of(text, font_size));
  }
  return widest;
}

constexpr double pixels_a_tic(Along along) {
  return along == Along::x ? 72 : 28;
}

}  // namespace

double Range::largest() const {
  return empty() ? 0 : std::max(std::abs(low), std::abs(high));
}

bool Range::wide() const {
  return !empty() && high / 2 - low / 2 > std::max(rounding / 2 * largest(), smallest);
}

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  const bool first = empty();
  low = first ? value : std::min(low, value);
  high = first ? value : std::max(high, value);
}

void Range::include(const std::vector<double>& values) {
  for (const double value : values) include(value);
}

void Range::include(const Range& other) {
  if (other.empty()) return;
  include(other.low);
  include(other.high);
}

Range Scale::operator()(const Range& range) const {
  if (range.empty()) return range;
  return {(*this)(range.low), (*this)(range.high)};
}

std::string Scale::heading(const std::string& name) const {
  return name + shift + (unit.empty() ? "" : " (" + unit + ")");
}

Scale choose_scale(const Unit& unit, const Range& range, double close) {
  if (range.wide() && range.width() <= close * range.largest()) {
    return shifted(unit, range, range.width());
  }
  return prefixed(unit, range.largest());
}

PlaneScales choose_scales(const Unit& unit, const Range& x, const Range& y) {
  Range both = x;
  both.include(y);
  const double width = std::max(x.width(), y.width());
  const auto is_far_off = [&](const Range& range) {
    return width <= close_together * range.largest();
  };
  if (!(width > rounding * both.largest()) || (!is_far_off(x) && !is_far_off(y))) {
    const Scale scale = prefixed(unit, both.largest());
    return {scale, scale};
  }
  const auto scale_of = [&](const Range& range) {
    return is_far_off(range) ? shifted(unit, range, width) : prefixed(unit, width);
  };
  return {scale_of(x), scale_of(y)};
}

Axis linear_axis(const Range& range, Along along, double pixels, double air) {
  const Range shown = around(range);
  const double more = range.wide() ? air * shown.width() : 0;
  Axis axis{shown.low - more, shown.high + more};
  constexpr double most = 8, gap = 10;
  for (double tics = std::clamp(pixels / pixels_a_tic(along), 2.0, most); tics >= 1; --tics) {
    axis.step = nice_step((axis.high - axis.low) / tics);
    const double apart = axis.step / (axis.high - axis.low) * pixels;
    if (along == Along::y || apart > widest_label(axis) + gap) break;
  }
  return axis;
}

bool better_by_log(const Range& range) {
  return !range.empty() && range.low > 0 && range.high / range.low > 1e3;
}

Axis log_axis(const Range& range, Along along, double pixels, double air) {
  const double more = range.wide() ? std::pow(range.high / range.low, air) : 2;
  Axis axis{range.low / more, range.high * more, true};
  const double decades = std::log10(axis.high) - std::log10(axis.low);
  const double most = std::max(2.0, pixels / pixels_a_tic(along));
  std::vector<double> mantissas{1};
  if (3 * decades <= most) {
    mantissas = {1, 2, 5};
  } else if (2 * decades <= most) {
    mantissas = {1, 3};
  }
  const int every = std::max(1, static_cast<int>(std::ceil(decades / most)));
  const int first = static_cast<int>(std::floor(std::log10(axis.low)));
  for (int exponent = first; power(exponent) <= axis.high; ++exponent) {
    if (exponent % every != 0) continue;
    for (const double mantissa : mantissas) {
      const double at = mantissa * power(exponent);
      if (at < axis.low * (1 - 1e-9) || at > axis.high * (1 + 1e-9)) continue;
      const bool plain = exponent >= -3 && exponent <= 4;
      const std::string ten = power_of_ten(exponent);
      axis.tics.push_back({at, plain           ? number(at)
                               : mantissa == 1 ? ten
                                               : number(mantissa) + "·" + ten});
    }
  }
  return axis;
}

}  // namespace bbsim::plot
