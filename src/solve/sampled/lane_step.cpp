// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/lane_step.hpp"

#include <algorithm>

namespace bbsim::solve::sampled {
namespace {

constexpr std::size_t angle_state = model::RigLayout::angle, rate_state = model::RigLayout::rate;

}  // namespace

Range LaneStep::bounds(Size size, std::size_t lane) const {
  const Range range = lane_kernels_->narrow(quantities_, size, static_cast<int>(lane));
  const double beyond = close_overshoot * (range.most - range.least);
  return {range.least - beyond, range.most + beyond};
}

model::HeldMotion LaneStep::servo(std::size_t lane, std::size_t i) const {
  const LaneServo& servo = servos_->of[i];
  const LaneAxis& axis = pieces_->axis[i];
  return {{servo.stiffness[lane], servo.damping[lane]},
          axis.angle[lane],
          axis.rate[lane],
          axis.acceleration[lane]};
}

void LaneStep::evaluate(std::size_t lane, const double* times, std::size_t count,
                        double* rows) const {
  const LanePieces& of = *pieces_;
  Piece piece;
  for (int i = 0; i < 3; ++i) {
    for (int n = 0; n < nodes; ++n) piece.series[i][n] = of.series[i][n][lane];
    piece.velocity[i] = of.velocity[i][lane];
    piece.position[i] = i < 2 ? of.position[i][lane] : 0;
  }
  piece.length = of.length[lane];
  const model::HeldMotion servos[2] = {servo(lane, 0), servo(lane, 1)};
  constexpr std::size_t together = 16;
  double after[together], ball[together][6];
  for (std::size_t first = 0; first < count; first += together) {
    const std::size_t some = std::min(together, count - first);
    for (std::size_t i = 0; i < some; ++i) after[i] = times[first + i] - from_[lane];
    kernels_->evaluate(piece, after, some, ball);
    for (std::size_t i = 0; i < some; ++i) {
      double* const row = rows + (first + i) * states;
      std::copy_n(ball[i], 5, row);
      const model::ImpulseAnswer answer = model::answer(servos[0].law, after[i]);
      for (std::size_t k = 0; k < 2; ++k) {
        const bool alike = servos[k].law == servos[0].law;
        const model::HeldMotion::Instant now =
            alike ? servos[k].after(answer) : servos[k].after(after[i]);
        row[angle_state + k] = now.angle;
        row[rate_state + k] = now.rate;
      }
    }
  }
}

void LaneStep::evaluate(std::size_t lane, const double* times, std::size_t count,
                        Track* track) const {
  constexpr std::size_t together = 32;
  double rows[together * states];
  const LaneAxis &phi = pieces_->axis[0], &theta = pieces_->axis[1];
  for (std::size_t first = 0; first < count; first += together) {
    const std::size_t some = std::min(together, count - first);
    evaluate(lane, times + first, some, rows);
    for (std::size_t i = 0; i < some; ++i) {
      const double* const row = rows + i * states;
      track[first + i] = {row[0],
                          row[1],
                          phi.ratio[lane] * row[angle_state] + phi.offset[lane],
                          theta.ratio[lane] * row[angle_state + 1] + theta.offset[lane],
                          phi.ratio[lane] * row[rate_state],
                          theta.ratio[lane] * row[rate_state + 1]};
    }
  }
}

}  // namespace bbsim::solve::sampled
