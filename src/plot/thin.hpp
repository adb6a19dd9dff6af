// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Fewer points for the same line on the screen.
#pragma once

#include "plot/picture.hpp"

namespace bbsim::plot {

// A curve over a growing x keeps at most four points a column of pixels: the first, the lowest, the
// highest and the last. No spike is lost, and gaps stay. Others are returned as they are.
[[nodiscard]] Curve thin_over_time(Curve curve, const Panel& panel);

// A path keeps the points that are at least a part of a pixel from the one before; more of them are
// left out where it still has more than 50,000.
[[nodiscard]] Curve thin_path(Curve curve, const Panel& panel);

}  // namespace bbsim::plot
