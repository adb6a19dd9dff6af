// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares the times of tools at equal error, because their errors differ at equal tolerance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure.hpp"

namespace bbsim::bench {

// Time (s) at which `tool` reaches `error` (m), by log-log interpolation between those of its
// points that no other point beats in both error and time. If all are more accurate, the time of
// the fastest. Empty if none is accurate enough.
[[nodiscard]] std::optional<double> seconds_at(const std::vector<Point>& points,
                                               const std::string& tool, double error);

}  // namespace bbsim::bench
