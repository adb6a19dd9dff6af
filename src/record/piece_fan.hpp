// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One run's motion for all who look at it.
#pragma once

#include <vector>

#include "solve/piece.hpp"

namespace bbsim::record {

// Passes pieces on to any number of sinks, in their order.
class PieceFan : public solve::PieceSink {
 public:
  void clear() { sinks_.clear(); }
  void add(solve::PieceSink& sink) { sinks_.push_back(&sink); }
  void begin_run() override {
    for (solve::PieceSink* const sink : sinks_) sink->begin_run();
  }
  void accept(const solve::Piece& piece) override {
    for (solve::PieceSink* const sink : sinks_) sink->accept(piece);
  }
  // Who is to be told: null if nobody asks.
  [[nodiscard]] solve::PieceSink* sink() {
    if (sinks_.size() > 1) return this;
    return sinks_.empty() ? nullptr : sinks_.front();
  }

 private:
  std::vector<solve::PieceSink*> sinks_;
};

}  // namespace bbsim::record
