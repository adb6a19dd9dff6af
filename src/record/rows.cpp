// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/rows.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "model/systems/given_plate.hpp"

namespace bbsim::record {
namespace {

using model::Detail;
using scenario::Needs;

Detail detail_for(Needs needs) {
  switch (needs) {
    case Needs::ball:
    case Needs::gamma:
    case Needs::orientation:
    case Needs::own:
      return Detail::ball;
    case Needs::gimbal:
    case Needs::servos:
    case Needs::third_servo:
    case Needs::believed:
    case Needs::legs_believed:
      return Detail::gimbal;
    case Needs::accelerations:
    case Needs::dynamics:
    case Needs::plate:
    case Needs::torques:
    case Needs::armature:
    case Needs::coupled:
    case Needs::work:
    case Needs::pushed:
      return Detail::motion;
    case Needs::commands:
    case Needs::samples:
      return Detail::loop;
    case Needs::controller:
      break;
  }
  return Detail::path;
}

}  // namespace

void Rows::Sources::add(Needs needs) {
  detail = std::max(detail, detail_for(needs));
  controller = controller || needs == Needs::controller;
  dynamics = dynamics || needs >= Needs::dynamics;
  own = own || needs == Needs::own;
}

Detail Rows::Sources::all_details() const {
  return detail > Detail::path && controller ? Detail::all : detail;
}

bool Rows::Sources::ball_only() const {
  return detail <= Detail::path && !dynamics && !own;
}

Rows::Rows(std::vector<const scenario::Column*> columns)
    : columns_(std::move(columns)), all_(columns_.size()) {
  std::iota(all_.begin(), all_.end(), std::size_t{0});
  for (const scenario::Column* column : columns_) of_all_.add(column->needs);
}

void Rows::begin(const model::Model& model, const model::BallConstants& constants) {
  model_ = &model;
  row_size_ = model.row_size();
  constants_ = &constants;
  fills_.clear();
  for (const scenario::Column* column : columns_) {
    fills_.push_back(fill_of(*column, model.own_columns()));
  }
  if (any_needs(columns_, Needs::orientation)) turn_.emplace(model.radius);
}

void Rows::evaluate(const double* times, const double* rows, std::size_t count) {
  evaluate_some(times, rows, count, of_all_, all_);
}

void Rows::evaluate_some(const double* times, const double* rows, std::size_t count,
                         const Sources& from, std::span<const std::size_t> which) {
  resize(count);
  for (std::size_t first = 0; first < count; first += strip) {
    take_samples(times + first, rows + first * row_size_, std::min(strip, count - first),
                 from.all_details());
    fill(first, from.dynamics, which);
  }
}

void Rows::take_samples(const double* times, const double* rows, std::size_t count, Detail detail) {
  samples_.resize(count);
  if (shared_reference_ == nullptr || detail > Detail::path) {
    model_->samples(times, rows, count, detail, samples_.data());
    return;
  }
  model::with_given_plate(model_->system, [&](const auto& loop) {
    for (std::size_t i = 0; i < count; ++i) {
      const double t = times[i];
      const auto& [x, y] =
          shared_reference_->entry(t).at(t, [&] { return loop.reference().at(t); });
      samples_[i].t = t;
      samples_[i].ball = loop.ball(rows + i * row_size_);
      samples_[i].reference = {x.value, y.value};
    }
  });
}

void Rows::evaluate(const solve::Piece& piece, const double* times, std::size_t count) {
  evaluate(piece, times, count, all_);
}

void Rows::evaluate(const solve::Piece& piece, const double* times, std::size_t count,
                    std::span<const std::size_t> which) {
  Sources from;
  for (const std::size_t c : which) from.add(columns_[c]->needs);
  rows_.resize(count * row_size_);
  if (from.ball_only()) {
    piece.evaluate_ball(times, count, rows_.data());
  } else {
    piece.evaluate(times, count, rows_.data());
  }
  evaluate_some(times, rows_.data(), count, from, which);
}

void Rows::evaluate(const model::Sample& sample) {
  resize(1);
  samples_.assign(1, sample);
  fill(0, of_all_.dynamics, all_);
}

void Rows::resize(std::size_t count) {
  count_ = count;
  numbers_.resize(columns_.size() * count);
}

void Rows::fill(std::size_t first, bool with_dynamics, std::span<const std::size_t> which) {
  const std::size_t count = samples_.size();
  if (with_dynamics) {
    dynamics_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      dynamics_[i] = model::dynamics(samples_[i], *constants_);
    }
  }
  if (turn_) {
    orientations_.resize(count);
    for (std::size_t i = 0; i < count; ++i) orientations_[i] = turn_->go_to(samples_[i]);
  }
  const RowBlock block{count, samples_.data(), constants_,
                       with_dynamics ? dynamics_.data() : nullptr,
                       turn_ ? orientations_.data() : nullptr};
  for (const std::size_t c : which) fills_[c](block, &numbers_[c * count_ + first]);
}

}  // namespace bbsim::record
