// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A fit as one HTML file: its tables, and plots of log and model. It opens offline and requests
// nothing.
#pragma once

#include <string>
#include <string_view>

#include "api/fit.hpp"

namespace bbsim::api {

inline constexpr const char* fit_template = "fit.html";  // see replay::read_template()

// Fills the page's template with a fit with_series. Times are doubles, other numbers floats. If all
// logs have more than 40,000 rows, each window keeps every nth.
[[nodiscard]] std::string fit_page(const FitRequest& request, const fit::Fitted& fitted,
                                   std::string_view page_template);

}  // namespace bbsim::api
