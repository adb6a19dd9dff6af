// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The JSON Schema (draft-07) of scenarios, for editors and validators.
#pragma once

#include <string>

namespace bbsim {

// The schema of the declared keys (scenario/keys.hpp) and their relations
// (scenario/relations.hpp).
[[nodiscard]] std::string scenario_json_schema();

}  // namespace bbsim
