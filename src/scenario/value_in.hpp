// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Values within names of measures and expectations: "5 cm", "0.05".
#pragma once

#include <optional>
#include <string_view>

namespace bbsim::scenario {

// A finite number, in SI, or a quantity of the dimension that `unit` is the SI unit of: "5 cm" of
// "m". Of a unit that has no others, such as "%" or "N m", it may stand behind the number.
[[nodiscard]] std::optional<double> value_in(std::string_view text, std::string_view unit);

}  // namespace bbsim::scenario
