// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/pieces.hpp"

#include <algorithm>

#include "base/instant.hpp"

namespace bbsim::record {
namespace {

class PiecePart : public solve::Piece {
 public:
  PiecePart(const solve::Piece& whole, double from, double to)
      : Piece(from, to, whole.parts()), whole_(whole) {}

  void evaluate(const double* times, std::size_t count, double* rows) const override {
    whole_.evaluate(times, count, rows);
  }
  void evaluate_ball(const double* times, std::size_t count, double* rows) const override {
    whole_.evaluate_ball(times, count, rows);
  }
  // Bounds of the whole piece hold for its part.
  [[nodiscard]] std::optional<solve::Bounds> bounds(solve::Bounded column,
                                                    const model::BallConstants& constants,
                                                    bool closely) const override {
    return whole_.bounds(column, constants, closely);
  }

 private:
  const solve::Piece& whole_;
};

}  // namespace

void WindowPieces::accept(const solve::Piece& piece) {
  const double from = std::max(piece.from(), window_.begin());
  const double to = std::min(piece.to(), window_.end());
  if (from == piece.from() && to == piece.to()) {
    sink_.accept(piece);
  } else if (to - from > rounding_of(to)) {
    sink_.accept(PiecePart(piece, from, to));
  }
}

}  // namespace bbsim::record
