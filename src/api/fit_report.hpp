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

// Puts a fit with_series into the page's template. Times are doubles, other numbers floats. Of more
// than 40,000 rows of all logs, each window keeps every nth.
[[nodiscard]] std::string fit_page(const FitRequest& request, const fit::Fitted& fitted,
                                   std::string_view page_template);

}  // namespace bbsim::api
