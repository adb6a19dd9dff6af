// Trajectory -> file: turns the rows of a run into the columns that the scenario asks for.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "record/ball_turn.hpp"
#include "record/columns.hpp"
#include "record/extremes.hpp"
#include "record/summary.hpp"
#include "record/table_writer.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

// The columns of these names, in this order. Throws InputError for an unknown one.
[[nodiscard]] std::vector<const Column*> columns_named(const std::vector<std::string>& names);

[[nodiscard]] bool any_needs(const std::vector<const Column*>& columns, Needs what);

// Whether one of them is computed from gamma, which the model then integrates.
[[nodiscard]] bool need_gamma(const std::vector<const Column*>& columns);

class Recorder : public solve::StateSink {
 public:
  Recorder(const model::Model& model, const model::BallConstants& constants,
           const solve::OutputGrid& grid, std::vector<const Column*> columns, TableWriter& writer);
  Recorder(const Recorder&) = delete;  // loads_ look through this one
  Recorder& operator=(const Recorder&) = delete;

  // Of the run so far; nothing unless a column needs the forces, or the plate's inertia is known.
  [[nodiscard]] std::optional<MotorPeaks> peaks() const;

  // Why some of the rows so far hold a number that is not finite, in the first `columns` columns;
  // empty if all are.
  [[nodiscard]] std::string why_not_finite(
      std::size_t columns = std::numeric_limits<std::size_t>::max()) const;

  // Throws OutputError.
  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override;

 private:
  void look_for_gaps(std::size_t first, std::size_t count);

  const model::Model& model_;
  model::BallConstants constants_;
  const solve::OutputGrid& grid_;
  std::vector<const Column*> columns_;
  TableWriter& writer_;
  bool needs_dynamics_, with_plate_;
  std::optional<BallTurn> turn_;   // where a column asks for the ball's orientation
  std::optional<Extremes> loads_;  // of the motors, each as it is and turned over
  struct Gaps {
    std::size_t rows = 0;  // that are no finite number
    double from = 0;       // the time of the first, s
  };
  std::vector<Gaps> gaps_;                  // of each column
  std::vector<std::vector<double>> block_;  // one vector a column
};

}  // namespace bbsim::record
