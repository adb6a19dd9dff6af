// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Run -> columns of its rows, in a table, and measures of its motion (scenario/measures.hpp).
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "record/motor_loads.hpp"
#include "record/piece_fan.hpp"
#include "record/rows.hpp"
#include "record/track/track_measures.hpp"
#include "record/window_measures.hpp"
#include "scenario/measures.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

// What is asked of each run.
struct Asked {
  std::vector<const scenario::Column*> columns{};  // of its rows, for a table
  std::vector<scenario::Measure> measures{};
  // The peaks of the motors' loads, if a column needs the forces or the plate's inertia is known.
  bool peaks = false;
};

// How a run is looked at.
struct Manner {
  // The usual measures of a smooth model by TrackMeasures, which looks at many instants at a time:
  // the same numbers but for their rounding.
  bool quick = false;
  // The motion or reference, and the grid, are those of the run before.
  bool same_signals = false;
};

// Records one run after another. A measure leaves out values that are no number, but for `end`; one
// without a value is no number.
class Recorder : public solve::StateSink {
 public:
  explicit Recorder(Asked asked);
  Recorder(const Recorder&) = delete;  // fan_ looks at this one's
  Recorder& operator=(const Recorder&) = delete;

  // Begins a run; all outlive it. `table` gets the columns, and is null if there are none.
  void begin(const model::Model& model, const model::BallConstants& constants,
             const solve::OutputGrid& grid, file::TableWriter* table = nullptr,
             const Manner& manner = {});

  // Whether this run is looked at in the quick manner.
  [[nodiscard]] bool is_quick() const { return quick_; }
  // Whether no more than positions is looked at.
  [[nodiscard]] bool wants_positions_only() const;

  // Throws OutputError.
  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override { return fan_.sink(); }
  [[nodiscard]] bool wants_rows() const override;

  // Writes the run's measures, one after the other.
  void finish(const solve::Outcome& outcome, double* results);
  // Why those that are no number are none, after finish(): of each measure.
  [[nodiscard]] const scenario::Whys& whys() const { return whys_; }

  // The columns at the instant at which an event stopped the run, if no row is of that instant;
  // else nothing. Comes after the last row.
  [[nodiscard]] std::vector<double> end_row(const solve::Outcome& outcome);

  // The peaks of a run that finish() was told of.
  [[nodiscard]] std::optional<MotorPeaks> peaks() const;

  // Why some of the rows so far hold a number that is not finite, in the first `columns` columns;
  // empty if all are.
  [[nodiscard]] std::string why_not_finite(
      std::size_t columns = std::numeric_limits<std::size_t>::max()) const;

 private:
  void take_rows(std::size_t count, const double* values);
  void look_for_gaps(std::size_t count);
  void finish_each(const solve::Outcome& outcome, double* results);

  Asked asked_;
  // Of each window that the measures are of; and which columns of rows_ each begins at.
  std::vector<std::unique_ptr<WindowMeasures>> windows_;
  std::vector<std::size_t> first_columns_;
  Rows rows_;  // columns of the table, then of the windows' means
  scenario::Whys whys_;
  std::optional<TrackMeasures> track_;  // takes the place of all these, if it can
  std::optional<MotorLoads> loads_;
  PieceFan fan_;

  const model::Model* model_ = nullptr;
  const solve::OutputGrid* grid_ = nullptr;
  file::TableWriter* table_ = nullptr;
  bool quick_ = false, with_loads_ = false;

  struct Gaps {
    std::size_t rows = 0;  // that are no finite number
    double from = 0;       // the time of the first, s
  };
  std::vector<Gaps> gaps_;            // of each column of the table
  std::vector<const double*> block_;  // columns of a block of rows
  std::vector<double> times_;         // of them
  double last_time_ = 0;              // s
  std::vector<double> last_;          // row
};

}  // namespace bbsim::record
