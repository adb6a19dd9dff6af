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

Traces::Traces(std::vector<const scenario::Column*> columns)
    : columns_(std::move(columns)), curves_(columns_.columns().size()) {}

void Traces::begin(const model::Model& model, const model::BallConstants& constants) {
  model_ = &model;
  columns_.begin(model, constants);
  begin_run();
}

void Traces::begin_run() {
  for (Curve& curve : curves_) curve.clear();
}

const Curve& Traces::of(const scenario::Column& column) const {
  return curves_[static_cast<std::size_t>(std::ranges::find(columns(), &column) -
                                          columns().begin())];
}

void Traces::accept(const solve::Piece& piece) {
  const auto shows = [this](std::size_t i, const ChebyshevPoints& points) {
    const double* const values = columns_[i];
    double size = 0;
    for (std::size_t p = 0; p < points.size(); ++p) size = std::max(size, std::abs(values[p]));
    return !(points.tail(values) > unseen * size);
  };
  for (std::size_t parts = piece.parts();; parts *= 2) {
    const ChebyshevPoints& points = tables_.points(parts);
    const std::size_t count = points.size();
    times_.resize(count);
    rows_.resize(count * model_->row_size());
    for (std::size_t p = 0; p < count; ++p) {
      times_[p] = piece.from() + (piece.to() - piece.from()) * points[p];
    }
    times_.back() = piece.to();
    piece.evaluate(times_.data(), count, rows_.data());
    columns_.evaluate(times_.data(), rows_.data(), count);
    bool enough = true;
    for (std::size_t i = 0; enough && i < curves_.size(); ++i) enough = shows(i, points);
    if (!enough && 2 * parts <= most_intervals) continue;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      curves_[i].add_piece(piece.from(), piece.to(), points, columns_[i]);
    }
    return;
  }
}

void Traces::finish(double t, const Rows& last) {
  for (std::size_t i = 0; i < curves_.size(); ++i) curves_[i].end_at(t, last[i][0]);
}

}  // namespace bbsim::record
