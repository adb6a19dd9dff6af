// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reduces the points of a curve without changing its picture.
#pragma once

#include "plot/picture.hpp"

namespace bbsim::plot {

// Reduces a curve over increasing x to at most four points per column of pixels: the first, lowest,
// highest and last. Spikes and gaps stay. Returns other curves unchanged.
[[nodiscard]] Curve thin_over_time(Curve curve, const Panel& panel);

// Keeps points of a path that are at least a fraction of a pixel from the one before. Increases
// this distance until at most 50,000 points remain.
[[nodiscard]] Curve thin_path(Curve curve, const Panel& panel);

}  // namespace bbsim::plot
