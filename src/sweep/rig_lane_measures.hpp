// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Takes the measures and series of sampled rigs in lanes, with a case in each lane.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/maxima.hpp"
#include "file/table_writer.hpp"
#include "record/rows.hpp"
#include "record/square_sum.hpp"
#include "scenario/measures.hpp"
#include "solve/sampled/rig_lanes.hpp"

namespace bbsim::sweep {

class RigLaneMeasures : public solve::sampled::LaneSink {
 public:
  // Requires are_usual_measures(measures).
  RigLaneMeasures(const std::vector<scenario::Measure>& measures,
                  const std::vector<const scenario::Column*>& series,
                  const solve::OutputGrid& grid);

  [[nodiscard]] solve::sampled::LaneAsked asks_for() const;

  // Begins a group whose cases have this reference, which must outlive the group. All groups have
  // the same reference.
  void begin(const model::SignalPair& reference);

  void accept(const solve::sampled::LaneStep& step) override;
  void accept_row(std::size_t lane, std::size_t row, double x, double y) override;
  void accept_whole(std::size_t lane, std::span<const double> row) override;
  void accept_end(std::size_t lane, double t, std::span<const double> row) override;

  // Writes the measures of a lane, one after the other. False if a square overflowed or vanished:
  // the case then needs another runner.
  [[nodiscard]] bool finish(std::size_t lane, const model::Model& model,
                            const model::BallConstants& constants, double* results);
  // Writes the series of a lane that has reached its end.
  void write_series(std::size_t lane, const model::Model& model,
                    const model::BallConstants& constants, file::TableWriter& into);

 private:
  static constexpr std::size_t group = solve::sampled::group;
  using Size = solve::Size;

  void look_closer(const solve::sampled::LaneStep& step, Size size, std::size_t lane);
  [[nodiscard]] double& greatest(Size size, std::size_t lane) { return greatest_[size][lane]; }
  void take_end(std::size_t lane, const model::Model& model);
  [[nodiscard]] double size_at(Size size, std::size_t point) const;

  std::vector<scenario::Measure> measures_;
  const solve::OutputGrid& grid_;
  std::array<bool, solve::size_count> wants_{};
  bool wants_rms_ = false;
  record::Rows end_;     // evaluates columns at the last row
  record::Rows series_;  // evaluates those of all rows

  const model::SignalPair* reference_ = nullptr;
  std::vector<std::array<double, 2>> at_rows_;  // the reference at each output row, m
  std::array<std::array<double, group>, solve::size_count> greatest_{};
  std::array<record::SquareSum, group> squares_{};
  std::array<std::vector<double>, group> last_row_;
  std::array<std::vector<double>, group> rows_;  // whole ones, if there are series
  std::array<double, group> last_time_{};

  const ChebyshevPoints points_;
  std::vector<double> times_, values_;
  std::vector<solve::sampled::LaneStep::Track> track_;  // at times_
  std::size_t track_of_ = group;                        // the lane in track_; `group` if none
};

}  // namespace bbsim::sweep
