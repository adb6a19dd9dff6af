// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/lane_step.hpp"

#include <algorithm>

#include "base/real.hpp"
#include "solve/sampled/column_bounds.hpp"
#include "solve/sampled/held_plate.hpp"

namespace bbsim::solve::sampled {
namespace {

constexpr std::size_t angle_state = model::RigLayout::angle;

}  // namespace

bool LaneStep::loses_motion() const {
  return std::any_of(pieces_->axis, pieces_->axis + pieces_->servos,
                     [](const LaneAxis& axis) { return axis.lost; });
}

std::optional<Bounds> LaneStep::bounds(std::size_t lane, Bounded column, bool closely) const {
  if (loses_motion()) return {};
  return column_bounds(column, [&](Quantity of) -> Range {
    if (of >= lane_quantity_count) return {-infinity, infinity};  // loads of motors
    if (!closely) return widened({quantities_.least[of][lane], quantities_.most[of][lane]});
    return widened_closely(lane_kernels_->narrow(quantities_, of, static_cast<int>(lane)));
  });
}

model::HeldMotion LaneStep::servo(std::size_t lane, std::size_t i) const {
  const LaneServo& servo = servos_->of[i];
  const LaneAxis& axis = pieces_->axis[i];
  return {{servo.stiffness[lane], servo.damping[lane]},
          axis.angle[lane],
          axis.rate[lane],
          axis.acceleration[lane]};
}

model::HeldMotions LaneStep::servos(std::size_t lane) const {
  model::HeldMotions motions{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(pieces_->servos); ++i) {
    motions[i] = servo(lane, i);
  }
  return motions;
}

void LaneStep::evaluate_ball(std::size_t lane, const double* times, std::size_t count, double* rows,
                             std::size_t row_size) const {
  const LanePieces& of = *pieces_;
  Piece piece;
  for (int i = 0; i < 3; ++i) {
    for (int n = 0; n < nodes; ++n) piece.series[i][n] = of.series[i][n][lane];
    piece.velocity[i] = of.velocity[i][lane];
    piece.position[i] = i < 2 ? of.position[i][lane] : 0;
  }
  piece.length = of.length[lane];
  const std::size_t size = rigs_[lane].model->size();
  constexpr std::size_t together = 16;
  double after[together], ball[together][6];
  for (std::size_t first = 0; first < count; first += together) {
    const std::size_t some = std::min(together, count - first);
    for (std::size_t i = 0; i < some; ++i) after[i] = times[first + i] - from_[lane];
    kernels_->evaluate(piece, after, some, ball);
    for (std::size_t i = 0; i < some; ++i) {
      double* const row = rows + (first + i) * row_size;
      // States beside the ball's and the servos' stay.
      std::copy_n(rigs_[lane].z, size, row);
      std::copy_n(ball[i], 5, row);
    }
  }
}

void LaneStep::evaluate(std::size_t lane, const double* times, std::size_t count, double* rows,
                        std::size_t row_size) const {
  evaluate_ball(lane, times, count, rows, row_size);
  const model::HeldMotions moves = servos(lane);
  const auto servo_count = static_cast<std::size_t>(pieces_->servos);
  for (std::size_t i = 0; i < count; ++i) {
    double* const row = rows + i * row_size;
    const double after = times[i] - from_[lane];
    const model::ImpulseAnswer answer = model::answer(moves[0].law, after);
    for (std::size_t k = 0; k < servo_count; ++k) {
      const bool alike = moves[k].law == moves[0].law;
      const model::HeldMotion::ServoState now =
          alike ? moves[k].after(answer, after) : moves[k].after(after);
      row[angle_state + k] = now.angle;
      row[angle_state + servo_count + k] = now.rate;
    }
  }
}

}  // namespace bbsim::solve::sampled
