// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a fit says: a report, JSON, and the fitted scenario.
#pragma once

#include <string>
#include <vector>

#include "api/fit.hpp"

namespace bbsim::api {

[[nodiscard]] std::string report_of(const FitRequest& request, const fit::Fitted& fitted);

// Its parts: tables whose first line has the columns' names, and lines about what was compared and
// what is to be known of the result.
[[nodiscard]] std::vector<std::vector<std::string>> parameter_table(const fit::Fitted& fitted);
[[nodiscard]] std::vector<std::vector<std::string>> residual_table(const fit::Fitted& fitted);
[[nodiscard]] std::string remarks_of(const FitRequest& request, const fit::Fitted& fitted);

[[nodiscard]] std::string json_of(const fit::Fitted& fitted);

// A scenario's text with its overrides, then these settings. Throws InputError if a key has no
// place in the text.
[[nodiscard]] std::string text_with(const Source& source,
                                    std::vector<ScenarioFamily::Setting> settings);

// Such a text below comments; that it can be read is made sure.
[[nodiscard]] std::string scenario_with(const Source& source, const std::string& comments,
                                        std::vector<ScenarioFamily::Setting> settings);

// Throws as text_with() does.
[[nodiscard]] std::string fitted_scenario(const FitRequest& request, const fit::Fitted& fitted);

}  // namespace bbsim::api
