// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Texts of a fit: a report, JSON, and the fitted scenario.
#pragma once

#include <string>
#include <vector>

#include "api/fit.hpp"

namespace bbsim::api {

[[nodiscard]] std::string report_of(const FitRequest& request, const fit::Fitted& fitted);

// Parts of the report: tables whose first line names the columns, and remarks on the comparison and
// the result.
[[nodiscard]] std::vector<std::vector<std::string>> parameter_table(const fit::Fitted& fitted);
[[nodiscard]] std::vector<std::vector<std::string>> residual_table(const fit::Fitted& fitted);
[[nodiscard]] std::string remarks_of(const FitRequest& request, const fit::Fitted& fitted);

[[nodiscard]] std::string json_of(const fit::Fitted& fitted);

// Throws as edited_scenario() does.
[[nodiscard]] std::string fitted_scenario(const FitRequest& request, const fit::Fitted& fitted);

}  // namespace bbsim::api
