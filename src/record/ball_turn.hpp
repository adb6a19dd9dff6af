// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How the ball is turned, from row to row: what columns ball_qw to ball_qz are.
#pragma once

#include "base/quaternion.hpp"
#include "model/sample.hpp"

namespace bbsim::record {

// The rotation from the ball's own frame to the plane's, the identity in the first row. A ball
// whose surface slips over the plane at s turns at w = (s_y - y', x' - s_x, r gamma') / r in the
// plane's frame, so q' = w q / 2. From one row to the next that is integrated by Magnus' expansion
// to fourth order in their distance h:
//
//   q <- exp(d - h/12 d x (w1 - w0)) q,   d = (S_y - dy, dx - S_x, r dgamma) / r.
//
// Where the ball rolls, s is zero and d, the integral of w, is exact, as the states are; what is
// left out comes of w turning between two rows. Where it slides, S = h (s0 + s1) / 2, exact under a
// constant friction: off by the square of h where the friction turns, or begins or ends between
// rows.
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
