// Takes the measures of a sweep (scenario/measures.hpp), run after run.
#pragma once

#include <optional>
#include <vector>

#include "model/model.hpp"
#include "record/column_values.hpp"
#include "record/extremes.hpp"
#include "record/square_sum.hpp"
#include "scenario/measures.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

// Takes the measures of one run after another. Where a value is no number it is left out of all but
// `end`; a measure without a value is no number.
class Meter : public solve::StateSink {
 public:
  explicit Meter(std::vector<scenario::Measure> measures);
  Meter(const Meter&) = delete;  // extremes_ look through this one
  Meter& operator=(const Meter&) = delete;

  // Begins a run; the three outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants,
             const solve::OutputGrid& grid);
  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override;
  // Writes the run's measures, one after the other.
  void finish(const solve::Outcome& outcome, double* results);

 private:
  [[nodiscard]] model::Dynamics dynamics_at(const model::Sample& sample, bool needed) const;

  std::vector<scenario::Measure> measures_;
  std::vector<ColumnValue> values_;               // of their columns
  std::vector<std::size_t> of_motion_, of_rows_;  // the extremes, and the means
  bool motion_needs_dynamics_ = false, rows_need_dynamics_ = false, end_needs_dynamics_ = false;
  const model::Model* model_ = nullptr;
  const model::BallConstants* constants_ = nullptr;
  const solve::OutputGrid* grid_ = nullptr;
  struct Sum {
    std::size_t rows = 0;
    SquareSum squares{};
  };
  std::vector<Sum> sums_;
  model::Sample last_;                // row
  std::optional<Extremes> extremes_;  // in the order of of_motion_; of the least, turned over
};

}  // namespace bbsim::record
