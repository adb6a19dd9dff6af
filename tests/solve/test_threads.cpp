// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Threads do not modify shared data.
#include <cmath>

#include "catch.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_threads {

using namespace bbsim;

TEST_CASE("a run does not write signgam, the C library's shared sign of the gamma function") {
  // std::lgamma would write it, and cases of a sweep would race on it.
  signgam = 7;
  CHECK(run_in_memory(scenario_named("fig2a"), Method::radau, {1e-8, 1e-10}).samples.size() == 101);
  CHECK(signgam == 7);
}

}  // namespace bbsim_test::test_threads
