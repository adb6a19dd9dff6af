// What a sweep keeps of a run: one number of a column over the run.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.hpp"
#include "record/columns.hpp"
#include "record/extremes.hpp"
#include "record/square_sum.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::record {

struct Measure {
  // least, greatest: over the continuous motion, both sides of every switch included; rms: the root
  // of the mean square over the rows; end: at the last instant reached, the row at time.end or
  // where the scene stopped.
  enum class Kind { least, greatest, rms, end } kind = Kind::end;
  const Column* column = nullptr;
  std::string name;  // max_tilt, end_phi, x_end

  [[nodiscard]] std::string meaning() const;
};

// min_, max_, rms_ or end_ and the name of a column; x_end and y_end are end_x and end_y.
[[nodiscard]] std::optional<Measure> find_measure(std::string_view name);

// For the message about a name that is none.
[[nodiscard]] std::string allowed_measures();

// x_end, y_end, max_tilt, max_tilt_rate, max_distance, and with a controller rms_tracking_error and
// max_tracking_error.
[[nodiscard]] std::vector<std::string> default_measures(bool closed_loop);

// What the columns of these measures are computed from.
[[nodiscard]] bool any_needs(const std::vector<Measure>& measures, Needs what);

// Why the scene has no such column, or null if it has.
[[nodiscard]] const char* why_missing(const Column& column, const Scenario& scenario);

// Why some of the measures of a run that came to its end are no finite numbers; empty if all are.
[[nodiscard]] std::string why_not_finite(const std::vector<Measure>& measures,
                                         const double* results, const Scenario& scenario);

// Takes the measures of one run after another. Where a value is no number it is left out of all but
// `end`; a measure without a value is no number.
class Meter : public solve::StateSink {
 public:
  explicit Meter(std::vector<Measure> measures);
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

  std::vector<Measure> measures_;
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
