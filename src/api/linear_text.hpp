// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a linearization says to a person, shared by linearize() and check().
#pragma once

#include <string>

#include "api/report.hpp"
#include "model/control/linearize.hpp"

namespace bbsim::api {

// Margins of each command's loop, and the bandwidths.
[[nodiscard]] Report margin_lines(const model::Linearization& made);

// Points of operation, names and units, poles, zeros and margins.
[[nodiscard]] Report linear_report(const std::string& of, const model::Linearization& made);

}  // namespace bbsim::api
