// The extremes of loops that go in step, a case in each lane.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/signals/signal_pair.hpp"
#include "record/track/spans.hpp"
#include "record/track/track_measures.hpp"
#include "solve/rosenbrock/loop_lanes.hpp"

namespace bbsim::sweep {

class LaneExtremes : public solve::rosenbrock::StepSink {
 public:
  LaneExtremes();

  // Begins a group; lane i has the i-th of the references, which outlive it.
  void begin(std::vector<const model::SignalPair*> references);
  void accept(const solve::rosenbrock::GroupStep& step) override;

  // What a lane's case was greatest at. Nothing of a case that is for another runner, since a
  // square overflowed or vanished.
  [[nodiscard]] std::optional<record::TrackExtremes> of(std::size_t lane) const;

 private:
  using Look = solve::rosenbrock::Look;
  static constexpr std::size_t group = solve::rosenbrock::group;

  void look_closer(const solve::rosenbrock::GroupStep& step, int look, std::size_t lane);
  [[nodiscard]] double size(int look, std::size_t lane, std::size_t point) const;

  record::SpanSearch search_;
  const ChebyshevPoints& points_;  // at which squares of the states show all that they do
  std::vector<const model::SignalPair*> references_;
  solve::rosenbrock::Looks looks_{};
  bool evaluated_ = false;  // rows_ are of the present step
  std::vector<double> times_, sizes_;
  record::PaddedRows rows_;
};

}  // namespace bbsim::sweep
