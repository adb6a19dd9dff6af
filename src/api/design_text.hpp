// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Texts of a design: a report, JSON, and comments for its scenario.
#pragma once

#include <string>

#include "api/design.hpp"

namespace bbsim::api {

[[nodiscard]] std::string report_of(const design::Task& task, const design::Designed& designed);
[[nodiscard]] std::string json_of(const design::Task& task, const design::Designed& designed);
[[nodiscard]] std::string comments_of(const DesignRequest& request, const design::Task& task,
                                      const design::Designed& designed);

}  // namespace bbsim::api
