// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/rows.hpp"

#include <algorithm>
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

Rows::Rows(std::vector<const scenario::Column*> columns) : columns_(std::move(columns)) {
  for (const scenario::Column* column : columns_) {
    detail_ = std::max(detail_, detail_for(column->needs));
  }
  needs_dynamics_ = scenario::need_dynamics(columns_);
  if (detail_ > Detail::path && any_needs(columns_, Needs::controller)) detail_ = Detail::all;
  needs_orientation_ = any_needs(columns_, Needs::orientation);
  needs_ball_only_ =
      detail_ <= Detail::path && !needs_dynamics_ && !any_needs(columns_, Needs::own);
}

void Rows::begin(const model::Model& model, const model::BallConstants& constants) {
  model_ = &model;
  constants_ = &constants;
  fills_.clear();
  for (const scenario::Column* column : columns_) {
    fills_.push_back(fill_of(*column, model.own_columns()));
  }
  if (needs_orientation_) turn_.emplace(model.radius);
}

void Rows::evaluate(const double* times, const double* rows, std::size_t count) {
  resize(count);
  const std::size_t row_size = model_->row_size();
  for (std::size_t first = 0; first < count; first += strip) {
    take_samples(times + first, rows + first * row_size, std::min(strip, count - first));
    fill(first);
  }
}

void Rows::take_samples(const double* times, const double* rows, std::size_t count) {
  samples_.resize(count);
  if (shared_reference_ == nullptr || detail_ > Detail::path) {
    model_->samples(times, rows, count, detail_, samples_.data());
    return;
  }
  model::with_given_plate(model_->system, [&](const auto& loop) {
    for (std::size_t i = 0; i < count; ++i) {
      const double t = times[i];
      const auto& [x, y] =
          shared_reference_->entry(t).at(t, [&] { return loop.reference().at(t); });
      samples_[i].t = t;
      samples_[i].ball = loop.ball(rows + i * model_->row_size());
      samples_[i].reference = {x.value, y.value};
    }
  });
}

void Rows::evaluate(const solve::Piece& piece, const double* times, std::size_t count) {
  rows_.resize(count * model_->row_size());
  if (needs_ball_only_) {
    piece.evaluate_ball(times, count, rows_.data());
  } else {
    piece.evaluate(times, count, rows_.data());
  }
  evaluate(times, rows_.data(), count);
}

void Rows::evaluate(const model::Sample& sample) {
  resize(1);
  samples_.assign(1, sample);
  fill(0);
}

void Rows::resize(std::size_t count) {
  count_ = count;
  numbers_.resize(columns_.size() * count);
}

void Rows::fill(std::size_t first) {
  const std::size_t count = samples_.size();
  if (needs_dynamics_) {
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
                       needs_dynamics_ ? dynamics_.data() : nullptr,
                       turn_ ? orientations_.data() : nullptr};
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    fills_[c](block, &numbers_[c * count_ + first]);
  }
}

}  // namespace bbsim::record
