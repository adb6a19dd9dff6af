// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

// Below this part of its values' size a range is rounding.
constexpr double rounding = 1e-9;

constexpr double tic_size = 13;  // of the font

// What is smaller is nothing: no factor makes numbers of it that a label can show.
constexpr double smallest = 1e-290;

struct Prefix {
  std::string_view text;
  double size;  // of one, in the unit without a prefix
  double from;  // values of at least this size take it
};

constexpr std::array lengths = {Prefix{"nm", 1e-9, 0},    Prefix{"µm", 1e-6, 1e-7},
                                Prefix{"mm", 1e-3, 1e-4}, Prefix{"cm", 1e-2, 1e-2},
                                Prefix{"m", 1, 1},        Prefix{"km", 1e3, 1e4}};
constexpr std::array speeds = {Prefix{"nm/s", 1e-9, 0},    Prefix{"µm/s", 1e-6, 1e-7},
                               Prefix{"mm/s", 1e-3, 1e-4}, Prefix{"cm/s", 1e-2, 1e-2},
                               Prefix{"m/s", 1, 1},        Prefix{"km/s", 1e3, 1e4}};
constexpr std::array times = {Prefix{"ns", 1e-9, 0}, Prefix{"µs", 1e-6, 1e-6},
                              Prefix{"ms", 1e-3, 1e-3}, Prefix{"s", 1, 0.1}};
constexpr std::array si = {Prefix{"n", 1e-9, 0}, Prefix{"µ", 1e-6, 1e-6}, Prefix{"m", 1e-3, 1e-3},
                           Prefix{"", 1, 1},     Prefix{"k", 1e3, 1e3},   Prefix{"M", 1e6, 1e6}};

template <class Prefixes>
const Prefix& prefix_for(const Prefixes& prefixes, double largest) {
  const Prefix* chosen = &prefixes.front();
  for (const Prefix& prefix : prefixes) {
    if (largest >= prefix.from) chosen = &prefix;
  }
  return *chosen;
}

// The unit of values in `unit`, which are at most so large; 0 leaves it as it is.
Scale prefixed(const Unit& unit, double largest) {
  constexpr double usual_length = 0.1;  // of what is zero: centimetres suit a plate
  if (largest < smallest && unit.text == "m") largest = usual_length;
  if (largest < smallest) return {unit.factor, 0, unit.text};
  const auto whole = [&](const Prefix& prefix) {
    return Scale{unit.factor / prefix.size, 0, std::string(prefix.text)};
  };
  if (unit.text == "m") return whole(prefix_for(lengths, largest));
  if (unit.text == "m/s") return whole(prefix_for(speeds, largest));
  if (unit.text == "s") return whole(prefix_for(times, largest));
  if (unit.text == "N" || unit.text == "N m" || unit.text == "J" || unit.text == "W") {
    const Prefix& prefix = prefix_for(si, largest);
    return {unit.factor / prefix.size, 0, std::string(prefix.text) + unit.text};
  }
  return {unit.factor, 0, unit.text};
}

double power(int exponent) {
  return std::pow(10.0, exponent);
}

// A power of ten in the unit where labels would still be long.
void shorten_labels(Scale& scale, double largest) {
  constexpr double most = 1e5, least = 1e-2;
  const double drawn = largest * scale.factor;
  if (largest < smallest || (drawn < most && drawn >= least)) return;
  // From the largest value alone, as it may be as small as no factor reaches in one go.
  const int exponent =
      static_cast<int>(std::floor((std::log10(largest) + std::log10(scale.factor)) / 3)) * 3;
  scale.factor = scale.factor * power(-exponent / 2) * power(-exponent - (-exponent / 2));
  scale.unit = power_of_ten(exponent) + (scale.unit.empty() ? "" : " " + scale.unit);
}

// A range that is wide: what is constant is in its middle.
Range around(const Range& range) {
  if (range.wide()) return range;
  if (range.empty()) return {0, 1};
  const double half = range.largest() > smallest ? range.largest() / 2 : 1;
  return {range.low - half, range.high + half};
}

// Whether tics over such a width would need many digits to differ.
bool is_far_off(const Range& range, double width, double close = close_together) {
  return width <= close * range.largest();
}

// Labels are differences from a round value near the middle of the range.
Scale shifted(const Unit& unit, const Range& range, double width) {
  Scale scale = prefixed(unit, width);
  shorten_labels(scale, width);
  // In the unit that is drawn without a prefix, rounded to what the width lets be seen.
  const double step = power(static_cast<int>(std::ceil(std::log10(width * unit.factor))));
  const double middle = (range.low / 2 + range.high / 2) * unit.factor;
  const double round = std::round(middle / step) * step;
  scale.offset = round / unit.factor;
  scale.shift = (round < 0 ? " + " : " − ") + number(std::abs(round), 12) +
                (unit.text.empty() ? "" : " " + unit.text);
  return scale;
}

double nice_step(double rough) {
  const double size = power(static_cast<int>(std::floor(std::log10(rough))));
  const double digits = rough / size;
  return size * (digits < 1.5 ? 1 : digits < 3.5 ? 2 : digits < 7.5 ? 5 : 10);
}

std::string with_decimals(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  // A value that is rounded to nothing has no sign.
  if (std::all_of(text, text + std::char_traits<char>::length(text),
                  [](char c) { return c == '-' || c == '.' || c == '0'; })) {
    std::snprintf(text, sizeof text, "%.*f", decimals, 0.0);
  }
  std::string result = text;
  if (result.starts_with('-')) result.replace(0, 1, "−");
  return result;
}

// What stands at a tic of a logarithmic axis.
std::string log_label(double mantissa, int exponent) {
  if (exponent >= -3 && exponent <= 4) return number(mantissa * power(exponent));
  const std::string ten = power_of_ten(exponent);
  return mantissa == 1 ? ten : number(mantissa) + "·" + ten;
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

std::string Scale::heading(const std::string& name) const {
  return name + shift + (unit.empty() ? "" : " (" + unit + ")");
}

Scale choose_scale(const Unit& unit, const Range& range, double close) {
  const double width = range.empty() ? 0 : range.high - range.low;
  if (range.wide() && is_far_off(range, width, close)) return shifted(unit, range, width);
  Scale scale = prefixed(unit, range.largest());
  shorten_labels(scale, range.largest());
  return scale;
}

PlaneScales choose_scales(const Unit& unit, const Range& x, const Range& y) {
  Range both = x;
  both.include(y);
  const double width = std::max(x.empty() ? 0 : x.high - x.low, y.empty() ? 0 : y.high - y.low);
  const bool x_off = is_far_off(x, width), y_off = is_far_off(y, width);
  if (!(width > rounding * both.largest()) || (!x_off && !y_off)) {
    const Scale scale = choose_scale(unit, both, 0);
    return {scale, scale};
  }
  const Scale near = choose_scale(unit, {0, width}, 0);
  return {x_off ? shifted(unit, x, width) : near, y_off ? shifted(unit, y, width) : near};
}

std::vector<Tic> linear_tics(double low, double high, std::size_t about) {
  const double step =
      nice_step((high - low) / static_cast<double>(std::max<std::size_t>(about, 1)));
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::vector<Tic> tics;
  // Within rounding of the ends.
  const double first = std::ceil(low / step - 1e-6), last = std::floor(high / step + 1e-6);
  for (double i = first; i <= last; ++i) {
    tics.push_back({i * step, with_decimals(i * step, decimals)});
  }
  return tics;
}

Axis linear_axis(Range range, double pixels, double pixels_a_tic, double air) {
  if (range.wide()) {
    const double more = air * (range.high - range.low);
    range = {range.low - more, range.high + more};
  }
  return tight_axis(range, pixels, pixels_a_tic);
}

Axis tight_axis(const Range& range, double pixels, double pixels_a_tic) {
  const Range shown = around(range);
  Axis axis{shown.low, shown.high};
  constexpr double most = 8;
  const auto about = static_cast<std::size_t>(std::clamp(pixels / pixels_a_tic, 2.0, most));
  axis.tics = linear_tics(axis.low, axis.high, about);
  return axis;
}

Axis across(Axis axis, double pixels) {
  constexpr double gap = 10;  // pixels, between labels
  const auto crowded = [&] {
    for (std::size_t i = 1; i < axis.tics.size(); ++i) {
      const Tic &left = axis.tics[i - 1], &right = axis.tics[i];
      const double widths = width_of(left.label, tic_size) + width_of(right.label, tic_size);
      const double distance = (axis.fraction(right.at) - axis.fraction(left.at)) * pixels;
      if (distance < widths / 2 + gap) return true;
    }
    return false;
  };
  for (std::size_t about = axis.tics.size(); about > 1 && crowded(); --about) {
    axis.tics = linear_tics(axis.low, axis.high, about - 1);
  }
  return axis;
}

bool better_by_log(const Range& range) {
  return !range.empty() && range.low > 0 && range.high / range.low > 1e3;
}

Axis log_axis(const Range& range, double pixels, double pixels_a_tic, double air) {
  const double more =
      range.wide() ? std::exp(air * (std::log(range.high) - std::log(range.low))) : 2;
  Axis axis{range.low / more, range.high * more, true};
  const double decades = std::log10(axis.high) - std::log10(axis.low);
  const double about = std::max(2.0, pixels / pixels_a_tic);
  if (decades < 0.7) {
    axis.tics = linear_tics(axis.low, axis.high, static_cast<std::size_t>(about));
    return axis;
  }
  const int first = static_cast<int>(std::floor(std::log10(axis.low)));
  const int last = static_cast<int>(std::ceil(std::log10(axis.high)));
  const int every = std::max(1, static_cast<int>(std::ceil(decades / about)));
  std::vector<double> mantissas{1};
  if (3 * decades <= about) {
    mantissas = {1, 2, 5};
  } else if (2 * decades <= about) {
    mantissas = {1, 3};
  }
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % every != 0) continue;
    for (const double mantissa : mantissas) {
      const double at = mantissa * power(exponent);
      if (at < axis.low * (1 - 1e-9) || at > axis.high * (1 + 1e-9)) continue;
      axis.tics.push_back({at, log_label(mantissa, exponent)});
    }
  }
  return axis;
}

}  // namespace bbsim::plot
