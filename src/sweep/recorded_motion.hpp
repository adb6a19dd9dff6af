// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keeps the integrator's polynomials of a run and evaluates the contact point at any time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/chebyshev.hpp"
#include "solve/outcome.hpp"
#include "solve/piece.hpp"

namespace bbsim::sweep {

// Records runs whose rows begin with x and y.
class RecordedMotion : public solve::StateSink, public solve::PieceSink {
 public:
  // `degree` is that of x and y over each piece; `row_size` is the number of values in a row.
  RecordedMotion(std::size_t degree, std::size_t row_size);

  void accept(std::size_t, std::size_t, const double*) override {}
  [[nodiscard]] solve::PieceSink* pieces() override { return this; }
  [[nodiscard]] bool wants_rows() const override { return false; }
  void begin_run() override { pieces_.clear(); }
  void accept(const solve::Piece& piece) override;

  // x and y at time t (s) within the run, m.
  [[nodiscard]] std::array<double, 2> at(double t) const;
  // The greatest |x| or |y| at the points of the pieces that touch from ... to (s), m.
  [[nodiscard]] double size(double from, double to) const;

 private:
  struct Kept {
    double from, to;
    std::array<std::vector<double>, 2> values{};  // of x and y, at points_
    double size = 0;
  };
  [[nodiscard]] std::vector<Kept>::const_iterator piece_at(double t) const;

  ChebyshevPoints points_;
  std::size_t row_size_;
  std::vector<Kept> pieces_;
  std::vector<double> times_, rows_;
};

}  // namespace bbsim::sweep
