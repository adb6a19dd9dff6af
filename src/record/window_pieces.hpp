// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motion within a window of time, for a sink that knows of no other.
#pragma once

#include "scenario/window.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Passes on what of each piece is within the window, the whole of it or a part; no part that is
// shorter than the rounding of its time. Both outlive it.
class WindowPieces : public solve::PieceSink {
 public:
  WindowPieces(const scenario::Window& window, solve::PieceSink& sink)
      : window_(window), sink_(sink) {}
  void begin_run() override { sink_.begin_run(); }
  void accept(const solve::Piece& piece) override;

 private:
  const scenario::Window& window_;
  solve::PieceSink& sink_;
};

}  // namespace bbsim::record
