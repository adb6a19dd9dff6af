// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Takes the usual measures of sweeps, many instants at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "record/rows.hpp"
#include "record/track/gimbal_extremes.hpp"
#include "record/track/kernels/track_kernels.hpp"
#include "record/track/padded_rows.hpp"
#include "record/track/signal_rows.hpp"
#include "record/track/spans.hpp"
#include "scenario/measures.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Whether TrackMeasures can take all of them: any column at the end except gamma; the greatest
// tilt, tilt_rate and distance; the greatest and the rms of tracking_error. All must be of the
// whole run.
[[nodiscard]] bool are_track_measures(const std::vector<scenario::Measure>& measures);

// Whether TrackMeasures can read the rows of the model: a ball anywhere on the plane under equation
// (27), with a given motion or equation (31).
[[nodiscard]] bool has_track(const model::Model& model);

// The motion of the model's gimbal, or the reference of its loop. Requires has_track(model).
[[nodiscard]] const model::SignalPair& signals_of(const model::Model& model);

// The greatest values of a run.
struct TrackExtremes {
  double versine = 0;       // 1 - cos(tilt)
  double rate_squared = 0;  // of the plane's angular velocity, rad^2/s^2
  double distance = 0;      // from the plane's origin, m
  double error = 0;         // distance from the reference, m
};

// Takes the measures of one run after another, as a Recorder does for any measures. Squares of the
// states are polynomials over each step of the integrator, and the other quantities are as smooth.
// Polynomials through enough points therefore have the same extremes.
class TrackMeasures : public solve::PieceSink {
 public:
  explicit TrackMeasures(std::vector<scenario::Measure> measures);
  TrackMeasures(const TrackMeasures&) = delete;
  TrackMeasures& operator=(const TrackMeasures&) = delete;

  // Whether only positions are needed.
  [[nodiscard]] bool wants_positions_only(const model::Model& model) const;

  // Begins a run. The first three arguments must outlive it. `same_signals`: the motion or
  // reference, and the grid, are those of the run before.
  void begin(const model::Model& model, const model::BallConstants& constants,
             const solve::OutputGrid& grid, bool same_signals);

  // Takes rows of the run as a StateSink does. Needed only if wants_rows().
  void accept(std::size_t first, std::size_t count, const double* values);
  [[nodiscard]] bool wants_rows() const { return wants_rms_; }
  void begin_run() override;
  void accept(const solve::Piece& piece) override;

  // Replaces both accept(): takes x and y at the first `count` rows, all states of the
  // last of these rows, and the greatest values of the motion.
  void take(std::size_t count, const double* x, const double* y, const double* last,
            const TrackExtremes& greatest);

  // Writes the measures of the run, one after the other.
  void finish(double* results);

 private:
  void copy_points(const double* rows, std::size_t count);
  void flush();
  void look_at_distances(double& greatest);
  void rescale(int exponent);
  [[nodiscard]] GimbalExtremes::Greatest motion_extremes();
  [[nodiscard]] double rms_error();

  std::vector<scenario::Measure> measures_;
  const TrackKernels& kernels_;
  const model::Model* model_ = nullptr;
  const solve::OutputGrid* grid_ = nullptr;
  const model::SignalPair* signals_ = nullptr;
  bool wants_distance_ = false, wants_gimbal_ = false, wants_error_ = false, wants_rms_ = false;
  bool closed_ = false;

  // The points of pieces that were not searched yet.
  SpanSearch search_;
  std::vector<Span> spans_;
  std::size_t points_ = 0;
  PaddedRows x_, y_, phi_, theta_, phi_rate_, theta_rate_;
  SignalRows reference_;  // at these points
  PaddedRows sizes_, more_sizes_;
  std::vector<double> times_, piece_rows_;

  TrackExtremes greatest_;  // so far; without those of a given motion, unless they were taken
  bool taken_ = false;      // by take()
  double reached_ = 0;      // s

  GimbalExtremes gimbal_;                           // of a given motion
  std::optional<GimbalExtremes::Greatest> motion_;  // up to motion_until_
  double motion_until_ = 0;                         // s

  std::size_t rows_ = 0;  // accepted rows, or passed output times if rows are not wanted
  PaddedRows row_x_, row_y_, row_squares_;
  SignalRows row_reference_;
  std::optional<solve::OutputGrid> timed_;  // the times of row_reference_
  bool has_row_reference_ = false;
  std::vector<double> last_;  // the last row
  Rows end_;                  // evaluates columns at it
};

}  // namespace bbsim::record
