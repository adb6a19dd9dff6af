// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/whole.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/short_number.hpp"

namespace bbsim {

bool is_whole(double value, double least, double most) {
  return value >= least && value <= most && value == std::floor(value);
}

std::string whole_numbers(double least, double most) {
  return "a whole number from " + short_number(least) +
         (most < largest_whole ? " to " + short_number(most) : " up");
}

void require_whole(const std::string& name, double value, double least, double most) {
  if (is_whole(value, least, most)) return;
  throw InputError(name + ": found " + short_number(value) +
                   "; allowed: " + whole_numbers(least, most));
}

}  // namespace bbsim
