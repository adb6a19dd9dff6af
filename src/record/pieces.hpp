// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Passes the pieces of one run to several sinks, or the parts of them within a window of time.
#pragma once

#include <algorithm>
#include <vector>

#include "scenario/measures.hpp"
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
  [[nodiscard]] bool may_miss(solve::BoundsOfColumns& within) const override {
    return std::ranges::all_of(
        sinks_, [&](const solve::PieceSink* sink) { return sink->may_miss(within); });
  }
  // The sink for the pieces; null if there is none.
  [[nodiscard]] solve::PieceSink* sink() {
    if (sinks_.size() > 1) return this;
    return sinks_.empty() ? nullptr : sinks_.front();
  }

 private:
  std::vector<solve::PieceSink*> sinks_;
};

// Passes on each piece, or the part of it within the window, unless the part is shorter than the
// rounding of its time. Window and sink must outlive it.
class WindowPieces : public solve::PieceSink {
 public:
  WindowPieces(const scenario::Window& window, solve::PieceSink& sink)
      : window_(window), sink_(sink) {}
  void begin_run() override { sink_.begin_run(); }
  void accept(const solve::Piece& piece) override;
  [[nodiscard]] bool may_miss(solve::BoundsOfColumns& within) const override {
    return window_.is_whole() && sink_.may_miss(within);
  }

 private:
  const scenario::Window& window_;
  solve::PieceSink& sink_;
};

}  // namespace bbsim::record
