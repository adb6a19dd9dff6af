// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The parts of the picture of a sweep.
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

// How each way to end but `done` is marked.
[[nodiscard]] Stroke stroke_of_status(const SweepTable& table, const std::string& status);

// A measure as it is drawn: in a unit that suits it, by its logarithm if it spans decades.
struct MeasureAxis {
  Scale scale;
  Range range;  // as drawn, of the cases that are done
  bool log = false;

  MeasureAxis(const SweepTable& table, const Column& measure, double close = close_together);
  [[nodiscard]] Axis axis(Along along, double pixels, double air) const;
};

// A key as an axis: numbers, by their logarithm if they follow each other by equal factors, or
// texts side by side.
struct KeyAxis {
  const Key& key;
  std::string label;  // with the keys that go along with it
  Scale scale;
  bool log = false;

  KeyAxis(const SweepTable& table, const Key& of);
  // Room at both ends for half the distance to the next value if `cells`, otherwise for a marker.
  [[nodiscard]] Axis axis(Along along, double pixels, bool cells) const;
  // Edges are between neighbors, and beyond the outermost: where the cell of each value begins,
  // and the last one ends. They are as drawn.
  [[nodiscard]] std::vector<double> edges() const;
  [[nodiscard]] double place(double value) const { return key.is_text() ? value : scale(value); }
};

// What a panel of each kind is made from.
struct SweepPanel {
  const SweepTable& table;
  const Column& measure;
  Box box;
  bool lowest;  // of its column: the others have no labels below them
};

// A curve for each value of `group`, or one if it is null, through the medians of the cases that
// are done; a band where nine of ten of them lie, if there are several, for up to most_bands
// curves: more would hide each other. Of a key that was drawn by chance, a point a case.
inline constexpr std::size_t most_bands = 3;
[[nodiscard]] Panel line_panel(const SweepPanel& of, const Key& over, const Key* group);
[[nodiscard]] std::vector<Entry> group_legend(const Key* group);

// A map of medians over two keys, with its scale of colours at its right.
[[nodiscard]] Panel map_panel(const SweepPanel& of, const Key& over, const Key& against);

// How often which value came.
[[nodiscard]] Panel histogram_panel(const SweepPanel& of);

}  // namespace bbsim::plot
