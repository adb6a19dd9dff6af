// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/fnv1a.hpp"
#include "catch.hpp"

namespace bbsim_test::test_fnv1a {

using namespace bbsim;

// Test vectors of its authors.
TEST_CASE("FNV-1a gives its authors' values") {
  CHECK(fnv1a("") == 0xCBF29CE484222325U);
  CHECK(fnv1a("a") == 0xAF63DC4C8601EC8CU);
  CHECK(fnv1a("foobar") == 0x85944171F73967E8U);
  CHECK(fnv1a(fnv1a_start, std::uint64_t{'a'}) == fnv1a("a"));
}

}  // namespace bbsim_test::test_fnv1a
