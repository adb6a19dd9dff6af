// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Records a run: columns of its rows in a table, and measures of its motion
// (scenario/measures.hpp). Notes where a ball leaves its plate.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "record/extremes.hpp"
#include "record/rows.hpp"
#include "record/summary.hpp"
#include "record/window_measures.hpp"
#include "scenario/measures.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

// The request for each run.
struct RecordRequest {
  std::vector<const scenario::Column*> columns{};  // of its rows, for a table
  std::vector<scenario::Measure> measures{};
  // Peaks of the motors' loads; taken only if a column needs forces or the plate's inertia is
  // known.
  bool peaks = false;
};

// Records one run after another. All measures but `end` ignore NaN; a measure without a value is
// NaN.
class Recorder : public solve::StateSink {
 public:
  explicit Recorder(RecordRequest request);
  Recorder(const Recorder&) = delete;  // fan_ refers to members
  Recorder& operator=(const Recorder&) = delete;

  // Begins a run. All arguments must outlive it. `table` receives the columns, and is null if there
  // are none.
  void begin(const model::Model& model, const model::BallConstants& constants,
             const solve::OutputGrid& grid, file::TableWriter* table = nullptr);

  // For runs that all have the same reference (Rows).
  void share_reference(model::SharedSignals& shared) { rows_.share_reference(shared); }

  // Throws OutputError.
  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override { return fan_.sink(); }
  [[nodiscard]] bool wants_rows() const override { return !rows_.columns().empty(); }
  [[nodiscard]] bool wants_ball_only() const override { return rows_.need_ball_only(); }

  // Writes the measures of the run, one after the other.
  void finish(const solve::Outcome& outcome, double* results);
  // After finish(): why each measure is NaN, or null if it is not.
  [[nodiscard]] const scenario::Whys& whys() const { return whys_; }

  // The columns at the instant at which an event stopped the run; empty if a row has this instant.
  // Call it after the last row.
  [[nodiscard]] std::vector<double> end_row(const solve::Outcome& outcome);

  // After finish(): the peaks of the run, if they were taken.
  [[nodiscard]] std::optional<MotorPeaks> peaks() const;

  // Reports values that are not finite in the first `columns` columns of the rows so far; empty if
  // there are none.
  [[nodiscard]] std::string why_not_finite(
      std::size_t columns = std::numeric_limits<std::size_t>::max()) const;

 private:
  void take_rows(std::size_t count, const double* values);
  void look_for_gaps(std::size_t count);

  RecordRequest request_;
  // One for each window of the measures, and the index of its first column in rows_.
  std::vector<std::unique_ptr<WindowMeasures>> windows_;
  std::vector<std::size_t> first_columns_;
  Rows rows_;  // columns of the table, then of the windows' means
  scenario::Whys whys_;
  std::optional<Extremes> loads_;
  PieceFan fan_;

  const model::Model* model_ = nullptr;
  const solve::OutputGrid* grid_ = nullptr;
  file::TableWriter* table_ = nullptr;
  bool with_loads_ = false, with_plate_ = false;

  struct Gaps {
    std::size_t rows = 0;  // with a value that is not finite
    double from = 0;       // time of the first one, s
  };
  std::vector<Gaps> gaps_;            // for each column of the table
  std::vector<const double*> block_;  // columns of a block of rows
  std::vector<double> times_;         // of these rows, s
  double last_time_ = 0;              // of the last row, s
  std::vector<double> last_;          // the last row
};

// The first row whose contact point is beyond the edge.
struct OffPlate {
  double t = 0;         // s
  double x = 0, y = 0;  // m
};

// For scenes that have no event at the edge of a plate of known size: checks rows as they pass,
// with two comparisons a row.
class EdgeNote : public solve::StateSink {
 public:
  // Whether the scene's plate has a size and no event at its edge.
  [[nodiscard]] static bool wanted(const Scenario& scenario);

  // Passes all rows on to `next`.
  EdgeNote(const model::Model& model, const Plate& plate, const solve::OutputGrid& grid,
           solve::StateSink& next);

  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override { return next_.pieces(); }

  [[nodiscard]] const std::optional<OffPlate>& left() const { return left_; }

 private:
  [[nodiscard]] bool is_beyond(double x, double y) const;

  const Plate plate_;
  const solve::OutputGrid& grid_;
  solve::StateSink& next_;
  std::size_t row_size_;
  std::optional<std::size_t> x_, y_;  // indices of states; empty if symmetry keeps the state at 0
  std::optional<OffPlate> left_;
};

}  // namespace bbsim::record
