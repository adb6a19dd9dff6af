// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Passes the pieces of one run to several sinks.
#pragma once

#include <vector>

#include "solve/piece.hpp"

namespace bbsim::record {

// Passes each piece to all sinks, in the order in which they were added.
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
  // The sink for the pieces; null if there is none.
  [[nodiscard]] solve::PieceSink* sink() {
    if (sinks_.size() > 1) return this;
    return sinks_.empty() ? nullptr : sinks_.front();
  }

 private:
  std::vector<solve::PieceSink*> sinks_;
};

}  // namespace bbsim::record
