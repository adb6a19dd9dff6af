#include "record/ball_turn.hpp"

#include <array>
#include <utility>

namespace bbsim::record {
namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

const Quaternion& BallTurn::go_to(const model::Sample& row) {
  const model::BallMotion& from = last_.ball;
  const model::BallMotion& to = row.ball;
  if (std::exchange(begun_, true)) {
    const Vector turn{-(to.y - from.y) / radius_, (to.x - from.x) / radius_,
                      row.gamma - last_.gamma};
    const Vector change{-(to.y_dot - from.y_dot) / radius_, (to.x_dot - from.x_dot) / radius_,
                        to.gamma_dot - from.gamma_dot};
    const Vector bent = cross(turn, change);
    const double weight = (row.t - last_.t) / 12;
    Vector whole{};
    for (std::size_t i = 0; i < 3; ++i) whole[i] = turn[i] - weight * bent[i];
    now_ = normalised(product(rotation_by(whole), now_));
  }
  last_ = row;
  return now_;
}

}  // namespace bbsim::record
