// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The parts of the picture of a sweep.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plot/axis.hpp"
#include "plot/legend.hpp"
#include "plot/picture.hpp"
#include "plot/sweep_table.hpp"

namespace bbsim::plot {

// How each way to end but `done` is marked, with how many cases ended so.
class StatusMarks {
 public:
  explicit StatusMarks(const SweepTable& table);
  [[nodiscard]] Stroke stroke_of(const std::string& status) const;
  [[nodiscard]] std::vector<Entry> legend() const;

 private:
  struct Kind {
    std::string status;
    std::size_t cases = 0;
  };
  std::vector<Kind> kinds_;
};

// A measure as it is drawn: in a unit that suits it, by its logarithm if it spans decades.
struct MeasureAxis {
  Scale scale;
  Range range;  // as drawn, of the cases that are done
  bool log = false;

  MeasureAxis(const SweepTable& table, const Column& measure, double close = close_together);
  [[nodiscard]] Axis axis(double pixels, double pixels_a_tic, double air) const;
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
  [[nodiscard]] Axis axis(double pixels, double pixels_a_tic, bool cells) const;
  // The same, below its panel.
  [[nodiscard]] Axis axis_across(double pixels, bool cells) const;
  // Edges are between neighbours, and beyond the outermost: where the cell of each value begins,
  // and the last one ends. They are as drawn.
  [[nodiscard]] std::vector<double> edges() const;
  [[nodiscard]] double place(double value) const { return key.is_text() ? value : scale(value); }
};

// Bands of more curves would hide each other.
inline constexpr std::size_t most_bands = 3;

// A curve for each value of `group`, or one if it is null, through the medians of the cases that
// are done; a band where nine of ten of them lie, if there are several, for up to most_bands
// curves.
void add_lines(Picture& picture, const SweepTable& table, const Column& measure, const Key& over,
               const Key* group, const StatusMarks& marks, Box box, bool lowest);
[[nodiscard]] std::vector<Entry> group_legend(const Key* group);

// A point a case.
void add_scatter(Picture& picture, const SweepTable& table, const Column& measure, const Key& over,
                 const StatusMarks& marks, Box box, bool lowest);

// A map of medians over two keys, with its scale of colours at its right.
void add_map(Picture& picture, const SweepTable& table, const Column& measure, const Key& over,
             const Key& against, const StatusMarks& marks, Box box, bool lowest);
inline constexpr double map_scale_width = 110;  // of the box's, with the gap

// How often which value came.
void add_histogram(Picture& picture, const SweepTable& table, const Column& measure, Box box);

}  // namespace bbsim::plot
