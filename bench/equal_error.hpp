// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares the times of tools at equal error, because their errors differ at equal tolerance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure.hpp"

namespace bbsim::bench {

// The time (s) at which `tool` reaches an error of `error` (m). Log-log interpolation between the
// points of the tool that no other of its points betters in both error and time. If all of these
// are more accurate than `error`, the time of the fastest. Empty if none is accurate enough.
[[nodiscard]] std::optional<double> seconds_at(const std::vector<Point>& points,
                                               const std::string& tool, double error);

}  // namespace bbsim::bench
