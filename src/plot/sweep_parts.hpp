// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The parts of a picture of a sweep.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plot/axis.hpp"
#include "plot/picture.hpp"
#include "results/sweep_table.hpp"

namespace bbsim::plot {

using results::Column;
using results::Key;
using results::Result;
using results::SweepTable;

// The mark of each status except `done`.
[[nodiscard]] Stroke stroke_of_status(const SweepTable& table, const std::string& status);

// The axis of a measure: in a fitting unit, logarithmic if the values span decades.
struct MeasureAxis {
  Scale scale;
  Range range;  // as drawn, over the cases that are done
  bool log = false;

  MeasureAxis(const SweepTable& table, const Column& measure, double close = close_together);
  [[nodiscard]] Axis axis(Along along, double pixels, double air) const;
};

// The axis of a key: numbers, logarithmic if they grow by equal factors, or texts side by side.
struct KeyAxis {
  const Key& key;
  std::string label;  // includes the keys that vary with it
  Scale scale;
  bool log = false;

  KeyAxis(const SweepTable& table, const Key& of);
  // Leaves half the distance to the next value at both ends if `cells`, else room for a marker.
  [[nodiscard]] Axis axis(Along along, double pixels, bool cells) const;
  // Edges of the values' cells, as drawn: halfway between neighbors, and beyond the outermost
  // values.
  [[nodiscard]] std::vector<double> edges() const;
  [[nodiscard]] double place(double value) const { return key.is_text() ? value : scale(value); }
};

// The input of each kind of panel.
struct SweepPanel {
  const SweepTable& table;
  const Column& measure;
  Box box;
  bool lowest;  // of its column: the others have no labels below
};

// A curve for each value of `group`, or one if it is null, through the medians of the done cases. A
// band holds nine of ten cases, if there are several at a value, for at most most_bands curves:
// more would hide each other. A random key has a point for each case.
inline constexpr std::size_t most_bands = 3;
[[nodiscard]] Panel line_panel(const SweepPanel& of, const Key& over, const Key* group);
[[nodiscard]] std::vector<LegendEntry> group_legend(const Key* group);

// A map of medians over two keys, with a color scale on its right.
[[nodiscard]] Panel map_panel(const SweepPanel& of, const Key& over, const Key& against);

// A histogram of the measure.
[[nodiscard]] Panel histogram_panel(const SweepPanel& of);

}  // namespace bbsim::plot
