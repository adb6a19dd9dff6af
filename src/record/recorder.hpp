// Trajectory -> file: turns the rows of a run into the columns that the scenario asks for.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "record/extremes.hpp"
#include "record/rows.hpp"
#include "record/summary.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

class Recorder : public solve::StateSink {
 public:
  Recorder(const model::Model& model, const model::BallConstants& constants,
           const solve::OutputGrid& grid, std::vector<const scenario::Column*> columns,
           file::TableWriter& writer);

  // The peaks of the run so far; nothing unless a column needs the forces, or the plate's inertia
  // is known.
  [[nodiscard]] std::optional<MotorPeaks> peaks() const;

  // Why some of the rows so far hold a number that is not finite, in the first `columns` columns;
  // empty if all are.
  [[nodiscard]] std::string why_not_finite(
      std::size_t columns = std::numeric_limits<std::size_t>::max()) const;

  // Throws OutputError.
  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override;

 private:
  void look_for_gaps(std::size_t count);

  const model::Model& model_;
  model::BallConstants constants_;
  const solve::OutputGrid& grid_;
  Rows rows_;
  file::TableWriter& writer_;
  bool with_plate_;
  std::optional<Extremes> loads_;  // of the motors: the greatest and the least of each
  struct Gaps {
    std::size_t rows = 0;  // that are no finite number
    double from = 0;       // the time of the first, s
  };
  std::vector<Gaps> gaps_;     // of each column
  std::vector<double> times_;  // of a block of rows
};

}  // namespace bbsim::record
