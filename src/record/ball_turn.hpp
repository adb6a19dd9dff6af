// How the ball is turned, from row to row: what columns ball_qw to ball_qz are.
#pragma once

#include "base/quaternion.hpp"
#include "model/sample.hpp"

namespace bbsim::record {

// The rotation from the ball's own frame to the plane's, the identity in the first row. A ball that
// rolls and pivots turns at w = (-y', x', r gamma') / r in the plane's frame, so q' = w q / 2. From
// one row to the next that is integrated by Magnus' expansion to fourth order in their distance h:
//
//   q <- exp(d - h/12 d x (w1 - w0)) q,   d = (-dy, dx, r dgamma) / r,
//
// in which d, the integral of w, is exact, as the states are; what is left out comes of w turning
// between two rows.
class BallTurn {
 public:
  explicit BallTurn(double radius) : radius_(radius) {}  // m

  // Goes on to a row, which has gamma.
  const Quaternion& go_to(const model::Sample& row);

 private:
  double radius_;
  bool begun_ = false;
  model::Sample last_{};
  Quaternion now_{1, 0, 0, 0};
};

}  // namespace bbsim::record
