// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tools asked for the same tolerance are not equally accurate; what compares them is their time at
// the same error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure.hpp"

namespace bbsim::bench {

// The time (s) at which `tool` gets an error of `error` (m): log-log interpolation between those of
// its points that no other of its points betters in both error and time. A tool whose every such
// point is more accurate than asked takes what its fastest takes; nothing if none is accurate
// enough.
[[nodiscard]] std::optional<double> seconds_at(const std::vector<Point>& points,
                                               const std::string& tool, double error);

}  // namespace bbsim::bench
