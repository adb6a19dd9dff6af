// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads values within names of measures and expectations: "5 cm", "0.05".
#pragma once

#include <optional>
#include <string_view>

namespace bbsim::scenario {

// Reads a finite number in SI units, or a quantity with a unit of the same dimension: "5 cm" for
// "m". A unit without a dimension of its own, such as "%", may follow the number.
[[nodiscard]] std::optional<double> value_in(std::string_view text, std::string_view unit);

}  // namespace bbsim::scenario
