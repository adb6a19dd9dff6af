// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/traces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bbsim::record {
namespace {

constexpr std::size_t most_intervals = 64;
// Points suffice if the remainder is at most this part of the values.
constexpr double unseen = 1e-14;

}  // namespace

Traces::Traces(std::vector<const scenario::Column*> columns,
               std::vector<const scenario::Column*> ends)
    : columns_(std::move(columns)),
      ends_(std::move(ends)),
      curves_(columns_.columns().size()),
      last_(ends_.columns().size()),
      values_(curves_.size()) {}

void Traces::begin(const model::Model& model, const model::BallConstants& constants) {
  columns_.begin(model, constants);
  ends_.begin(model, constants);
  begin_run();
}

void Traces::begin_run() {
  for (std::vector<Curve>* const curves : {&curves_, &last_}) {
    for (Curve& curve : *curves) curve.clear();
  }
}

const Curve& Traces::of(const scenario::Column& column) const {
  const auto traced = std::ranges::find(columns_.columns(), &column);
  if (traced != columns_.columns().end()) {
    return curves_[static_cast<std::size_t>(traced - columns_.columns().begin())];
  }
  return last_[static_cast<std::size_t>(std::ranges::find(ends_.columns(), &column) -
                                        ends_.columns().begin())];
}

void Traces::accept(const solve::Piece& piece) {
  if (!last_.empty()) {
    const double t = piece.to();
    ends_.evaluate(piece, &t, 1);
    for (std::size_t i = 0; i < last_.size(); ++i) {
      last_[i].clear();
      last_[i].add_line(t, t, ends_[i][0], ends_[i][0]);
    }
  }
  const auto shows = [](const std::vector<double>& values, const ChebyshevPoints& points) {
    double size = 0;
    for (const double value : values) size = std::max(size, std::abs(value));
    return !(points.tail(values.data()) > unseen * size);
  };
  for (std::size_t parts = piece.parts(), stride = 1;; parts *= 2, stride = 2) {
    const ChebyshevPoints& points = tables_.points(parts);
    sample(piece, points, stride);
    bool enough = true;
    for (std::size_t i = 0; enough && i < curves_.size(); ++i) enough = shows(values_[i], points);
    if (!enough && 2 * parts <= most_intervals) continue;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      curves_[i].add_piece(piece.from(), piece.to(), points, values_[i].data());
    }
    return;
  }
}

// Evaluates the columns at all points, or with a stride of 2 at each second one: the others have
// the values of half as many points.
void Traces::sample(const solve::Piece& piece, const ChebyshevPoints& points, std::size_t stride) {
  const std::size_t first = stride - 1;
  times_.clear();
  for (std::size_t p = first; p < points.size(); p += stride) {
    times_.push_back(piece.from() + (piece.to() - piece.from()) * points[p]);
  }
  if (first == 0) times_.back() = piece.to();
  columns_.evaluate(piece, times_.data(), times_.size());
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    std::vector<double>& values = values_[i];
    values.resize(points.size());
    for (std::size_t p = points.size() / 2 + 1; stride == 2 && p-- > 0;) values[2 * p] = values[p];
    for (std::size_t k = 0; k < times_.size(); ++k) values[first + k * stride] = columns_[i][k];
  }
}

void Traces::finish(double t, const model::Sample& last) {
  columns_.evaluate(last);
  ends_.evaluate(last);
  for (std::size_t i = 0; i < curves_.size(); ++i) curves_[i].end_at(t, columns_[i][0]);
  for (std::size_t i = 0; i < last_.size(); ++i) last_[i].end_at(t, ends_[i][0]);
}

}  // namespace bbsim::record
