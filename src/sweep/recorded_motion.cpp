// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bbsim::sweep {

RecordedMotion::RecordedMotion(std::size_t degree, std::size_t row_size)
    : points_(degree), row_size_(row_size), times_(points_.size()) {}

void RecordedMotion::accept(const solve::Piece& piece) {
  const double from = piece.from(), to = piece.to();
  for (std::size_t i = 0; i < points_.size(); ++i) times_[i] = from + (to - from) * points_[i];
  times_.back() = to;
  rows_.resize(points_.size() * row_size_);
  piece.evaluate(times_.data(), points_.size(), rows_.data());
  Kept& kept = pieces_.emplace_back(Kept{from, to});
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double value = rows_[i * row_size_ + c];
      kept.values[c].push_back(value);
      kept.size = larger(kept.size, std::abs(value));
    }
  }
}

std::vector<RecordedMotion::Kept>::const_iterator RecordedMotion::piece_at(double t) const {
  const auto ends_before = [](const Kept& kept, double time) { return kept.to < time; };
  const auto found = std::lower_bound(pieces_.begin(), pieces_.end(), t, ends_before);
  return found == pieces_.end() ? std::prev(found) : found;
}

std::array<double, 2> RecordedMotion::at(double t) const {
  const Kept& piece = *piece_at(t);
  const double s = std::clamp((t - piece.from) / (piece.to - piece.from), 0.0, 1.0);
  return {points_.at(piece.values[0].data(), s), points_.at(piece.values[1].data(), s)};
}

double RecordedMotion::size(double from, double to) const {
  double size = 0;
  const auto last = piece_at(to);
  for (auto piece = piece_at(from); piece <= last; ++piece) size = larger(size, piece->size);
  return size;
}

}  // namespace bbsim::sweep
