// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The parts of a picture of runs.
#pragma once

#include <string>
#include <vector>

#include "plot/axis.hpp"
#include "plot/columns.hpp"
#include "plot/picture.hpp"
#include "results/result.hpp"

namespace bbsim::plot {

using results::Event;
using results::Result;

// The time axis of runs; row numbers if one of them has no t.
struct Abscissa {
  bool is_time = true;
  Range range;  // as drawn
  Scale scale;

  [[nodiscard]] std::vector<double> of(const Result& run) const;  // as drawn
};
[[nodiscard]] Abscissa abscissa_of(const std::vector<Result>& runs);

// The mark of each kind of event, the same in all panels. Kinds are in order of appearance.
class EventMarks {
 public:
  explicit EventMarks(const std::vector<Result>& runs);
  [[nodiscard]] Stroke stroke_of(const Result& run, const std::string& event) const;
  [[nodiscard]] std::vector<LegendEntry> legend() const;

 private:
  struct Kind {
    std::string name;
    std::size_t times = 0;
    bool stopped = false;
  };
  [[nodiscard]] std::size_t index_of(const std::string& name) const;

  const std::vector<Result>& runs_;
  std::vector<Kind> kinds_;
};

// The stroke of references, below the runs.
inline const Stroke band_of_reference{"#d0d0d0", 6};

// The stroke of a run among several; the first stroke for a single run.
[[nodiscard]] Stroke stroke_of_run(const std::vector<Result>& runs, const Result& run);

[[nodiscard]] bool has_path(const std::vector<Result>& runs);

// Whether a picture of the plane shows no more than the columns: the ball stays on a line along x
// or y, and no plate is known.
[[nodiscard]] bool is_along_an_axis(const std::vector<Result>& runs);

// Draws the paths in the plane, to scale, and adds them to the picture's legend.
void add_path(Picture& picture, const std::vector<Result>& runs, const EventMarks& marks,
              const Box& box);

// Columns over time. Only the lowest panel of a stack has labels on its time axis.
[[nodiscard]] Panel time_panel(const std::vector<Result>& runs, const PlannedPanel& planned,
                               const Abscissa& abscissa, const EventMarks& marks, const Box& box,
                               bool lowest);

}  // namespace bbsim::plot
