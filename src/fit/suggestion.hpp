// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Suggests a further key that would reduce the residuals of a fit.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// The one of task.candidates that, free together with the keys, would reduce the residuals most by
// their linear model at u; empty if each removes less than 5 % of their root mean square.
[[nodiscard]] std::optional<Suggestion> suggestion(const Task& task, const WindowsFit& at,
                                                   const Eigen::VectorXd& u);

}  // namespace bbsim::fit
