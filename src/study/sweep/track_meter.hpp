// The measures that most sweeps ask for, many rows at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "record/measures.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "study/sweep/kernels/sweep_kernels.hpp"
#include "study/sweep/plan.hpp"

namespace bbsim::study {

// Doubles aligned and padded as the kernels want them.
class PaddedRows {
 public:
  void resize(std::size_t rows);
  // Repeats the last of `rows` values in the padding.
  void pad(std::size_t rows);
  [[nodiscard]] double* data() { return data_.get(); }
  [[nodiscard]] const double* data() const { return data_.get(); }

 private:
  struct Free {
    void operator()(double* memory) const { ::operator delete (memory, std::align_val_t{64}); }
  };
  std::unique_ptr<double, Free> data_;
  std::size_t room_ = 0;
};

// Whether a sum of squares has lost nothing to overflow and underflow.
[[nodiscard]] bool is_square(double squared);

// Whether all of them can be taken by a TrackMeter: of any column at the end; the greatest tilt,
// tilt_rate and distance; the greatest and the root mean square of tracking_error.
[[nodiscard]] bool are_track_measures(const std::vector<record::Measure>& measures);

// Whether a TrackMeter understands the model's rows: a ball anywhere on the plane under equation
// (27), with a given motion or equation (31).
[[nodiscard]] bool has_track(const model::Model& model);

// Whether all cases of a plan have one motion or reference, at the same times.
[[nodiscard]] bool shares_signals(const SweepPlan& plan);

// The motion of the model's gimbal, or the reference of its loop. The model has a track.
[[nodiscard]] const model::SignalPair& signals_of(const model::Model& model);

// Takes the measures of one run after another, as record::Meter does.
class TrackMeter : public solve::StateSink {
 public:
  explicit TrackMeter(std::vector<record::Measure> measures);

  // Whether it looks at positions alone.
  [[nodiscard]] bool wants_positions_only(const model::Model& model) const;

  // Begins a run; the three outlive it. `same_signals`: the motion or reference, and the grid, are
  // those of the run before.
  void begin(const model::Model& model, const model::BallConstants& constants,
             const solve::OutputGrid& grid, bool same_signals);
  void accept(std::size_t first, std::size_t count, const double* values) override;
  // The same, of rows that lie apart: state s of the i-th is values[i * row_stride + s * stride].
  void take(std::size_t first, std::size_t count, const double* values, std::size_t row_stride,
            std::size_t stride);
  // Writes the run's measures, one after the other. It has at least one row.
  void finish(double* results);

 private:
  void evaluate_signals(const model::SignalPair& signals);
  void cut_signals();
  [[nodiscard]] double tilt_at(std::size_t row) const;
  [[nodiscard]] double greatest_distance(bool from_reference) const;
  [[nodiscard]] double rms_tracking_error() const;

  std::vector<record::Measure> measures_;
  const SweepKernels& kernels_;
  const model::Model* model_ = nullptr;
  const model::BallConstants* constants_ = nullptr;
  const solve::OutputGrid* grid_ = nullptr;
  bool closed_ = false, wants_gimbal_ = false, wants_error_ = false, has_signals_ = false;
  std::size_t rows_ = 0;
  std::optional<solve::OutputGrid> timed_;  // whose times times_ are, and the waves'
  struct Sampled {
    double frequency;
    PaddedRows sines, cosines;
  };
  std::vector<Sampled> sampled_;
  std::vector<Wave> waves_;
  PaddedRows times_, x_, y_, phi_, theta_, phi_rate_, theta_rate_;
  PaddedRows signal_[2], signal_rate_[2];  // the gimbal's motion, or the reference
  PaddedRows cut_[4];                      // the same, as far as a run came that ended early
  std::vector<double> last_;               // row
  Track track_;
};

}  // namespace bbsim::study
