// Takes measures (scenario/measures.hpp) of runs, one after another.
#pragma once

#include <cstddef>
#include <vector>

#include "model/model.hpp"
#include "record/both_sinks.hpp"
#include "record/extremes.hpp"
#include "record/rows.hpp"
#include "record/square_sum.hpp"
#include "record/traces.hpp"
#include "scenario/measures.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

// Takes the measures of one run after another. Where a value is no number it is left out of all but
// `end`; a measure without a value is no number.
class Meter : public solve::StateSink {
 public:
  explicit Meter(std::vector<scenario::Measure> measures);
  Meter(const Meter&) = delete;  // pieces_ look at this one's
  Meter& operator=(const Meter&) = delete;

  // Begins a run; the three outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants,
             const solve::OutputGrid& grid);
  void accept(std::size_t first, std::size_t count, const double* values) override;
  [[nodiscard]] solve::PieceSink* pieces() override;
  [[nodiscard]] std::size_t size() const { return measures_.size(); }
  // Writes the run's measures, size() of them, one after the other.
  void finish(const solve::Outcome& outcome, double* results);

 private:
  std::vector<scenario::Measure> measures_;
  // Which of them: extremes, means, and step metrics and instants (record/instants.hpp).
  std::vector<std::size_t> at_end_, of_motion_, of_rows_, of_curves_;
  Rows end_, rows_;  // the columns of those
  Extremes extremes_;
  Traces traces_;
  Rows traces_end_;
  BothPieces pieces_;
  const model::Model* model_ = nullptr;
  const solve::OutputGrid* grid_ = nullptr;
  struct Sum {
    std::size_t rows = 0;
    SquareSum squares{};
  };
  std::vector<Sum> sums_;      // of of_rows_
  std::vector<double> times_;  // of a block of rows
  double last_time_ = 0;       // s
  std::vector<double> last_;   // row
};

}  // namespace bbsim::record
