// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which further key would make the residuals of a fit smaller.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// The one of task.candidates that, free beside the keys, would take most of the residuals away, by
// their linear model at u; none if each takes less than a twentieth of their root mean square.
[[nodiscard]] std::optional<Suggestion> suggestion(const Task& task, const WindowsFit& at,
                                                   const Eigen::VectorXd& u);

}  // namespace bbsim::fit
