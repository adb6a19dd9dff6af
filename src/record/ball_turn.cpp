// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/ball_turn.hpp"

#include <array>
#include <utility>

namespace bbsim::record {
namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Pair slip_of(const model::Sample& row) {
  return row.coupled ? Pair{row.coupled->slip[0], row.coupled->slip[1]} : Pair{0, 0};
}

}  // namespace

const Quaternion& BallTurn::go_to(const model::Sample& row) {
  const model::BallMotion& from = last_.ball;
  const model::BallMotion& to = row.ball;
  if (std::exchange(begun_, true)) {
    const double step = row.t - last_.t;
    const Pair before = slip_of(last_), now = slip_of(row);
    const Pair slipped{step * (before[0] + now[0]) / 2, step * (before[1] + now[1]) / 2};
    const Vector turn{(slipped[1] - (to.y - from.y)) / radius_,
                      (to.x - from.x - slipped[0]) / radius_, row.gamma - last_.gamma};
    const Vector change{(now[1] - before[1] - (to.y_dot - from.y_dot)) / radius_,
                        (to.x_dot - from.x_dot - (now[0] - before[0])) / radius_,
                        to.gamma_dot - from.gamma_dot};
    const Vector bent = cross(turn, change);
    const double weight = step / 12;
    Vector whole{};
    for (std::size_t i = 0; i < 3; ++i) whole[i] = turn[i] - weight * bent[i];
    now_ = normalised(product(rotation_by(whole), now_));
  }
  last_ = row;
  return now_;
}

}  // namespace bbsim::record
