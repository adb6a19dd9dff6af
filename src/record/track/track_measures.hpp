// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures that most sweeps ask for, many instants at a time.
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

// Whether all of them can be taken by a TrackMeasures: of any column at the end; the greatest tilt,
// tilt_rate and distance; the greatest and the root mean square of tracking_error; all of them of
// the whole run.
[[nodiscard]] bool are_track_measures(const std::vector<scenario::Measure>& measures);

// Whether a TrackMeasures understands the model's rows: a ball anywhere on the plane under equation
// (27), with a given motion or equation (31).
[[nodiscard]] bool has_track(const model::Model& model);

// The motion of the model's gimbal, or the reference of its loop. The model has a track.
[[nodiscard]] const model::SignalPair& signals_of(const model::Model& model);

// What a run was greatest at.
struct TrackExtremes {
  double versine = 0;       // 1 - cos(tilt)
  double rate_squared = 0;  // of the plane's angular velocity, rad^2/s^2
  double distance = 0;      // from the plane's origin, m
  double error = 0;         // distance from the reference, m
};

// Takes the measures of one run after another, as a Recorder does of any measures. Squares of the
// states are polynomials over each step of the integrator, and what else it looks at is as smooth:
// their extremes are those of polynomials through values at as many points as they need.
class TrackMeasures : public solve::PieceSink {
 public:
  explicit TrackMeasures(std::vector<scenario::Measure> measures);
  TrackMeasures(const TrackMeasures&) = delete;
  TrackMeasures& operator=(const TrackMeasures&) = delete;

  // Whether it looks at positions alone.
  [[nodiscard]] bool wants_positions_only(const model::Model& model) const;

  // Begins a run; the three outlive it. `same_signals`: the motion or reference, and the grid, are
  // those of the run before.
  void begin(const model::Model& model, const model::BallConstants& constants,
             const solve::OutputGrid& grid, bool same_signals);

  // Rows of the run as a StateSink gets them, if they are wanted.
  void accept(std::size_t first, std::size_t count, const double* values);
  [[nodiscard]] bool wants_rows() const { return wants_rms_; }
  void begin_run() override;
  void accept(const solve::Piece& piece) override;

  // Takes the place of both accept(): a loop's places at its first `count` rows, all states of the
  // last of them, and what the motion was greatest at.
  void take(std::size_t count, const double* x, const double* y, const double* last,
            const TrackExtremes& greatest);

  // Writes the run's measures, one after the other.
  void finish(double* results);

 private:
  void copy_points(const double* rows, std::size_t count);
  void look();
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

  // The points of the pieces that have not been looked at yet.
  SpanSearch search_;
  std::vector<Span> spans_;
  std::size_t points_ = 0;
  PaddedRows x_, y_, phi_, theta_, phi_rate_, theta_rate_;
  SignalRows reference_;  // at them
  PaddedRows sizes_, more_sizes_;
  std::vector<double> times_, piece_rows_;

  TrackExtremes greatest_;  // so far; of a given motion without its own
  double reached_ = 0;      // s

  GimbalExtremes gimbal_;                           // of a given motion
  std::optional<GimbalExtremes::Greatest> motion_;  // up to motion_until_
  double motion_until_ = 0;                         // s

  std::size_t rows_ = 0;  // that came or, where they are not wanted, would have come
  PaddedRows row_x_, row_y_, row_squares_;
  SignalRows row_reference_;
  std::optional<solve::OutputGrid> timed_;  // whose times those are
  bool has_row_reference_ = false;
  std::vector<double> last_;  // row
  Rows end_;                  // the columns that are wanted of it
};

}  // namespace bbsim::record
