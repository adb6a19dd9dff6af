// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Limits the motion that a sink receives to a window of time.
#pragma once

#include "scenario/window.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Passes on each piece, or the part of it within the window, unless the part is shorter than the
// rounding of its time. Window and sink must outlive it.
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
