// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Texts of tuning: a report, JSON, and the tuned scenario.
#pragma once

#include <string>

#include "api/tune.hpp"

namespace bbsim::api {

[[nodiscard]] std::string report_of(const TuneRequest& request, const Tuned& tuned);
[[nodiscard]] std::string json_of(const Tuned& tuned);

// Throws InputError if edited_text() cannot set a key in the text.
[[nodiscard]] std::string tuned_scenario(const TuneRequest& request, const Tuned& tuned);

}  // namespace bbsim::api
