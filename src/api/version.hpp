// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The version and the commit of the source that this bbsim was built from.
#pragma once

#include <string_view>

namespace bbsim::api {

// For files: "0.4.0+g1234567", or "0.4.0" if the commit is unknown. With changes since the commit,
// ".changed" follows.
[[nodiscard]] std::string_view version();

// For people: "1234567", with ", with changes" if there are any, or why it is unknown.
[[nodiscard]] std::string_view commit();

}  // namespace bbsim::api
